//! The late policy of an assignment.

use std::path::Path;

use classroom::policy::{Course, Policy};
use harness::assignment::Assignment;
use verdict::error::{Error, Result};

/// Combines the rules of a rubric with the dates of a course: those of the file `course`, or else of the `course.yml` beside
/// the rubric. `None` if the rubric has no late policy.
///
/// # Errors
/// If the dates are wrong, or `course` is given for a rubric without a late policy.
pub(super) fn policy(assignment: &Assignment, course: Option<&Path>) -> Result<Option<Policy>> {
    let beside = assignment.folder.course_file();
    let file = course.map(Path::to_owned).or_else(|| beside.is_file().then_some(beside));
    let Some(rules) = &assignment.rubric.policy else {
        return match course {
            Some(path) => Err(Error::file(path, "the rubric has no `policy` that these dates belong to")),
            None => Ok(None),
        };
    };
    let dates = file.as_deref().map_or(Ok(Course::default()), Course::load)?;
    let wrong = |message: String| match &file {
        Some(file) => Error::file(file, message),
        None => Error::Input(message),
    };
    Policy::new(rules, &dates).map(Some).map_err(wrong)
}
