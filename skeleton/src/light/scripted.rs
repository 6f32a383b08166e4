//! Lights under the grader's control (see [`crate::probe`]).

use super::{DirectSample, Emission, Light, Shape};
use crate::math::{Rgb, Vec3, direction_and_distance};
use crate::probe::{Call, ScriptedLight, count, record};
use crate::scene::Hit;

impl Light {
    pub(crate) fn set_script(&mut self, script: Option<ScriptedLight>) {
        self.script = script;
    }

    /// Counts and records a light sample: by this light's script if it has one, else the one that `draw` gives.
    #[inline]
    pub(super) fn probe_sample(
        &self,
        from: Vec3,
        draw: impl FnOnce() -> Option<DirectSample>,
    ) -> Option<DirectSample> {
        count(|counts| counts.light_samples += 1);
        let sample = self.scripted_sample(from).unwrap_or_else(draw);
        record(|| self.sample_call(from, sample));
        sample
    }

    /// What this light's script says, if it has one: the inner `None` is for points that the light does not face.
    #[inline]
    fn scripted_sample(&self, from: Vec3) -> Option<Option<DirectSample>> {
        let (Some(script), Shape::Triangle(light)) = (self.script, &self.shape) else { return None };
        let cos = light.normal.dot(direction_and_distance(script.point, from).0);
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
        record(|| self.emission_call(hit, emission));
        emission
    }

    fn sample_call(&self, from: Vec3, sample: Option<DirectSample>) -> Call {
        let call = Call::new("Light::sample_direct").given("light", self.index).given("from", from);
        let Some(DirectSample { point, intensity, pdf_area, cos }) = sample else { return call };
        call.got("point", point).got("intensity", intensity).got("pdf_area", pdf_area).got("cos", cos)
    }

    fn emission_call(&self, hit: &Hit<'_>, Emission { radiance, pdf_area, cos }: Emission) -> Call {
        Call::new("Light::emission")
            .given("light", self.index)
            .given("point", hit.point)
            .got("radiance", radiance)
            .got("pdf_area", pdf_area)
            .got("cos", cos)
    }
}
