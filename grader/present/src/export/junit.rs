//! JUnit's XML: a suite for each task, a test case for each check. Why something failed stands in the element's text, too:
//! some show that, others its attribute `message`.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report as Document, TestCase, TestCaseStatus, TestSuite};

use crate::words;
use verdict::check::{CheckResult, Verdict};
use verdict::report::{Report, TaskResult};

/// The document. Names of test cases are told apart by their suites and their class names, which are the tasks.
pub(super) fn xml(report: &Report) -> Result<String, quick_junit::SerializeError> {
    let mut document = Document::new(&report.assignment);
    if let Some(failure) = &report.submission.build_failure {
        let mut suite = TestSuite::new("build");
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status
            .set_message("the submission does not compile")
            .set_type("build")
            .set_description(&failure.messages);
        suite.add_test_case(case("build", "compile", status, report.cost.build));
        document.add_test_suite(suite);
    }
    for task in &report.tasks {
        document.add_test_suite(suite(report, task));
    }
    let skipped = document.skipped;
    // Jenkins' schema (junit-10.xsd of its xUnit plugin) has this attribute in suites, but not in their parent.
    let text = document.to_string()?.replacen(&format!(" skipped=\"{skipped}\""), "", 1);
    // quick-junit removes the other characters that XML does not allow.
    Ok(text.replace(['\u{fffe}', '\u{ffff}'], ""))
}

fn suite(report: &Report, task: &TaskResult) -> TestSuite {
    let mut suite = TestSuite::new(format!("{} {}", task.id, task.title));
    if let Some(points) = task.points {
        suite.add_property(("points", points.to_string().as_str()));
    }
    suite.add_property(("max", task.max.to_string().as_str()));
    if task.staff_only > 0.0 {
        suite.add_property(("staff-only", task.staff_only.to_string().as_str()));
    }
    for check in report.checks.iter().filter(|check| check.task == task.id) {
        let mut case = case(&task.id, &check.id.to_string(), status(report, check), check.seconds);
        let remarks = words::remarks_with_replay(check, &report.submission.path);
        if !remarks.is_empty() {
            case.set_system_out(remarks.join("\n"));
        }
        suite.add_test_case(case);
    }
    for entry in &report.skipped {
        if let Some(check) = entry.check.as_ref().filter(|check| task.checks.contains(check)) {
            let why = words::why_not(&entry.why);
            suite.add_test_case(case(&task.id, &check.to_string(), skipped(&why), 0.0));
        }
    }
    let state = words::task_state(task);
    let unexplained =
        suite.test_cases.is_empty() || (report.lacking(&task.id).is_empty() && !state.is_empty());
    if unexplained {
        // A task without checks of its own, or one that lost its points by another's.
        let status = match task.points {
            Some(points) if points + task.staff_only < task.max => failed(&state, "task"),
            _ => skipped(&state),
        };
        suite.add_test_case(case(&task.id, "points", status, 0.0));
    }
    suite
}

fn case(class: &str, name: &str, status: TestCaseStatus, seconds: f64) -> TestCase {
    let mut case = TestCase::new(name, status);
    case.set_classname(class).set_time(Duration::try_from_secs_f64(seconds).unwrap_or_default());
    case
}

fn status(report: &Report, check: &CheckResult) -> TestCaseStatus {
    let explanation = words::explanation(check);
    match &check.verdict {
        Verdict::Pass => TestCaseStatus::success(),
        Verdict::Skipped { .. } => skipped(&explanation),
        verdict @ (Verdict::Fail | Verdict::Inconclusive | Verdict::NotRun { .. }) => {
            let mut status = failed(&explanation, words::verdict(verdict));
            let rerun = words::repeat_command(report, &check.id);
            status.set_description(format!("{explanation}\n\nrerun: {rerun}"));
            status
        }
    }
}

fn failed(why: &str, kind: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_message(why).set_type(kind).set_description(why);
    status
}

fn skipped(why: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::skipped();
    status.set_message(why).set_description(why);
    status
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::CheckKind;
    use verdict::sample::{EVIL, evil_report, id, report};

    #[test]
    fn what_is_written_reads_back_whatever_stands_in_the_report() {
        let mut report = evil_report();
        let skipped = id(CheckKind::Efficiency, EVIL);
        report.skipped[0].check = Some(skipped.clone());
        report.tasks[0].checks.push(skipped);
        let text = xml(&report).expect("it can be made");
        let read = Document::deserialize_from_str(&text).expect("it is JUnit's XML");
        assert_eq!(read.test_suites.len(), 2, "{text}");
        assert_eq!((read.tests, read.failures), (4, 1), "{text}");
        let tags = |name: &str| -> Vec<String> {
            let parts = text.split('<').filter_map(|part| part.strip_prefix(name)?.split('>').next());
            parts.filter(|part| part.starts_with(' ')).map(str::to_owned).collect()
        };
        assert!(
            tags("testsuites").iter().all(|tag| !tag.contains(" skipped=")),
            "Jenkins refuses it: {text}"
        );
        assert!(tags("testsuite").iter().all(|tag| tag.contains(" skipped=")), "{text}");
        let failed = &read.test_suites[0].test_cases[0];
        assert!(
            matches!(&failed.status, TestCaseStatus::NonSuccess { message: Some(message), .. }
            if message.as_str().contains("<script>")),
            "{failed:?}"
        );
        // XML allows no control characters but three, and no noncharacters, not even escaped.
        let is_refused =
            |c: char| (c.is_control() && !"\n\r\t".contains(c)) || "\u{fffe}\u{ffff}".contains(c);
        assert!(!text.chars().any(is_refused), "{text:?}");
        let points = &read.test_suites[0].properties[0];
        assert_eq!((points.name.as_str(), points.value.as_str()), ("points", "12.5"));
    }

    #[test]
    fn what_does_not_compile_is_an_error_and_no_empty_success() {
        let mut report = report("x");
        report.checks.clear();
        report.skipped.clear();
        report.tasks[0].points = Some(0.0);
        report.submission.build_failure =
            Some(verdict::submission::BuildFailure { messages: "error: x]]>".to_owned(), line: None });
        let text = xml(&report).expect("it can be made");
        let read = Document::deserialize_from_str(&text).expect("it is JUnit's XML");
        assert_eq!((read.errors, read.failures), (1, 1), "{text}");
    }
}
