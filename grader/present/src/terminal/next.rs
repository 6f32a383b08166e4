//! One next step, on a terminal.

use std::io::{self, Write};

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, CellAlignment, Color, ContentArrangement, Table};

use verdict::check::{CheckResult, Verdict};
use verdict::next::Next;
use verdict::report::{Cause, Report};

use super::lines::{bold, loud, paint, paragraph};
use crate::words::{self, count};

/// The points of each task, and the first check to look at.
pub(super) fn write(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    if report.submission.build_failure.is_none() {
        writeln!(out, "{}", table(report, width))?;
    }
    paragraph(out, "", &words::sum(report), width)?;
    match report.next() {
        Some(next) => write_next(out, report, &next, width),
        None => words::finish(report).map_or(Ok(()), |text| paragraph(out, "", &text, width)),
    }
}

fn write_next(
    out: &mut impl Write,
    report: &Report,
    next: &Next<'_>,
    width: Option<usize>,
) -> io::Result<()> {
    let check = next.check;
    writeln!(out)?;
    paragraph(out, "", &bold(&words::next_heading(next)), width)?;
    let done = words::steps_done(report, next.task);
    if !done.is_empty() {
        paragraph(out, "  ", &paint(&Verdict::Pass, &done), width)?;
    }
    // Where nothing has been filled in, a failed check says nothing new.
    if !matches!(next.cause.map(|diagnosis| &diagnosis.cause), Some(Cause::NotBegun { .. })) {
        writeln!(out, "  {}  {}", paint(&check.verdict, loud(&check.verdict)), check.id)?;
        paragraph(out, "    ", &words::explanation(check), width)?;
    }
    if let Some(diagnosis) = next.cause {
        paragraph(out, "  ", &words::heading(diagnosis), width)?;
        let hint = words::hint(&diagnosis.cause);
        if !hint.is_empty() {
            paragraph(out, "  ", &format!("hint: {hint}"), width)?;
        }
    }
    // Not broken, so that it can be copied.
    match words::replay_of(check, &report.submission.path) {
        Some(replay) => writeln!(out, "  replay: {replay}")?,
        None => writeln!(out, "  rerun: {}", words::repeat_command(report, &check.id))?,
    }
    let others = report.checks.iter().filter(|other| other.costs_points()).count().saturating_sub(1);
    let others = match others {
        0 => String::new(),
        others => {
            format!("{} did not pass: `cargo grade --all`, report.html; ", count(others, "other check"))
        }
    };
    paragraph(out, "", &format!("{others}more help: `cargo hint`"), width)
}

fn table(report: &Report, width: Option<usize>) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).enforce_styling();
    if let Some(width) = width {
        table.set_width(u16::try_from(width).unwrap_or(u16::MAX));
    }
    table.set_header(["task", "", "points", ""].map(|head| Cell::new(head).add_attribute(Attribute::Bold)));
    let next = report.next();
    for task in &report.tasks {
        let ran = |check: &&CheckResult| check.task == task.id && check.was_run();
        let color = match task.points {
            _ if report.is_done(task) => Color::Green,
            Some(points) if points > 0.0 => Color::Yellow,
            Some(_) if report.checks.iter().any(|check| ran(&check)) => Color::Red,
            _ => Color::Reset,
        };
        let points = task.points.map_or("–".to_owned(), |points| points.to_string());
        table.add_row([
            Cell::new(&task.id),
            Cell::new(&task.title),
            Cell::new(format!("{points} / {}", task.max)).fg(color).set_alignment(CellAlignment::Right),
            Cell::new(words::standing(report, task, next.as_ref())),
        ]);
    }
    table
}
