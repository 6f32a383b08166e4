//! Pictures of what rays see, to look at a scene before any light transport.

use arty::cli::DebugView;
use arty::prelude::*;

/// Shows one property of the surface that each pixel sees.
pub struct DebugTracer {
    view: DebugView,
}

impl DebugTracer {
    /// A tracer that shows `view`.
    pub fn new(view: DebugView) -> Self {
        Self { view }
    }
}

impl Integrator for DebugTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let Some(hit) = scene.intersect(&ray) else { return Rgb::BLACK };
        match self.view {
            // Each coordinate from [-1, 1] to [0, 1].
            DebugView::Normals => Rgb::from((0.5 * hit.normal + 0.5).to_array()),
            // The mean of f · cos / p is the share of light that the surface scatters.
            DebugView::Albedo => {
                hit.bsdf().sample(sampler).map_or(Rgb::BLACK, |sample| sample.f * (sample.cos / sample.pdf))
            }
        }
    }
}
