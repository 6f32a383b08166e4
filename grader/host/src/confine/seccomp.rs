//! seccomp: the kernel answers system calls that nobody needs with an error.

use std::collections::BTreeMap;

use libc::c_long;
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};

/// The filters of a host, to be applied in this order: the first makes the C library fall back to a call whose
/// arguments can be looked at, the second lets through what computing needs, and nothing else.
///
/// `None` where there are no filters for this processor.
pub fn host_filters() -> Option<[BpfProgram; 2]> {
    let computing = computing(std::process::id())?;
    Some([denying(&[libc::SYS_clone3], libc::ENOSYS)?, allowing(computing)?])
}

/// The filters that a grader puts on a process between fork and exec, in this order: they let through what
/// [`host_filters`] do, and what it takes to load a program and to have it lock itself in.
///
/// The program is started by the very system call that it must not make itself, which no filter can tell apart: Landlock
/// sees to it that there is nothing else to execute. [`set_own_id`] has to be called in the new process.
///
/// `None` where there are no filters for this processor.
pub fn loading_filters() -> Option<[BpfProgram; 2]> {
    Some([denying(&[libc::SYS_clone3], libc::ENOSYS)?, allowing(loading()?)?])
}

/// Has filters that were made before a fork let the calling process signal itself. It allocates nothing.
pub fn set_own_id(filters: &mut [BpfProgram]) {
    let own = std::process::id();
    for instruction in filters.iter_mut().flatten().filter(|instruction| instruction.k == NOT_KNOWN_YET) {
        instruction.k = own;
    }
}

/// Stands for the id of a process that is not there yet; larger than any.
const NOT_KNOWN_YET: u32 = 0x5e1f_1d00;

fn allowing(rules: Rules) -> Option<BpfProgram> {
    filter(rules, SeccompAction::Errno(EPERM), SeccompAction::Allow)
}

/// A filter under which these calls fail with this error, and all others are let through.
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

/// What allocating, threads, locks, clocks, panics and an open pipe need in the process of this id.
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
    let thread = u64::try_from(CLONE_THREAD).ok()?;
    let execute = u64::try_from(PROT_EXEC).ok()?;
    // Threads, but no processes.
    rules.insert(SYS_clone, vec![one(condition(0, SeccompCmpOp::MaskedEq(thread), thread)?)?]);
    // Memory, but none that could be executed.
    for call in [SYS_mmap, SYS_mprotect] {
        rules.insert(call, vec![one(condition(2, SeccompCmpOp::MaskedEq(execute), 0)?)?]);
    }
    // How a process aborts: by this signal to itself. It cannot end itself as a machine without memory would.
    rules.insert(
        SYS_tgkill,
        vec![both(equals(0, u64::from(own))?, equals(2, u64::try_from(SIGABRT).ok()?)?)?],
    );
    // Names of threads and of regions of memory.
    rules.insert(
        SYS_prctl,
        vec![
            one(equals(0, u64::try_from(PR_SET_NAME).ok()?)?)?,
            one(equals(0, u64::try_from(PR_SET_VMA).ok()?)?)?,
        ],
    );
    Some(rules)
}

/// What the kernel's loader, the dynamic linker, the C library's and Rust's start and `confine` need besides.
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
    // Which files may be opened, Landlock decides, but for those that are not opened to be read or written.
    let path_only = u64::try_from(O_PATH).ok()?;
    rules.insert(SYS_openat, vec![one(condition(2, SeccompCmpOp::MaskedEq(path_only), 0)?)?]);
    // Processors with a longer history have older names for the same.
    #[cfg(target_arch = "x86_64")]
    rules
        .extend([SYS_open, SYS_arch_prctl, SYS_poll, SYS_dup2, SYS_getrlimit].map(|call| (call, Vec::new())));
    // The C library asks about open files by this.
    let empty_path = u64::try_from(AT_EMPTY_PATH).ok()?;
    let open_file = condition(3, SeccompCmpOp::MaskedEq(empty_path), empty_path)?;
    rules.insert(SYS_newfstatat, vec![one(open_file)?]);
    // Its own limits may be read, but not be set.
    rules.insert(SYS_prlimit64, vec![both(equals(0, 0)?, equals(2, 0)?)?]);
    // Not those that have the kernel send signals.
    let commands = [F_DUPFD_CLOEXEC, F_GETFD, F_GETFL];
    let command = |command: c_int| one(equals(1, u64::try_from(command).ok()?)?);
    rules.insert(SYS_fcntl, commands.into_iter().map(command).collect::<Option<_>>()?);
    rules.get_mut(&SYS_prctl)?.push(one(equals(0, u64::try_from(PR_SET_NO_NEW_PRIVS).ok()?)?)?);
    Some(rules)
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

/// Whether the calling thread can no longer ask about files, which Landlock leaves to anyone.
pub fn holds() -> bool {
    std::fs::metadata("/").is_err()
}
