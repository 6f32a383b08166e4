//! Builds a submission against the framework, runs it in a sandbox, and asks it for numbers.
//!
//! [`build`] compiles it, [`sandbox`] confines compiler and program, [`host_process`] runs the program. Nothing here
//! judges: whatever a submission does wrong is a [`Fault`](verdict::check::Fault), everything else an
//! [`Error`](verdict::error::Error).

pub mod assignment;
pub mod assignment_folder;
pub mod build;
pub mod host_process;
pub mod job;
pub mod sandbox;
pub mod scan;
pub mod tree_hash;
pub mod trial;
pub mod workspace;
