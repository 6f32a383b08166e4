//! The plan: which checks apply to which scene.

use std::collections::BTreeMap;

use arty::integrator::Technique;
use verdict::check::{CheckKind, Visibility, WhyNot};
use verdict::error::{Error, Result};
use verdict::report::SkippedCheck;
use verdict::rubric::{CheckSpec, Rubric, Task};

use crate::checks::{SceneWithReference, of_kind};

/// A kind of check with a technique in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedCheck {
    /// Kind of check.
    pub check: CheckKind,
    /// Technique.
    pub technique: Technique,
    /// Why it does not apply; `None` if it applies.
    pub why_not: Option<WhyNot>,
}

/// All kinds of checks and techniques in a scene, with the recommended number of bounces.
pub fn for_scene(scene: &SceneWithReference) -> Vec<PlannedCheck> {
    let all = scene.scene.defaults().max_bounces.unwrap_or(8);
    let entry = |kind: CheckKind, technique| {
        let spec = CheckSpec::new(kind, technique, of_kind(kind).recommended_bounces(all));
        PlannedCheck { check: kind, technique, why_not: why_not(&spec, scene).err() }
    };
    let kinds = CheckKind::ALL.into_iter().filter(|&kind| kind != CheckKind::HiddenVariants);
    kinds
        .flat_map(|kind| of_kind(kind).techniques().iter().map(move |&technique| entry(kind, technique)))
        .collect()
}

/// Refuses a rubric with a check that is not valid in any scene. [`for_scene`] uses the same functions.
///
/// # Errors
/// The first invalid check.
pub fn validate(rubric: &Rubric) -> Result<()> {
    for (task, spec) in rubric.checks() {
        of_kind(spec.check).accepts(spec).map_err(|why| {
            let what = match why {
                WhyNot::Technique => {
                    let names: Vec<&str> =
                        of_kind(spec.check).techniques().iter().map(|technique| technique.name()).collect();
                    format!("`technique` must be {}", names.join(" or "))
                }
                WhyNot::Bounces { min, max } if min == max => format!("`max_bounces` must be {min}"),
                WhyNot::Bounces { min, max } => format!("`max_bounces` must be from {min} to {max}"),
                _ => "`emission_on_hit: off` needs mean-bias or closed-form with `technique: nee`".to_owned(),
            };
            Error::Input(format!("task {}, {}: {what}", task.id, spec.id()))
        })?;
    }
    Ok(())
}

/// Refuses a rubric with a check whose result would mean nothing in its scene: in images of BSDF sampling that rarely finds
/// a light, the solution would fail.
///
/// # Errors
/// The first such check.
pub(crate) fn validate_in_scenes(
    specs: &[(&Task, &CheckSpec)],
    scenes: &BTreeMap<String, SceneWithReference>,
) -> Result<()> {
    for (task, spec) in specs {
        let why = scenes.get(&spec.scene).and_then(|scene| why_not(spec, scene).err());
        if let Some(WhyNot::BsdfFindsLittle { share, .. }) = why {
            return Err(Error::Input(format!(
                "task {}, {}: BSDF sampling finds a light with only {:.1} % of the bounces there, so that no mean can be \
                 judged; `cargo grader plan {}` lists what applies",
                task.id,
                spec.id(),
                100.0 * share,
                spec.scene
            )));
        }
    }
    Ok(())
}

/// Why a check of a rubric is skipped; `None` if it is not. `scene` is `None` if the check builds its own scene, or if
/// the scene is missing because only staff have it.
pub fn why_skipped(
    spec: &CheckSpec,
    scene: Option<&SceneWithReference>,
    has_solution: bool,
) -> Option<WhyNot> {
    match scene {
        None if spec.check.needs_scene() => Some(WhyNot::SceneNotHere),
        _ if spec.check.draws_scenes() && !has_solution => Some(WhyNot::NoSolution),
        Some(scene) => why_not(spec, scene).err(),
        None => None,
    }
}

/// True if only staff can run the check. If it is skipped for that reason, its points are kept open.
pub fn needs_staff(spec: &CheckSpec) -> bool {
    spec.visibility() == Visibility::StaffOnly || spec.check.draws_scenes()
}

/// All kinds of checks that do not apply to the scenes of a grade.
pub fn skipped(scenes: &BTreeMap<String, SceneWithReference>) -> Vec<SkippedCheck> {
    let of_scene = |(name, scene): (&String, &SceneWithReference)| -> Vec<SkippedCheck> {
        let skipped = |PlannedCheck { check: kind, technique, why_not }: PlannedCheck| {
            Some(SkippedCheck { kind, technique, scene: name.clone(), check: None, why: why_not? })
        };
        for_scene(scene).into_iter().filter_map(skipped).collect()
    };
    scenes.iter().flat_map(of_scene).collect()
}

fn why_not(spec: &CheckSpec, scene: &SceneWithReference) -> std::result::Result<(), WhyNot> {
    let check = of_kind(spec.check);
    check.accepts(spec)?;
    let features = scene.scene.features();
    if !features.has_lights() && !features.environment {
        // Paths must end even without lights.
        return if spec.check == CheckKind::RayBudget { Ok(()) } else { Err(WhyNot::NoLights) };
    }
    if spec.technique == Technique::Bsdf && features.area_lights == 0 && !features.environment {
        return Err(WhyNot::BsdfFindsNothing);
    }
    check.applies(scene, spec)
}
