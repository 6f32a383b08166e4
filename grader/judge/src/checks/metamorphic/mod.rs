//! **metamorphic**: transformed scenes whose image is known from that of the original.
//!
//! A scene is transformed with a known effect on its image, and the image is compared with the reference of the
//! original. This detects everything that depends on units, positions or the description of the scene: epsilons in the
//! submission, clamped samples, limits on radiance, precomputed pictures.

mod transform;

pub(super) use transform::Transform;

use arty::scene::SceneDescription;
use verdict::check::{ChangeTest, CheckKind, Evidence, SceneChange, WhyNot};
use verdict::rubric::CheckSpec;

use super::means::{self, Anomalies, Picture};
use super::{
    Check, CheckOutcome, GradeContext, JobError, Observation, SceneWithReference, WrongPlace, mean_bias,
    rare_light,
};
use crate::statistics::sequential::{Decision, Judgement};

/// A changed scene (if several, their images are summed), and the factor on its brightness.
struct Change {
    change: SceneChange,
    scenes: Vec<SceneDescription>,
    brighter: f64,
}

pub(super) struct Metamorphic;

impl Check for Metamorphic {
    fn kind(&self) -> CheckKind {
        CheckKind::Metamorphic
    }

    fn applies(&self, scene: &SceneWithReference, spec: &CheckSpec) -> Result<(), WhyNot> {
        rare_light::require(&scene.scene, spec)
    }

    fn run(&self, context: &GradeContext<'_>, spec: &CheckSpec) -> Result<CheckOutcome, JobError> {
        let scene = context.scene(spec);
        let changes = changes(&scene.description);
        let reference = mean_bias::expected(spec, &scene.reference)?;
        let (mut anomalies, mut samples) = (Anomalies::default(), 0);
        let mut worst: Option<(SceneChange, Judgement)> = None;
        for (index, Change { change, scenes, brighter }) in changes.iter().enumerate() {
            let expected = reference.brightened(*brighter);
            let scenes: Vec<&SceneDescription> = scenes.iter().collect();
            let mut picture = Picture::of(context, spec, &scenes, &expected);
            picture.screening_level /= changes.len() as f64;
            picture.seed ^= (index as u64).rotate_right(8);
            let judgement = picture.judge(context, &mut anomalies)?;
            samples += judgement.samples;
            let is_biased = judgement.decision == Decision::Biased;
            let rank = |decision| match decision {
                Decision::Unbiased => 0,
                Decision::Unclear => 1,
                Decision::Biased => 2,
            };
            if worst.as_ref().is_none_or(|(_, other)| rank(judgement.decision) > rank(other.decision)) {
                worst = Some((*change, judgement));
            }
            if is_biased {
                break;
            }
        }
        let (change, judgement) = worst.expect("every scene can be changed");
        let test = means::mean_test(&judgement, spec.tolerance);
        let is_biased = judgement.decision == Decision::Biased;
        let evidence = ChangeTest { change, changes: changes.len() as u32, is_biased, test };
        let outcome = means::conclude(&judgement, Evidence::Metamorphic(evidence), samples);
        Ok(outcome.with(anomalies.numerics(None)))
    }

    fn observations(&self, evidence: &Evidence) -> Vec<Observation> {
        let Evidence::Metamorphic(ChangeTest { change, is_biased, test, .. }) = evidence else {
            return Vec::new();
        };
        let place = is_biased.then(|| Observation::wrong_at(WrongPlace::Change(*change)));
        Observation::of_mean(test).into_iter().chain(place).collect()
    }
}

/// All changes that apply to the scene.
fn changes(scene: &SceneDescription) -> Vec<Change> {
    let one = |change, changed: SceneDescription| Change { change, scenes: vec![changed], brighter: 1.0 };
    let brighter = |change, factor: f32| Change {
        change,
        scenes: vec![transform::brightened(scene, factor)],
        brighter: f64::from(factor),
    };
    let moved = |transform: Transform| transform.apply(scene);
    let mut changes = vec![
        brighter(SceneChange::Brighter, 1000.0),
        brighter(SceneChange::Dimmer, 1e-3),
        one(SceneChange::Larger, moved(Transform::scale(100.0))),
        one(SceneChange::Smaller, moved(Transform::scale(0.01))),
        one(SceneChange::Rotated, moved(Transform::turn())),
        one(SceneChange::Moved, moved(Transform::shift())),
        one(SceneChange::Tessellated, transform::tessellated(scene)),
        one(SceneChange::LightsSplit, transform::lights_split(scene)),
        one(SceneChange::BlackObjects, transform::with_black_objects(scene)),
    ];
    if let Some(parts) = transform::lights_apart(scene) {
        changes.push(Change { change: SceneChange::LightsApart, scenes: parts.into(), brighter: 1.0 });
    }
    changes
}
