//! Lights under the grader's control (see [`crate::probe`]).

use super::{DirectSample, Emission, Light, Shape};
use crate::math::{Rgb, Vec3, direction};
use crate::probe::{ScriptedLight, count};
use crate::scene::Hit;

impl Light {
    pub(crate) fn set_script(&mut self, script: Option<ScriptedLight>) {
        self.script = script;
    }

    /// Counts a light sample. If this light has a script, what it says: the inner `None` is for points that the light
    /// does not face.
    #[inline]
    pub(super) fn probe_sample(&self, from: Vec3) -> Option<Option<DirectSample>> {
        count(|counts| counts.light_samples += 1);
        let (Some(script), Shape::Triangle(light)) = (self.script, &self.shape) else { return None };
        let cos = light.normal.dot(direction(script.point, from).0);
        Some((cos > 0.0).then(|| DirectSample {
            point: script.point,
            intensity: light.radiance,
            pdf_area: script.pdf_area,
            cos: cos.min(1.0),
        }))
    }

    /// What the light emits at a hit, by its script and the scene's switches.
    #[inline]
    pub(super) fn probe_emission(&self, hit: &Hit<'_>, mut emission: Emission) -> Emission {
        if let Some(script) = self.script {
            emission.pdf_area = script.pdf_area;
        }
        if hit.switches().hits_off {
            emission.radiance = Rgb::BLACK;
        }
        emission
    }
}
