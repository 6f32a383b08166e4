//! Calls of a scene and its hits as the grader's replay records them.
//!
//! None of these functions is inlined, or every submission would compile them again.

use super::Hit;
use crate::math::Vec3;
use crate::probe::Call;
use crate::ray::Ray;

pub(super) fn intersect(ray: &Ray, hit: Option<&Hit<'_>>) -> Call {
    let call = Call::new("Scene::intersect").given("origin", ray.origin).given("direction", ray.direction);
    let Some(hit) = hit else { return call };
    let call = call.got("point", hit.point).got("normal", hit.normal).got("wo", hit.wo);
    // The grader knows how many of the surfaces are materials.
    let call = call.got("surface", hit.triangle.surface as usize).got("surfaces", hit.scene.surfaces.len());
    match hit.light() {
        Some(light) => call.got("light", light.index()),
        None => call,
    }
}

pub(super) fn occluded(hit: &Hit<'_>, point: Vec3, occluded: bool) -> Call {
    Call::new("Scene::occluded").given("from", hit.point).given("point", point).got("occluded", occluded)
}

pub(super) fn occluded_towards(hit: &Hit<'_>, direction: Vec3, occluded: bool) -> Call {
    Call::new("Scene::occluded_towards")
        .given("from", hit.point)
        .given("direction", direction)
        .got("occluded", occluded)
}

pub(super) fn cos(wi: Vec3, cos: f32) -> Call {
    Call::new("Hit::cos").given("wi", wi).got("cos", cos)
}
