//! What keeps a hand-in from touching anything but its numbers.
//!
//! The host locks itself in, once it has taken over its pipe and before any code of the hand-in runs: no such code can
//! run before `main`, since it would take `unsafe` to have the linker call it. Landlock takes away all files, seccomp
//! all system calls but those that computing needs. Both hold for all threads that are started afterwards, and nobody
//! can lift them again. Limits of memory and time and the other user id have been set by the grader before.
//!
//! Elsewhere than on Linux nothing of this exists: [`Layers`] says so.

#[cfg(target_os = "linux")]
pub mod landlock;
#[cfg(target_os = "linux")]
pub mod seccomp;

use serde::{Deserialize, Serialize};

/// The parts of a sandbox that were found to hold, each tried out by the process that it confines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layers {
    /// The version of Landlock's interface that is in force; 0 if files are not locked away.
    pub landlock: u32,
    /// System calls are filtered.
    pub seccomp: bool,
    /// Memory is limited.
    pub limits: bool,
    /// The process does not run as root.
    pub unprivileged: bool,
}

/// Locks the calling process in, as far as the system can, and tells what holds.
///
/// To be called while there is one thread only: Landlock holds for the calling thread and for those it starts.
#[cfg(all(target_os = "linux", feature = "serve"))]
pub(crate) fn confine() -> Layers {
    let landlock = landlock::ruleset()
        .filter(|(ruleset, _)| landlock::restrict(ruleset).is_ok())
        .filter(|_| landlock::holds())
        .map_or(0, |(_, abi)| abi);
    let limits = rustix::process::getrlimit(rustix::process::Resource::As).current.is_some();
    let unprivileged = !rustix::process::geteuid().is_root();
    let seccomp = seccomp::host_filters().is_some_and(|filters| {
        filters.iter().all(|filter| seccompiler::apply_filter_all_threads(filter).is_ok()) && seccomp::holds()
    });
    Layers { landlock, seccomp, limits, unprivileged }
}

/// There is no sandbox here.
#[cfg(all(not(target_os = "linux"), feature = "serve"))]
pub(crate) fn confine() -> Layers {
    Layers::default()
}
