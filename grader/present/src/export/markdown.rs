//! A summary in GitHub's Markdown, for the page of a workflow's run.

use std::fmt::Write;

use super::shortened;
use crate::words;
use verdict::check::CheckResult;
use verdict::report::{Report, TaskResult};
use verdict::sandbox::Level;

/// Failed checks of a task that are explained.
const EXPLAINED: usize = 5;

/// Characters of one explanation, and of rustc's messages: GitHub takes 1 MiB in all.
const LONGEST: usize = 600;
const LONGEST_MESSAGES: usize = 20_000;

/// The summary.
pub(super) fn summary(report: &Report) -> String {
    let points = &report.points;
    let max = words::number_of_points(points.automatic_max);
    let mut out = format!("## {}: {} of {max}\n\n", text(&report.assignment), points.earned);
    let rest = words::not_covered(points);
    if !rest.is_empty() {
        let _ = writeln!(out, "Graded automatically; {rest}.\n");
    }
    out += "| task | | points | what is missing |\n|---|---|--:|---|\n";
    for task in &report.tasks {
        let points = task.points.map_or_else(|| "–".to_owned(), |points| points.to_string());
        let (id, title, reason) = (text(&task.id), text(&task.title), text(&words::task_state(task)));
        let _ = writeln!(out, "| {id} | {title} | {points} / {} | {reason} |", task.max);
    }
    if let Some(failure) = &report.submission.build_failure {
        out += "\n### The submission does not compile\n\n";
        out += &block(&failure.messages);
    }
    for diagnosis in &report.diagnosis {
        let _ = writeln!(out, "\n### {}", text(&words::heading(diagnosis)));
        let seen = words::seen(report, diagnosis);
        for (begin, part) in [("Observed: ", seen.as_str()), ("Hint: ", words::hint(&diagnosis.cause))] {
            if !part.is_empty() {
                let _ = writeln!(out, "\n{begin}{}", text(part));
            }
        }
    }
    for task in &report.tasks {
        failures(&mut out, report, task);
    }
    let remarks: Vec<(&CheckResult, String)> = report
        .checks
        .iter()
        .flat_map(|check| words::remarks(check).into_iter().map(move |remark| (check, remark)))
        .take(EXPLAINED)
        .collect();
    if !remarks.is_empty() {
        out += "\n### Remarks (they cost no points)\n\n";
        for (check, remark) in remarks {
            let _ = writeln!(out, "- {}: {}", text(&check.id.to_string()), text(&remark));
        }
    }
    if report.sandbox.level < Level::Strong {
        let (level, missing) = (report.sandbox.level, text(&words::missing_layers(&report.sandbox)));
        let _ = writeln!(out, "\nThe sandbox was {level}: {missing}.");
    }
    out
}

fn failures(out: &mut String, report: &Report, task: &TaskResult) {
    let failed = report.lacking(&task.id);
    let Some(first) = failed.first() else { return };
    let _ = writeln!(out, "\n### {} {}\n", text(&task.id), text(&task.title));
    for check in failed.iter().take(EXPLAINED) {
        let (verdict, id) = (words::verdict(&check.verdict), text(&check.id.to_string()));
        let _ = writeln!(out, "- **{verdict}** {id}: {}", text(&words::explanation(check)));
    }
    if failed.len() > EXPLAINED {
        let _ = writeln!(out, "- … and {} more", failed.len() - EXPLAINED);
    }
    let _ = write!(out, "\nTo rerun the first:\n\n{}", block(&words::repeat_command(report, &first.id)));
}

/// The beginning of a text, in one line in which nothing is Markdown or HTML, as it can also stand in a table.
pub(super) fn text(plain: &str) -> String {
    let mut out = String::new();
    for character in shortened(plain, LONGEST).chars() {
        match character {
            '\n' | '\r' | '\t' => out.push(' '),
            _ if character.is_control() => {}
            // Characters that begin something, also links: each stands for itself as a number. What is left of
            // `https://` and of names with an `@` then is no link.
            '\\' | '`' | '*' | '[' | ']' | '<' | '>' | '&' | '|' | '~' | '#' | '!' | '@' | '$' | ':'
            | '_' => {
                let _ = write!(out, "&#{};", u32::from(character));
            }
            _ => out.push(character),
        }
    }
    // `www.` is taken for the beginning of a link, whatever stands before it.
    out.replace("www.", "www&#46;").replace("WWW.", "WWW&#46;")
}

/// The beginning of a text as it stands, in a block with more backticks than it has itself.
pub(super) fn block(plain: &str) -> String {
    let plain =
        shortened(plain, LONGEST_MESSAGES).replace(|c: char| c.is_control() && c != '\n' && c != '\t', "");
    let (mut longest, mut run) = (0, 0);
    for character in plain.chars() {
        run = if character == '`' { run + 1 } else { 0 };
        longest = longest.max(run);
    }
    let fence = "`".repeat(3.max(longest + 1));
    format!("{fence}text\n{}\n{fence}\n", plain.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::sample::{evil_report, report};

    #[test]
    fn nothing_in_a_report_becomes_markup() {
        let made = summary(&evil_report());
        // A block ends at the fence that it began with.
        let (mut outside, mut fence) = (String::new(), None);
        for line in made.lines() {
            match fence {
                Some(open) if line == open => fence = None,
                Some(_) => {}
                None if line.starts_with("```") => fence = line.strip_suffix("text"),
                None => outside += line,
            }
        }
        assert!(outside.contains("Remarks"), "blocks end: {made}");
        for sign in ["<script", "![", "](", "https://", "```"] {
            assert!(!outside.contains(sign), "{sign}: {made}");
        }
        assert!(!made.contains(['\u{7}', '\u{1b}', '\0']), "{made:?}");
        let rows: Vec<&str> = made.lines().filter(|line| line.starts_with('|')).collect();
        assert_eq!(rows.len(), 4, "{made}");
        assert!(rows.iter().all(|row| row.matches('|').count() == 5), "{made}");
    }

    #[test]
    fn a_block_ends_where_it_should() {
        assert_eq!(block("a\n```\nb"), "````text\na\n```\nb\n````\n");
        assert_eq!(block("a"), "```text\na\n```\n");
    }

    #[test]
    fn it_is_never_longer_than_github_takes() {
        let mut report = report(&"<".repeat(200_000));
        report.checks = vec![report.checks[0].clone(); 60];
        report.submission.build_failure =
            Some(verdict::submission::BuildFailure { messages: "🙂".repeat(200_000), line: None });
        // The title and the command are the grader's own words; only a path can be long.
        report.tasks.iter_mut().for_each(|task| task.title = "title".to_owned());
        report.assignment = "a".to_owned();
        assert!(summary(&report).len() < 1 << 20, "{}", summary(&report).len());
    }
}
