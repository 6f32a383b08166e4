//! The kernel's counter of processes that it killed for lack of memory.

/// Number of out-of-memory kills of this machine or control group; `None` where the kernel does not tell.
pub(crate) fn out_of_memory_kills() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    // Of the whole machine. A container may not see it, and has its own.
    let number =
        |text: &str| text.lines().find_map(|line| line.strip_prefix("oom_kill ")?.trim().parse().ok());
    read("/proc/vmstat").as_deref().and_then(number).or_else(|| {
        let own = read("/proc/self/cgroup")?;
        let own = own.lines().find_map(|line| line.strip_prefix("0::"))?;
        read(&format!("/sys/fs/cgroup{own}/memory.events")).as_deref().and_then(number)
    })
}
