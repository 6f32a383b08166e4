//! Names of files that other people chose.

/// The part of a path after the last separator of either kind.
pub(super) fn base(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// True if a name within an archive leads out of the place where it would be unpacked.
pub(super) fn leads_out(name: &str) -> bool {
    let drive = name.as_bytes().get(1) == Some(&b':');
    name.starts_with(['/', '\\']) || drive || name.split(['/', '\\']).any(|part| part == "..")
}

/// True for what tools leave behind, and nobody means to hand in.
pub(super) fn is_left_behind(name: &str) -> bool {
    name.split(['/', '\\'])
        .any(|part| matches!(part, "target" | ".git" | "__MACOSX") || part.starts_with("._"))
}

/// What a file's name says that it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `render_pt.rs`, in capitals or not.
    Named,
    /// Another source in Rust.
    OtherSource,
    /// `.txt`, `.md` or `.pdf`.
    Explanation,
    /// An archive of a kind that is read.
    Archive,
    /// An archive of another kind.
    UnknownArchive,
    /// Anything else.
    Other,
}

/// What a file's name says that it is.
pub(super) fn kind(name: &str) -> Kind {
    let name = base(name).to_lowercase();
    let ends = |list: &[&str]| list.iter().any(|end| name.ends_with(end));
    if name == verdict::submission::FILE_NAME {
        Kind::Named
    } else if ends(&[".rs", ".rs.txt"]) {
        Kind::OtherSource
    } else if ends(&[".txt", ".md", ".pdf"]) {
        Kind::Explanation
    } else if ends(&[".zip", ".tar", ".tar.gz", ".tgz"]) {
        Kind::Archive
    } else if ends(&[".7z", ".rar", ".xz", ".bz2", ".zst", ".gz"]) {
        Kind::UnknownArchive
    } else {
        Kind::Other
    }
}
