//! Findings about a submission before it is compiled.

use serde::{Deserialize, Serialize};

use verdict::submission::IntakeFinding;
use verdict::text::harmless;

/// Why a submission is not graded. Names of files are printed without control characters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Refusal {
    /// `missing-file`: it contains no source. The usual name of the source, and some of the other files in it.
    MissingFile(String, Vec<String>),
    /// `several-candidates`: it contains several sources that differ.
    SeveralCandidates(Vec<String>),
    /// `duplicate-entry`: two files of the same name in one archive differ, so that programs disagree about its content.
    TwoEntries(String),
    /// `source-not-found`: there is no source at the path that was asked for. The path, and the sources that there are.
    NotThere(String, Vec<String>),
    /// `too-large`: a source or an archive exceeds its [limit](crate::limits).
    TooLarge {
        /// Name of the source or archive.
        name: String,
        /// Maximum size in bytes.
        max: u64,
    },
    /// `not-source`: the file has the right name but another format.
    NotSource(String),
    /// `empty`: the source is empty.
    Empty,
    /// `encoding`: it is marked as UTF-16 but is not.
    Encoding,
    /// `nul-bytes`: it contains NUL bytes.
    NulBytes,
    /// `link`: the source is a link.
    Link(String),
    /// `no-file`: it is a pipe, a socket or a device.
    NoFile(String),
    /// `outside-path`: the source's path leads out of its archive.
    OutsidePath(String),
    /// `bomb`: reading it takes more bytes, files, memory or time than the [limits](crate::limits) allow.
    Bomb(String),
    /// `nested-archive`: an archive inside an archive inside an archive.
    NestedArchive(String),
    /// `unsupported-archive`: an archive of another format.
    UnsupportedArchive(String),
    /// `encrypted`: an archive with a password.
    Encrypted(String),
    /// `broken-archive`: an archive that cannot be read to its end.
    BrokenArchive(String, String),
    /// `git`: the repository has no readable commit.
    Git(String),
    /// `unreadable`: the operating system refuses to read it.
    Unreadable(String, String),
    /// `intake-failed`: the process that reads it failed, with this exit status: a fault of the grader.
    Failed(i32),
}

impl Refusal {
    /// Code for tables and scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MissingFile(..) => "missing-file",
            Self::SeveralCandidates(_) => "several-candidates",
            Self::TwoEntries(_) => "duplicate-entry",
            Self::NotThere(..) => "source-not-found",
            Self::TooLarge { .. } => "too-large",
            Self::NotSource(_) => "not-source",
            Self::Empty => "empty",
            Self::Encoding => "encoding",
            Self::NulBytes => "nul-bytes",
            Self::Link(_) => "link",
            Self::NoFile(_) => "no-file",
            Self::OutsidePath(_) => "outside-path",
            Self::Bomb(_) => "bomb",
            Self::NestedArchive(_) => "nested-archive",
            Self::UnsupportedArchive(_) => "unsupported-archive",
            Self::Encrypted(_) => "encrypted",
            Self::BrokenArchive(..) => "broken-archive",
            Self::Git(_) => "git",
            Self::Unreadable(..) => "unreadable",
            Self::Failed(_) => "intake-failed",
        }
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MissingFile(file, others) if others.is_empty() => write!(f, "there is no {file} in it"),
            Self::MissingFile(file, others) => {
                write!(f, "there is no {file} in it, but {}", listed(others))
            }
            Self::SeveralCandidates(names) => write!(
                f,
                "there are several sources that differ: {}; choose one with --source=PATH, or in the column `source` \
                 of the manifest",
                listed(names)
            ),
            Self::TwoEntries(name) => {
                write!(f, "{} is in it twice, with different content; pack it again", harmless(name))
            }
            Self::NotThere(path, names) if names.is_empty() => {
                write!(f, "there is no source {} in it, and no other", harmless(path))
            }
            Self::NotThere(path, names) => {
                write!(f, "there is no source {} in it; choose one of {}", harmless(path), listed(names))
            }
            Self::TooLarge { name, max } => {
                write!(f, "{} is too large (at most {max} bytes)", harmless(name))
            }
            Self::NotSource(what) => write!(f, "its source is {what}, not a text file"),
            Self::Empty => write!(f, "its source is empty"),
            Self::Encoding => {
                write!(f, "its source is marked as UTF-16 but is not valid; save it as UTF-8")
            }
            Self::NulBytes => {
                write!(f, "its source contains NUL bytes, so it is not a text file; save it as UTF-8")
            }
            Self::Link(name) => write!(f, "{} is a link, and links are not followed", harmless(name)),
            Self::NoFile(name) => write!(f, "{} is neither a file nor a folder", harmless(name)),
            Self::OutsidePath(name) => write!(f, "the path {} leads out of its archive", harmless(name)),
            Self::Bomb(why) => write!(f, "reading it exceeds a limit: {why}"),
            Self::NestedArchive(name) => {
                write!(f, "{}: archives nested more than twice are not opened", harmless(name))
            }
            Self::UnsupportedArchive(name) => {
                write!(
                    f,
                    "{}: this archive format is not supported; use .zip, .tar.gz or .tar",
                    harmless(name)
                )
            }
            Self::Encrypted(name) => write!(f, "{} is encrypted", harmless(name)),
            Self::BrokenArchive(name, why) => {
                write!(f, "{}: the archive is broken ({})", harmless(name), harmless(why))
            }
            Self::Git(why) => {
                write!(f, "the git repository has no readable commit: {}", harmless(why))
            }
            Self::Unreadable(name, why) => {
                write!(f, "{} cannot be read: {}", harmless(name), harmless(why))
            }
            Self::Failed(status) => {
                write!(f, "the grader failed to read it (exit status {status}); have a look at it by hand")
            }
        }
    }
}

