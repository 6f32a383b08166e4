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
    Some([
        denying(&[libc::SYS_clone3], libc::ENOSYS)?,
        filter(allowed()?, SeccompAction::Errno(EPERM), SeccompAction::Allow)?,
    ])
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

/// What allocating, threads, locks, clocks, panics and an open pipe need.
fn allowed() -> Option<Rules> {
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
    rules.insert(SYS_clone, vec![argument(0, SeccompCmpOp::MaskedEq(thread), thread)?]);
    // Memory, but none that could be executed.
    for call in [SYS_mmap, SYS_mprotect] {
        rules.insert(call, vec![argument(2, SeccompCmpOp::MaskedEq(execute), 0)?]);
    }
    // Signals to oneself: that is how a process aborts.
    rules.insert(SYS_tgkill, vec![argument(0, SeccompCmpOp::Eq, u64::from(std::process::id()))?]);
    // Names of threads and of regions of memory.
    rules.insert(
        SYS_prctl,
        vec![
            argument(0, SeccompCmpOp::Eq, u64::try_from(PR_SET_NAME).ok()?)?,
            argument(0, SeccompCmpOp::Eq, u64::try_from(PR_SET_VMA).ok()?)?,
        ],
    );
    Some(rules)
}

fn argument(index: u8, comparison: SeccompCmpOp, value: u64) -> Option<SeccompRule> {
    let condition = SeccompCondition::new(index, SeccompCmpArgLen::Qword, comparison, value).ok()?;
    SeccompRule::new(vec![condition]).ok()
}

/// Whether the calling thread can no longer ask about files, which Landlock leaves to anyone.
pub fn holds() -> bool {
    std::fs::metadata("/").is_err()
}
