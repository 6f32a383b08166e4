//! Annotations of GitHub Actions: workflow commands that point at lines of the student's file.

use super::{Surroundings, shortened};
use crate::words;
use verdict::report::Report;

/// GitHub shows so many of a kind for each step.
const SHOWN: usize = 10;

/// Characters of one message.
const LONGEST: usize = 2000;

/// One line for each annotation: what does not compile, the first checks of each task that failed, what the sandbox
/// refuses, remarks.
pub(super) fn annotations(report: &Report, surroundings: &Surroundings) -> String {
    let (mut errors, mut warnings, mut notices) = (Vec::new(), Vec::new(), Vec::new());
    let annotation = |line: Option<usize>, title: &str, message: &str| {
        let line = line.map_or_else(String::new, |line| format!(",line={line}"));
        let file = property(&surroundings.file);
        format!("file={file}{line},title={}::{}", property(title), data(&shortened(message, LONGEST)))
    };
    if let Some(failure) = &report.submission.build_failure {
        let line = failure.line.map(|line| line as usize);
        errors.push(annotation(line, "The file does not compile", &failure.messages));
    }
    // The first of each task, then the second of each: none is crowded out by another.
    let mut failed: Vec<_> = report
        .tasks
        .iter()
        .flat_map(|task| {
            report.lacking(&task.id).into_iter().enumerate().map(move |(rank, check)| (rank, task, check))
        })
        .collect();
    failed.sort_by_key(|(rank, _, _)| *rank);
    for (_, task, check) in failed {
        let title = format!("{} {}: {}", task.id, words::verdict(&check.verdict), check.id);
        let rerun = words::repeat_command(report, &check.id);
        let message = format!("{}\nrerun: {rerun}", words::explanation(check));
        errors.push(annotation(surroundings.lines.get(&task.id).copied(), &title, &message));
    }
    for finding in &report.sandbox.findings {
        warnings.push(annotation(Some(finding.line), &finding.what, &finding.why));
    }
    for check in &report.checks {
        let line = surroundings.lines.get(&check.task).copied();
        let remarks = words::remarks(check);
        notices.extend(remarks.iter().map(|remark| annotation(line, &check.id.to_string(), remark)));
    }
    let mut text = String::new();
    for (kind, list) in [("error", errors), ("warning", warnings), ("notice", notices)] {
        for annotation in list.iter().take(SHOWN) {
            text += &format!("::{kind} {annotation}\n");
        }
    }
    text
}

/// A message of a workflow command.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property of a workflow command.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{EVIL, check_with_remark, evil_report, report};
    use verdict::submission::BuildFailure;

    /// Takes a workflow command apart as the runner of GitHub does: up to the first `::`, split at commas, unescaped.
    fn read(line: &str) -> (String, Vec<(String, String)>, String) {
        let rest = line.strip_prefix("::").expect("it is a command");
        let (head, message) = rest.split_once("::").expect("it ends");
        let (kind, properties) = head.split_once(' ').expect("it has properties");
        let plain = |text: &str| {
            text.replace("%0D", "\r")
                .replace("%0A", "\n")
                .replace("%3A", ":")
                .replace("%2C", ",")
                .replace("%25", "%")
        };
        let properties = properties
            .split(',')
            .map(|pair| pair.split_once('=').map(|(key, value)| (key.to_owned(), plain(value))))
            .collect::<Option<_>>()
            .expect("they are pairs");
        (kind.to_owned(), properties, plain(message))
    }

    #[test]
    fn nothing_in_a_report_breaks_out_of_its_annotation() {
        let mut report = evil_report();
        report.submission.build_failure =
            Some(BuildFailure { messages: format!("100 %\r\n{EVIL}"), line: Some(7) });
        let surroundings = Surroundings {
            file: "a,b:c%0A.rs".to_owned(),
            lines: [("5.1a".to_owned(), 42)].into(),
            ..Surroundings::default()
        };
        let text = annotations(&report, &surroundings);
        let commands: Vec<_> = text.lines().map(read).collect();
        assert!(commands.len() >= 4, "{text}");
        for (kind, properties, _) in &commands {
            assert!(["error", "warning", "notice"].contains(&kind.as_str()));
            let keys: Vec<&str> = properties.iter().map(|(key, _)| key.as_str()).collect();
            assert_eq!(keys, ["file", "line", "title"], "{text}");
            assert_eq!(properties[0].1, "a,b:c%0A.rs");
        }
        assert_eq!(commands[0].1[1].1, "7");
        assert_eq!(commands[0].2, format!("100 %\r\n{EVIL}"));
        assert_eq!(commands[1].1[1].1, "42");
    }

    #[test]
    fn no_kind_has_more_than_are_shown_and_each_task_has_its_first() {
        let mut report = report("x");
        let mut task = report.tasks[0].clone();
        task.id = "5.2b".to_owned();
        report.tasks.push(task);
        let check = report.checks[0].clone();
        report.checks.extend(vec![check.clone(); 30]);
        report.checks.extend(vec![check_with_remark("x"); 30]);
        report.checks.push(verdict::check::CheckResult { task: "5.2b".to_owned(), ..check });
        let text = annotations(&report, &Surroundings::default());
        for kind in ["error", "warning", "notice"] {
            let count = text.lines().filter(|line| line.starts_with(&format!("::{kind} "))).count();
            assert!((1..=10).contains(&count), "{kind}: {count}");
        }
        assert!(text.lines().nth(1).is_some_and(|line| line.contains("5.2b")), "{text}");
    }
}
