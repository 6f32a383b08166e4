//! Keeping what a student wrote from everything but its own points.
//!
//! Two things run on behalf of a submission, and each gets a sandbox of its own: **rustc**, since `include_str!` and its
//! kin read files at compile time, and the **host**, which runs what was compiled. The compiler may read the
//! toolchain, the framework and its own folder, write there, and start the linker. The host may load its program, and
//! nothing else: it is locked in between fork and exec, and tightens that itself ([`host::confine`]). Both get limits of
//! time and memory, an empty environment, and a user id that no other submission has when the grader runs as root, and are
//! ended together with everything that they have started.
//!
//! What of it a machine really does is tried out, never assumed, and every report has it as a [`Level`]. What is defended
//! how, and what is not: `grader/SANDBOX.md`.

mod grants;
mod limits;
mod process;

#[cfg(not(target_os = "linux"))]
mod elsewhere;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(not(target_os = "linux"))]
use elsewhere as system;
#[cfg(target_os = "linux")]
use linux as system;

pub use grants::Grants;
pub use grants::linker;
pub use limits::Limits;
pub(crate) use process::{Profile, blame_machine, end, prepare};
pub use system::Machine;
pub(crate) use system::{Account, confirmed, out_of_memory_kills, processor_time};
pub use verdict::sandbox::{Layers, Level};
