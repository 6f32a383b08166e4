//! Processes that are confined from the outside, and ended with all that they have started.

use std::path::Path;
use std::process::{Child, Command, ExitStatus};

use verdict::sandbox::Layers;

use super::{Grants, Limits, system};
use verdict::error::{Error, Result};

/// What a process is for.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    not(target_os = "linux"),
    expect(dead_code, reason = "elsewhere there is no sandbox that needs them")
)]
pub(crate) enum Profile<'a> {
    /// rustc and the linker.
    Compiler {
        /// What they may read and start.
        grants: &'a Grants,
        /// The only folder that they may write to.
        folder: &'a Path,
        /// False where they cannot work at all once files are locked away.
        locked: bool,
    },
    /// A hand-in on so many threads: it locks itself in, but for what only the grader can do.
    Host {
        /// Threads that render.
        threads: usize,
    },
}

/// Has a command start confined and at the head of a process group, and tells what of it the grader sees to.
///
/// # Errors
/// What should work on this machine does not.
pub(crate) fn prepare(command: &mut Command, profile: Profile<'_>, limits: &Limits) -> Result<Layers> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    system::confine(command, profile, limits)
}

/// Ends a process that was started so, and all that it has started. It is still to be waited for.
pub(crate) fn end(child: &mut Child) {
    // Once waited for, its number may be another's: the library's own `kill` knows that.
    #[cfg(unix)]
    if matches!(child.try_wait(), Ok(None)) {
        let _ = rustix::process::kill_process_group(
            rustix::process::Pid::from_child(child),
            rustix::process::Signal::KILL,
        );
    }
    let _ = child.kill();
}

/// An error if a process ended by a signal that the grader did not send, and that its program cannot send itself: then it is
/// the machine that had no more memory, or somebody who ended it.
///
/// # Errors
/// If it is so.
pub(crate) fn blame_machine(status: ExitStatus, who: &str) -> Result<()> {
    #[cfg(unix)]
    let killed = std::os::unix::process::ExitStatusExt::signal(&status)
        == Some(rustix::process::Signal::KILL.as_raw());
    // Elsewhere nothing tells that from an end of its own.
    #[cfg(not(unix))]
    let killed = {
        let _ = status;
        false
    };
    if killed {
        return Err(Error::Harness(format!(
            "{who} was ended from outside: a machine does so that has no memory left; grade again, with fewer --jobs"
        )));
    }
    Ok(())
}
