//! The dates of one course: `course.yml`.

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;

use verdict::error::Result;

/// Deadline and extensions of one course.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Course {
    /// Last moment at which a submission is in time. Without a deadline, nothing is late.
    #[serde(default)]
    pub deadline: Option<String>,
    /// Later deadlines of individual students.
    #[serde(default)]
    pub extensions: Vec<Extension>,
    /// True to write a leaderboard of efficiency without names.
    #[serde(default)]
    pub leaderboard: bool,
}

/// A later deadline for one student.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Extension {
    /// The student: login, number or e-mail address.
    pub student: String,
    /// The student's own deadline.
    pub until: String,
    /// Reason, for the record.
    pub reason: String,
}

impl Course {
    /// Reads the file.
    ///
    /// # Errors
    /// The first thing in it that is not as expected, with the line.
    pub fn load(path: &Path) -> Result<Self> {
        Ok(arty::yaml::read::<Self>(path)?.0)
    }

    /// The schema of the file, as JSON.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(Self).into()
    }
}
