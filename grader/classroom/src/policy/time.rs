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
    let local: DateTime = text.parse().map_err(|_| {
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
