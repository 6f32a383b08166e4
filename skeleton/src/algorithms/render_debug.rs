//! Images of surface properties, to inspect a scene without light transport.

use arty::cli::DebugView;
use arty::prelude::*;

/// Shows a property of the surface visible in each pixel.
pub struct DebugTracer {
    view: DebugView,
}

impl DebugTracer {
    /// A tracer that shows the given property.
    pub fn new(view: DebugView) -> Self {
        Self { view }
    }
}

impl Integrator for DebugTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, sampler: &mut Sampler) -> Rgb {
        let Some(hit) = scene.intersect(&ray) else { return Rgb::BLACK };
        match self.view {
            // Maps each coordinate from [-1, 1] to [0, 1].
            DebugView::Normals => Rgb::from((0.5 * hit.normal + 0.5).to_array()),
            // The expected value of f · cos / pdf is the albedo.
            DebugView::Albedo => {
                hit.bsdf().sample(sampler).map_or(Rgb::BLACK, |sample| sample.f * (sample.cos / sample.pdf))
            }
        }
    }
}
