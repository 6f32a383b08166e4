//! Every sentence about a result: reports hold data only.
//!
//! A sentence says what happened, where, and what to do. It is plain text of unknown length, which may quote names,
//! paths and panic messages: each format escapes what is special in it.

mod cause;
mod check;
mod command;
pub mod fact;
mod fault;
mod hint;
mod means;
mod next;
mod number;
mod points;
mod sampling;
mod sandbox;
mod skipped;
mod stability;
mod task;
mod verdict;
mod weights;

#[cfg(test)]
mod tests;

pub use cause::{heading, hint, seen, title};
pub(crate) use check::variances;
pub use check::{about, explanation, remarks, remarks_with_replay};
pub use command::{repeat_command, replay_command, replay_of};
pub use fact::audit_rows;
pub use fault::{fault, numerics};
pub use hint::{hint_on_causes, hint_on_check, hint_on_paths};
pub(crate) use next::standing;
pub use next::{changes, finish, next_heading, prints, steps_done};
pub use number::{count, duration, number_of_points};
pub(crate) use points::staff_only;
pub use points::{not_covered, sum};
pub use sandbox::missing_layers;
pub use skipped::{not_run, skipped, why_not};
pub use task::task_state;
pub use verdict::verdict;
