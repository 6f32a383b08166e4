//! The checks: one file or folder per kind.
//!
//! A new kind is one file that implements [`Check`] and one line in `REGISTRY`, besides its name in
//! [`CheckKind`] and its measurements in [`Evidence`](verdict::check::Evidence). Plan,
//! rubric, grade and diagnosis use the registry.

mod against_oracle;
mod check;
mod closed_form;
mod context;
mod efficiency;
mod facts;
mod hidden_variants;
mod light_pick;
mod mean_bias;
mod means;
mod metamorphic;
mod mis_weights;
mod path_length;
mod randomness;
mod rare_light;
mod ray_budget;
mod sampling;
mod stability;
#[cfg(test)]
mod test_scenes;
mod varied_scene;
mod white_furnace;

pub use check::{Check, CheckOutcome, Observation, Quantity, WrongPlace};
pub use context::{GradeContext, SceneWithReference, out_of_time, skipped};
pub use harness::job::JobError;
pub(crate) use light_pick::three_lights;
pub use mean_bias::expected as expected_by_reference;

use verdict::check::CheckKind;

/// All checks, one per kind.
static REGISTRY: [&dyn Check; CheckKind::ALL.len()] = [
    &closed_form::ClosedForm,
    &efficiency::Efficiency,
    &facts::Facts,
    &hidden_variants::HiddenVariants,
    &light_pick::LightPick,
    &mean_bias::MeanBias,
    &metamorphic::Metamorphic,
    &mis_weights::MisWeights,
    &path_length::PathLength,
    &randomness::Randomness,
    &ray_budget::RayBudget,
    &sampling::Sampling,
    &stability::Stability,
    &varied_scene::VariedScene,
    &white_furnace::WhiteFurnace,
];

/// The check of a kind.
pub fn of_kind(kind: CheckKind) -> &'static dyn Check {
    REGISTRY
        .into_iter()
        .find(|check| check.kind() == kind)
        .expect("every kind is registered, as a test checks")
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
