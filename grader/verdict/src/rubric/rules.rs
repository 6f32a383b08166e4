//! Rules for late submissions: the section `policy` of a rubric.

use jiff::tz::TimeZone;
use serde::Deserialize;

/// Rules for late submissions.
#[derive(Clone, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// IANA name of the time zone of times without an offset.
    pub time_zone: String,
    /// Penalty for late submissions; without it, late submissions are not accepted.
    #[serde(default)]
    pub late: Option<LateRule>,
    /// Rule for a checksum that arrives in time and its file later.
    #[serde(default)]
    pub md5: Option<Md5Rule>,
    /// Points after a penalty are rounded to the nearest multiple of this, ties upwards.
    #[serde(default = "half")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub round_to: f64,
}

/// Penalty for late submissions.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LateRule {
    /// A submission is accepted if it is less than this many hours late.
    #[schemars(extend("maximum" = u32::MAX))]
    pub less_than_hours: u32,
    /// Factor on its points, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub factor: f64,
}

/// Rule for submitting a checksum before the deadline.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Md5Rule {
    /// Number of hours after the deadline within which the file must arrive, if its checksum arrived before the
    /// deadline.
    #[schemars(extend("maximum" = u32::MAX))]
    pub within_hours: u32,
}

/// The time zone with an IANA name such as `Europe/Berlin`.
///
/// # Errors
/// If there is no such time zone.
pub fn zone(name: &str) -> Result<TimeZone, String> {
    TimeZone::get(name)
        .map_err(|_| format!("unknown time zone `{name}`: use an IANA name such as Europe/Berlin"))
}

fn half() -> f64 {
    0.5
}

impl Rules {
    /// Checks the values.
    ///
    /// # Errors
    /// The first wrong value.
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
