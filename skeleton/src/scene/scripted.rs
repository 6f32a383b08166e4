//! Scenes under the grader's control (see [`crate::probe`]).

use super::{Hit, Scene};
use crate::probe::{ScriptedBsdf, ScriptedLight, Switches, count};

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

    /// Counts a shadow ray; true if all are switched off.
    #[inline]
    pub(super) fn probe_shadow_ray(&self) -> bool {
        count(|counts| counts.shadow_rays += 1);
        self.switches.shadows_off
    }
}

impl Hit<'_> {
    /// The switches of its scene.
    #[inline]
    pub(crate) fn switches(&self) -> Switches {
        self.scene.switches
    }
}
