//! Runs one submission and answers the grader's requests.
//!
//! The submission is linked into a small fixed program (`program/`) whose `main` calls `serve`. The process
//! reads [`Request`](protocol::Request)s from its standard input and writes a [`Response`](protocol::Response) to
//! each to its original standard output; output of the submission goes to standard error. Its printing macros are
//! replaced (`printed`): a line is formatted only while a path is replayed. The process only returns numbers: the
//! grader judges them. It is confined from its start, and tightens the confinement before it runs code of
//! the submission ([`confine`]).
//!
//! Without the feature `serve`, the crate contains only the protocol, for the grader.

#[cfg(feature = "serve")]
mod audit;
pub mod confine;
#[cfg(feature = "serve")]
mod directions;
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
mod submission;

#[cfg(feature = "serve")]
pub use arty::probe::record_print as printed;
#[cfg(feature = "serve")]
pub use serve::serve;
#[cfg(feature = "serve")]
pub use submission::{NewDirections, Submission};
