//! Limits on the size of a submission.

/// Maximum size of a source in bytes.
pub const SOURCE: u64 = 512 << 10;
/// Maximum size in bytes of a written explanation, and of an archive inside another.
pub const ATTACHMENT: u64 = 16 << 20;
/// Maximum size of an archive in bytes.
pub const ARCHIVE: u64 = 100 << 20;
/// Maximum number of files and folders in a submission.
pub const ENTRIES: usize = 20_000;
/// Maximum number of bytes unpacked from all compressed streams of a submission.
pub const UNPACKED: u64 = 1 << 30;
/// Maximum compression ratio of a stream that unpacks to more than [`ATTACHMENT`].
pub const RATIO: u64 = 200;
/// Maximum depth of folders.
pub const DEPTH: usize = 64;
