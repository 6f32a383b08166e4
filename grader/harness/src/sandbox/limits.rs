//! Limits of time and memory for a submission.

use std::time::Duration;

use super::Level;

/// Limits for compiling and running a submission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Processor time of rustc, and the time for which it may wait for the linker. It must be limited, since constants can be computed for any length of time.
    pub compile_time: Duration,
    /// Address space of rustc and of the linker each, in bytes. With too little, rustc's messages are misleading.
    pub compile_memory: u64,
    /// Processor time of one job, and of all jobs of a check together, over all threads. A job has at most a million samples,
    /// for which a correct submission needs less than a second. The first part of a job gets a sixth of it.
    pub job_time: Duration,
    /// Time for which a submission may wait instead of computing, over all its processes. One answer may take half of it.
    /// Time in which other processes have the processors does not count.
    pub waiting: Duration,
    /// Address space of the host in bytes, not counting what its threads reserve without using it.
    pub job_memory: u64,
    /// False only to measure the cost of the sandbox: then files and system calls are not restricted.
    pub sandbox: bool,
    /// False only to test the sandbox by itself: then neither source nor program are inspected.
    pub inspect: bool,
    /// Weakest sandbox in which a submission is compiled or run.
    pub min_level: Level,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            compile_time: Duration::from_secs(30),
            compile_memory: 4 << 30,
            job_time: Duration::from_secs(60),
            waiting: Duration::from_secs(30),
            job_memory: 4 << 30,
            sandbox: true,
            inspect: true,
            min_level: Level::None,
        }
    }
}
