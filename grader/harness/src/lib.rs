//! From a source to numbers: builds a submission against the framework and runs it in a sandbox.
//!
//! [`build`] compiles it, [`sandbox`] confines compiler and program, [`host_process`] runs the program and asks it for
//! numbers. Nothing here judges: what a submission does wrong is a [`host_process::Fault`], everything else an
//! [`Error`](verdict::error::Error).

pub mod assignment;
pub mod build;
pub mod host_process;
pub mod job;
pub mod sandbox;
pub mod scan;
pub mod tree_hash;
pub mod trial;
pub mod workspace;
