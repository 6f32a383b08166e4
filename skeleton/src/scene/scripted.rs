//! Scenes under the grader's control (see [`crate::probe`]).

use super::{Hit, Scene};
use crate::math::Vec3;
use crate::probe::{Call, ScriptedBsdf, ScriptedLight, Switches, count, record};
use crate::ray::Ray;

impl Scene {
    /// Closes ways of finding light, and opens all others.
    pub fn set_switches(&mut self, switches: Switches) {
        self.switches = switches;
    }

    /// Scripts materials and lights: one entry for each material of the description, and one for each light in the
    /// order of [`Scene::lights`]; `None` leaves it as it is. Only lights with an area can be scripted.
    pub fn set_script(&mut self, bsdfs: &[Option<ScriptedBsdf>], lights: &[Option<ScriptedLight>]) {
        // Before the materials there may be the one surface that all triangle lights share.
        let first = self.surfaces.len().saturating_sub(bsdfs.len());
        for (surface, script) in self.surfaces[first..].iter_mut().zip(bsdfs) {
            surface.script = *script;
        }
        for (light, script) in self.lights.iter_mut().zip(lights) {
            light.set_script(*script);
        }
    }

    /// Counts and records a shadow ray; true if all are switched off.
    #[inline]
    pub(super) fn probe_shadow_ray(&self, hit: &Hit<'_>, point: Vec3, trace: impl Fn() -> bool) -> bool {
        count(|counts| counts.shadow_rays += 1);
        let occluded = self.switches.shadows_off || trace();
        record(|| occluded_call(hit, point, occluded));
        occluded
    }
}

fn occluded_call(hit: &Hit<'_>, point: Vec3, occluded: bool) -> Call {
    Call::new("Scene::occluded").given("from", hit.point).given("point", point).got("occluded", occluded)
}

pub(super) fn cos_call(wi: Vec3, cos: f32) -> Call {
    Call::new("Hit::cos").given("wi", wi).got("cos", cos)
}

/// Records a ray and what it hits.
#[inline]
pub(super) fn record_intersect(ray: &Ray, hit: Option<&Hit<'_>>) {
    record(|| intersect_call(ray, hit));
}

fn intersect_call(ray: &Ray, hit: Option<&Hit<'_>>) -> Call {
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

impl Hit<'_> {
    /// The switches of its scene.
    #[inline]
    pub(crate) fn switches(&self) -> Switches {
        self.scene.switches
    }
}
