//! Findings about a submission before it is compiled.

use verdict::submission::{FILE_NAME, IntakeFinding};

use super::limits;
use verdict::text::harmless;

/// Why a submission is not graded. Names of files are printed without control characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `missing-file`: it contains no source. Names some of the other files in it.
    MissingFile(Vec<String>),
    /// `several-candidates`: it contains several sources that differ.
    SeveralCandidates(Vec<String>),
    /// `too-large`: a source or an archive exceeds its [limit](crate::limits). Name, and size in bytes.
    TooLarge(String, u64),
    /// `not-source`: the file has the right name but another format.
    NotSource(&'static str),
    /// `empty`: the source is empty.
    Empty,
    /// `encoding`: it is marked as UTF-16 but is not.
    Encoding,
    /// `nul-bytes`: it contains NUL bytes.
    NulBytes,
    /// `link`: the source is a link.
    Link(String),
    /// `outside-path`: the source's path leads out of its archive.
    OutsidePath(String),
    /// `bomb`: it unpacks to more than the [limits](crate::limits) allow.
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
}

impl Refusal {
    /// Code for tables and scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::MissingFile(_) => "missing-file",
            Self::SeveralCandidates(_) => "several-candidates",
            Self::TooLarge(..) => "too-large",
            Self::NotSource(_) => "not-source",
            Self::Empty => "empty",
            Self::Encoding => "encoding",
            Self::NulBytes => "nul-bytes",
            Self::Link(_) => "link",
            Self::OutsidePath(_) => "outside-path",
            Self::Bomb(_) => "bomb",
            Self::NestedArchive(_) => "nested-archive",
            Self::UnsupportedArchive(_) => "unsupported-archive",
            Self::Encrypted(_) => "encrypted",
            Self::BrokenArchive(..) => "broken-archive",
            Self::Git(_) => "git",
            Self::Unreadable(..) => "unreadable",
        }
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MissingFile(others) if others.is_empty() => write!(f, "there is no {FILE_NAME} in it"),
            Self::MissingFile(others) => {
                let others: Vec<String> = others.iter().map(|name| harmless(name)).collect();
                write!(f, "there is no {FILE_NAME} in it, but {}", others.join(", "))
            }
            Self::SeveralCandidates(names) => {
                let names: Vec<String> = names.iter().take(5).map(|name| harmless(name)).collect();
                write!(
                    f,
                    "there are several {FILE_NAME} that differ: {}; name the one to grade",
                    names.join(", ")
                )
            }
            Self::TooLarge(name, size) => {
                let max = if super::names::kind(name) == super::names::Kind::Archive {
                    limits::ARCHIVE
                } else {
                    limits::SOURCE
                };
                write!(f, "{}: {size} bytes are too many (at most {max})", harmless(name))
            }
            Self::NotSource(what) => write!(f, "its {FILE_NAME} is {what}, not a text file"),
            Self::Empty => write!(f, "its {FILE_NAME} is empty"),
            Self::Encoding => {
                write!(f, "its {FILE_NAME} is marked as UTF-16 but is not valid; save it as UTF-8")
            }
            Self::NulBytes => {
                write!(f, "its {FILE_NAME} contains NUL bytes, so it is not a text file; save it as UTF-8")
            }
            Self::Link(name) => write!(f, "{} is a link, and links are not followed", harmless(name)),
            Self::OutsidePath(name) => write!(f, "the path {} leads out of its archive", harmless(name)),
            Self::Bomb(why) => write!(f, "it unpacks to more than is allowed: {why}"),
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
            Self::Unreadable(name, why) => write!(f, "{} cannot be read: {why}", harmless(name)),
        }
    }
}

/// Anything odd about a submission that does not prevent grading.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// `other-name`: the only source has another name.
    OtherName(String),
    /// `starter-too`: it also contains the unchanged starting file, which was skipped.
    StarterToo(String),
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
            Self::OtherName(_) => "other-name",
            Self::StarterToo(_) => "starter-too",
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
            Self::OtherName(name) => write!(f, "it is called {}, not {FILE_NAME}", harmless(name)),
            Self::StarterToo(name) => {
                write!(f, "{} is the unchanged starting file and was skipped", harmless(name))
            }
            Self::Untouched => write!(f, "it is the unchanged starting file"),
            Self::Uncommitted(name) => {
                write!(f, "{} has changes that are not committed; the last commit is graded", harmless(name))
            }
            Self::PassedOver(what) => write!(f, "skipped: {}", harmless(what)),
        }
    }
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
