//! The student's edition of a report: staff-only data is removed before any format is written.
//!
//! Staff-only checks count for points, and students may know how many there are. Every format is generated from the
//! report's data, so that no title, command or embedded number can reveal what was removed.

use crate::check::{CheckId, SkipReason, Verdict, Visibility};
use crate::report::{Report, TaskState};

/// Audience of a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edition {
    /// Staff: everything is shown.
    Tutor,
    /// The student: staff-only checks are hidden.
    Student {
        /// Number of hidden checks.
        concealed: usize,
        /// Number of hidden checks that passed.
        passed: usize,
    },
}

/// The student's edition of a report. `path` replaces the path of the submission, which may be one on a staff machine.
#[must_use]
pub fn for_student(report: &Report, path: Option<&str>) -> (Report, Edition) {
    let is_shown = |id: &CheckId| id.visibility() == Visibility::Public;
    let is_public = |scene: &str| Visibility::of_scene(scene) == Visibility::Public;
    let mut student = report.clone();
    student.checks.retain(|check| check.visibility == Visibility::Public);
    let concealed = report.checks.iter().filter(|check| check.visibility == Visibility::StaffOnly);
    let edition = Edition::Student {
        concealed: concealed.clone().count(),
        passed: concealed.filter(|check| check.verdict == Verdict::Pass).count(),
    };
    for check in &mut student.checks {
        if let Verdict::Skipped { why: SkipReason::PointsLostTo(cause) } = &mut check.verdict {
            *cause = cause.take().filter(is_shown);
        }
    }
    student.skipped.retain(|skipped| skipped.visibility() == Visibility::Public);
    student.images.retain(|image| is_public(&image.scene));
    for task in &mut student.tasks {
        task.checks.retain(is_shown);
        for step in &mut task.steps {
            step.checks.retain(is_shown);
        }
        task.steps.retain(|step| !step.checks.is_empty());
        match &mut task.state {
            TaskState::Graded { missing } => missing.retain(is_shown),
            TaskState::RequiredCheckMissing(check) => *check = check.take().filter(is_shown),
            _ => {}
        }
    }
    for diagnosis in &mut student.diagnosis {
        diagnosis.seen = diagnosis.seen.take().filter(|seen| is_shown(&seen.wrong)).map(|mut seen| {
            seen.right = seen.right.filter(is_shown);
            seen
        });
        if let crate::report::Cause::ConstantFactor { scenes, .. } = &mut diagnosis.cause {
            scenes.retain(|scene| is_public(scene));
        }
    }
    if let Some(convergence) = &mut student.convergence {
        convergence.panels.retain(|panel| is_public(&panel.scene));
        convergence.left_out.retain(|entry| is_public(&entry.scene));
    }
    if student.provenance.secret_seed {
        student.provenance.seed = None;
    }
    if let Some(path) = path {
        path.clone_into(&mut student.submission.path);
        student.provenance.assignment.clone_from(&student.assignment);
    }
    (student, edition)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn the_students_edition_has_no_staff_only_data() {
        let report = sample::with_staff_only_checks();
        let (student, edition) = for_student(&report, None);
        assert_eq!(edition, Edition::Student { concealed: 2, passed: 1 });
        let json = serde_json::to_string(&student).expect("it is JSON");
        let everything = serde_json::to_string(&report).expect("it is JSON");
        for secret in sample::STAFF_ONLY {
            assert!(everything.contains(secret), "{secret} is there to be found");
            assert!(!json.contains(secret), "{secret}");
        }
        assert_eq!(student.checks.len(), 1);
        assert_eq!(student.points, report.points, "checks that are not shown count all the same");
    }

    #[test]
    fn a_secret_seed_is_in_the_tutors_edition_only() {
        let mut report = sample::report("open");
        (report.provenance.seed, report.provenance.secret_seed) = (Some(0x5eed_5eed), true);
        let text = |report: &Report| serde_json::to_string(report).expect("it is JSON");
        let secret = 0x5eed_5eed_u64.to_string();
        assert!(text(&report).contains(&secret), "staff can repeat the grade");
        assert!(!text(&for_student(&report, None).0).contains(&secret));
        report.provenance.secret_seed = false;
        assert!(text(&for_student(&report, None).0).contains(&secret), "any other seed is no secret");
    }

    #[test]
    fn staff_paths_are_replaced_in_the_students_edition() {
        let mut report = sample::report("open");
        report.submission.path = "submissions/Ann B_12/render_pt.rs".to_owned();
        report.provenance.assignment = "/staff/tiny".to_owned();
        let (student, _) = for_student(&report, Some("my/render_pt.rs"));
        let json = serde_json::to_string(&student).expect("it is JSON");
        assert!(!json.contains("Ann B") && !json.contains("/staff"), "{json}");
        assert_eq!(for_student(&report, None).0, report, "where everything is public, nothing changes");
    }
}
