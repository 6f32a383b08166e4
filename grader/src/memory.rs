//! How much memory the grader's process keeps.

/// Has the C library share memory among threads and give back what is freed. To be called before there are other threads.
///
/// Each process of a submission begins as a copy of this one's page tables, a hundred times in a grade. Answers of megabytes,
/// taken by one thread after the other, would leave 180 MB behind in a class, and copying the tables of these would take as
/// long as a twentieth of all grading. Only glibc hoards like that.
pub(crate) fn stay_small() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    for (parameter, value) in
        [(libc::M_ARENA_MAX, 2), (libc::M_MMAP_THRESHOLD, 1 << 20), (libc::M_TRIM_THRESHOLD, 4 << 20)]
    {
        // SAFETY: sets a parameter of malloc; no other thread is there to read it meanwhile. A refusal changes nothing.
        unsafe { libc::mallopt(parameter, value) };
    }
}
