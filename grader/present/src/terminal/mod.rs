//! The report on a terminal, and in plain text where there is none.
//!
//! Colours are always written; `anstream` removes them where they are not wanted: in a pipe, with `NO_COLOR`, on a
//! terminal that has none. Only on a terminal lines are broken, at its width: elsewhere one finding is one line.

use std::io::{self, Write};

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, CellAlignment, Color, ContentArrangement, Table};

use verdict::check::{CheckId, CheckResult, Verdict};
use verdict::report::{Report, TaskResult};
use verdict::sandbox::Level;
use verdict::submission::SourceFinding;
use verdict::text::harmless;

use crate::words::{self, count};
use lines::{bold, paragraph};

mod lines;

pub(crate) use lines::{loud, one_line, paint};

/// The table of tasks, and what is wrong.
pub fn print_summary(report: &Report) {
    let out = anstream::stdout();
    let width = out.is_terminal().then(textwrap::termwidth);
    // The reader may be gone (`… | head`): the report is saved all the same.
    let _ = write_summary(&mut out.lock(), report, width);
}

/// The sum of points, in one line.
pub fn print_sum(report: &Report) {
    let _ = writeln!(io::stdout().lock(), "{}", words::sum(report));
}

/// Failed checks of a task that are explained: once the first ones are fixed, the others often are.
const EXPLAINED: usize = 3;

/// Remarks that are shown.
const REMARKS: usize = 5;

fn write_summary(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    if let Some(failure) = &report.submission.build_failure {
        match &report.submission.refusal {
            None => writeln!(out, "The submission does not compile:\n\n{}", failure.messages)?,
            Some(refusal) => writeln!(out, "{}: {}", refusal.code, failure.messages.trim_end())?,
        }
    }
    writeln!(out, "{}", table(report, width))?;
    paragraph(out, "", &words::sum(report), width)?;
    write_causes(out, report, width)?;
    for explanation in &report.submission.explanations {
        let name = harmless(&explanation.name);
        let content = match &explanation.text {
            Some(text) => {
                let words = count(text.split_whitespace().count(), "word");
                format!("explanation: {name}, {words}, shown in report.html")
            }
            None => {
                format!(
                    "explanation: {name}, {}; not a text file, open it directly",
                    count(explanation.bytes, "byte")
                )
            }
        };
        paragraph(out, "", &content, width)?;
    }
    for task in &report.tasks {
        write_failures(out, task, report, width)?;
    }
    write_remarks(out, report, width)?;
    write_sandbox(out, report, width)
}

/// What the source names that the sandbox refuses, and what the sandbox lacks.
fn write_sandbox(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    let sandbox = &report.sandbox;
    if !sandbox.findings.is_empty() || sandbox.level < Level::Strong {
        writeln!(out)?;
    }
    for SourceFinding { line, what, why } in &sandbox.findings {
        let text = format!("violation: render_pt.rs:{line}: {what}: {why}; the sandbox refuses it");
        paragraph(out, "", &text, width)?;
    }
    if sandbox.level < Level::Strong {
        let (level, missing) = (sandbox.level, words::missing_layers(sandbox));
        paragraph(out, "", &format!("sandbox: {level}: {missing} (see cargo grader doctor)"), width)?;
    }
    Ok(())
}

/// What is probably wrong, with the observation that decided and a hint.
fn write_causes(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    for diagnosis in &report.diagnosis {
        writeln!(out)?;
        paragraph(out, "", &bold(&words::heading(diagnosis)), width)?;
        let seen = words::seen(report, diagnosis);
        for (begin, text) in [("observed: ", seen.as_str()), ("hint: ", words::hint(&diagnosis.cause))] {
            if !text.is_empty() {
                paragraph(out, "  ", &format!("{begin}{text}"), width)?;
            }
        }
    }
    Ok(())
}

fn table(report: &Report, width: Option<usize>) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).enforce_styling();
    if let Some(width) = width {
        table.set_width(u16::try_from(width).unwrap_or(u16::MAX));
    }
    let heads = ["task", "", "points", "passed", "what is missing"];
    table.set_header(heads.map(|head| Cell::new(head).add_attribute(Attribute::Bold)));
    for task in &report.tasks {
        let counts =
            |check: &&CheckResult| check.task == task.id && !matches!(check.verdict, Verdict::Skipped { .. });
        let checks = report.checks.iter().filter(counts);
        let passed = checks.clone().filter(|check| check.verdict == Verdict::Pass).count();
        let (points, passed) = match task.points {
            None => (format!("– / {}", task.max), String::new()),
            Some(points) => (format!("{points} / {}", task.max), format!("{passed} of {}", checks.count())),
        };
        let color = match task.points {
            Some(points) if points + task.staff_only >= task.max => Color::Green,
            Some(points) if points > 0.0 => Color::Yellow,
            Some(_) => Color::Red,
            None => Color::Reset,
        };
        table.add_row([
            Cell::new(&task.id),
            Cell::new(&task.title),
            Cell::new(points).fg(color).set_alignment(CellAlignment::Right),
            Cell::new(passed).set_alignment(CellAlignment::Right),
            Cell::new(missing(task, report)),
        ]);
    }
    table
}

