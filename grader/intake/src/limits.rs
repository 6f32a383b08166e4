//! How much of a submission is looked at.

/// The longest source, in bytes.
pub const SOURCE: u64 = 512 << 10;
/// The largest written explanation, and the largest archive within another archive, in bytes.
pub const ATTACHMENT: u64 = 16 << 20;
/// The largest archive, in bytes.
pub const ARCHIVE: u64 = 100 << 20;
/// Files and folders in a submission.
pub const ENTRIES: usize = 20_000;
/// Bytes that come out of all compressed streams of a submission.
pub const UNPACKED: u64 = 1 << 30;
/// How many times larger than the compressed stream its contents may be, once they are more than [`ATTACHMENT`].
pub const RATIO: u64 = 200;
/// Folders within folders.
pub const DEPTH: usize = 64;
