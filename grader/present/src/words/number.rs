//! Numbers as people write them.

/// "1 check", "3 checks".
pub fn count(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

/// "1 point", "2.5 points".
pub fn number_of_points(points: f64) -> String {
    if points == 1.0 { "1 point".to_owned() } else { format!("{points} points") }
}

/// A duration in whole seconds: "1 h 05 min 00 s".
pub fn duration(seconds: i64) -> String {
    format!("{} h {:02} min {:02} s", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

/// A fraction in percent, with at most so many digits after the point and without trailing zeros: "2 %", "0.51 %".
pub(super) fn percent(fraction: f64, digits: usize) -> String {
    format!("{} %", trimmed(100.0 * fraction, digits))
}

/// A number with at most so many digits after the point and without trailing zeros.
pub(super) fn trimmed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Seconds, rounded to what a reader cares about: "30 s", "0.5 s".
pub(super) fn seconds(seconds: f64) -> String {
    let digits = if seconds < 10.0 { 1 } else { 0 };
    format!("{} s", trimmed(seconds, digits))
}

/// A radiance: "(0.5, NaN, 1e-9)".
pub(super) fn radiance(value: [f64; 3]) -> String {
    format!("({})", value.map(significant).join(", "))
}

/// Four significant digits; powers of ten only where they shorten the number.
pub(super) fn significant(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size @ 1e-3..1e6 => {
            let digits = (3.0 - size.log10().floor()).max(0.0) as usize;
            trimmed(value, digits)
        }
        _ if value.is_finite() => {
            let text = format!("{value:.3e}");
            let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => value.to_string(),
    }
}

/// A factor to a power: "distance²", "cos θ⁻¹".
pub(super) fn power(factor: &str, exponent: i32) -> String {
    if exponent == 1 { factor.to_owned() } else { format!("{factor}{}", superscript(exponent)) }
}

/// An exponent in raised digits: "⁻¹²".
pub(super) fn superscript(exponent: i32) -> String {
    let raised = |character: char| match character.to_digit(10) {
        Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
        None => '⁻',
    };
    exponent.to_string().chars().map(raised).collect()
}

/// "a", "a and b", "a, b and c".
pub(super) fn list(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns_and_verbs_agree_with_their_number() {
        assert_eq!([0, 1, 2].map(|n| count(n, "check")), ["0 checks", "1 check", "2 checks"]);
        assert_eq!([0.5, 1.0, 2.5].map(number_of_points), ["0.5 points", "1 point", "2.5 points"]);
    }

    #[test]
    fn numbers_have_no_digits_that_say_nothing() {
        assert_eq!([29.998172652, 4.0, 0.25].map(seconds), ["30 s", "4 s", "0.2 s"]);
        assert_eq!([(0.02, 1), (0.0051, 2), (-0.0, 1)].map(|(x, d)| percent(x, d)), ["2 %", "0.51 %", "0 %"]);
        let values = [0.0, 2.0, -0.12345, 1234.56, 1e-9, 3.4028e38, f64::NAN, f64::NEG_INFINITY];
        assert_eq!(values.map(significant), ["0", "2", "-0.1235", "1235", "1e-9", "3.403e38", "NaN", "-inf"]);
        assert_eq!(power("distance", -12), "distance⁻¹²");
        assert_eq!(list(&["a", "b", "c"].map(str::to_owned)), "a, b and c");
    }
}
