//! The student's edition of a report: what is kept from students is not named anywhere in it.
//!
//! Kept back are the checks of the kind `hidden-variants`, and all that happens in a scene of `scenes/hidden/`, which a
//! rubric names `hidden/<name>`. Their points count, and how many there are is no secret. An edition is a report of its
//! own, made before any format is: no title, command or embedded number of a page can hold what is not in it.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::error::{Error, Result};
use crate::report::{CheckResult, Report, Verdict};
use crate::rubric::CheckKind;
use crate::text::quote;

/// The folder, below `scenes/`, of scenes that students do not get.
const FOLDER: &str = "hidden/";

/// What stands where a hidden check, or its scene, was named.
const INSTEAD: &str = "a check that is not shown";

/// For whom a report is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edition {
    /// For those who grade: everything.
    Tutor,
    /// For the student. So many checks are not shown, of which so many passed.
    Student {
        /// Checks that are not shown.
        concealed: usize,
        /// Of these, passed.
        passed: usize,
    },
}

/// The student's edition of a report. With `path`, commands in it name this path instead of the hand-in's, which may be
/// one of the staff's machine.
///
/// # Errors
/// If the report holds what JSON cannot.
pub fn for_student(report: &Report, path: Option<&str>) -> Result<(Report, Edition)> {
    let (hidden, shown): (Vec<&CheckResult>, Vec<&CheckResult>) =
        report.checks.iter().partition(|check| is_hidden(check.check, &check.scene));
    let edition = Edition::Student {
        concealed: hidden.len(),
        passed: hidden.iter().filter(|check| check.verdict == Verdict::Pass).count(),
    };
    let names = names(report, &hidden);
    let mut student = report.clone();
    student.checks = shown.into_iter().cloned().collect();
    student.left_out.retain(|entry| !(is_hidden_name(&entry.check) || is_hidden_name(&entry.scene)));
    student.images.retain(|image| !is_hidden_name(&image.scene));
    for task in &mut student.tasks {
        task.checks.retain(|check| !is_hidden_name(check));
    }
    if let Some(convergence) = &mut student.convergence {
        convergence.panels.retain(|panel| !is_hidden_name(&panel.scene));
        convergence.left_out.retain(|entry| !is_hidden_name(&entry.scene));
    }
    // What is left in sentences: reasons of tasks, evidence of likely causes, whatever else says a name.
    let mut replacements: Vec<(String, &str)> = names.into_iter().map(|name| (name, INSTEAD)).collect();
    if let Some(path) = path {
        let own = &report.submission.path;
        replacements.push((quote(own.as_ref()), path));
        replacements.push((own.clone(), path));
    }
    // The longest first: one name may be the beginning of another.
    replacements.retain(|(name, _)| !name.is_empty());
    replacements.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    let trouble = |error: serde_json::Error| Error::Harness(format!("the student's edition: {error}"));
    let mut value = serde_json::to_value(&student).map_err(trouble)?;
    replace(&mut value, &|text| {
        for (name, instead) in &replacements {
            if text.contains(name.as_str()) {
                *text = text.replace(name.as_str(), instead);
            }
        }
        if path.is_some() {
            name_assignment(text, &report.assignment);
        }
    });
    Ok((serde_json::from_value(value).map_err(trouble)?, edition))
}

/// True of checks that students do not get to know of: they can be run by staff only.
pub fn is_hidden(check: CheckKind, scene: &str) -> bool {
    check == CheckKind::HiddenVariants || is_hidden_name(scene)
}

/// True of names of scenes in the folder, and of names of checks that have such a scene or that kind.
pub fn is_hidden_name(name: &str) -> bool {
    name.starts_with(CheckKind::HiddenVariants.name()) || name.split_inclusive('/').any(|part| part == FOLDER)
}

/// All names by which a report calls what is hidden.
fn names(report: &Report, hidden: &[&CheckResult]) -> BTreeSet<String> {
    let of_checks = hidden.iter().flat_map(|check| [check.id.clone(), check.scene.clone()]);
    let left_out = report.left_out.iter().flat_map(|entry| [entry.check.clone(), entry.scene.clone()]);
    let of_tasks = report.tasks.iter().flat_map(|task| task.checks.clone());
    let mut names: BTreeSet<String> =
        of_checks.chain(left_out).chain(of_tasks).filter(|name| is_hidden_name(name)).collect();
    // The scene by itself, as files and messages may call it.
    let bare: Vec<String> = names
        .iter()
        .filter(|name| name.starts_with(FOLDER))
        .map(|name| name[FOLDER.len()..].to_owned())
        .collect();
    names.extend(bare);
    names.insert(CheckKind::HiddenVariants.name().to_owned());
    names
}

