//! Gradescope's `results.json`.
//!
//! One test for each task that is graded automatically; nothing is hidden, since a hidden test would hide the total.

use std::fmt::Write;

use serde_json::{Value, json};

use super::markdown::{block, text};
use super::surroundings::Received;
use super::{Surroundings, shortened};
use crate::words;
use verdict::report::{Report, TaskResult};

/// Characters of a name.
const LONGEST: usize = 600;

/// The results.
pub(super) fn results(report: &Report, surroundings: &Surroundings) -> serde_json::Result<String> {
    let tests: Vec<Value> = report
        .tasks
        .iter()
        .filter_map(|task| {
            let points = task.points?;
            // Points that only staff can decide are not held against anyone here.
            let all = points + task.staff_only >= task.max;
            Some(json!({
                "name": shortened(&task.title, LONGEST),
                "number": task.id,
                "score": points,
                "max_score": task.max,
                "status": if all { "passed" } else { "failed" },
                "output": details(report, task),
                "output_format": "md",
                "visibility": "visible",
            }))
        })
        .collect();
    let results = json!({
        "score": report.points.earned,
        "execution_time": report.cost.total.round(),
        "output": output(report, surroundings),
        "output_format": "md",
        "test_output_format": "md",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
        "extra_data": {
            "schema": report.schema,
            "submission": report.submission.hash,
            "provenance": report.provenance,
            "sandbox": report.sandbox.level,
        },
    });
    Ok(serde_json::to_string_pretty(&results)? + "\n")
}

fn output(report: &Report, surroundings: &Surroundings) -> String {
    let points = &report.points;
    let mut out = format!(
        "{} of {}, graded automatically",
        points.earned,
        words::number_of_points(points.automatic_max)
    );
    let rest = words::not_covered(points);
    if !rest.is_empty() {
        out += &format!("; {rest}");
    }
    out += ".";
    if let Some(failure) = &report.submission.build_failure {
        out += "\n\n**The submission does not compile.**\n\n";
        out += &block(&failure.messages);
    }
    if let Some(Received { created_at, due: Some(due) }) = surroundings.received
        && created_at > due
    {
        let minutes = created_at.duration_since(due).as_secs().unsigned_abs().div_ceil(60);
        out += &format!(
            "\n\nIt was received {}:{:02} h after the deadline. These points do not take lateness into account.",
            minutes / 60,
            minutes % 60
        );
    }
    out
}

fn details(report: &Report, task: &TaskResult) -> String {
    let mut out = text(&words::task_state(task));
    for check in report.lacking(&task.id) {
        let (verdict, id) = (words::verdict(&check.verdict), text(&check.id.to_string()));
        let _ = write!(out, "\n\n**{verdict}** {id}: {}", text(&words::explanation(check)));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{evil_report, report};

    /// What Gradescope's documentation demands of a file, as far as we use it.
    fn assert_valid(value: &Value) {
        const FORMATS: [&str; 5] = ["text", "html", "simple_format", "md", "ansi"];
        const VISIBILITIES: [&str; 4] = ["hidden", "after_due_date", "after_published", "visible"];
        let one_of = |value: &Value, list: &[&str]| value.as_str().is_some_and(|text| list.contains(&text));
        let top = value.as_object().expect("an object");
        for key in top.keys() {
            let known = [
                "score",
                "execution_time",
                "output",
                "output_format",
                "test_output_format",
                "test_name_format",
                "visibility",
                "stdout_visibility",
                "extra_data",
                "tests",
                "leaderboard",
            ];
            assert!(known.contains(&key.as_str()), "{key}");
        }
        assert!(value["score"].is_number() || value["tests"].as_array().is_some_and(|list| !list.is_empty()));
        assert!(value["execution_time"].is_number() && value["output"].is_string());
        assert!(value["extra_data"].is_object());
        for key in ["output_format", "test_output_format"] {
            assert!(one_of(&value[key], &FORMATS), "{key}");
        }
        for key in ["visibility", "stdout_visibility"] {
            assert!(one_of(&value[key], &VISIBILITIES), "{key}");
        }
        for test in value["tests"].as_array().expect("a list") {
            assert!(test["score"].as_f64().is_some_and(|score| score >= 0.0), "{test}");
            assert!(test["score"].as_f64() <= test["max_score"].as_f64(), "{test}");
            assert!(one_of(&test["status"], &["passed", "failed"]), "{test}");
            assert!(one_of(&test["output_format"], &FORMATS), "{test}");
            assert_eq!(test["visibility"], "visible", "a hidden test hides the student's total");
            assert!(test["name"].is_string() && test["number"].is_string() && test["output"].is_string());
        }
    }

    #[test]
    fn it_keeps_to_the_documented_format_whatever_stands_in_the_report() {
        let made = results(&evil_report(), &Surroundings::default()).expect("it can be made");
        let value: Value = serde_json::from_str(&made).expect("it is JSON");
        assert_valid(&value);
        assert_eq!(value["score"], 12.5);
        let output = value["tests"][0]["output"].as_str().expect("a text");
        assert!(!output.contains("<script") && !output.contains("](http"), "{output}");
        assert!(
            value["output"].as_str().is_some_and(|text| text.contains("10 more are graded by your tutor"))
        );
    }

    #[test]
    fn who_is_late_is_told_and_keeps_the_raw_points() {
        let due = "2026-11-20T10:00:00Z".parse().ok();
        let at = |text: &str| {
            let created_at = text.parse().expect("a time");
            let surroundings =
                Surroundings { received: Some(Received { created_at, due }), ..Surroundings::default() };
            results(&report("x"), &surroundings).expect("it can be made")
        };
        assert!(at("2026-11-20T11:20:01Z").contains("It was received 1:21 h after"));
        assert!(!at("2026-11-20T10:00:00Z").contains("It was received"));
        assert!(at("2026-11-20T11:20:01Z").contains("\"score\": 12.5"));
    }

    #[test]
    fn points_that_only_staff_decide_are_not_held_against_a_task() {
        let mut report = report("x");
        report.tasks[0].staff_only = 7.5;
        report.points.staff_only = 7.5;
        let value: Value =
            serde_json::from_str(&results(&report, &Surroundings::default()).expect("it can be made"))
                .expect("it is JSON");
        assert_eq!(value["tests"][0]["status"], "passed");
        assert!(
            value["output"]
                .as_str()
                .is_some_and(|text| text.contains("up to 7.5 points are added after submission"))
        );
    }
}
