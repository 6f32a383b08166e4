//! Instants as people write them.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::{AmbiguousOffset, TimeZone};

/// Which of two instants is meant in the hour that the clocks go through twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Repeated {
    Earlier,
    Later,
}

/// When something was received: with an offset (`2026-05-21T23:59:00+02:00`, `…Z`) or as a local time. In the hour
/// that the clocks go through twice, a local time is read as the earlier one, in favour of the student.
///
/// # Errors
/// If it is no time, or one that the clocks of the zone jumped over.
pub fn parse_received(text: &str, zone: &TimeZone) -> Result<Timestamp, String> {
    parse(text, zone, Repeated::Earlier)
}

/// An instant, with an offset or as a local time.
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
