//! The sandbox of a submission: its code can affect nothing but its own points.
//!
//! Two processes run for a submission, each in a sandbox of its own: **rustc**, since macros such as `include_str!` read
//! files at compile time, and the **host**, which runs the compiled code. The compiler may read the toolchain, the
//! framework and its own folder, write to that folder, and start the linker. The host may only load its program: it is
//! confined between fork and exec, and then confines itself further ([`host::confine`]). Both have limits of time and
//! memory, an empty environment, and, if the grader runs as root, a user id that no other submission has. They are ended
//! together with all processes that they have started.
//!
//! What a machine supports is tried, never assumed, and every report states it as a [`Level`]. The threat model is in
//! `grader/SANDBOX.md`.

mod grants;
mod limits;
mod process;
mod watch;

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
pub(crate) use system::{Account, confirmed, out_of_memory_kills};
pub use verdict::sandbox::{Layers, Level};
pub(crate) use watch::{BUSY, Watch};
