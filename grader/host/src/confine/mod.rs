//!
//! The confinement of a submission's process.
//!
//! A host is confined in two steps. The grader confines it between fork and exec, so that the process is confined from
//! its first instruction, even if code of the submission runs before `main`: Landlock grants access to the program,
//! its loader and its libraries, and seccomp allows the system calls of loading ([`seccomp::loading_filters`]). Then
//! the host tightens the confinement itself, once it has taken over its pipe: Landlock removes access to all files;
//! once the threads that render are running, seccomp allows only the system calls of computing, and no further thread.
//! Neither can be lifted.
//!
//! A report describes the confinement that the grader has set up and tested. A process reports nothing about its own.
//!
//! Confinement exists on Linux only.

#[cfg(target_os = "linux")]
pub mod landlock;
#[cfg(target_os = "linux")]
pub mod seccomp;

/// Gives up access to files and to the network, as far as the system supports it.
///
/// Call this while the process has a single thread: Landlock applies to the calling thread and those it starts.
#[cfg(all(target_os = "linux", feature = "serve"))]
pub(crate) fn close_files() {
    if let Some((ruleset, _)) = landlock::ruleset() {
        let _ = landlock::restrict(&ruleset);
    }
}

/// Restricts all threads of the process to computing, as far as the system supports it: from then on it can neither open
/// files nor start programs, and the kernel ends it if it starts a thread.
///
/// Call this when all threads that render are running.
#[cfg(all(target_os = "linux", feature = "serve"))]
pub(crate) fn allow_only_computing() {
    for filter in seccomp::host_filters().iter().flatten() {
        let _ = seccompiler::apply_filter_all_threads(filter);
    }
}

/// Does nothing: confinement exists on Linux only.
#[cfg(all(not(target_os = "linux"), feature = "serve"))]
pub(crate) fn close_files() {}

/// Does nothing: confinement exists on Linux only.
#[cfg(all(not(target_os = "linux"), feature = "serve"))]
pub(crate) fn allow_only_computing() {}
