//! seccomp: the kernel refuses all system calls but those that a host needs.

use std::collections::BTreeMap;

use libc::c_long;
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

/// The filters of a host whose threads are running, to be applied in this order: the first makes the C library fall back
/// from `clone3` to `clone`, whose arguments can be inspected; the second ends a process that starts a thread; the third
/// allows only the system calls of computing.
///
/// The kernel ends such a process with the signal `SIGSYS`, which nothing else here sends.
///
/// `None` if the processor architecture is not supported.
pub fn host_filters() -> Option<[BpfProgram; 3]> {
    let computing = computing(std::process::id())?;
    let threads = BTreeMap::from([(libc::SYS_clone, vec![thread()?])]);
    let no_threads = filter(threads, SeccompAction::Allow, SeccompAction::KillProcess)?;
    Some([denying(&[libc::SYS_clone3], libc::ENOSYS)?, no_threads, allowing(computing)?])
}

/// The filters that the grader applies to a process between fork and exec, in this order: they allow what
/// [`host_filters`] allow, and the system calls of loading a program and confining it.
///
/// They must allow `execve`, which starts the program; Landlock ensures that nothing else can be executed. Call
/// [`set_own_id`] in the new process before applying them.
///
/// `None` if the processor architecture is not supported.
pub fn loading_filters() -> Option<[BpfProgram; 2]> {
    Some([denying(&[libc::SYS_clone3], libc::ENOSYS)?, allowing(loading()?)?])
}

/// Replaces the placeholder in filters built before a fork, so that the calling process may signal itself. Allocates
/// nothing.
pub fn set_own_id(filters: &mut [BpfProgram]) {
    let own = std::process::id();
    for instruction in filters.iter_mut().flatten().filter(|instruction| instruction.k == NOT_KNOWN_YET) {
        instruction.k = own;
    }
}

/// Placeholder for the id of a process that does not exist yet; larger than any process id.
const NOT_KNOWN_YET: u32 = 0x5e1f_1d00;

fn allowing(rules: Rules) -> Option<BpfProgram> {
    filter(rules, SeccompAction::Errno(EPERM), SeccompAction::Allow)
}

/// A filter that makes these calls fail with this error and allows all others.
pub fn denying(calls: &[c_long], error: i32) -> Option<BpfProgram> {
    let rules = calls.iter().map(|&call| (call, Vec::new())).collect();
    filter(rules, SeccompAction::Allow, SeccompAction::Errno(u32::try_from(error).ok()?))
}

const EPERM: u32 = libc::EPERM.unsigned_abs();

type Rules = BTreeMap<c_long, Vec<SeccompRule>>;

fn filter(rules: Rules, otherwise: SeccompAction, matched: SeccompAction) -> Option<BpfProgram> {
    let arch = std::env::consts::ARCH.try_into().ok()?;
    SeccompFilter::new(rules, otherwise, matched, arch).ok()?.try_into().ok()
}

/// System calls of computing in the process with this id: allocation, threads, locks, clocks, panics and an open pipe.
fn computing(own: u32) -> Option<Rules> {
    use libc::*;

    let mut rules: Rules = [
        SYS_read,
        SYS_readv,
        SYS_write,
        SYS_writev,
        SYS_close,
        SYS_munmap,
        SYS_mremap,
        SYS_madvise,
        SYS_brk,
        SYS_futex,
        SYS_clone3,
        SYS_set_robust_list,
        SYS_rseq,
        SYS_exit,
        SYS_exit_group,
        SYS_restart_syscall,
        SYS_rt_sigaction,
        SYS_rt_sigprocmask,
        SYS_rt_sigreturn,
        SYS_sigaltstack,
        SYS_sched_yield,
        SYS_sched_getaffinity,
        SYS_clock_gettime,
        SYS_clock_getres,
        SYS_clock_nanosleep,
        SYS_nanosleep,
        SYS_gettimeofday,
        SYS_getrandom,
        SYS_getpid,
        SYS_gettid,
    ]
    .into_iter()
    .map(|call| (call, Vec::new()))
    .collect();
    let execute = u64::try_from(PROT_EXEC).ok()?;
    // Threads, but not processes.
    rules.insert(SYS_clone, vec![thread()?]);
    // Memory, but not executable memory.
    for call in [SYS_mmap, SYS_mprotect] {
        rules.insert(call, vec![one(condition(2, SeccompCmpOp::MaskedEq(execute), 0)?)?]);
    }
    // A process aborts by sending itself this signal. It cannot send itself SIGKILL, as if it had run out of memory.
    rules.insert(
        SYS_tgkill,
        vec![both(equals(0, u64::from(own))?, equals(2, u64::try_from(SIGABRT).ok()?)?)?],
    );
    // Names of threads and memory regions.
    rules.insert(
        SYS_prctl,
        vec![
            one(equals(0, u64::try_from(PR_SET_NAME).ok()?)?)?,
            one(equals(0, u64::try_from(PR_SET_VMA).ok()?)?)?,
        ],
    );
    Some(rules)
}

