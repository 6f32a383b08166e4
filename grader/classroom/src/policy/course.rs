//! The dates of one course: `course.yml`.

use std::path::Path;

use serde::Deserialize;

use verdict::error::Result;

/// A file of the course's own, with what changes each term.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Course {
    /// The last moment at which a submission is in time. Without it, nothing is late.
    #[serde(default)]
    pub deadline: Option<String>,
    /// Students who have longer.
    #[serde(default)]
    pub extensions: Vec<Extension>,
}

/// More time for one student.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extension {
    /// The student: login, number or e-mail address.
    pub student: String,
    /// The student's own deadline.
    pub until: String,
    /// Why, for those who ask later.
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
}
