//! Limits on the size of a submission, and on what reading it may cost.

/// Maximum size of a source in bytes.
pub const SOURCE: u64 = 512 << 10;
/// Maximum size in bytes of a written explanation, and of an archive inside another.
pub const ATTACHMENT: u64 = 16 << 20;
/// Maximum size of an archive in bytes.
pub const ARCHIVE: u64 = 100 << 20;
/// Maximum number of files and folders in a submission, over everything in it.
pub const ENTRIES: usize = 20_000;
/// Maximum number of bytes read and unpacked from a submission, headers included.
pub const BYTES: u64 = 1 << 30;
/// Maximum number of bytes of sources that are kept in memory until one is selected.
pub const KEPT: u64 = 32 << 20;
/// Maximum processor time in seconds. The largest checkout in a compressed archive takes about five.
pub const SECONDS: u64 = 30;
/// Maximum compression ratio of a stream that unpacks to more than [`ATTACHMENT`].
pub const RATIO: u64 = 200;
/// Maximum depth of folders.
pub const DEPTH: usize = 64;
/// Maximum length in bytes of a name in an archive: that of a path on Linux.
pub const NAME: usize = 4096;
/// Maximum size in bytes of a header that holds a name and other things.
pub const HEADER: u64 = 64 << 10;
/// Maximum number of written explanations.
pub const EXPLANATIONS: usize = 20;
/// Maximum number of notes.
pub const NOTES: usize = 30;
/// Maximum address space in bytes of a process that reads a submission.
pub const MEMORY: u64 = 1 << 30;
