//! **metamorphic**: scenes that must look the same, or brighter by a known factor.
//!
//! A scene is changed in a way of which the effect is known without rendering, and judged against the reference of the
//! original. Whatever depends on units, on places or on how a thing is described shows: epsilons of the student's own,
//! clamped samples, limits on brightness, pictures made ahead.

mod transform;

pub(super) use transform::Transform;

use arty::scene::SceneDescription;

use super::means::{self, Numerics, Picture};
use super::{Bench, Stop, mean_bias};
use crate::statistics::sequential::{Decision, Judgement};
use verdict::report::{CheckResult, Verdict};
use verdict::rubric::CheckSpec;

/// A changed scene (several: their sum), and how many times as bright it is.
struct Change {
    /// In words that continue "with".
    name: &'static str,
    scenes: Vec<SceneDescription>,
    brighter: f64,
}

pub(super) fn run(bench: &Bench<'_>, spec: &CheckSpec, result: &mut CheckResult) -> Result<(), Stop> {
    let judged = bench.scene(spec);
    let changes = changes(&judged.description);
    let reference = mean_bias::expected(spec, &judged.reference)?;
    let mut numerics = Numerics::default();
    let mut worst: Option<(&Change, Judgement)> = None;
    let mut biased = Vec::new();
    for (index, change) in changes.iter().enumerate() {
        let expected = reference.brightened(change.brighter);
        let scenes: Vec<&SceneDescription> = change.scenes.iter().collect();
        let mut picture = Picture::of(bench, spec, &scenes, &expected);
        picture.screening_level /= changes.len() as f64;
        picture.seed ^= (index as u64).rotate_right(8);
        let judgement = picture.judge(bench, &mut numerics)?;
        result.samples += judgement.samples;
        if judgement.decision == Decision::Biased {
            biased.push((change.name.to_owned(), judgement.whole.relative()));
        }
        let grade = |decision| match decision {
            Decision::Unbiased => 0,
            Decision::Unclear => 1,
            Decision::Biased => 2,
        };
        if worst.as_ref().is_none_or(|(_, other)| grade(judgement.decision) > grade(other.decision)) {
            worst = Some((change, judgement));
        }
        if worst.as_ref().is_some_and(|(_, worst)| worst.decision == Decision::Biased) {
            break;
        }
    }
    let Some((change, judgement)) = worst else { return Ok(()) };
    let samples = result.samples;
    means::describe(result, &judgement, spec.tolerance);
    result.samples = samples;
    result.details.extend(biased.into_iter().filter(|(_, effect)| effect.is_finite()));
    result.explanation = if result.verdict == Verdict::Pass {
        format!("{} changes of the scene change the picture as they should", changes.len())
    } else {
        format!("with {}, {}", change.name, result.explanation)
    };
    numerics.enter(result, |_| None);
    Ok(())
}

/// All changes that mean something in the scene.
fn changes(scene: &SceneDescription) -> Vec<Change> {
    let one = |name, changed: SceneDescription| Change { name, scenes: vec![changed], brighter: 1.0 };
    let brighter = |name, factor: f32| Change {
        name,
        scenes: vec![transform::brightened(scene, factor)],
        brighter: f64::from(factor),
    };
    let moved = |transform: Transform| transform.apply(scene);
    let mut changes = vec![
        brighter("all lights 1000 times as bright", 1000.0),
        brighter("all lights a thousandth as bright", 1e-3),
        one("all lengths 100 times as long", moved(Transform::scale(100.0))),
        one("all lengths a hundredth as long", moved(Transform::scale(0.01))),
        one("the scene turned", moved(Transform::turn())),
        one("the scene moved", moved(Transform::shift())),
        one("more and smaller triangles", transform::tessellated(scene)),
        one("each light split into two", transform::lights_split(scene)),
        one("black things beside the scene", transform::with_things_beside(scene)),
    ];
    if let Some(parts) = transform::lights_apart(scene) {
        changes.push(Change { name: "the lights in two scenes", scenes: parts.into(), brighter: 1.0 });
    }
    changes
}
