//! Confined processes, which are ended together with all processes that they have started.

use std::path::Path;
use std::process::{Child, Command, ExitStatus};

use verdict::sandbox::Layers;

use super::{Account, Grants, Limits, system};
use verdict::error::{Error, Result};

/// Purpose of a process, which decides how it is confined.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    not(target_os = "linux"),
    expect(dead_code, reason = "elsewhere there is no sandbox that needs them")
)]
pub(crate) enum Profile<'a> {
    /// rustc and the linker.
    Compiler {
        /// Files that they may read and programs that they may start.
        grants: &'a Grants,
        /// The only folder that they may write to.
        folder: &'a Path,
        /// False where they fail if file access is restricted.
        locked: bool,
        /// User that runs them and owns the folder.
        account: &'a Account,
    },
    /// A submission, which may load its program and do nothing else with files or other processes.
    Host {
        /// Path of the program.
        program: &'a Path,
        /// User that runs it.
        account: &'a Account,
        /// Number of threads that render.
        threads: usize,
    },
}

/// Prepares a command to start confined and as the leader of a process group, and returns its sandbox layers.
///
/// # Errors
/// If something fails that this machine supports.
pub(crate) fn prepare(command: &mut Command, profile: Profile<'_>, limits: &Limits) -> Result<Layers> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    system::confine(command, profile, limits)
}

/// Kills a process prepared by [`prepare`], and its process group. It must still be waited for.
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

/// Finds out whether a process was killed because the machine had no memory left. Only the kernel's counter is trusted:
/// `before` is the value of [`out_of_memory_kills`](system::out_of_memory_kills) before the process started.
///
/// # Errors
/// If the machine had no memory left.
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
