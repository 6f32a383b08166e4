//! The observation that decided, in a sentence.

use super::distance::of_check;
use super::observation::{State, Vector, technique};
use super::rank::Candidate;
use super::{Catalogue, Cause};
use verdict::report::{CheckResult, Report, Verdict};
use verdict::rubric::CheckKind;

/// How little a check must be apart from the signature to speak for it.
const AGREES: f64 = 4.0;

/// By how much a check that passes has to tell a cause from others, on average, to be worth naming.
const TELLS: f64 = 2.0;

/// What was seen that speaks for the candidate and against other causes: a check that is wrong as the candidate would
/// have it, and, if there is one, a check that passes where others would not.
pub(super) fn sentence(
    catalogue: &Catalogue,
    report: &Report,
    vector: &Vector,
    candidate: &Candidate<'_>,
) -> String {
    let Some(signature) = catalogue.signatures.get(candidate.variant) else { return String::new() };
    let of_technique = |check: &&CheckResult| candidate.technique.is_none_or(|it| technique(&check.id) == it);
    let telling = |check: &CheckResult| -> Option<f64> {
        let (seen, expected) = (vector.0.get(&check.id)?, signature.0.get(&check.id)?);
        let agrees = of_check(seen, expected).is_some_and(|apart| apart <= AGREES);
        agrees.then(|| mean_of_others(catalogue, candidate.cause, vector, check)).flatten()
    };
    let nee_is_right = vector.of_technique("nee").is_right();
    let best = |passes: bool| {
        let of_state = |check: &&CheckResult| {
            vector.0.get(&check.id).is_some_and(|seen| (seen.state == State::Pass) == passes)
        };
        let checks = report.checks.iter().filter(of_technique).filter(of_state);
        let mut scored: Vec<(&CheckResult, f64)> =
            checks.filter_map(|check| Some((check, telling(check)?))).collect();
        // Of checks that tell nearly as much as the best, the one that is simplest to understand, and of these the first.
        scored.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (_, most) = *scored.first()?;
        let nearly = scored.into_iter().filter(|(_, score)| *score >= NEARLY * most);
        nearly.min_by_key(|(check, _)| (effort(check, nee_is_right), place(report, check)))
    };
    let wrong = best(false).map(|(check, _)| check);
    let fallback = || {
        let mut failed = report.checks.iter().filter(of_technique);
        failed.find(|check| vector.0.get(&check.id).is_some_and(|seen| seen.state != State::Pass))
    };
    let Some(wrong) = wrong.or_else(fallback) else { return String::new() };
    let mut text = what_is_wrong(wrong);
    if let Some((right, score)) = best(true)
        && score >= TELLS
    {
        text += &format!("; {}", what_is_right(right));
    }
    text
}

/// Which share of the most that a check tells is nearly as much.
const NEARLY: f64 = 0.6;

/// How hard it is to see what a check's result means. Weights mean little where light samples themselves are wrong.
fn effort(check: &CheckResult, nee_is_right: bool) -> u32 {
    let exact = check.whole().is_some_and(|[effect, margin]| effect.abs() > 10.0 * margin);
    match check.check {
        CheckKind::MisWeights if nee_is_right => 0,
        CheckKind::ClosedForm | CheckKind::MeanBias if check.max_bounces == 1 && exact => 0,
        CheckKind::WhiteFurnace | CheckKind::LightPick | CheckKind::RayBudget | CheckKind::Randomness => 1,
        CheckKind::ClosedForm | CheckKind::MeanBias if exact || check.verdict == Verdict::Pass => 1,
        CheckKind::Efficiency | CheckKind::Metamorphic => 2,
        _ => 3,
    }
}

fn place(report: &Report, check: &CheckResult) -> usize {
    report.checks.iter().position(|other| std::ptr::eq(other, check)).unwrap_or(usize::MAX)
}

/// How far the check is from other causes, on average.
fn mean_of_others(catalogue: &Catalogue, own: &Cause, vector: &Vector, check: &CheckResult) -> Option<f64> {
    let seen = vector.0.get(&check.id)?;
    let others = catalogue.causes().iter().filter(|cause| cause.id != own.id);
    let distances: Vec<f64> = others
        .filter_map(|cause| catalogue.signatures.get(cause.variants.first()?)?.0.get(&check.id))
        .filter_map(|other| of_check(seen, other))
        .collect();
    (!distances.is_empty()).then(|| distances.iter().sum::<f64>() / distances.len() as f64)
}

/// "direct light is 2.00 ± 0.01 times what it should be in area_plane (`nee`)".
fn what_is_wrong(check: &CheckResult) -> String {
    let place = format!("in {} (`{}`)", check.scene, check.technique);
    if !check.coefficients.is_empty() {
        let times: Vec<String> = check.coefficients.iter().map(|c| format!("{c:.2}")).collect();
        return format!(
            "light that is scattered 0, 1, 2, … times counts {} times {place}, where each should count once",
            times.join(", ")
        );
    }
    let of_one_picture = matches!(check.check, CheckKind::MeanBias | CheckKind::ClosedForm);
    match check.whole() {
        Some([effect, margin]) if of_one_picture && effect.abs() > 2.0 * margin && effect > -0.995 => {
            format!(
                "{} is {:.2} ± {:.2} times what it should be {place}",
                light(check),
                1.0 + effect,
                margin.max(0.01)
            )
        }
        _ if of_one_picture => format!("{place}, {}", beginning(&check.explanation)),
        _ => format!("{} (`{}`): {}", check.check.name(), check.technique, beginning(&check.explanation)),
    }
}

fn what_is_right(check: &CheckResult) -> String {
    let quantity = match check.check {
        CheckKind::MisWeights => return "the weights, looked at one by one, are right (`mis`)".to_owned(),
        CheckKind::LightPick => return format!("each of three lights counts once (`{}`)", check.technique),
        CheckKind::RayBudget => return format!("no path takes too many rays (`{}`)", check.technique),
        CheckKind::Stability => return format!("extreme scenes come out right (`{}`)", check.technique),
        CheckKind::Efficiency => "the noise",
        CheckKind::Randomness => "the use of random numbers",
        CheckKind::Metamorphic => "what becomes of a changed scene",
        _ => light(check),
    };
    format!("{quantity} is right in {} (`{}`)", check.scene, check.technique)
}

/// Which light a check looks at.
fn light(check: &CheckResult) -> &'static str {
    match (check.max_bounces, check.id.ends_with("hits-off")) {
        (1, false) => "direct light",
        (1, true) => "direct light that light samples bring",
        (_, false) => "light",
        (_, true) => "light that light samples bring",
    }
}

/// An explanation without the place of a sample, without guesses and without a command, all of which follow.
fn beginning(explanation: &str) -> &str {
    let ends = ["; the first: pixel", "; likely cause:", "; see it again", ": it is not picked"];
    let end = ends.iter().filter_map(|end| explanation.find(end)).min();
    &explanation[..end.unwrap_or(explanation.len())]
}
