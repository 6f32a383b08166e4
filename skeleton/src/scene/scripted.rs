//! Scenes under the grader's control: see [`crate::probe`].
#![cfg(feature = "probe")]

use super::Scene;
use crate::probe::{HitRadiance, ScriptedBsdf, ScriptedLight};

impl Scene {
    /// Makes all lights black for paths that hit them, so that only light samples find light. The lights keep their place
    /// in the scene and are still reported, since a shadow ray may be an ordinary ray that checks which light it hits.
    pub fn blacken_hits(&mut self) {
        self.lights.iter_mut().for_each(|light| light.hit_radiance = HitRadiance::BLACK);
    }

    /// Scripts materials and lights: one entry for each material of the description, and one for each light in the
    /// order of [`Scene::lights`]; `None` leaves it as it is. Of the script of a light
    /// without an area, only `bright_from` has an effect.
    pub fn set_script(&mut self, bsdfs: &[Option<ScriptedBsdf>], lights: &[Option<ScriptedLight>]) {
        // The surface shared by all triangle lights, if there are any, comes before the materials.
        let first = self.surfaces.len().saturating_sub(bsdfs.len());
        for (surface, script) in self.surfaces[first..].iter_mut().zip(bsdfs) {
            surface.script = *script;
        }
        for (light, script) in self.lights.iter_mut().zip(lights) {
            light.script = *script;
        }
    }
}
