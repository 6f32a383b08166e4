//!
//! The confinement of a submission's process.
//!
//! A host is confined in two steps. The grader confines it between fork and exec, so that the process is confined from
//! its first instruction, even if code of the submission runs before `main`: Landlock grants access to the program,
//! its loader and its libraries, and seccomp allows the system calls of loading ([`seccomp::loading_filters`]). Then
//! the host tightens the confinement itself, once it has taken over its pipe: Landlock removes access to all files,
//! and seccomp allows only the system calls of computing. Both apply to all threads started later, and cannot be
//! lifted.
//!
//! A report describes the confinement that the grader has set up and tested. A process reports nothing about its own.
//!
//! Confinement exists on Linux only.

#[cfg(target_os = "linux")]
pub mod landlock;
#[cfg(target_os = "linux")]
pub mod seccomp;

/// Tightens the confinement of the calling process as far as the system supports it: afterwards it can neither open
/// files nor start programs.
///
/// Call this while the process has a single thread: Landlock applies to the calling thread and those it starts.
#[cfg(all(target_os = "linux", feature = "serve"))]
pub(crate) fn tighten() {
    if let Some((ruleset, _)) = landlock::ruleset() {
        let _ = landlock::restrict(&ruleset);
    }
    for filter in seccomp::host_filters().iter().flatten() {
        let _ = seccompiler::apply_filter_all_threads(filter);
    }
}

/// Does nothing: confinement exists on Linux only.
#[cfg(all(not(target_os = "linux"), feature = "serve"))]
pub(crate) fn tighten() {}
