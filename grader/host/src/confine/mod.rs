//! What keeps a submission from touching anything but its numbers.
//!
//! A host is locked in twice. The grader does it between fork and exec, so that whatever runs in the process is confined
//! from its first instruction, even if something of a submission should run before `main`: Landlock grants the program, its
//! loader and its libraries, seccomp what loading takes ([`seccomp::loading_filters`]). Then the host tightens that itself,
//! once it has taken over its pipe: Landlock takes away all files, seccomp all system calls but those that computing
//! needs. Both hold for all threads that are started afterwards, and nobody can lift them again.
//!
//! What a report says about the sandbox is what the grader set and tried. A process says nothing about its own.
//!
//! Elsewhere than on Linux nothing of this exists.

#[cfg(target_os = "linux")]
pub mod landlock;
#[cfg(target_os = "linux")]
pub mod seccomp;

/// Tightens the confinement of the calling process as far as the system can: after it, nothing can be opened or started.
///
/// To be called while there is one thread only: Landlock holds for the calling thread and for those it starts.
#[cfg(all(target_os = "linux", feature = "serve"))]
pub(crate) fn tighten() {
    if let Some((ruleset, _)) = landlock::ruleset() {
        let _ = landlock::restrict(&ruleset);
    }
    for filter in seccomp::host_filters().iter().flatten() {
        let _ = seccompiler::apply_filter_all_threads(filter);
    }
}

/// There is no sandbox here.
#[cfg(all(not(target_os = "linux"), feature = "serve"))]
pub(crate) fn tighten() {}
