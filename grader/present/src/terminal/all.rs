//! Everything that a report says of its checks, on a terminal.

use std::io::{self, Write};

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, CellAlignment, Color, ContentArrangement, Table};

use verdict::check::{CheckId, CheckResult, Verdict};
use verdict::report::{Report, TaskResult};
use verdict::sandbox::Level;

use super::audit;
use super::lines::{bold, loud, paint, paragraph};
use crate::words::{self, count};

/// Failed checks of a task that are explained: once the first ones are fixed, the others often are.
const EXPLAINED: usize = 3;

/// Remarks that are shown.
const REMARKS: usize = 5;

/// The table of tasks, likely causes, and what is wrong in each task.
pub(super) fn write(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    writeln!(out, "{}", table(report, width))?;
    paragraph(out, "", &words::sum(report), width)?;
    write_causes(out, report, width)?;
    write_facts(out, report)?;
    for task in &report.tasks {
        write_failures(out, task, report, width)?;
    }
    write_remarks(out, report, width)?;
    let sandbox = &report.sandbox;
    if sandbox.level < Level::Strong {
        writeln!(out)?;
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

/// The measured factors that are wrong.
fn write_facts(out: &mut impl Write, report: &Report) -> io::Result<()> {
    let failed = report.audit.iter().filter(|audit| audit.failed().next().is_some());
    for audit in failed {
        writeln!(out, "\n{}", bold("Measured factors that are wrong (`cargo grader audit` shows all)"))?;
        audit::write_failed(out, audit)?;
    }
    Ok(())
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
    let (not_run, explained): (Vec<&CheckResult>, Vec<&CheckResult>) =
        failed.iter().partition(|check| !check.was_run());
    for check in explained.iter().take(EXPLAINED) {
        let required = if check.required { " (required)" } else { "" };
        writeln!(out, "  {}  {}{required}", paint(&check.verdict, loud(&check.verdict)), check.id)?;
        paragraph(out, "    ", &words::explanation(check), width)?;
    }
    if explained.len() > EXPLAINED {
        writeln!(out, "  … and {} more: see report.html", explained.len() - EXPLAINED)?;
    }
    if let Some(one) = not_run.first() {
        writeln!(out, "  {}: {}", count(not_run.len(), "check"), words::explanation(one))?;
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
