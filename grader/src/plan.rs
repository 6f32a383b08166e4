//! Which checks mean something in which scene.

use arty::integrator::Technique;

use crate::checks::{JudgedScene, is_furnace};
use crate::report::LeftOut;
use crate::rubric::{CheckKind, CheckSpec, Rubric};

/// Why a check would mean nothing in its scene; `None` if it does mean something.
pub fn why_left_out(spec: &CheckSpec, judged: &JudgedScene) -> Option<String> {
    let features = judged.scene.features();
    if !features.has_lights() {
        return Some("there are no lights: every technique gives black".to_owned());
    }
    if spec.technique == Technique::Bsdf && features.area_lights == 0 {
        return Some("no light has an area: BSDF sampling gives black".to_owned());
    }
    if spec.technique != Technique::Bsdf && features.lit_surfaces == 0 {
        return Some(
            "every surface is black, a mirror or glass: next event estimation has nothing to do".to_owned(),
        );
    }
    if spec.check == CheckKind::WhiteFurnace && !is_furnace(judged) {
        return Some(not_a_furnace(judged));
    }
    None
}

/// What is left out over all scenes of a rubric, beside its own checks: kinds that mean nothing in a scene.
pub fn left_out<'a>(rubric: &Rubric, scene: impl Fn(&str) -> Option<&'a JudgedScene>) -> Vec<LeftOut> {
    let mut list = Vec::new();
    for name in rubric.scenes().keys() {
        let Some(judged) = scene(name) else { continue };
        if !is_furnace(judged) {
            list.push(LeftOut {
                check: CheckKind::WhiteFurnace.name().to_owned(),
                scene: (*name).to_owned(),
                why: not_a_furnace(judged),
            });
        }
        if judged.scene.features().area_lights == 0 {
            list.push(LeftOut {
                check: format!("{} with {}", CheckKind::MeanBias.name(), Technique::Bsdf),
                scene: (*name).to_owned(),
                why: "no light has an area: BSDF sampling gives black".to_owned(),
            });
        }
    }
    list
}

fn not_a_furnace(judged: &JudgedScene) -> String {
    if judged.scene.features().closed {
        "closed, but not of one diffuse emitting material: there is no closed form".to_owned()
    } else {
        "the camera is not enclosed: light gets lost".to_owned()
    }
}
