//! Ranking the known mistakes by their distance from a report.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use arty::integrator::Technique;

use super::distance::Distance;
use super::observation::{CheckState, ObservationVector};
use super::{Catalogue, Cause, MAX_CAUSES};

/// Minimum p-value of a cause that fits.
const MIN_P_VALUE: f64 = 1e-3;

/// Minimum p-value of a cause for one technique only: with fewer checks, more causes fit by chance.
const MIN_P_VALUE_ONE_TECHNIQUE: f64 = 0.05;

/// Minimum share of the failed checks that a signature must cover.
const MIN_COVERAGE: f64 = 0.4;

/// The numbers of one submission are correlated: differences of squared distances are divided by this.
const CORRELATION: f64 = 3.0;

/// Minimum confidence of a cause that is reported.
const MIN_CONFIDENCE: f64 = 0.04;

/// Minimum total confidence of the causes that are reported.
const MIN_TOTAL_CONFIDENCE: f64 = 0.5;

/// Minimum improvement of the squared distance for diagnosing two mistakes instead of one.
const TWO_CAUSES_PENALTY: f64 = 15.0;

/// A cause with its distance from the report.
#[derive(Clone, Debug)]
pub(super) struct Candidate<'a> {
    pub(super) cause: &'a Cause,
    /// The variant of the cause with the smallest distance.
    pub(super) variant: &'a str,
    /// The technique that was compared; `None` for all.
    pub(super) technique: Option<Technique>,
    /// Posterior probability among all causes, in [0, 1].
    pub(super) confidence: f64,
    distance: Distance,
}

impl Candidate<'_> {
    fn fits(&self) -> bool {
        let Distance { squared, degrees_of_freedom, .. } = self.distance;
        let level = if self.technique.is_some() { MIN_P_VALUE_ONE_TECHNIQUE } else { MIN_P_VALUE };
        ChiSquared::new(f64::from(degrees_of_freedom))
            .is_ok_and(|distribution| distribution.sf(squared) >= level)
    }
}

/// The causes that fit, most likely first. If no single cause explains everything, the causes of each technique are
/// ranked separately and merged.
pub(super) fn rank<'a>(catalogue: &'a Catalogue, vector: &ObservationVector) -> Vec<Candidate<'a>> {
    let joint = within(catalogue, vector, None);
    let parts: Vec<Vec<Candidate<'a>>> = vector
        .techniques()
        .into_iter()
        .map(|technique| (technique, vector.of_technique(technique)))
        .filter(|(_, part)| !part.all_pass())
        .map(|(technique, part)| within(catalogue, &part, Some(technique)))
        .collect();
    let best = |ranking: &[Candidate<'a>]| ranking.first().filter(|it| it.fits()).cloned();
    let firsts: Vec<Candidate<'a>> = parts.iter().filter_map(|part| best(part)).collect();
    let apart = firsts.iter().fold(Distance::default(), |sum, first| sum.plus(first.distance));
    let all_explained = !parts.is_empty() && firsts.len() == parts.len();
    let one = best(&joint)
        .filter(|one| !(all_explained && apart.squared + TWO_CAUSES_PENALTY < one.distance.squared));
    match one {
        Some(_) => worth_naming(joint),
        None => merge(parts.into_iter().map(worth_naming).collect()),
    }
}

/// All comparable causes, sorted by distance, with their confidences.
fn within<'a>(
    catalogue: &'a Catalogue,
    vector: &ObservationVector,
    technique: Option<Technique>,
) -> Vec<Candidate<'a>> {
    let candidate = |cause: &'a Cause| {
        let distances = cause.variants.iter().filter_map(|variant| {
            let signature = catalogue.signatures.get(variant)?;
            let distance = Distance::between(vector, signature);
            let comparable = distance.coverage >= MIN_COVERAGE && explains_something(vector, signature);
            comparable.then_some((variant.as_str(), distance))
        });
        let (variant, distance) = distances.min_by(|a, b| a.1.squared.total_cmp(&b.1.squared))?;
        Some(Candidate { cause, variant, technique, confidence: 0.0, distance })
    };
    let mut all: Vec<Candidate<'a>> = catalogue.causes().iter().filter_map(candidate).collect();
    all.sort_by(|a, b| a.distance.squared.total_cmp(&b.distance.squared));
    let nearest = all.first().map_or(0.0, |first| first.distance.squared);
    let weight = |it: &Candidate<'_>| (-0.5 * (it.distance.squared - nearest) / CORRELATION).exp();
    let sum: f64 = all.iter().map(weight).sum();
    for candidate in &mut all {
        candidate.confidence = weight(candidate) / sum;
    }
    all
}

/// True if some check fails on both sides.
fn explains_something(vector: &ObservationVector, signature: &ObservationVector) -> bool {
    let mut wrong = vector.0.iter().filter(|(_, seen)| seen.state != CheckState::Pass);
    wrong.any(|(check, _)| signature.0.get(check).is_some_and(|seen| seen.state != CheckState::Pass))
}

/// The first causes of a ranking; empty if so many fit equally well that the selection would be arbitrary.
fn worth_naming(ranking: Vec<Candidate<'_>>) -> Vec<Candidate<'_>> {
    let worth = |candidate: &Candidate<'_>| candidate.fits() && candidate.confidence >= MIN_CONFIDENCE;
    let named: Vec<Candidate<'_>> = ranking.into_iter().filter(worth).take(MAX_CAUSES).collect();
    let together: f64 = named.iter().map(|candidate| candidate.confidence).sum();
    if together >= MIN_TOTAL_CONFIDENCE { named } else { Vec::new() }
}

/// True if some cause fits, even if too many fit to report any.
pub(super) fn something_fits(catalogue: &Catalogue, vector: &ObservationVector) -> bool {
    within(catalogue, vector, None).first().is_some_and(Candidate::fits)
}

/// Interleaves rankings: the first of each, then the second of each, and so on, without duplicates.
fn merge(parts: Vec<Vec<Candidate<'_>>>) -> Vec<Candidate<'_>> {
    let mut merged: Vec<Candidate<'_>> = Vec::new();
    for place in 0..MAX_CAUSES {
        for candidate in parts.iter().filter_map(|part| part.get(place)) {
            if merged.iter().all(|other| other.cause.id != candidate.cause.id) {
                merged.push(candidate.clone());
            }
        }
    }
    merged.truncate(MAX_CAUSES);
    merged
}
