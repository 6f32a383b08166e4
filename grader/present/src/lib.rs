//! What people and other systems see: terminal, pages, plots and exports, all made from a
//! [`Report`](verdict::report::Report).
//!
//! Nothing here changes a verdict or a point, and only [`words`] makes sentences about them. Names, panic messages and
//! paths may hold anything; what is special in a format is escaped by that format.

pub mod convergence;
pub mod export;
pub mod page;
pub mod pictures;
mod profile;
mod progress;
pub mod replay;
pub mod streams;
mod terminal;
pub mod words;

pub use profile::print_profile;
pub use progress::Progress;
pub use terminal::{Detail, print_audit, print_sum, print_summary, summary_since};
