use arty::prelude::*;
pub struct PathTracer;
impl PathTracer { pub fn new(_: Settings) -> Self { Self } }
impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb { Rgb::BLACK }
}