/// Why points are missing, short enough for a table: what follows it names the checks.
fn missing(task: &TaskResult, report: &Report) -> String {
    let failed = report.lacking(&task.id).len();
    let state = words::task_state(task);
    let mut parts = Vec::new();
    if (task.points == Some(0.0) || failed == 0) && !state.is_empty() {
        parts.push(state);
    } else if failed > 0 {
        parts.push(format!("{} did not pass, see below", count(failed, "check")));
    }
    if task.staff_only > 0.0 {
        parts.push(words::staff_only(task.staff_only));
    }
    parts.join("; ")
}

/// What is wrong in a task, and the command that runs it again.
fn write_failures(
    out: &mut impl Write,
    task: &TaskResult,
    report: &Report,
    width: Option<usize>,
) -> io::Result<()> {
    let failed = report.lacking(&task.id);
    let Some(first) = failed.first() else { return Ok(()) };
    writeln!(out, "\n{}", bold(&format!("{} {}", task.id, task.title)))?;
    for check in failed.iter().take(EXPLAINED) {
        let required = if check.required { " (required)" } else { "" };
        writeln!(out, "  {}  {}{required}", paint(&check.verdict, loud(&check.verdict)), check.id)?;
        paragraph(out, "    ", &words::explanation(check), width)?;
    }
    if failed.len() > EXPLAINED {
        writeln!(out, "  … and {} more: see report.html", failed.len() - EXPLAINED)?;
    }
    // Not broken, so that they can be copied.
    if let Some(replay) = words::replay_of(first, &report.submission.path) {
        writeln!(out, "  replay: {replay}")?;
    }
    writeln!(out, "  rerun: {}", words::repeat_command(report, &first.id))
}

/// What costs no points, but is worth knowing.
fn write_remarks(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    let of = |check: &CheckResult| words::remarks_with_replay(check, &report.submission.path);
    let all: Vec<(&CheckId, String)> = report
        .checks
        .iter()
        .flat_map(|check| of(check).into_iter().map(|remark| (&check.id, remark)))
        .collect();
    if all.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{}", bold("Remarks (they cost no points)"))?;
    for (id, remark) in all.iter().take(REMARKS) {
        paragraph(out, "  ", &format!("{id}: {remark}"), width)?;
    }
    if all.len() > REMARKS {
        writeln!(out, "  … and {} more: see report.html", all.len() - REMARKS)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::{Evidence, Noise, VarianceOf};
    use verdict::report::Cause;
    use verdict::sample::report;

    fn shown(report: &Report, width: Option<usize>) -> String {
        let mut out = anstream::StripStream::new(Vec::new());
        write_summary(&mut out, report, width).expect("it can be written");
        String::from_utf8(out.into_inner()).expect("it is text")
    }

    #[test]
    fn no_line_is_wider_than_the_terminal_but_those_to_copy() {
        let long = "word ".repeat(60);
        let text = shown(&report(&long), Some(80));
        for line in text.lines().filter(|line| !line.contains("rerun:") && !line.contains("FAIL")) {
            // The title of a task is ours, and short; here it is not.
            assert!(line.chars().count() <= 80 || line.starts_with("5.1a"), "{line}");
        }
        // Without a terminal, a text is one line.
        assert!(shown(&report(&long), None).contains(&format!("  hint: {long}")));
    }

    #[test]
    fn a_failed_check_says_what_happened_and_how_to_rerun_it() {
        let text = shown(&report("x"), Some(120));
        for expected in [
            "  FAIL  mean-bias/x/nee/8 (required)\n    the mean is 12.5 % too dark\n",
            "  rerun: cargo grade x --assignment=x --seed=0 --only=mean-bias/x/nee/8\n",
            "12.5 of 70 points, graded automatically; 10 more are graded by your tutor",
            "1 check did not pass, see below",
        ] {
            assert!(text.contains(expected), "{expected} in {text}");
        }
    }

    #[test]
    fn a_cause_that_is_unknown_is_one_sentence() {
        let mut report = report("x");
        let text = shown(&report, Some(120));
        let expected = "Likely cause (50 % sure): x\n  observed: the mean radiance is 0.88 ± 0.01 times what it should be in x (`nee`)\n  \
                        hint: x\n";
        assert!(text.contains(expected), "{text}");
        report.diagnosis[0].cause = Cause::Unknown { several_fit: false };
        let text = shown(&report, Some(120));
        assert!(text.contains("\nCause unknown: the results fit no known mistake.\n"), "{text}");
        assert!(!text.contains("observed:"), "{text}");
    }

    #[test]
    fn remarks_and_points_of_staff_only_checks_are_shown() {
        let mut report = report("x");
        report.tasks[0].staff_only = 1.5;
        report.points.staff_only = 1.5;
        report.checks[0].verdict = Verdict::Pass;
        let own = VarianceOf { technique: report.checks[0].id.technique, ratio: 2.5 };
        report.checks[0].evidence =
            Some(Evidence::Efficiency(Noise { ratios: vec![own], as_noisy_as: None, is_noisier: true }));
        let text = shown(&report, None);
        assert!(text.contains("up to 1.5 points are added after submission"), "{text}");
        assert!(
            text.contains("Remarks (they cost no points)") && text.contains("2.5 times the variance"),
            "{text}"
        );
    }
}
