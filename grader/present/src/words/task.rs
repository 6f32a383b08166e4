//! Where the points of a task are.

use verdict::report::{TaskResult, TaskState};

/// Why points of a task are missing, or who grades it; empty if nothing is missing.
pub fn task_state(task: &TaskResult) -> String {
    let is_missing = task.points.is_some_and(|points| points + task.staff_only < task.max);
    match &task.state {
        TaskState::Graded { missing } if missing.is_empty() && is_missing => {
            "a check that only staff can see did not pass".to_owned()
        }
        TaskState::Graded { missing } => {
            missing.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
        }
        TaskState::RequiredCheckMissing(Some(check)) => {
            format!("{check} must pass for any points in this task")
        }
        TaskState::RequiredCheckMissing(None) => {
            "a check that only staff can see must pass for any points in this task".to_owned()
        }
        TaskState::RequiredTaskMissing(other) => {
            format!("the required checks of {other} must pass for any points in this task")
        }
        TaskState::NotCompiled => "the submission does not compile".to_owned(),
        TaskState::NothingToGrade => "there is nothing to grade".to_owned(),
        TaskState::Partial => "not all checks of this task were run".to_owned(),
        TaskState::ByHand { comment: None } => "graded by your tutor".to_owned(),
        TaskState::ByHand { comment: Some(comment) } => format!("graded by your tutor: {comment}"),
    }
}
