//! The report on a terminal, and in plain text where there is none.
//!
//! A student sees one next step: the first task that is not finished and one check of it, with its likely cause
//! ([`Detail::Next`]). Everything else is for those who ask for it ([`Detail::All`]), and in the pages.
//!
//! Colours are always written; `anstream` removes them where they are not wanted: in a pipe, with `NO_COLOR`, on a
//! terminal that has none. Only on a terminal lines are broken, at its width: elsewhere one finding is one line.

use std::io::{self, Write};

use verdict::report::Report;
use verdict::submission::SourceFinding;
use verdict::text::harmless;

use crate::words::{self, count};
use lines::paragraph;

mod all;
mod audit;
mod lines;
mod next;

pub use audit::print_audit;
pub(crate) use lines::{loud, one_line, paint};

/// Level of detail of a summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// The points, and one next step.
    Next,
    /// All tasks with their failed checks, all likely causes, and remarks.
    All,
}

/// Prints the points of a report and what is wrong.
pub fn print_summary(report: &Report, detail: Detail) {
    let out = anstream::stdout();
    let width = out.is_terminal().then(textwrap::termwidth);
    // The reader may be gone (`… | head`): the report is saved all the same.
    let _ = write_summary(&mut out.lock(), report, detail, width);
}

/// The same for a screen that is drawn again and again, with the lines that say what has changed since an earlier report.
pub fn summary_since(report: &Report, earlier: Option<&Report>) -> String {
    let width = anstream::stdout().is_terminal().then(textwrap::termwidth);
    let mut text = Vec::new();
    // Writing to memory cannot fail.
    let _ = write_summary(&mut text, report, Detail::Next, width);
    if let Some(changes) = earlier.and_then(|earlier| words::changes(earlier, report)) {
        let _ = paragraph(&mut text, "", &changes, width);
    }
    String::from_utf8_lossy(&text).into_owned()
}

/// The sum of points, in one line.
pub fn print_sum(report: &Report) {
    let _ = writeln!(io::stdout().lock(), "{}", words::sum(report));
}

fn write_summary(
    out: &mut impl Write,
    report: &Report,
    detail: Detail,
    width: Option<usize>,
) -> io::Result<()> {
    if let Some(failure) = &report.submission.build_failure {
        match &report.submission.refusal {
            None => writeln!(out, "The submission does not compile:\n\n{}", failure.messages)?,
            Some(refusal) => writeln!(out, "{}: {}", refusal.code, failure.messages.trim_end())?,
        }
    }
    match detail {
        Detail::Next => next::write(out, report, width)?,
        Detail::All => all::write(out, report, width)?,
    }
    write_explanations(out, report, width)?;
    let file = harmless(&report.submission.file_name);
    for SourceFinding { line, what, why } in &report.sandbox.findings {
        let text = format!("violation: {file}:{line}: {what}: {why}; the sandbox refuses it");
        paragraph(out, "", &text, width)?;
    }
    words::prints(&file, &report.submission.prints).map_or(Ok(()), |note| paragraph(out, "", &note, width))
}

/// What was sent with the file, for the tutor who grades it.
fn write_explanations(out: &mut impl Write, report: &Report, width: Option<usize>) -> io::Result<()> {
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
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use verdict::check::{Evidence, Noise, VarianceOf, Verdict};
    use verdict::report::{Cause, Step};
    use verdict::sample::report;

    fn next(report: &Report) -> String {
        let mut out = anstream::StripStream::new(Vec::new());
        write_summary(&mut out, report, Detail::Next, None).expect("it can be written");
        String::from_utf8(out.into_inner()).expect("it is text")
    }

    fn shown(report: &Report, width: Option<usize>) -> String {
        let mut out = anstream::StripStream::new(Vec::new());
        write_summary(&mut out, report, Detail::All, width).expect("it can be written");
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

    #[test]
    fn one_next_step_is_shown_and_nothing_of_later_tasks() {
        let mut report = report("x");
        let first = report.checks[0].clone();
        report.tasks[0].steps = vec![Step { title: "one light".to_owned(), checks: vec![first.id.clone()] }];
        let mut later = report.tasks[0].clone();
        later.id = "5.1b".to_owned();
        report.tasks.push(later);
        report.checks.push(verdict::check::CheckResult { task: "5.1b".to_owned(), ..first });
        let text = next(&report);
        for expected in [
            "Next: 5.1a x, step 1 of 1: one light\n",
            "  FAIL  mean-bias/x/nee/8\n    the mean is 12.5 % too dark\n",
            "  Likely cause (50 % sure): x\n  hint: x\n",
            "  rerun: cargo grade x --assignment=x --seed=0 --only=mean-bias/x/nee/8\n",
            "1 other check did not pass",
        ] {
            assert!(text.contains(expected), "{expected} in {text}");
        }
        assert_eq!(text.matches("FAIL").count(), 1, "{text}");
        assert!(text.lines().count() < 20, "{text}");
    }

    #[test]
    fn a_finished_task_says_so_and_what_comes_next() {
        let mut report = report("x");
        report.checks[0].verdict = Verdict::Pass;
        (report.tasks[0].points, report.tasks[0].staff_only) = (Some(18.5), 1.5);
        (report.points.earned, report.points.automatic_max, report.points.staff_only) = (18.5, 20.0, 1.5);
        let text = next(&report);
        for expected in [
            "✓ done; 1.5 more are decided by checks that only your tutor can run",
            "Done: everything that can be graded here passes.",
            "Next: 5.2a x, then `cargo grader pack --explanation=FILE`.",
        ] {
            assert!(text.contains(expected), "{expected} in {text}");
        }
        assert!(!text.contains("FAIL") && !text.contains("hint"), "{text}");
    }

    #[test]
    fn an_unknown_cause_is_not_worth_a_line() {
        let mut report = report("x");
        report.diagnosis[0].cause = Cause::Unknown { several_fit: false };
        assert!(!next(&report).contains("ause"), "{}", next(&report));
    }
}
