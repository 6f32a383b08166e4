//! What the sheet says of lateness: the section `policy` of a rubric.

use jiff::tz::TimeZone;
use serde::Deserialize;

/// The section `policy`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// The IANA name of the time zone in which times without an offset are meant.
    pub time_zone: String,
    /// What a late submission is worth; without it, late ones are not accepted.
    #[serde(default)]
    pub late: Option<LateRule>,
    /// For those who send a checksum in time and the file later.
    #[serde(default)]
    pub md5: Option<Md5Rule>,
    /// Points after a penalty are rounded to the nearest multiple of this, upwards in the middle.
    #[serde(default = "half")]
    pub round_to: f64,
}

/// What a late submission is worth.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LateRule {
    /// It is accepted if it is less than so many hours late.
    pub less_than_hours: u32,
    /// Then its points are multiplied by this.
    pub factor: f64,
}

/// A checksum instead of the file.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Md5Rule {
    /// The file may come up to so many hours after the deadline, if its checksum came before it.
    pub within_hours: u32,
}

/// The time zone of an IANA name such as `Europe/Berlin`.
///
/// # Errors
/// If there is none of that name.
pub fn zone(name: &str) -> Result<TimeZone, String> {
    TimeZone::get(name)
        .map_err(|_| format!("there is no time zone `{name}`; they are called like Europe/Berlin"))
}

fn half() -> f64 {
    0.5
}

impl Rules {
    /// What is wrong with them, if anything is.
    pub(crate) fn validate(&self) -> Result<(), String> {
        zone(&self.time_zone)?;
        if let Some(late) = self.late
            && !(0.0..=1.0).contains(&late.factor)
        {
            return Err("policy: `factor` must be between 0 and 1".to_owned());
        }
        if !(self.round_to.is_finite() && self.round_to > 0.0) {
            return Err("policy: `round_to` must be a positive number".to_owned());
        }
        Ok(())
    }
}