/// Anything odd about a submission that does not prevent grading.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Note {
    /// `byte-order-mark`: a byte order mark was removed.
    ByteOrderMark,
    /// `utf-16`: it was converted from UTF-16.
    Utf16,
    /// `windows-1252`: it is not UTF-8 and was read as Windows-1252. The first line that is not UTF-8, counted from 1.
    Windows1252(usize),
    /// `line-ends`: line ends of another system were replaced by `\n`.
    LineEnds,
    /// `copies`: it contains several equal sources.
    Copies(Vec<String>),
    /// `other-name`: the only source has another name; the name, and the usual one.
    OtherName(String, String),
    /// `starter-too`: it also contains the unchanged starting file, which was skipped.
    StarterToo(String),
    /// `other-source`: it also contains a source with another name, which was skipped.
    OtherSource(String),
    /// `older-version`: it also contains an older version of the source by the naming of a course system; skipped.
    OlderVersion(String),
    /// `no-type`: it also contains a file with the right name that does not define the type of a submission; skipped.
    /// The file, and the type.
    NoType(String, String),
    /// `untouched`: the source is the unchanged starting file.
    Untouched,
    /// `uncommitted`: the file on disk differs from the last commit, which is graded.
    Uncommitted(String),
    /// `passed-over`: something in it could not be read but was not needed.
    PassedOver(String),
}

impl Note {
    /// Code for tables and scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::ByteOrderMark => "byte-order-mark",
            Self::Utf16 => "utf-16",
            Self::Windows1252(_) => "windows-1252",
            Self::LineEnds => "line-ends",
            Self::Copies(_) => "copies",
            Self::OtherName(..) => "other-name",
            Self::StarterToo(_) => "starter-too",
            Self::OtherSource(_) => "other-source",
            Self::OlderVersion(_) => "older-version",
            Self::NoType(..) => "no-type",
            Self::Untouched => "untouched",
            Self::Uncommitted(_) => "uncommitted",
            Self::PassedOver(_) => "passed-over",
        }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::ByteOrderMark => write!(f, "a byte order mark was removed"),
            Self::Utf16 => write!(f, "it was converted from UTF-16 to UTF-8"),
            Self::Windows1252(line) => {
                write!(f, "line {line} is not UTF-8; the file was read as Windows-1252 (Latin-1)")
            }
            Self::LineEnds => write!(f, "line ends of another system were replaced"),
            Self::Copies(names) => write!(f, "it contains {} equal copies of the source", names.len()),
            Self::OtherName(name, usual) => write!(f, "it is called {}, not {usual}", harmless(name)),
            Self::StarterToo(name) => {
                write!(f, "{} is the unchanged starting file and was skipped", harmless(name))
            }
            Self::OtherSource(name) => {
                write!(f, "{} is also a source, but has another name; it was skipped", harmless(name))
            }
            Self::OlderVersion(name) => {
                write!(f, "{} is an older version and was skipped", harmless(name))
            }
            Self::NoType(name, type_name) => {
                write!(f, "{} does not define {type_name} and was skipped", harmless(name))
            }
            Self::Untouched => write!(f, "it is the unchanged starting file"),
            Self::Uncommitted(name) => {
                write!(f, "{} has changes that are not committed; the last commit is graded", harmless(name))
            }
            Self::PassedOver(what) => write!(f, "skipped: {}", harmless(what)),
        }
    }
}

/// The first names of a list.
fn listed(names: &[String]) -> String {
    const NAMED: usize = 5;
    let mut list: Vec<String> = names.iter().take(NAMED).map(|name| harmless(name)).collect();
    if names.len() > NAMED {
        list.push("…".to_owned());
    }
    list.join(", ")
}

impl From<&Note> for IntakeFinding {
    fn from(note: &Note) -> Self {
        Self { code: note.code().to_owned(), message: note.to_string() }
    }
}

impl From<&Refusal> for IntakeFinding {
    fn from(refusal: &Refusal) -> Self {
        Self { code: refusal.code().to_owned(), message: refusal.to_string() }
    }
}
