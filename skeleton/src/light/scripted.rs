//! A triangle light under the grader's control. No normal build has one: see `no_probe.rs`.

use super::{DirectSample, TriangleLight};
use crate::math::{Vec3, direction_and_distance};
use crate::probe::ScriptedLight;

impl ScriptedLight {
    /// The scripted point of `light`, as seen from `from`; `None` if it does not face that point.
    #[inline]
    pub(super) fn sample_direct(&self, light: &TriangleLight, from: Vec3) -> Option<DirectSample> {
        let cos_light = light.normal.dot(direction_and_distance(self.point(), from).0);
        (cos_light > 0.0).then(|| DirectSample {
            point: self.point(),
            emitted: light.radiance,
            pdf_area: self.pdf_area(),
            cos_light: cos_light.min(1.0),
        })
    }
}
