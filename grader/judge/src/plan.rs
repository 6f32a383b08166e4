//! Which checks mean something in which scene.

use std::collections::BTreeMap;

use arty::integrator::Technique;

use crate::checks::{JudgedScene, why_it_does_not_tell, why_no_closed_form, why_no_furnace};
use verdict::edition::is_hidden;
use verdict::report::LeftOut;
use verdict::rubric::{CheckKind, CheckSpec, Hits};

/// A kind of check in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Which kind.
    pub check: CheckKind,
    /// With which technique.
    pub technique: Technique,
    /// Why it would mean nothing there; `None` if it does mean something.
    pub why_not: Option<String>,
}

/// Everything that could be looked at in a scene.
pub fn for_scene(judged: &JudgedScene) -> Vec<Entry> {
    let techniques: fn(CheckKind) -> &'static [Technique] = |check| match check {
        CheckKind::MisWeights => &[Technique::Mis],
        CheckKind::Efficiency | CheckKind::LightPick | CheckKind::RayBudget => {
            &[Technique::Nee, Technique::Mis]
        }
        _ => &[Technique::Bsdf, Technique::Nee, Technique::Mis],
    };
    let entry = |check, technique| {
        // Direct light has a closed form, and differences in noise, in more scenes than all of it.
        let direct = matches!(check, CheckKind::ClosedForm | CheckKind::Efficiency);
        let all = judged.scene.defaults().max_bounces.unwrap_or(8);
        let spec = CheckSpec::new(check, technique, if direct { 1 } else { all });
        Entry { check, technique, why_not: why_not(&spec, judged) }
    };
    let kinds = CheckKind::ALL.into_iter().filter(|&check| check != CheckKind::HiddenVariants);
    kinds.flat_map(|check| techniques(check).iter().map(move |&technique| entry(check, technique))).collect()
}

/// Why a check of a rubric is left out; `None` if it is not. Its scene is `None` if it makes its own, or if only staff have it.
pub fn why_left_out(spec: &CheckSpec, judged: Option<&JudgedScene>, has_solution: bool) -> Option<String> {
    match judged {
        Some(judged) => why_not(spec, judged),
        None if spec.check.needs_scene() => Some("its scene is not here".to_owned()),
        None => (needs_staff(spec) && !has_solution)
            .then(|| "there is no solution here to compare with".to_owned()),
    }
}

/// True of a check that only staff can run. Where it is left out for that, its points are left out, too.
pub fn needs_staff(spec: &CheckSpec) -> bool {
    is_hidden(spec.check, &spec.scene)
}

/// What is left out in all scenes of a grade, and why.
pub fn left_out(scenes: &BTreeMap<String, JudgedScene>) -> Vec<LeftOut> {
    let of_scene = |(name, judged): (&String, &JudgedScene)| -> Vec<LeftOut> {
        let left_out = |entry: Entry| {
            let check = format!("{} with {}", entry.check.name(), entry.technique);
            entry.why_not.map(|why| LeftOut { check, scene: name.clone(), why })
        };
        for_scene(judged).into_iter().filter_map(left_out).collect()
    };
    scenes.iter().flat_map(of_scene).collect()
}

fn why_not(spec: &CheckSpec, judged: &JudgedScene) -> Option<String> {
    let features = judged.scene.features();
    let no_area = || "no light has an area: paths never hit one".to_owned();
    let nothing_lit =
        || "every surface is black, a mirror or glass: next event estimation has nothing to do".to_owned();
    if !features.has_lights() {
        return (spec.check != CheckKind::RayBudget)
            .then(|| "there are no lights: every technique gives black".to_owned());
    }
    if spec.technique == Technique::Bsdf && features.area_lights == 0 {
        return Some(format!("{}, and BSDF sampling gives black", no_area()));
    }
    match spec.check {
        CheckKind::MeanBias if spec.hits == Hits::Off && features.lit_surfaces == 0 => Some(nothing_lit()),
        CheckKind::WhiteFurnace => why_no_furnace(judged),
        CheckKind::ClosedForm => why_no_closed_form(judged, spec.max_bounces),
        CheckKind::MisWeights if features.area_lights == 0 => {
            Some(format!("{}, so that there is nothing to weigh", no_area()))
        }
        CheckKind::LightPick | CheckKind::MisWeights | CheckKind::RayBudget if features.lit_surfaces == 0 => {
            Some(nothing_lit())
        }
        CheckKind::LightPick if features.area_lights + features.point_lights < 2 => {
            Some("there is only one light to pick".to_owned())
        }
        CheckKind::Efficiency if features.area_lights == 0 => {
            Some(format!("{}, so that there is only one technique", no_area()))
        }
        CheckKind::Efficiency if features.lit_surfaces == 0 => Some(nothing_lit()),
        CheckKind::Efficiency => why_it_does_not_tell(judged, spec),
        _ => None,
    }
}
