//! Which checks mean something in which scene.

use std::collections::BTreeMap;

use arty::integrator::Technique;
use verdict::check::{CheckKind, Visibility, WhyNot};
use verdict::error::{Error, Result};
use verdict::report::SkippedCheck;
use verdict::rubric::{CheckSpec, Rubric};

use crate::checks::{SceneWithReference, of_kind};

/// A kind of check in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedCheck {
    /// The kind.
    pub check: CheckKind,
    /// With which technique.
    pub technique: Technique,
    /// Why it means nothing there; `None` if it does mean something.
    pub why_not: Option<WhyNot>,
}

/// Everything that could be checked in a scene, with the number of bounces that says most.
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

/// Refuses a rubric that asks for a check which could mean nothing in any scene: `for_scene` asks the same functions.
///
/// # Errors
/// The first such check.
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
                _ => {
                    "`emission_on_hit: off` goes with mean-bias and closed-form, and with nee only".to_owned()
                }
            };
            Error::Input(format!("task {}, {}: {what}", task.id, spec.id()))
        })?;
    }
    Ok(())
}

/// Why a check of a rubric is skipped; `None` if it is not. Its scene is `None` if it makes its own, or if only staff
/// have it.
pub fn why_skipped(
    spec: &CheckSpec,
    scene: Option<&SceneWithReference>,
    has_solution: bool,
) -> Option<WhyNot> {
    match scene {
        Some(scene) => why_not(spec, scene).err(),
        None if spec.check.needs_scene() => Some(WhyNot::SceneNotHere),
        None => (needs_staff(spec) && !has_solution).then_some(WhyNot::NoSolution),
    }
}

/// True of a check that only staff can run. Where it is skipped for that, it keeps its worth.
pub fn needs_staff(spec: &CheckSpec) -> bool {
    spec.visibility() == Visibility::StaffOnly
}

/// What is skipped in all scenes of a grade, and why.
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
    if !features.has_lights() {
        // Paths must end there, too.
        return if spec.check == CheckKind::RayBudget { Ok(()) } else { Err(WhyNot::NoLights) };
    }
    if spec.technique == Technique::Bsdf && features.area_lights == 0 {
        return Err(WhyNot::BsdfFindsNothing);
    }
    check.applies(scene, spec)
}