/// System calls of loading: those of computing, and those of the kernel's loader, the dynamic linker, the startup code
/// of the C library and of Rust, and `confine`.
fn loading() -> Option<Rules> {
    use libc::*;

    let mut rules = computing(NOT_KNOWN_YET)?;
    let calls = [
        SYS_execve,
        SYS_pread64,
        // Shared libraries are executed.
        SYS_mmap,
        SYS_set_tid_address,
        SYS_uname,
        SYS_ppoll,
        SYS_dup,
        SYS_dup3,
        SYS_fstat,
        SYS_getuid,
        SYS_geteuid,
        SYS_getgid,
        SYS_getegid,
        SYS_landlock_create_ruleset,
        SYS_landlock_restrict_self,
        SYS_seccomp,
    ];
    rules.extend(calls.map(|call| (call, Vec::new())));
    // Landlock decides which files may be opened, but does not cover O_PATH.
    let path_only = u64::try_from(O_PATH).ok()?;
    rules.insert(SYS_openat, vec![one(condition(2, SeccompCmpOp::MaskedEq(path_only), 0)?)?]);
    // x86-64 has older system calls for the same purposes.
    #[cfg(target_arch = "x86_64")]
    rules
        .extend([SYS_open, SYS_arch_prctl, SYS_poll, SYS_dup2, SYS_getrlimit].map(|call| (call, Vec::new())));
    // The C library queries open files with this call.
    let empty_path = u64::try_from(AT_EMPTY_PATH).ok()?;
    let open_file = condition(3, SeccompCmpOp::MaskedEq(empty_path), empty_path)?;
    rules.insert(SYS_newfstatat, vec![one(open_file)?]);
    // A process may read its own limits, but not set them.
    rules.insert(SYS_prlimit64, vec![both(equals(0, 0)?, equals(2, 0)?)?]);
    // Excludes the commands that make the kernel send signals.
    let commands = [F_DUPFD_CLOEXEC, F_GETFD, F_GETFL];
    let command = |command: c_int| one(equals(1, u64::try_from(command).ok()?)?);
    rules.insert(SYS_fcntl, commands.into_iter().map(command).collect::<Option<_>>()?);
    rules.get_mut(&SYS_prctl)?.push(one(equals(0, u64::try_from(PR_SET_NO_NEW_PRIVS).ok()?)?)?);
    Some(rules)
}

/// Matches a `clone` that starts a thread, and none that starts a process.
fn thread() -> Option<SeccompRule> {
    let flag = u64::try_from(libc::CLONE_THREAD).ok()?;
    one(condition(0, SeccompCmpOp::MaskedEq(flag), flag)?)
}

fn condition(index: u8, comparison: SeccompCmpOp, value: u64) -> Option<SeccompCondition> {
    SeccompCondition::new(index, SeccompCmpArgLen::Qword, comparison, value).ok()
}

fn equals(index: u8, value: u64) -> Option<SeccompCondition> {
    condition(index, SeccompCmpOp::Eq, value)
}

fn one(condition: SeccompCondition) -> Option<SeccompRule> {
    SeccompRule::new(vec![condition]).ok()
}

fn both(first: SeccompCondition, second: SeccompCondition) -> Option<SeccompRule> {
    SeccompRule::new(vec![first, second]).ok()
}

/// True if the calling thread cannot query file metadata, which Landlock alone does not prevent.
pub fn holds() -> bool {
    std::fs::metadata("/").is_err()
}
