//! Pictures of a report on disk, and small ones for a class's page.

mod store;
mod thumbnail;

pub use store::{load, save};
pub use thumbnail::{png, thumbnail};
