//! Formatting of numbers.

use std::time::Duration;

/// A duration like 0:07, 12:34 or 1:02:03.
pub(super) fn clock(span: Duration) -> String {
    let seconds = span.as_secs_f64().round() as u64;
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02}"),
        _ => format!("{hours}:{minutes:02}:{seconds:02}"),
    }
}

/// A rate like 1.25 M samples/s.
pub(super) fn speed(samples_per_second: f64) -> String {
    format!("{:.2} M samples/s", samples_per_second * 1e-6)
}

/// A count with its noun: 1 light, 3 lights.
pub(super) fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_show_hours_only_if_needed() {
        let cases = [(0.2, "0:00"), (7.5, "0:08"), (59.6, "1:00"), (754.0, "12:34"), (3723.0, "1:02:03")];
        for (seconds, text) in cases {
            assert_eq!(clock(Duration::from_secs_f64(seconds)), text);
        }
    }

    #[test]
    fn one_is_singular() {
        assert_eq!(counted(1, "light"), "1 light");
        assert_eq!(counted(0, "light"), "0 lights");
        assert_eq!(speed(1_254_000.0), "1.25 M samples/s");
    }
}
