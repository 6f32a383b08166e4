//! The report on a terminal.

use std::io::{self, Write};

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{Cell, CellAlignment, Color, ContentArrangement, Table};

use super::{CheckResult, Report, TaskResult, Verdict};
use crate::sandbox::Level;
use crate::scan::Finding;

/// One line for a check, as soon as it has ended.
pub fn print_check(check: &CheckResult) {
    let _ = writeln!(io::stderr(), "{:>12}  {}  {}", word(check.verdict), check.id, check.explanation);
}

/// The table of tasks and the checks that cost points.
pub fn print_summary(report: &Report) {
    // Nobody may be reading any more (`… | head`): the report is saved all the same.
    let _ = write_summary(&mut std::io::stdout().lock(), report);
}

fn write_summary(out: &mut impl Write, report: &Report) -> io::Result<()> {
    if let Some(failure) = &report.submission.build_failure {
        match &report.submission.refusal {
            None => writeln!(out, "The hand-in does not compile:\n\n{}", failure.messages)?,
            Some(refusal) => writeln!(out, "{}: {}", refusal.code, failure.messages.trim_end())?,
        }
    }
    let mut table = Table::new();
    table.load_style(UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic).set_header([
        "task",
        "",
        "points",
        "checks passed",
        "what is missing",
    ]);
    for task in &report.tasks {
        let checks = report.checks.iter().filter(|check| check.task == task.id);
        let passed = checks.clone().filter(|check| check.verdict == Verdict::Pass).count();
        let (points, passed) = match task.points {
            None => (format!("– / {}", task.max), String::new()),
            Some(points) => (format!("{} / {}", points, task.max), format!("{passed} of {}", checks.count())),
        };
        let color = match task.points {
            Some(points) if points >= task.max => Color::Green,
            Some(points) if points > 0.0 => Color::Yellow,
            Some(_) => Color::Red,
            None => Color::Reset,
        };
        table.add_row([
            Cell::new(&task.id),
            Cell::new(&task.title),
            Cell::new(points).fg(color).set_alignment(CellAlignment::Right),
            Cell::new(passed).set_alignment(CellAlignment::Right),
            Cell::new(&task.reason),
        ]);
    }
    writeln!(out, "{table}")?;
    writeln!(
        out,
        "{} of {} automatic points ({} more are marked by a person), {:.1} s",
        report.points.earned, report.points.automatic_max, report.points.manual_max, report.cost.total
    )?;
    for task in &report.tasks {
        write_failures(out, task, report)?;
    }
    for Finding { line, what, why, .. } in &report.sandbox.findings {
        writeln!(out, "violation: render_pt.rs:{line}: {what}: {why}; the sandbox refuses it")?;
    }
    if report.sandbox.level < Level::Strong {
        writeln!(out, "sandbox: {}: {} (grader doctor)", report.sandbox.level, report.sandbox.missing)?;
    }
    Ok(())
}

/// How many failed checks of a task are explained: with the first ones mended, the others often are.
const EXPLAINED: usize = 3;

/// What is wrong in a task, and the command that shows it again.
fn write_failures(out: &mut impl Write, task: &TaskResult, report: &Report) -> io::Result<()> {
    let failed: Vec<&CheckResult> = report
        .checks
        .iter()
        .filter(|check| check.task == task.id && check.verdict != Verdict::Pass)
        .collect();
    let Some(first) = failed.first() else { return Ok(()) };
    writeln!(out, "\n{} {}", task.id, task.title)?;
    for check in failed.iter().take(EXPLAINED) {
        writeln!(out, "  {}: {}\n    {}", word(check.verdict), check.id, check.explanation)?;
    }
    if failed.len() > EXPLAINED {
        writeln!(out, "  … and {} more: see report.json", failed.len() - EXPLAINED)?;
    }
    writeln!(out, "  again: {}", first.repeat)
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "FAIL",
        Verdict::Inconclusive => "inconclusive",
        Verdict::LeftOut => "left out",
        Verdict::Error => "error",
    }
}
