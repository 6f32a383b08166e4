//! The report on a terminal, and in plain text where there is none.
//!
//! Colours are written always; `anstream` takes them out where they are not wanted: in a pipe, with `NO_COLOR`, on a
//! terminal that has none. Only on a terminal lines are broken, at its width: elsewhere one finding is one line.

use std::io::{self, Write};

use anstyle::{AnsiColor, Style};
use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, Cell, CellAlignment, Color, ContentArrangement, Table};

use verdict::text::harmless;

use verdict::report::{CheckResult, Report, TaskResult, Verdict};
use verdict::sandbox::Level;
use verdict::submission::SourceFinding;

/// The table of tasks, and what is wrong.
pub fn print_summary(report: &Report) {
    let out = anstream::stdout();
    let width = out.is_terminal().then(textwrap::termwidth);
    // Nobody may be reading any more (`… | head`): the report is saved all the same.
    let _ = write_summary(&mut out.lock(), report, width);
}

/// The sum of points, in one line.
pub fn print_sum(report: &Report) {
    let _ = writeln!(io::stdout().lock(), "{}", sum(report));
}

/// How many failed checks of a task are explained: with the first ones mended, the others often are.
const EXPLAINED: usize = 3;

/// How many remarks are shown.
const REMARKS: usize = 5;

fn write_summary(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    if let Some(failure) = &report.submission.build_failure {
        match &report.submission.refusal {
            None => writeln!(out, "The hand-in does not compile:\n\n{}", failure.messages)?,
            Some(refusal) => writeln!(out, "{}: {}", refusal.code, failure.messages.trim_end())?,
        }
    }
    writeln!(out, "{}", table(report, width))?;
    paragraph(out, "", &sum(report), width)?;
    write_causes(out, report, width)?;
    for explanation in &report.submission.explanations {
        let name = harmless(&explanation.name);
        let bytes = explanation.bytes;
        match &explanation.text {
            Some(text) => {
                let words = text.split_whitespace().count();
                paragraph(
                    out,
                    "",
                    &format!("explanation: {name}, {words} words, shown in report.html"),
                    width,
                )?;
            }
            None => {
                paragraph(out, "", &format!("explanation: {name}, {bytes} bytes: open it yourself"), width)?
            }
        }
    }
    for task in &report.tasks {
        write_failures(out, task, report, width)?;
    }
    write_remarks(out, report, width)?;
    let apart = !report.sandbox.findings.is_empty() || report.sandbox.level < Level::Strong;
    if apart {
        writeln!(out)?;
    }
    for SourceFinding { line, what, why, .. } in &report.sandbox.findings {
        let text = format!("violation: render_pt.rs:{line}: {what}: {why}; the sandbox refuses it");
        paragraph(out, "", &text, width)?;
    }
    if report.sandbox.level < Level::Strong {
        let (level, missing) = (report.sandbox.level, &report.sandbox.missing);
        paragraph(out, "", &format!("sandbox: {level}: {missing} (cargo grader doctor)"), width)?;
    }
    Ok(())
}

