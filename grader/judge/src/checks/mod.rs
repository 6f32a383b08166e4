//! The checks: one file or folder a kind.
//!
//! A new kind is one file that implements [`Check`] and one line in [`REGISTRY`] (its name stands in
//! [`CheckKind`](verdict::check::CheckKind), its measurements in [`Evidence`](verdict::check::Evidence)): plan, rubric,
//! grade and diagnosis ask the registry.

mod check;
mod closed_form;
mod context;
mod efficiency;
mod hidden_variants;
mod light_pick;
mod mean_bias;
mod means;
mod metamorphic;
mod mis_weights;
mod path_length;
mod randomness;
mod ray_budget;
mod stability;
#[cfg(test)]
mod test_scenes;
mod white_furnace;

pub use check::{Check, Observation, Outcome, Quantity, WrongPlace};
pub use context::{GradeContext, SceneWithReference, give_up, skip};
pub use harness::job::JobError;
pub use mean_bias::expected as expected_by_reference;

use verdict::check::CheckKind;

/// All checks, one a kind.
static REGISTRY: [&dyn Check; CheckKind::ALL.len()] = [
    &closed_form::ClosedForm,
    &efficiency::Efficiency,
    &hidden_variants::HiddenVariants,
    &light_pick::LightPick,
    &mean_bias::MeanBias,
    &metamorphic::Metamorphic,
    &mis_weights::MisWeights,
    &path_length::PathLength,
    &randomness::Randomness,
    &ray_budget::RayBudget,
    &stability::Stability,
    &white_furnace::WhiteFurnace,
];

/// The check of a kind.
pub fn of_kind(kind: CheckKind) -> &'static dyn Check {
    REGISTRY
        .into_iter()
        .find(|check| check.kind() == kind)
        .expect("every kind is registered: a test holds that")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_registered_once() {
        let mut registered: Vec<CheckKind> = REGISTRY.iter().map(|check| check.kind()).collect();
        registered.sort();
        assert_eq!(registered, CheckKind::ALL);
    }
}
