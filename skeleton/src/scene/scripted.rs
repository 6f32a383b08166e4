//! Scenes under the grader's control: see [`crate::probe`].
#![cfg(feature = "probe")]

use super::Scene;
use crate::probe::{ScriptedBsdf, ScriptedLight, Switches};

impl Scene {
    /// Sets which ways of finding light are enabled.
    pub fn set_switches(&mut self, switches: Switches) {
        self.switches = switches;
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
