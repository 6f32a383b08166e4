//! The lateness of one submission.

use std::path::PathBuf;

use super::policy::policy;
use classroom::policy::{Policy, Receipt, Standing, parse_received};
use harness::assignment::Assignment;
use verdict::error::{Error, Result};

/// The options that say when a submission was received.
#[derive(clap::Args)]
pub(super) struct When {
    /// Receipt time, for the late policy; file times are never used
    #[arg(long, value_name = "TIME")]
    received_at: Option<String>,
    /// Deadline and extensions [default: course.yml beside the rubric, if there is one]
    #[arg(long, value_name = "FILE.yml", requires = "received_at")]
    course: Option<PathBuf>,
    /// Login of the student, to look up an extension
    #[arg(long, requires = "received_at", default_value = "")]
    student: String,
}

/// The receipt time of one submission, and the policy that applies to it.
pub(super) struct Received {
    policy: Policy,
    receipt: Receipt,
    student: String,
}

impl When {
    /// Reads policy and time; `None` without `--received-at`.
    ///
    /// # Errors
    /// If a file or the time is wrong, or the rubric has no late policy.
    pub(super) fn read(&self, assignment: &Assignment) -> Result<Option<Received>> {
        let Some(text) = &self.received_at else { return Ok(None) };
        let policy = policy(assignment, self.course.as_deref())?;
        let policy =
            policy.ok_or_else(|| Error::Input("the rubric has no `policy` for late submissions".into()))?;
        let time = parse_received(text, policy.zone())
            .map_err(|error| Error::Input(format!("--received-at: {error}")))?;
        let receipt = Receipt { received_at: Some(time), ..Receipt::default() };
        Ok(Some(Received { policy, receipt, student: self.student.clone() }))
    }
}

impl Received {
    /// One line: how late it is, and how many of the raw points count. `checksums` are the MD5 sums of the files that
    /// were received.
    pub(super) fn describe(&self, raw: f64, checksums: &[String]) -> String {
        let names = [self.student.as_str()];
        let lateness = self.policy.judge(&names, Some(&self.receipt), checksums);
        let points = self.policy.points(raw, &lateness);
        let standing = standing(&self.policy, &names, &self.receipt, checksums)
            .unwrap_or_else(|| "in time: there is no deadline".to_owned());
        format!("{standing}; {points} of {raw} points count")
    }
}

/// One line: whether a submission that was received then is late; `None` if there is no deadline.
pub(super) fn standing(
    policy: &Policy,
    names: &[&str],
    receipt: &Receipt,
    checksums: &[String],
) -> Option<String> {
    let (deadline, _) = policy.deadline(names)?;
    let lateness = policy.judge(names, Some(receipt), checksums);
    let local = deadline.to_zoned(policy.zone().clone()).strftime("%F %T %Z");
    let late = lateness.late_by_text();
    Some(match lateness.standing {
        Standing::InTime | Standing::Unknown => format!("in time: the deadline is {local}"),
        Standing::Late => format!("{late} late (deadline {local}): points × {}", lateness.factor),
        Standing::NotAccepted => format!("{late} late (deadline {local}): no longer accepted"),
    })
}
