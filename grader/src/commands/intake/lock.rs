//! The process that reads a submission gives up everything else: Landlock, seccomp and resource limits, as far as the
//! system has them.

use std::collections::BTreeMap;
use std::path::PathBuf;

use host::confine::landlock as files;
use intake::limits;
use landlock::{AccessFs, PathBeneath, PathFd, RulesetCreatedAttr};
use rustix::process::{Resource, Rlimit, Signal, getrlimit, set_parent_process_death_signal, setrlimit};
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};
use verdict::error::{Error, Result};

/// Locks the calling process in for good: it can read these paths with everything below them, compute, and use what it
/// has open. Call it while there is one thread.
///
/// # Errors
/// If a layer fails that the system has.
pub(super) fn lock_in(paths: &[PathBuf]) -> Result<()> {
    limit().map_err(failed)?;
    confine_thread(paths)
}

fn failed(error: impl std::fmt::Display) -> Error {
    Error::Harness(format!("intake cannot be locked in: {error}"))
}

/// Limits memory and time, and has the process end with the grader.
fn limit() -> std::io::Result<()> {
    for (resource, value) in [
        (Resource::As, limits::MEMORY),
        // The budget of intake ends reading before, with a better message.
        (Resource::Cpu, 2 * limits::SECONDS),
        (Resource::Fsize, 0),
        (Resource::Nofile, 64),
        (Resource::Core, 0),
    ] {
        let highest = getrlimit(resource).maximum.map_or(value, |maximum| maximum.min(value));
        setrlimit(resource, Rlimit { current: Some(highest), maximum: Some(highest) })?;
    }
    Ok(set_parent_process_death_signal(Some(Signal::KILL))?)
}

/// Landlock and seccomp, which apply to the calling thread and to those that it starts.
fn confine_thread(paths: &[PathBuf]) -> Result<()> {
    rustix::thread::set_no_new_privs(true).map_err(failed)?;
    if let Some((mut ruleset, _)) = files::ruleset() {
        for path in paths {
            let access = match std::fs::symlink_metadata(path) {
                Ok(entry) if entry.is_dir() => AccessFs::ReadFile | AccessFs::ReadDir,
                Ok(entry) if entry.is_file() => AccessFs::ReadFile.into(),
                // Nothing else is read.
                _ => continue,
            };
            let rule = PathBeneath::new(PathFd::new(path).map_err(failed)?, access);
            ruleset = ruleset.add_rule(rule).map_err(failed)?;
        }
        files::restrict(&ruleset).map_err(failed)?;
    }
    match reading_filter() {
        // A kernel without seccomp has one layer less.
        Some(filter) => seccompiler::apply_filter(&filter).or_else(|error| match error {
            seccompiler::Error::Prctl(_) | seccompiler::Error::Seccomp(_) => Ok(()),
            error => Err(failed(error)),
        }),
        None => Ok(()),
    }
}

/// A filter that permits reading files, computing and answering; `None` on processors that it does not know.
fn reading_filter() -> Option<BpfProgram> {
    use libc::*;

    let mut rules: BTreeMap<c_long, Vec<SeccompRule>> = [
        SYS_read,
        SYS_readv,
        SYS_pread64,
        SYS_lseek,
        SYS_write,
        SYS_writev,
        SYS_close,
        SYS_fstat,
        SYS_newfstatat,
        SYS_statx,
        SYS_getdents64,
        SYS_fcntl,
        SYS_munmap,
        SYS_mremap,
        SYS_madvise,
        SYS_brk,
        SYS_futex,
        SYS_exit,
        SYS_exit_group,
        SYS_restart_syscall,
        SYS_rt_sigaction,
        SYS_rt_sigprocmask,
        SYS_rt_sigreturn,
        SYS_sigaltstack,
        SYS_sched_yield,
        SYS_clock_gettime,
        SYS_getrandom,
        SYS_getpid,
        SYS_gettid,
    ]
    .into_iter()
    .map(|call| (call, Vec::new()))
    .collect();
    // x86-64 has older system calls for the same purposes.
    #[cfg(target_arch = "x86_64")]
    rules.extend([SYS_stat, SYS_lstat].map(|call| (call, Vec::new())));
    let execute = u64::try_from(PROT_EXEC).ok()?;
    for call in [SYS_mmap, SYS_mprotect] {
        rules.insert(call, vec![rule(2, SeccompCmpOp::MaskedEq(execute), 0)?]);
    }
    let write = u64::try_from(O_WRONLY | O_RDWR | O_CREAT | O_TRUNC).ok()?;
    rules.insert(SYS_openat, vec![rule(2, SeccompCmpOp::MaskedEq(write), 0)?]);
    #[cfg(target_arch = "x86_64")]
    rules.insert(SYS_open, vec![rule(1, SeccompCmpOp::MaskedEq(write), 0)?]);
    // A failed allocation aborts: the process sends itself a signal.
    rules.insert(SYS_tgkill, vec![rule(0, SeccompCmpOp::Eq, u64::from(std::process::id()))?]);
    let arch = std::env::consts::ARCH.try_into().ok()?;
    let denied = SeccompAction::Errno(EPERM.unsigned_abs());
    SeccompFilter::new(rules, denied, SeccompAction::Allow, arch).ok()?.try_into().ok()
}

/// Permits a call if one of its arguments compares so.
fn rule(argument: u8, comparison: SeccompCmpOp, value: u64) -> Option<SeccompRule> {
    let condition = SeccompCondition::new(argument, SeccompCmpArgLen::Qword, comparison, value).ok()?;
    SeccompRule::new(vec![condition]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_locked_thread_reads_the_submission_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let submission = folder.path().join("ann");
        std::fs::create_dir(&submission).expect("it can be made");
        for file in ["ann/render_pt.rs", "secret"] {
            std::fs::write(folder.path().join(file), file).expect("it can be written");
        }
        let secret = folder.path().join("secret");
        assert!(std::fs::read(&secret).is_ok(), "unlocked");
        let locked = std::thread::spawn(move || {
            confine_thread(std::slice::from_ref(&submission)).expect("it can be confined");
            // Landlock may be missing here, seccomp as well.
            let landlocked = files::holds();
            (
                landlocked,
                std::fs::read(submission.join("render_pt.rs")).is_ok(),
                std::fs::read_dir(&submission).is_ok(),
                std::fs::read(&secret).is_ok(),
                std::fs::write(submission.join("new"), "").is_ok(),
                std::net::TcpListener::bind("127.0.0.1:0").is_ok(),
                std::process::Command::new("/bin/true").status().is_ok(),
            )
        });
        let (landlocked, reads, lists, reads_secret, writes, listens, starts) =
            locked.join().expect("it ends");
        assert!(reads && lists);
        assert!(!writes && !listens && !starts, "{writes} {listens} {starts}");
        assert!(!landlocked || !reads_secret);
    }
}
