//! The last line that Autolab looks for: points by problem.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use verdict::report::Report;

/// One line of JSON, without tasks that a tutor grades or that were not run.
pub(super) fn line(report: &Report) -> serde_json::Result<String> {
    let scores: BTreeMap<&str, f64> =
        report.tasks.iter().filter_map(|task| Some((task.id.as_str(), task.points?))).collect();
    let scores: Map<String, Value> =
        scores.into_iter().map(|(id, points)| (id.to_owned(), json!(points))).collect();
    Ok(serde_json::to_string(&json!({ "scores": scores }))? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{EVIL, report};

    #[test]
    fn it_is_one_line_of_the_tasks_that_have_points() {
        let line = line(&report(EVIL)).expect("it can be made");
        assert_eq!(line, "{\"scores\":{\"5.1a\":12.5}}\n");
    }
}
