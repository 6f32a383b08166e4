//! The report as one self-contained page: no network, no other files.
//!
//! Everything that comes from the report is escaped by the template; style, script, plot and numbers of pictures are
//! our own. A content security policy forbids the page to load anything.

mod causes;
mod viewer;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::pictures::Picture;
use super::{CheckResult, Report, TaskResult, Verdict};
use crate::convergence::{sentences, svg};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("viewer.js");
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// The page of a report, as HTML.
pub fn page(report: &Report, pictures: &[Picture]) -> String {
    let points = &report.points;
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                title { (report.submission.path) ": " (points.earned) " of " (points.automatic_max) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (report.submission.path) }
                    p.soft { "assignment " (report.assignment) }
                    p.sum { (points.earned) " of " (points.automatic_max) " points "
                        small { "graded automatically; " @match points.marked {
                            Some(marked) => { (marked) " of " (points.manual_max) " given by a person" }
                            None => { (points.manual_max) " more are marked by a person" }
                        } } }
                }
                main {
                    (tasks(report))
                    @if let Some(failure) = &report.submission.build_failure {
                        h2 { "It does not compile" }
                        pre { (failure.messages) }
                    }
                    (explanations(report))
                    (causes::section(report))
                    (checks(report))
                    @if !pictures.is_empty() {
                        h2 { "Pictures" }
                        p.soft { "Move over a picture, or focus it and use the arrow keys, to read its pixels." }
                        @for (index, picture) in pictures.iter().enumerate() { (viewer::figure(index, picture)) }
                    }
                    (convergence(report))
                    (left_out(report))
                    (provenance(report))
                }
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    markup.into_string()
}

/// Points task by task, with what is wrong and what to do.
fn tasks(report: &Report) -> Markup {
    html! {
        h2 { "Points" }
        div.scroll { table {
            thead { tr { th { "task" } th { "" } th.number { "points" } th { "what is wrong, and what to do next" } } }
            tbody {
                @for task in &report.tasks {
                    tr {
                        td { (task.id) }
                        td { (task.title) }
                        td.number { @match task.points { Some(points) => (points), None => "–" } " / " (task.max) }
                        td { (advice(task, report)) }
                    }
                }
            }
        } }
    }
}

fn advice(task: &TaskResult, report: &Report) -> Markup {
    let mut of_task = report.checks.iter().filter(|check| check.task == task.id);
    let Some(wrong) = of_task.find(|check| check.verdict != Verdict::Pass) else {
        return html! { @if task.reason.is_empty() { "nothing" } @else { (task.reason) } };
    };
    html! {
        (wrong.explanation)
        @if wrong.verdict == Verdict::Inconclusive { " Bring the noise down first: " } @else { " Mend this first: " }
        code { (wrong.repeat) }
    }
}

/// What the student wrote, for the person who marks it.
fn explanations(report: &Report) -> Markup {
    html! {
        @for explanation in &report.submission.explanations {
            details {
                summary { "Explanation: " (explanation.name) }
                @match &explanation.text {
                    Some(text) => pre { (text) },
                    None => p { "not a text: open the file itself (" (explanation.bytes) " bytes, BLAKE3 " code { (explanation.hash) } ")" }
                }
            }
        }
    }
}

/// All checks, those of a task that has points missing unfolded.
fn checks(report: &Report) -> Markup {
    html! {
        @if !report.checks.is_empty() { h2 { "Checks" } }
        @for task in &report.tasks {
            @let of_task: Vec<&CheckResult> = report.checks.iter().filter(|check| check.task == task.id).collect();
            @let passed = of_task.iter().filter(|check| check.verdict == Verdict::Pass).count();
            @if !of_task.is_empty() {
                details open[passed < of_task.len()] {
                    summary { (task.id) " " (task.title) ": " (passed) " of " (of_task.len()) " passed" }
                    div.scroll { table {
                        thead { tr {
                            th { "check" } th { "verdict" } th { "why" } th.number { "effect" } th.number { "99 % interval" }
                            th.number { "detectable" } th.number { "samples" } th.number { "seconds" }
                        } }
                        tbody { @for check in of_task { (row(check)) } }
                    } }
                }
            }
        }
    }
}

