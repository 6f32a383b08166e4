//! What a process has used of the processors.

use std::process::Child;
use std::time::Duration;

/// Time for which the threads of a process were ready to run and did not: the second number of their `schedstat`, in
/// nanoseconds. `None` if the kernel keeps none.
///
/// An expensive question: the kernel has to set up `/proc` for the process, and to clear it when the process ends.
pub(crate) fn delay(child: &Child) -> Option<Duration> {
    let threads = std::fs::read_dir(format!("/proc/{}/task", child.id())).ok()?.flatten();
    threads
        .map(|thread| {
            let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
            text.split_whitespace().nth(1)?.parse().ok().map(Duration::from_nanos)
        })
        .sum()
}

/// Processor time of a process over all threads; `None` if it is gone.
pub(crate) fn processor_time(child: &Child) -> Option<Duration> {
    let pid = libc::pid_t::try_from(child.id()).ok()?;
    let mut clock = 0;
    // SAFETY: writes the number of a clock into a variable of its type.
    if unsafe { libc::clock_getcpuclockid(pid, &raw mut clock) } != 0 {
        return None;
    }
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: writes a time into a variable of its type. A clock whose process is gone is an error.
    if unsafe { libc::clock_gettime(clock, &raw mut time) } != 0 {
        return None;
    }
    Some(Duration::new(u64::try_from(time.tv_sec).ok()?, u32::try_from(time.tv_nsec).ok()?))
}
