//! Points, likely causes and checks of a report's page.

use maud::{Markup, html};

use super::prose::prose;
use crate::words::{self, count};
use verdict::check::{CheckResult, Evidence, Reason, Verdict};
use verdict::edition::Edition;
use verdict::report::{Provenance, Report, TaskResult};

/// Points task by task, with what is wrong and what to do.
pub(super) fn tasks(report: &Report) -> Markup {
    html! {
        h2 { "Points" }
        div.scroll { table.cards {
            thead { tr { th { "task" } th { "title" } th.number { "points" } th { "what is wrong, and what to do next" } } }
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
    let Some(&wrong) = report.lacking(&task.id).first() else {
        let state = words::task_state(task);
        return html! { @if state.is_empty() { "nothing to fix" } @else { (state) } };
    };
    html! {
        (prose(&words::explanation(wrong))) "."
        @if wrong.verdict == Verdict::Inconclusive { " Reduce the noise first. Re-run: " } @else { " Fix this first. Re-run: " }
        code.command { (words::repeat_command(report, &wrong.id)) }
    }
}

/// What the student wrote, for the tutor who grades it.
pub(super) fn explanations(report: &Report) -> Markup {
    html! {
        @for explanation in &report.submission.explanations {
            details {
                summary { "Explanation: " (explanation.name) }
                @match &explanation.text {
                    Some(text) => pre { (text) },
                    None => p { "This is not a text file; open it directly (" (count(explanation.bytes, "byte")) ", BLAKE3 " code { (explanation.hash) } ")." }
                }
            }
        }
    }
}

/// All checks of each task. Those that failed are unfolded.
pub(super) fn checks(report: &Report, edition: Edition) -> Markup {
    html! {
        @if !report.checks.is_empty() { h2 { "Checks" } }
        @for task in &report.tasks {
            @let of_task = || report.checks.iter().filter(|check| check.task == task.id);
            @let passed: Vec<&CheckResult> = of_task().filter(|check| check.verdict == Verdict::Pass).collect();
            @let skipped: Vec<&CheckResult> = of_task().filter(|check| matches!(check.verdict, Verdict::Skipped { .. })).collect();
            @let wrong = report.lacking(&task.id);
            @if passed.len() + wrong.len() > 0 {
                h3 { (task.id) " " (task.title) ": " (passed.len()) " of " (count(passed.len() + wrong.len(), "check")) " passed" }
                // Beside failures, inconclusive checks help little.
                @let (open, failed): (Vec<&CheckResult>, Vec<&CheckResult>) =
                    wrong.iter().partition(|check| check.verdict == Verdict::Inconclusive);
                @if !failed.is_empty() { (table(report, &failed)) }
                @if failed.is_empty() && !open.is_empty() { (table(report, &open)) }
                @if !failed.is_empty() && !open.is_empty() {
                    details { summary { "inconclusive checks" } (table(report, &open)) }
                }
                @if !passed.is_empty() { details { summary { "passed checks" } (table(report, &passed)) } }
                @if !skipped.is_empty() { details { summary { "skipped checks" } (table(report, &skipped)) } }
            }
        }
        @if let Edition::Student { concealed, passed } = edition && concealed > 0 {
            p { (count(concealed, "check")) " in scenes that are not handed out " @if concealed == 1 { "is" } @else { "are" }
                " not shown; " (passed) " passed. They test nothing new: a submission that is correct in every scene passes them." }
        }
    }
}

fn table(report: &Report, checks: &[&CheckResult]) -> Markup {
    html! {
        div.scroll { table.cards {
            thead { tr {
                th { "check" } th { "verdict" } th { "why" } th.number { "error" } th.number { "99 % interval" }
                th.number title="the smallest relative error of the whole image that this check would have detected" { "detectable" }
                th.number { "samples" } th.number { "seconds" }
            } }
            tbody { @for check in checks { (row(report, check)) } }
        } }
    }
}

fn row(report: &Report, check: &CheckResult) -> Markup {
    let percent = |value: f64| format!("{:+.2} %", 100.0 * value);
    let class = match check.verdict {
        Verdict::Pass => "pass",
        Verdict::Fail | Verdict::NotRun { .. } => "fail",
        Verdict::Inconclusive => "inconclusive",
        Verdict::Skipped { .. } => "skipped",
    };
    let test = check.mean_test();
    let effect = test.and_then(|test| test.effect);
    let interval = test.and_then(|test| test.interval);
    let detectable = test.and_then(|test| test.detectable);
    html! {
        tr {
            td.name {
                (breakable(&check.id.to_string()))
                @if check.required { br; span.soft { "required" } }
            }
            td class=(class) { (crate::terminal::loud(&check.verdict)) }
            td {
                (prose(&words::explanation(check)))
                @if let Some(Evidence::Efficiency(noise)) = &check.evidence && !noise.ratios.is_empty() {
                    br; span.soft { "variance relative to each technique of the solution: " (words::variances(noise)) }
                }
                @for remark in words::remarks_with_replay(check, &report.submission.path) { br; span.soft { "Remark: " (prose(&remark)) } }
                details.again {
                    summary { "what this checks / re-run" }
                    p.soft { "This check " (prose(words::about(check.id.kind))) "." }
                    @if check.reason == Reason::Bias && test.is_some() {
                        p.soft { "The result was confirmed with independent random numbers." }
                    }
                    code.command { (words::repeat_command(report, &check.id)) }
                    @if let Some(replay) = words::replay_of(check, &report.submission.path) { br; code.command { (replay) } }
                }
            }
            (number("error", effect.map(percent)))
            (number("99 % interval", interval.map(|[low, high]| format!("{} to {}", percent(low), percent(high)))))
            (number("detectable", detectable.map(|detectable| format!("{:.2} %", 100.0 * detectable))))
            (number("samples", Some(check.samples.to_string())))
            (number("seconds", Some(format!("{:.2}", check.seconds))))
        }
    }
}

/// A cell with a number; its label is shown where the table is too narrow for a head.
fn number(label: &str, text: Option<String>) -> Markup {
    html! { td.number data-label=[text.is_some().then_some(label)] { (text.unwrap_or_default()) } }
}

/// A name that may be broken after its slashes.
fn breakable(name: &str) -> Markup {
    html! { @for part in name.split_inclusive('/') { (part) wbr; } }
}

/// Checks that mean nothing in their scenes, and why.
pub(super) fn skipped(report: &Report) -> Markup {
    html! {
        @if !report.skipped.is_empty() {
            h2 { "Skipped checks" }
            details {
                summary { (count(report.skipped.len(), "check")) " not applicable to the scene, whatever is submitted" }
                ul { @for entry in &report.skipped {
                    li { (entry.kind) " with " (entry.technique) ", " (entry.scene) ": " (prose(&words::why_not(&entry.why))) }
                } }
            }
        }
    }
}

/// Versions, seeds and times.
pub(super) fn provenance(report: &Report) -> Markup {
    let (cost, sandbox, numerics) = (&report.cost, &report.sandbox, words::numerics(&report.numerics));
    let Provenance {
        assignment,
        grader,
        framework,
        rubric,
        references,
        seed,
        secret_seed,
        toolchain,
        threads,
    } = &report.provenance;
    let threads = threads.to_string();
    let mut seed = seed.map_or_else(|| "known to your tutors".to_owned(), |seed| seed.to_string());
    if *secret_seed && report.provenance.seed.is_some() {
        seed += " (secret: not in the student's report)";
    }
    let rows = [
        ("submission (BLAKE3)", &report.submission.hash),
        ("assignment", assignment),
        ("grader", grader),
        ("framework (BLAKE3)", framework),
        ("rubric (BLAKE3)", rubric),
        ("references (BLAKE3)", references),
        ("seed", &seed),
        ("compiler", toolchain),
        ("threads", &threads),
    ];
    html! {
        h2 { "Versions and seeds" }
        details {
            summary { "provenance" }
            div.scroll { table { tbody {
                @for (name, value) in rows { tr { th { (name) } td { code { (value) } } } }
                tr { th { "sandbox" } td { (sandbox.level) " " (words::missing_layers(sandbox)) } }
                @for finding in &sandbox.findings {
                    tr { th { "line " (finding.line) } td { code { (finding.what) } ": " (finding.why) } }
                }
                tr { th { "seconds" } td { (format!("compiling {:.1}, running {:.1}, total {:.1}", cost.build, cost.run, cost.total)) } }
                @if !numerics.is_empty() { tr { th { "invalid samples" } td { (numerics) } } }
            } } }
        }
    }
}
