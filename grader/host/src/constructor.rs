//! Construction of the submission's path tracer.

use arty::integrator::{Integrator, Settings};

/// Creates the path tracer of a submission.
pub type Constructor = fn(Settings) -> Box<dyn Integrator>;
