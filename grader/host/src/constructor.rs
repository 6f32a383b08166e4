//! How the host makes the submission's path tracer.

use arty::integrator::{Integrator, Settings};

/// Makes the path tracer of a submission.
pub type Constructor = fn(Settings) -> Box<dyn Integrator>;