fn row(check: &CheckResult) -> Markup {
    let percent = |value: f64| format!("{:+.2} %", 100.0 * value);
    let (class, word) = match check.verdict {
        Verdict::Pass => ("pass", "pass"),
        Verdict::Fail => ("fail", "FAIL"),
        Verdict::Inconclusive => ("inconclusive", "inconclusive"),
        Verdict::LeftOut => ("left-out", "left out"),
        Verdict::Error => ("error", "error"),
    };
    html! {
        tr {
            td {
                (check.id)
                @if check.evidence { br; span.soft { "no points without it" } }
            }
            td class=(class) { (word) }
            td {
                (check.explanation)
                @if !check.coefficients.is_empty() {
                    br; span.soft { "light that is scattered 0, 1, 2, … times counts "
                        (check.coefficients.iter().map(|c| format!("{c:.3}")).collect::<Vec<_>>().join(", ")) " times" }
                }
                @if !check.variance_ratios.is_empty() {
                    br; span.soft { "variance, relative to the solution's: "
                        (check.variance_ratios.iter().map(|it| format!("{} {:.2}", it.technique, it.ratio)).collect::<Vec<_>>().join(", ")) }
                }
                @for remark in &check.remarks { br; span.soft { "Remark: " (remark) } }
                details.again { summary { "again" } code { (check.repeat) } }
            }
            td.number { @if let Some(effect) = check.effect { (percent(effect)) } }
            td.number { @if let Some([low, high]) = check.interval { (percent(low)) br; (percent(high)) } }
            td.number { @if let Some(detectable) = check.detectable { (format!("{:.2} %", 100.0 * detectable)) } }
            td.number { (check.samples) }
            td.number { (format!("{:.2}", check.seconds)) }
        }
    }
}

fn convergence(report: &Report) -> Markup {
    let Some(convergence) = &report.convergence else { return html! {} };
    html! {
        h2 { "Error against run time" }
        p.soft { "For no points. An unbiased program follows the slope −1; one that flattens has a bias. Bars are 95 % intervals." }
        @if let Some(plot) = svg(convergence) { div.scroll { (PreEscaped(plot)) } }
        ul { @for sentence in convergence.panels.iter().flat_map(sentences) { li { (sentence) } } }
        @for left_out in &convergence.left_out { p { "Left out: " (left_out.check) " " (left_out.scene) ": " (left_out.why) } }
    }
}

fn left_out(report: &Report) -> Markup {
    html! {
        @if !report.left_out.is_empty() {
            h2 { "Left out, and why" }
            details {
                summary { (report.left_out.len()) " checks would mean nothing in their scenes" }
                ul { @for entry in &report.left_out { li { (entry.check) ", " (entry.scene) ": " (entry.why) } } }
            }
        }
    }
}

fn provenance(report: &Report) -> Markup {
    let cost = &report.cost;
    html! {
        h2 { "What this rests on" }
        details {
            summary { "provenance" }
            div.scroll { table { tbody {
                tr { th { "hand-in (BLAKE3)" } td { code { (report.submission.hash) } } }
                @for (key, value) in &report.provenance { tr { th { (key) } td { code { (value) } } } }
                tr { th { "confinement" } td { (report.sandbox.level) " " (report.sandbox.missing) } }
                @for finding in &report.sandbox.findings {
                    tr { th { "line " (finding.line) } td { code { (finding.what) } ": " (finding.why) } }
                }
                tr { th { "seconds" } td { (format!("compiling {:.1}, running {:.1}, all {:.1}", cost.build, cost.run, cost.total)) } }
                tr { th { "samples that are no radiance" } td { (report.numerics.non_finite) " not finite, " (report.numerics.negative) " negative" } }
            } } }
        }
    }
}

#[cfg(test)]
mod tests;
