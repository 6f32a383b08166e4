//! Runs one submission and answers the grader's jobs.
//!
//! The submission is linked into a small fixed program (`program/main.rs`) whose `main` calls `serve`. The process
//! reads [`Request`](protocol::Request)s from its standard input and writes a [`Response`](protocol::Response) to
//! each to what was its standard output; whatever the submission prints goes to standard error. It has no say in
//! anything else: it gives numbers, and the grader judges them. It is locked in from its start, and tightens that before
//! it meets the submission ([`confine`]).
//!
//! Without the feature `serve` there is only the protocol, for the grader.

pub mod confine;
#[cfg(feature = "serve")]
mod constructor;
#[cfg(feature = "serve")]
mod probe;
pub mod protocol;
#[cfg(feature = "serve")]
mod render;
#[cfg(feature = "serve")]
mod replay;
#[cfg(feature = "serve")]
mod serve;
#[cfg(feature = "serve")]
mod stdio;

#[cfg(feature = "serve")]
pub use constructor::Constructor;
#[cfg(feature = "serve")]
pub use serve::serve;
