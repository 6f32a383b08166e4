use arty::prelude::*;
pub struct EnvironmentSampler;
impl EnvironmentSampler { pub fn new(_: &Environment) -> Self { Self } }
impl SampleDirections for EnvironmentSampler {
    fn sample(&self, _: &Environment, _: &mut Sampler) -> Option<DirectionSample> { None }
    fn pdf(&self, _: &Environment, _: Vec3) -> f32 { 0.0 }
}
pub struct PathTracer;
impl PathTracer { pub fn new(_: Settings, _: &Scene) -> Self { Self } }
impl Integrator for PathTracer {
    fn radiance(&self, _: &Scene, _: Ray, _: &mut Sampler) -> Rgb { Rgb::BLACK }
}
