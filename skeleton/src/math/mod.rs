//! Numbers, colours and directions.

mod rgb;

pub use rgb::Rgb;
