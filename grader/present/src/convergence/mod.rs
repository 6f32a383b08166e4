//! Error against run time as plot, page, table and CSV.

mod export;
mod page;
mod plot;
mod table;

pub use export::{save_csv, save_json};
pub use page::page;
pub use plot::{Axis, svg};
pub(crate) use plot::{GRID, INK, OTHER, PAPER, SUBMISSION};
pub(crate) use table::not_measured;
pub use table::{print_sentences, print_table, sentences};
