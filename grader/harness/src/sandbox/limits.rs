//! How much a submission may use up.

use std::time::Duration;

use super::Level;

/// What compiling and running a submission may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Time for rustc, by the clock on the wall. Constants can be computed at compile time for as long as one likes.
    pub compile_time: Duration,
    /// Address space of rustc and of the linker, each, in bytes. With too little, rustc's messages mislead.
    pub compile_memory: u64,
    /// Time for one job, by the clock on the wall: a million samples at most, for which a correct submission needs less
    /// than a second. A sixth of it is for the first part of a job that is tried before. All jobs of a check together
    /// have no more.
    pub job_time: Duration,
    /// Address space of the host, in bytes, beside what its threads reserve without using it.
    pub job_memory: u64,
    /// False only to measure what the sandbox costs: files and system calls are not locked away then.
    pub sandbox: bool,
    /// False only to test the sandbox alone: neither source nor program are inspected then.
    pub inspect: bool,
    /// The worst sandbox in which anything of a submission is compiled or run.
    pub min_level: Level,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            compile_time: Duration::from_secs(30),
            compile_memory: 4 << 30,
            job_time: Duration::from_secs(30),
            job_memory: 4 << 30,
            sandbox: true,
            inspect: true,
            min_level: Level::None,
        }
    }
}
