//! Points, likely causes and checks of a report's page.

use maud::{Markup, html};

use verdict::edition::Edition;
use verdict::report::{CheckResult, Report, TaskResult, Verdict};
use verdict::rubric::CheckKind;

/// Points task by task, with what is wrong and what to do.
pub(super) fn tasks(report: &Report) -> Markup {
    html! {
        h2 { "Points" }
        div.scroll { table.cards {
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
    let Some(&wrong) = report.lacking(&task.id).first() else {
        return html! { @if task.reason.is_empty() { "nothing is missing" } @else { (task.reason) } };
    };
    html! {
        (wrong.explanation) "."
        @if wrong.verdict == Verdict::Inconclusive { " Bring the noise down first: " } @else { " Mend this first: " }
        code { (wrong.repeat) }
    }
}

/// What the student wrote, for the person who marks it.
pub(super) fn explanations(report: &Report) -> Markup {
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

/// All checks of each task. Those that failed are unfolded.
pub(super) fn checks(report: &Report, edition: Edition) -> Markup {
    html! {
        @if !report.checks.is_empty() { h2 { "Checks" } }
        @for task in &report.tasks {
            @let with = |verdict| report.checks.iter().filter(|check| check.task == task.id && check.verdict == verdict).collect::<Vec<_>>();
            @let (passed, wrong, left_out) = (with(Verdict::Pass), report.lacking(&task.id), with(Verdict::LeftOut));
            @if passed.len() + wrong.len() > 0 {
                h3 { (task.id) " " (task.title) ": " (passed.len()) " of " (passed.len() + wrong.len()) " passed" }
                // Beside what is known to be wrong, what nobody can tell helps little.
                @let (open, failed): (Vec<&CheckResult>, Vec<&CheckResult>) =
                    wrong.iter().partition(|check| check.verdict == Verdict::Inconclusive);
                @if !failed.is_empty() { (table(&failed)) }
                @if failed.is_empty() && !open.is_empty() { (table(&open)) }
                @if !failed.is_empty() && !open.is_empty() {
                    details { summary { "what could not be told" } (table(&open)) }
                }
                @if !passed.is_empty() { details { summary { "what passed" } (table(&passed)) } }
                @if !left_out.is_empty() { details { summary { "what was not run" } (table(&left_out)) } }
            }
        }
        @if let Edition::Student { concealed, passed } = edition && concealed > 0 {
            p { "Checks in scenes that are not handed out, which are not shown: " (concealed) ", of which " (passed) " passed. They hold a \
                hand-in to nothing that the others do not: what is right in every scene passes them." }
        }
    }
}

fn table(checks: &[&CheckResult]) -> Markup {
    html! {
        div.scroll { table.cards {
            thead { tr {
                th { "check" } th { "verdict" } th { "why" } th.number { "effect" } th.number { "99 % interval" }
                th.number title="the smallest error of the whole picture that would have been found" { "detectable" }
                th.number { "samples" } th.number { "seconds" }
            } }
            tbody { @for check in checks { (row(check)) } }
        } }
    }
}

/// What a check looks at, and why.
fn about(kind: CheckKind) -> &'static str {
    match kind {
        CheckKind::ClosedForm => "compares each pixel with a formula: no reference takes part",
        CheckKind::Efficiency => {
            "compares the noise with that of the solution: means alone cannot tell whether a technique is used"
        }
        CheckKind::HiddenVariants => "compares with the solution in scenes that are drawn anew for each seed",
        CheckKind::LightPick => "counts how often each light is picked, and what is divided by",
        CheckKind::MeanBias => {
            "compares means of regions with the reference: noise may be anything, bias may not"
        }
        CheckKind::Metamorphic => "turns, moves and rebuilds the scene in ways that must not show",
        CheckKind::MisWeights => {
            "reads single weights off scenes in which the light can be reached in one way only"
        }
        CheckKind::Randomness => {
            "compares runs with each other: random numbers must be the sampler's, and used once"
        }
        CheckKind::RayBudget => "counts rays",
        CheckKind::Stability => "makes sizes, distances, radiances and densities very small and very large",
        CheckKind::WhiteFurnace => {
            "looks at a closed surface that emits the same everywhere, where each bounce is known"
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
            td.name {
                (breakable(&check.id))
                @if check.evidence { br; span.soft { "no points without it" } }
            }
            td class=(class) { (word) }
            td {
                (check.explanation)
                @if !check.variance_ratios.is_empty() {
                    br; span.soft { "variance, relative to the solution's: "
                        (check.variance_ratios.iter().map(|it| format!("{} {:.2}", it.technique, it.ratio)).collect::<Vec<_>>().join(", ")) }
                }
                @for remark in &check.remarks { br; span.soft { "Remark: " (remark) } }
                details.again {
                    summary { "what is looked at, and how to see it again" }
                    p.soft { "It " (about(check.check)) "." }
                    code { (check.repeat) }
                }
            }
            (number("effect", check.effect.map(percent)))
            (number("99 % interval", check.interval.map(|[low, high]| format!("{} to {}", percent(low), percent(high)))))
            (number("detectable", check.detectable.map(|detectable| format!("{:.2} %", 100.0 * detectable))))
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

pub(super) fn left_out(report: &Report) -> Markup {
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

pub(super) fn provenance(report: &Report) -> Markup {
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
