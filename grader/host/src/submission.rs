//! The functions through which the host uses a submission.

use arty::environment::{Environment, SampleDirections};
use arty::integrator::{Integrator, Settings};
use arty::scene::Scene;

/// Creates a submission's sampling of an environment.
pub type NewDirections = fn(&Environment) -> Box<dyn SampleDirections>;

/// The constructors of a submission.
#[derive(Clone, Copy)]
pub struct Submission {
    /// Creates its path tracer for one scene.
    pub path_tracer: fn(Settings, &Scene) -> Box<dyn Integrator>,
    /// Creates its sampling of an environment; `None` if the exercise has none.
    pub directions: Option<NewDirections>,
}
