//! Names of files in a submission.

/// The part of a path after the last `/` or `\`.
pub(super) fn base(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// True if a name in an archive leads out of the folder that it would be unpacked to.
pub(super) fn leads_out(name: &str) -> bool {
    let drive = name.as_bytes().get(1) == Some(&b':');
    name.starts_with(['/', '\\']) || drive || name.split(['/', '\\']).any(|part| part == "..")
}

/// True for files that tools leave behind and that no student means to hand in.
pub(super) fn is_left_behind(name: &str) -> bool {
    name.split(['/', '\\'])
        .any(|part| matches!(part, "target" | ".git" | "__MACOSX") || part.starts_with("._"))
}

/// Kind of a file by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// `render_pt.rs`, in upper or lower case.
    Named,
    /// Another Rust source.
    OtherSource,
    /// `.txt`, `.md` or `.pdf`.
    Explanation,
    /// An archive of a supported format.
    Archive,
    /// An archive of another format.
    UnknownArchive,
    /// Anything else.
    Other,
}

/// Kind of a file by its name.
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
