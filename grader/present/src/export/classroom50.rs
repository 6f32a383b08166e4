//! The `result.json` of Classroom 50, the successor of GitHub Classroom: `classroom50/result/v1`.

use serde_json::{Value, json};

use super::Surroundings;
use verdict::report::Report;

/// The result. Its scores are whole numbers: each task is rounded, and the sum is that of the rounded ones. Points that
/// only staff can decide do not count.
pub(super) fn result(report: &Report, surroundings: &Surroundings) -> serde_json::Result<String> {
    let graded = report.tasks.iter().filter_map(|task| Some((task, task.points?)));
    let tests: Vec<(String, bool, u64, u64)> = graded
        .map(|(task, points)| {
            let max = task.max - task.staff_only;
            let name = format!("{} {}", task.id, task.title);
            (name, points >= max, points.round() as u64, max.round() as u64)
        })
        .collect();
    let list: Vec<Value> = tests
        .iter()
        .map(|(name, passed, score, max)| {
            json!({ "test-name": name, "passed": passed, "score": score, "max-score": max })
        })
        .collect();
    let variable = |name| surroundings.variable(name);
    let now = surroundings.now.map(|now| now.strftime("%FT%TZ").to_string()).unwrap_or_default();
    let result = json!({
        "schema": "classroom50/result/v1",
        "classroom": variable("CLASSROOM"),
        "assignment": variable("ASSIGNMENT"),
        "assignment_type": "individual",
        "owner": variable("GITHUB_REPOSITORY_OWNER"),
        "submission": variable("SUBMISSION_TAG"),
        "commit": variable("COMMIT_URL"),
        "release": variable("RELEASE_URL"),
        "review": variable("REVIEW_URL"),
        "datetime": now,
        "score": tests.iter().map(|(_, _, score, _)| score).sum::<u64>(),
        "max-score": tests.iter().map(|(_, _, _, max)| max).sum::<u64>(),
        "tests": list,
    });
    Ok(serde_json::to_string_pretty(&result)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{EVIL, report};

    #[test]
    fn it_has_every_key_and_whole_numbers_that_add_up() {
        let environment = [("CLASSROOM".to_owned(), EVIL.to_owned())].into();
        let surroundings = Surroundings { environment, ..Surroundings::default() };
        let text = result(&report(EVIL), &surroundings).expect("it can be made");
        let value: Value = serde_json::from_str(&text).expect("it is JSON");
        for key in [
            "schema",
            "classroom",
            "assignment",
            "assignment_type",
            "owner",
            "submission",
            "commit",
            "release",
            "review",
            "datetime",
        ] {
            assert!(value[key].is_string(), "{key}");
        }
        assert_eq!(value["classroom"], EVIL);
        let sum = |key: &str| -> Option<u64> {
            value["tests"].as_array()?.iter().map(|test| test[key].as_u64()).sum()
        };
        assert_eq!(sum("score"), value["score"].as_u64());
        assert_eq!(sum("max-score"), value["max-score"].as_u64());
        assert_eq!(value["score"], 13);
    }

    #[test]
    fn what_only_staff_can_decide_does_not_count_and_rounding_passes_nothing() {
        let task = |points: f64| {
            let mut report = report("x");
            (report.tasks[0].points, report.tasks[0].max, report.tasks[0].staff_only) =
                (Some(points), 20.0, 1.0);
            let text = result(&report, &Surroundings::default()).expect("it can be made");
            serde_json::from_str::<Value>(&text).expect("it is JSON")["tests"][0].clone()
        };
        let right = task(19.0);
        assert_eq!((&right["passed"], &right["max-score"]), (&json!(true), &json!(19)));
        let almost = task(18.5);
        assert_eq!((&almost["passed"], &almost["score"]), (&json!(false), &json!(19)));
    }
}
