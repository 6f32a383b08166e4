//! Selecting the checks that are evidence for a cause.

use arty::integrator::Technique;
use verdict::check::{CheckKind, CheckResult, Verdict};
use verdict::report::{Report, SeenIn};

use super::distance::check_distance;
use super::observation::{CheckState, ObservationVector};
use super::rank::Candidate;
use super::{Catalogue, Cause};

/// Maximum contribution to the distance of a check that agrees with the signature.
const MAX_AGREEING_DISTANCE: f64 = 4.0;

/// Minimum mean distance from other causes of a passing check that is evidence.
const MIN_SEPARATION: f64 = 2.0;

/// The evidence for a candidate: a check that fails the way the candidate predicts and, if there is one, a check that
/// passes although other causes would make it fail.
pub(super) fn seen(
    catalogue: &Catalogue,
    report: &Report,
    vector: &ObservationVector,
    candidate: &Candidate<'_>,
) -> Option<SeenIn> {
    let signature = catalogue.signatures.get(candidate.variant)?;
    let of_technique = |check: &&CheckResult| candidate.technique.is_none_or(|it| check.id.technique == it);
    let separation = |check: &CheckResult| -> Option<f64> {
        let (seen, expected) = (vector.0.get(&check.id)?, signature.0.get(&check.id)?);
        let agrees = check_distance(seen, expected).is_some_and(|apart| apart <= MAX_AGREEING_DISTANCE);
        agrees.then(|| mean_distance_of_others(catalogue, candidate.cause, vector, check)).flatten()
    };
    let nee_is_right = vector.of_technique(Technique::Nee).all_pass();
    let best = |passes: bool| {
        // What is too noisy to judge shows nothing.
        let of_state = |check: &&CheckResult| {
            let state = vector.0.get(&check.id).map(|seen| seen.state);
            state.is_some_and(|state| state != CheckState::Unclear && (state == CheckState::Pass) == passes)
        };
        let checks = report.checks.iter().filter(of_technique).filter(of_state);
        let mut scored: Vec<(&CheckResult, f64)> =
            checks.filter_map(|check| Some((check, separation(check)?))).collect();
        // Of the checks with nearly the best separation, take the one that is easiest to understand, and of these the
        // first.
        scored.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (_, most) = *scored.first()?;
        let nearly = scored.into_iter().filter(|(_, score)| *score >= NEARLY_BEST * most);
        nearly.min_by_key(|(check, _)| (effort(check, nee_is_right), index_of(report, check)))
    };
    let wrong = best(false).map(|(check, _)| check);
    let fallback = || {
        let mut failed = report.checks.iter().filter(of_technique);
        failed.find(|check| {
            let state = vector.0.get(&check.id).map(|seen| seen.state);
            state.is_some_and(|state| !matches!(state, CheckState::Pass | CheckState::Unclear))
        })
    };
    let wrong = wrong.or_else(fallback)?.id.clone();
    let right = best(true).filter(|(_, score)| *score >= MIN_SEPARATION).map(|(check, _)| check.id.clone());
    Some(SeenIn { wrong, right })
}

/// Share of the best separation that counts as nearly the best.
const NEARLY_BEST: f64 = 0.6;

/// How hard a result is to understand: 0 is easiest. Weights mean little if light samples are wrong.
fn effort(check: &CheckResult, nee_is_right: bool) -> u32 {
    let whole = check.mean_test().and_then(|test| test.whole);
    let exact = whole.is_some_and(|whole| whole.relative.abs() > 10.0 * whole.margin);
    match check.id.kind {
        CheckKind::MisWeights if nee_is_right => 0,
        CheckKind::ClosedForm | CheckKind::MeanBias if check.id.max_bounces == 1 && exact => 0,
        CheckKind::WhiteFurnace | CheckKind::LightPick | CheckKind::RayBudget | CheckKind::Randomness => 1,
        CheckKind::ClosedForm | CheckKind::MeanBias if exact || check.verdict == Verdict::Pass => 1,
        CheckKind::Efficiency | CheckKind::Metamorphic => 2,
        _ => 3,
    }
}

fn index_of(report: &Report, check: &CheckResult) -> usize {
    report.checks.iter().position(|other| std::ptr::eq(other, check)).unwrap_or(usize::MAX)
}

/// Mean contribution of the check to the distances of other causes; `None` if no other cause has it.
fn mean_distance_of_others(
    catalogue: &Catalogue,
    own: &Cause,
    vector: &ObservationVector,
    check: &CheckResult,
) -> Option<f64> {
    let seen = vector.0.get(&check.id)?;
    let others = catalogue.causes().iter().filter(|cause| cause.id != own.id);
    let distances: Vec<f64> = others
        .filter_map(|cause| catalogue.signatures.get(cause.variants.first()?)?.0.get(&check.id))
        .filter_map(|other| check_distance(seen, other))
        .collect();
    (!distances.is_empty()).then(|| distances.iter().sum::<f64>() / distances.len() as f64)
}