/// Replaces in all texts; keys are the format's own but in provenance, where they are the grader's.
fn replace(value: &mut Value, change: &dyn Fn(&mut String)) {
    match value {
        Value::String(text) => change(text),
        Value::Array(list) => list.iter_mut().for_each(|value| replace(value, change)),
        Value::Object(map) => map.values_mut().for_each(|value| replace(value, change)),
        _ => {}
    }
}

/// Has a command name the assignment, where it names a folder of the staff's machine with the rubric in it.
fn name_assignment(text: &mut String, assignment: &str) {
    const OPTION: &str = "--assignment=";
    let Some(start) = text.find(OPTION).map(|place| place + OPTION.len()) else { return };
    let end = text[start..].find(" --").map_or(text.len(), |length| start + length);
    if text[start..end].contains(['/', '\\']) {
        text.replace_range(start..end, assignment);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Diagnosis, LeftOut};
    use crate::sample::report;

    /// A report in which a hidden scene and the hidden variants are named wherever a name can be.
    fn telling() -> Report {
        let mut report = report("open");
        let mut secret = |id: &str, check, scene: &str| {
            let mut result = report.checks[0].clone();
            let text = format!("{id} in {scene}, the cellar");
            (result.id, result.check, result.scene) = (id.to_owned(), check, scene.to_owned());
            (result.explanation, result.repeat) = (text.clone(), format!("--only={id}"));
            result.remarks = vec![text];
            report.checks.push(result);
        };
        secret("hidden-variants/scripted/nee/6", CheckKind::HiddenVariants, "scripted");
        secret("mean-bias/hidden/cellar/nee/8", CheckKind::MeanBias, "hidden/cellar");
        report.checks[1].verdict = Verdict::Pass;
        let ids: Vec<String> = report.checks.iter().map(|check| check.id.clone()).collect();
        report.tasks[0].reason = ids.join(", ");
        report.tasks[0].checks = ids;
        let why = "scenes/hidden/cellar.yml has no area lights".to_owned();
        report.left_out.push(LeftOut {
            check: "efficiency with nee".to_owned(),
            scene: "hidden/cellar".to_owned(),
            why,
        });
        report.diagnosis.push(Diagnosis {
            mistake: "1".to_owned(),
            title: "a title".to_owned(),
            confidence: 0.9,
            evidence: "the cellar and hidden-variants are dark".to_owned(),
            hint: "look at mean-bias/hidden/cellar/nee/8".to_owned(),
        });
        report
    }

    #[test]
    fn nothing_hidden_is_named_in_the_students_edition() {
        let report = telling();
        let (student, edition) = for_student(&report, None).expect("it can be made");
        assert_eq!(edition, Edition::Student { concealed: 2, passed: 1 });
        let json = serde_json::to_string(&student).expect("it is JSON");
        let everything = serde_json::to_string(&report).expect("it is JSON");
        for secret in ["hidden-variants", "HiddenVariants", "cellar", "hidden/"] {
            assert!(
                secret == "HiddenVariants" || everything.contains(secret),
                "{secret} is there to be found"
            );
            assert!(!json.contains(secret), "{secret}");
        }
        assert_eq!(student.checks.len(), 1);
        assert_eq!(student.points, report.points, "hidden checks count all the same");
        assert!(student.tasks[0].reason.contains(INSTEAD));
    }

    #[test]
    fn a_path_of_the_staff_stays_with_the_staff() {
        let mut report = report("open");
        report.submission.path = "hand ins/Ann B_12/render_pt.rs".to_owned();
        report.assignment = "tiny".to_owned();
        report.checks[0].repeat =
            "cargo grade 'hand ins/Ann B_12/render_pt.rs' --assignment=/staff/tiny --seed=1".to_owned();
        let (student, _) = for_student(&report, Some("my/render_pt.rs")).expect("it can be made");
        assert_eq!(student.checks[0].repeat, "cargo grade my/render_pt.rs --assignment=tiny --seed=1");
        assert_eq!(student.submission.path, "my/render_pt.rs");
        let (same, _) = for_student(&report, None).expect("it can be made");
        assert_eq!(same, report, "where nothing is hidden, nothing changes");
    }
}
