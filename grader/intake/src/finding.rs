//! What can be said of a submission before it is compiled.

use verdict::submission::{FILE_NAME, IntakeFinding};

use super::limits;
use verdict::text::harmless;

/// Why a submission is not graded. Names of files in it are printed as they are, but for characters that would steer a
/// terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `missing-file`: there is no source in it, but maybe other files, of which some are named.
    MissingFile(Vec<String>),
    /// `several-candidates`: there are several sources that are not the same.
    SeveralCandidates(Vec<String>),
    /// `too-large`: a source or an archive is larger than any that is meant seriously.
    TooLarge(String, u64),
    /// `not-source`: the file has the right name, but is something else.
    NotSource(&'static str),
    /// `empty`: there is nothing in the source.
    Empty,
    /// `encoding`: it says that it is UTF-16, and is not.
    Encoding,
    /// `nul-bytes`: no text has these.
    NulBytes,
    /// `link`: the source is a link to somewhere else.
    Link(String),
    /// `outside-path`: the source's name in the archive leads out of the archive.
    OutsidePath(String),
    /// `bomb`: it unpacks to more than any submission has.
    Bomb(String),
    /// `nested-archive`: an archive in an archive in an archive.
    NestedArchive(String),
    /// `unsupported-archive`: of a kind that is not read.
    UnsupportedArchive(String),
    /// `encrypted`: a password is needed.
    Encrypted(String),
    /// `broken-archive`: it cannot be read to its end.
    BrokenArchive(String, String),
    /// `git`: the repository has no commit that can be read.
    Git(String),
    /// `unreadable`: the machine does not let the grader read it.
    Unreadable(String, String),
}

impl Refusal {
    /// The code, for tables and scripts.
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
            Self::NotSource(what) => write!(f, "its {FILE_NAME} is {what}, not a text"),
            Self::Empty => write!(f, "its {FILE_NAME} is empty"),
            Self::Encoding => write!(f, "its {FILE_NAME} begins like UTF-16, but is not; save it as UTF-8"),
            Self::NulBytes => write!(f, "its {FILE_NAME} has NUL bytes: it is no text; save it as UTF-8"),
            Self::Link(name) => write!(f, "{} is a link, and links are not followed", harmless(name)),
            Self::OutsidePath(name) => write!(f, "{} leads out of its archive", harmless(name)),
            Self::Bomb(why) => write!(f, "it unpacks to more than any submission has: {why}"),
            Self::NestedArchive(name) => {
                write!(f, "{}: an archive in an archive in an archive is not opened", harmless(name))
            }
            Self::UnsupportedArchive(name) => {
                write!(
                    f,
                    "{}: archives of this kind are not read (.zip, .tar.gz and .tar are)",
                    harmless(name)
                )
            }
            Self::Encrypted(name) => write!(f, "{} is encrypted", harmless(name)),
            Self::BrokenArchive(name, why) => {
                write!(f, "{}: the archive is broken ({})", harmless(name), harmless(why))
            }
            Self::Git(why) => {
                write!(f, "the git repository has no commit that can be read: {}", harmless(why))
            }
            Self::Unreadable(name, why) => write!(f, "{} cannot be read: {why}", harmless(name)),
        }
    }
}

/// What is odd about a submission that is graded all the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    /// `byte-order-mark`: one at the start was removed.
    ByteOrderMark,
    /// `utf-16`: it was turned into UTF-8.
    Utf16,
    /// `windows-1252`: it is not UTF-8, and was read as Windows-1252, of which Latin-1 is a part; the first line that
    /// this matters for.
    Windows1252(usize),
    /// `line-ends`: those of another system were turned into `\n`.
    LineEnds,
    /// `copies`: there are several that are the same.
    Copies(Vec<String>),
    /// `other-name`: the only source has another name.
    OtherName(String),
    /// `starter-too`: an untouched starting file lies beside it, and was passed over.
    StarterToo(String),
    /// `untouched`: it is the starting file.
    Untouched,
    /// `uncommitted`: the file on disk is not that of the last commit, which counts.
    Uncommitted(String),
    /// `passed-over`: something in it could not be read, and did not have to be.
    PassedOver(String),
}

impl Note {
    /// The code, for tables and scripts.
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
            Self::Utf16 => write!(f, "it was turned from UTF-16 into UTF-8"),
            Self::Windows1252(line) => {
                write!(f, "line {line} is not UTF-8; the file was read as Windows-1252 (Latin-1)")
            }
            Self::LineEnds => write!(f, "line ends of another system were replaced"),
            Self::Copies(names) => write!(f, "there are {} copies of it, all the same", names.len()),
            Self::OtherName(name) => write!(f, "it is called {}, not {FILE_NAME}", harmless(name)),
            Self::StarterToo(name) => {
                write!(f, "{} is the untouched starting file and was passed over", harmless(name))
            }
            Self::Untouched => write!(f, "it is the untouched starting file"),
            Self::Uncommitted(name) => {
                write!(f, "{} has changes that are not committed; the last commit is graded", harmless(name))
            }
            Self::PassedOver(what) => write!(f, "passed over: {}", harmless(what)),
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
