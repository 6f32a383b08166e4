//! Parsing of dates and times.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::{AmbiguousOffset, TimeZone};

/// Which of two instants a local time means in the hour that is repeated when clocks are set back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Repeated {
    Earlier,
    Later,
}

/// Parses a receipt time, with an offset (`2026-05-21T23:59:00+02:00`, `…Z`) or local. In the hour that is repeated when
/// clocks are set back, a local time means the earlier instant, in favour of the student.
///
/// # Errors
/// If it is not a time, or one that was skipped when clocks were set forward.
pub fn parse_received(text: &str, zone: &TimeZone) -> Result<Timestamp, String> {
    parse(text, zone, Repeated::Earlier)
}

/// Parses an instant, with an offset or as a local time.
pub(super) fn parse(text: &str, zone: &TimeZone, repeated: Repeated) -> Result<Timestamp, String> {
    let text = text.trim();
    if let Ok(instant) = text.parse::<Timestamp>() {
        return Ok(instant);
    }
    let of_office = || written_out(text).or_else(|| german(text));
    let local: DateTime = text.parse().ok().or_else(of_office).ok_or_else(|| {
        format!("`{text}` is no time; write 2026-05-21 23:59, or with an offset 2026-05-21T23:59:00+02:00")
    })?;
    // A date alone would be read as its first moment, which nobody means.
    if !text.contains(':') {
        return Err(format!("`{text}` has no time of day"));
    }
    let ambiguous = zone.to_ambiguous_timestamp(local);
    let chosen = match (ambiguous.offset(), repeated) {
        (AmbiguousOffset::Gap { .. }, _) => {
            return Err(format!("`{text}` did not exist: the clocks were put forward; give an offset"));
        }
        (AmbiguousOffset::Fold { .. }, Repeated::Later) => ambiguous.later(),
        _ => ambiguous.earlier(),
    };
    chosen.map_err(|error| format!("`{text}`: {error}"))
}

/// `24.10.2026 23:41`, with or without seconds and a comma.
fn german(text: &str) -> Option<DateTime> {
    let (date, time) = text.split_once([' ', ','])?;
    let [day, month, year] = date.split('.').collect::<Vec<_>>().try_into().ok()?;
    civil(year.trim(), month.parse().ok()?, day, time)
}

/// Months in the languages of course systems, as they begin.
const MONTHS: [&[&str]; 12] = [
    &["jan"],
    &["feb"],
    &["mar", "mär"],
    &["apr"],
    &["may", "mai"],
    &["jun"],
    &["jul"],
    &["aug"],
    &["sep"],
    &["oct", "okt"],
    &["nov"],
    &["dec", "dez"],
];

/// Moodle: `Saturday, 24 October 2026, 11:41 PM`, `Samstag, 24. Oktober 2026, 23:41`; ILIAS: `24. Okt 2026, 23:41`.
fn written_out(text: &str) -> Option<DateTime> {
    let is_day = |part: &&str| part.trim().starts_with(|c: char| c.is_ascii_digit());
    let parts: Vec<&str> = text.splitn(3, ',').skip_while(|part| !is_day(part)).collect();
    let [date, time] = parts.try_into().ok()?;
    let [day, month, year] = date.split_whitespace().collect::<Vec<_>>().try_into().ok()?;
    let month = month.to_lowercase();
    let number = MONTHS.iter().position(|starts| starts.iter().any(|start| month.starts_with(start)))?;
    civil(year, i8::try_from(number + 1).ok()?, day.trim_end_matches('.'), time)
}

/// A date with a time of day, `23:41`, `23:41:05` or `11:41 PM`.
fn civil(year: &str, month: i8, day: &str, time: &str) -> Option<DateTime> {
    let time = time.trim_matches([' ', ',']).to_lowercase();
    let (clock, half) = match (time.strip_suffix("am"), time.strip_suffix("pm")) {
        (Some(clock), _) => (clock, Some(0)),
        (_, Some(clock)) => (clock, Some(12)),
        _ => (time.as_str(), None),
    };
    let numbers: Vec<i8> = clock.trim().split(':').map(|text| text.parse().ok()).collect::<Option<_>>()?;
    let (hour, minute, second) = match numbers.as_slice() {
        [hour, minute] => (*hour, *minute, 0),
        [hour, minute, second] => (*hour, *minute, *second),
        _ => return None,
    };
    let hour = match half {
        Some(start) if (1..=12).contains(&hour) => hour % 12 + start,
        Some(_) => return None,
        None => hour,
    };
    DateTime::new(year.parse().ok()?, month, day.parse().ok()?, hour, minute, second, 0).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_offices_and_course_systems_are_read() {
        let expected = "2026-10-24T21:41:00Z";
        let zone = super::super::zone("Europe/Berlin").expect("it is known");
        for text in [
            "2026-10-24 23:41",
            "24.10.2026 23:41",
            "24.10.2026, 23:41:00",
            "Saturday, 24 October 2026, 11:41 PM",
            "Samstag, 24. Oktober 2026, 23:41",
            "24. Okt 2026, 23:41",
        ] {
            let time = parse_received(text, &zone).expect(text);
            assert_eq!(time.to_string(), expected, "{text}");
        }
        let midnight = parse_received("Saturday, 24 October 2026, 12:05 AM", &zone).expect("it is a time");
        assert_eq!(midnight.to_string(), "2026-10-23T22:05:00Z");
        for text in
            ["24.10.2026", "10/24/2026 23:41", "24.13.2026 23:41", "24.10.2026 25:41", "24.10.2026 13:41 PM"]
        {
            assert!(parse_received(text, &zone).is_err(), "{text}");
        }
    }
}
