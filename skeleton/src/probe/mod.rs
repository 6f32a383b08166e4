//! Instrumentation for the grader's host: scripts, switches, stratified random numbers, counters and recordings. The
//! window (`skeleton/view/`) uses recordings, too.
//!
//! This module exists with the feature `probe` only. In every other build [`no_probe`](../../no_probe.rs) takes its
//! place: the same names, zero-sized and without effect, so that the renderer's code needs no conditional compilation.
//!
//! A **script** replaces numbers and keeps the geometry of a scene: a scripted light has one known sample point with a
//! known density; a scripted BSDF has known values and densities and samples one known direction, or nothing.
//! Anything that an integrator derives from positions and normals therefore stays correct. Scripts are stateless and
//! draw no random numbers, so that all random numbers drawn are the integrator's own.
//!
//! **Hit radiances** are what paths find when they hit lights. In a scene for light samples only they are black.
//!
//! **Strata** distribute the integrator's own random numbers evenly over many paths.
//!
//! **Counters** and **recordings** are those of the current thread: one path is followed on one thread. Strata,
//! counters and recordings require the [`Key`], which the host takes before any code of a submission runs.

mod count;
mod hit_radiance;
mod record;
mod script;
mod strata;

use std::sync::atomic::{AtomicBool, Ordering};

pub use count::{Counts, take_counts};
pub(crate) use count::{count_light_sample, count_ray, count_shadow_ray};
pub(crate) use hit_radiance::HitRadiance;
pub(crate) use record::record;
pub use record::{Call, Recording, Value, record_print, start_recording, take_recording};
pub use script::{ScriptedBsdf, ScriptedLight, ScriptedSampling, ScriptedValue};
pub(crate) use strata::stratified;
pub use strata::{Strata, set_strata};

/// The permission to reset counters, to record calls and to stratify random numbers. A submission that held it could
/// hide what it does.
#[derive(Debug)]
pub struct Key(());

impl Key {
    /// The only key of this process; `None` from the second call on.
    pub fn take() -> Option<Self> {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        (!TAKEN.swap(true, Ordering::Relaxed)).then_some(Self(()))
    }
}
