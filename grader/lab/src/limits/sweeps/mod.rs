//! The sweeps, by name.

mod cost;
mod rays;
mod transport;

use arty::integrator::Settings;
use arty::scene::SceneDescription;

use super::sweep::Sweep;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use judge::extreme::measure::{Measurement, MinPaths, measure};
use verdict::error::Result;

/// What sweeps are measured with.
pub struct Context<'a> {
    /// A program that is trusted: the solution.
    pub program: &'a SubmissionProgram,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Paths for each point where noise matters.
    pub effort: MinPaths,
}

/// Measures one sweep.
pub type Measure = fn(&Context<'_>) -> Result<Sweep>;

/// All sweeps, in the order of the summary.
pub const SWEEPS: [(&str, Measure); 12] = [
    ("scale", transport::scale),
    ("offset", transport::offset),
    ("light-distance", transport::light_distance),
    ("light-size", transport::light_size),
    ("radiance", transport::radiance),
    ("exponent", transport::exponent),
    ("glass-index", transport::glass_index),
    ("scale-of-rays", |context| Ok(rays::scale_of_rays(context.seed))),
    ("offset-of-rays", |context| Ok(rays::offset_of_rays(context.seed))),
    ("triangles", |context| Ok(cost::triangles(context.seed))),
    ("lights", cost::lights),
    ("bounces", cost::bounces),
];

impl Context<'_> {
    /// Renders a scene at 8 × 8 pixels.
    fn measure(&self, scene: &SceneDescription, settings: Settings, effort: MinPaths) -> Result<Measurement> {
        let mut process = HostProcess::start(self.program, rayon::current_num_threads())?;
        let measured = process
            .load(scene)
            .and_then(|scene| measure(&mut process, scene, settings, [8, 8], effort, self.seed));
        measured.map_err(|error| error.of_trusted("the solution"))
    }
}