/// What probably went wrong, with the observation that decided and something to think about.
fn write_causes(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    for cause in &report.diagnosis {
        writeln!(out)?;
        paragraph(out, "", &bold(&cause.heading()), width)?;
        for (begin, text) in [("seen: ", &cause.evidence), ("think: ", &cause.hint)] {
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
        let run = |check: &&CheckResult| check.task == task.id && check.verdict != Verdict::LeftOut;
        let checks = report.checks.iter().filter(run);
        let passed = checks.clone().filter(|check| check.verdict == Verdict::Pass).count();
        let (points, passed) = match task.points {
            None => (format!("– / {}", task.max), String::new()),
            Some(points) => (format!("{} / {}", points, task.max), format!("{passed} of {}", checks.count())),
        };
        let color = match task.points {
            Some(points) if points + task.elsewhere >= task.max => Color::Green,
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
    let gated = task.points == Some(0.0) || failed == 0;
    let mut parts = Vec::new();
    if gated && !task.reason.is_empty() {
        parts.push(task.reason.clone());
    } else if failed > 0 {
        parts.push(format!("{failed} checks, see below"));
    }
    if task.elsewhere > 0.0 {
        parts.push(format!("{} points are decided by your tutors' checks", task.elsewhere));
    }
    parts.join("; ")
}

fn sum(report: &Report) -> String {
    let points = &report.points;
    let mut text = format!("{} of {} automatic points", points.earned, points.automatic_max);
    if points.elsewhere > 0.0 {
        text += &format!(
            ": {} can be had here, {} rest on checks that only your tutors can run",
            points.automatic_max - points.elsewhere,
            points.elsewhere
        );
    }
    let manual = match points.marked {
        Some(marked) => format!("{marked} of {} given by a person", points.manual_max),
        None => format!("{} more are marked by a person", points.manual_max),
    };
    format!("{text} ({manual}), {:.1} s", report.cost.total)
}

/// What is wrong in a task, and the command that shows it again.
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
        let evidence = if check.evidence { " (no points without it)" } else { "" };
        writeln!(out, "  {}  {}{evidence}", paint(check.verdict, word(check.verdict)), check.id)?;
        paragraph(out, "    ", &check.explanation, width)?;
    }
    if failed.len() > EXPLAINED {
        writeln!(out, "  … and {} more: see report.json", failed.len() - EXPLAINED)?;
    }
    // Not broken, so that it can be copied.
    writeln!(out, "  again: {}", first.repeat)
}

/// What costs no points, but is worth knowing.
fn write_remarks(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
    let all: Vec<(&str, &String)> = report
        .checks
        .iter()
        .flat_map(|check| check.remarks.iter().map(|remark| (check.id.as_str(), remark)))
        .collect();
    if all.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{}", bold("Remarks, for no points"))?;
    for (id, remark) in all.iter().take(REMARKS) {
        paragraph(out, "  ", &format!("{id}: {remark}"), width)?;
    }
    if all.len() > REMARKS {
        writeln!(out, "  … and {} more: see report.json", all.len() - REMARKS)?;
    }
    Ok(())
}

/// A text, indented; broken at the width of a terminal.
fn paragraph(out: &mut impl Write, indent: &str, text: &str, width: Option<usize>) -> io::Result<()> {
    match width {
        Some(width) => {
            let options = textwrap::Options::new(width).initial_indent(indent).subsequent_indent(indent);
            // Commands and paths are not broken inside.
            let options = options
                .break_words(false)
                .word_splitter(textwrap::WordSplitter::NoHyphenation)
                .word_separator(textwrap::WordSeparator::AsciiSpace);
            writeln!(out, "{}", textwrap::fill(text, options))
        }
        None => writeln!(out, "{indent}{text}"),
    }
}

/// As much of a text as fits in a line of the terminal.
pub(super) fn one_line(text: &str) -> String {
    let width = textwrap::termwidth().saturating_sub(1).max(20);
    let text = text.lines().next().unwrap_or_default();
    if text.chars().count() <= width {
        return text.to_owned();
    }
    text.chars().take(width - 1).chain(['…']).collect()
}

/// A text in the colour of a verdict.
pub(super) fn paint(verdict: Verdict, text: &str) -> String {
    let color = match verdict {
        Verdict::Pass => AnsiColor::Green,
        Verdict::Inconclusive | Verdict::LeftOut => AnsiColor::Yellow,
        Verdict::Fail | Verdict::Error => AnsiColor::Red,
    };
    let style = color.on_default();
    format!("{style}{text}{style:#}")
}

fn bold(text: &str) -> String {
    let style = Style::new().bold();
    format!("{style}{text}{style:#}")
}

pub(super) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "FAIL",
        Verdict::Inconclusive => "inconclusive",
        Verdict::LeftOut => "left out",
        Verdict::Error => "error",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::report::Diagnosis;
    use verdict::report::UNKNOWN;
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
        for line in text.lines().filter(|line| !line.contains("again:") && !line.contains("FAIL")) {
            // The title of a task is ours, and short; here it is not.
            assert!(line.chars().count() <= 80 || line.starts_with("5.1a"), "{line}");
        }
        // Without a terminal, an explanation is one line.
        assert!(shown(&report(&long), None).contains(&format!("    {long}")));
    }

    #[test]
    fn a_cause_that_is_unknown_is_one_sentence() {
        let mut report = report("x");
        let text = shown(&report, Some(80));
        assert!(text.contains("Likely cause (50 % sure): x\n  seen: x\n  think: x\n"), "{text}");
        let nothing = String::new;
        report.diagnosis[0] = Diagnosis {
            mistake: UNKNOWN.to_owned(),
            title: "Nobody knows.".to_owned(),
            confidence: 0.0,
            evidence: nothing(),
            hint: nothing(),
        };
        let text = shown(&report, Some(80));
        assert!(text.contains("\nNobody knows.\n") && !text.contains("seen:"), "{text}");
    }

    #[test]
    fn what_costs_no_points_and_what_is_decided_elsewhere_is_said() {
        let mut report = report("x");
        report.tasks[0].elsewhere = 1.5;
        report.points.elsewhere = 1.5;
        let text = shown(&report, Some(80));
        assert!(text.contains("12.5 of 70 automatic points: 68.5 can be had here, 1.5 rest on"), "{text}");
        assert!(text.contains("Remarks, for no points"), "{text}");
    }
}
