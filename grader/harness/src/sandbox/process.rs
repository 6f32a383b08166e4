//! Processes that are confined from the outside, and ended with all that they have started.

use std::path::Path;
use std::process::{Child, Command, ExitStatus};

use verdict::sandbox::Layers;

use super::{Account, Grants, Limits, system};
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
        /// Who runs them, and owns the folder.
        account: &'a Account,
    },
    /// A submission on so many threads, which may load its program and do nothing else with files or other processes.
    Host {
        /// The program.
        program: &'a Path,
        /// Who runs it.
        account: &'a Account,
        /// Threads that render.
        threads: usize,
    },
}

/// Has a command start confined and at the head of a process group, and tells how it will be confined.
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

/// An error if a process was ended because the machine had no memory left. That is believed on the kernel's evidence
/// only: `before` is [`out_of_memory_kills`](system::out_of_memory_kills) as it was before the process started. Any other
/// end is the process's own matter.
///
/// # Errors
/// If it is so.
pub(crate) fn blame_machine(status: ExitStatus, before: Option<u64>, who: &str) -> Result<()> {
    #[cfg(unix)]
    let killed = std::os::unix::process::ExitStatusExt::signal(&status)
        == Some(rustix::process::Signal::KILL.as_raw());
    // Elsewhere nothing tells that from an end of its own.
    #[cfg(not(unix))]
    let killed = {
        let _ = status;
        false
    };
    if killed && system::out_of_memory_kills() > before {
        return Err(Error::Harness(format!(
            "{who} was ended by the system, which had no memory left; grade again, with fewer --jobs"
        )));
    }
    Ok(())
}
