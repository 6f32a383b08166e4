//! Names of files in a submission.

use verdict::text::harmless;

/// The part of a path after the last `/` or `\`.
pub(super) fn base(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// The part of a path before [`base`].
fn folder(name: &str) -> &str {
    &name[..name.len() - base(name).len()]
}

/// Name of a file inside a folder or archive, as it appears in reports and tables. All names pass through here: control
/// characters and bidirectional overrides are escaped, and of a long path the end is kept.
pub(super) fn shown(inside: &str, name: &str) -> String {
    const MAX_LENGTH: usize = 190;
    let path = if inside.is_empty() { name.to_owned() } else { format!("{inside}/{name}") };
    match path.char_indices().rev().nth(MAX_LENGTH) {
        Some((cut, _)) => harmless(&format!("…{}", path[cut..].chars().skip(1).collect::<String>())),
        None => harmless(&path),
    }
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
    /// The source with its usual name, in upper or lower case, or as course systems name its versions.
    Named,
    /// Another Rust source.
    OtherSource,
    /// `.txt`: a written explanation, unless it is a Rust source.
    Text,
    /// A written explanation of another format.
    Explanation,
    /// An archive of a supported format.
    Archive,
    /// An archive of another format.
    UnknownArchive,
    /// Anything else.
    Other,
}

/// Kind of a file by its name, where `file_name` is the usual name of the source.
pub(super) fn kind(name: &str, file_name: &str) -> Kind {
    if version(name, file_name).is_some() {
        return Kind::Named;
    }
    let name = base(name).to_lowercase();
    let ends = |list: &[&str]| list.iter().any(|end| name.ends_with(end));
    if ends(&[".rs", ".rs.txt"]) {
        Kind::OtherSource
    } else if ends(&[".txt"]) {
        Kind::Text
    } else if ends(&[".md", ".pdf", ".html", ".htm", ".doc", ".docx", ".odt", ".rtf", ".tex"]) {
        Kind::Explanation
    } else if ends(&[".zip", ".tar", ".tar.gz", ".tgz"]) {
        Kind::Archive
    } else if ends(&[".7z", ".rar", ".xz", ".bz2", ".zst", ".gz"]) {
        Kind::UnknownArchive
    } else {
        Kind::Other
    }
}

/// Number of a version of the source in the name of its file, 0 if there is none, and where it lies; `None` for any other file.
/// Versions can be ordered if their places are equal.
///
/// Moodle without folders writes the student in front (`Ann Lee_11_assignsubmission_file_tracer.rs`). ILIAS numbers
/// files of the same name in the order of their arrival (`tracer (2).rs`), and writes words and a dash in front of
/// those that are late (`Late Submission - tracer (3).rs`). Browsers number downloads in the same way.
pub(super) fn version(name: &str, file_name: &str) -> Option<(String, u32)> {
    let (stem, end) = file_name.rsplit_once('.')?;
    let lower = base(name).to_lowercase();
    let before_end = lower.strip_suffix(end)?.strip_suffix('.')?;
    let (before_number, number) = match before_end.strip_suffix(')').and_then(|it| it.rsplit_once('(')) {
        Some((before, number)) => (before.trim_end_matches(' '), number.parse().ok()?),
        None => (before_end, 0),
    };
    let student = before_number.strip_suffix(stem)?;
    let known =
        student.is_empty() || student.ends_with("_assignsubmission_file_") || student.ends_with(" - ");
    let student = student.rsplit_once("_assignsubmission_file_").map_or("", |(student, _)| student);
    known.then(|| (format!("{}{student}", folder(name)), number))
}

/// True if `wanted` is this file: its name, or the end of its path.
pub(super) fn is_at(name: &str, wanted: &str) -> bool {
    let parts = |path: &str| -> Vec<String> {
        path.split(['/', '\\']).filter(|part| !matches!(*part, "" | ".")).map(str::to_owned).collect()
    };
    let wanted = parts(&shown("", wanted));
    !wanted.is_empty() && parts(name).ends_with(&wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_those_of_course_systems() {
        for (name, expected) in [
            ("render_pt.rs", Some(("", 0))),
            ("a/Render_PT.rs", Some(("a/", 0))),
            ("render_pt (2).rs", Some(("", 2))),
            ("render_pt(12).rs", Some(("", 12))),
            ("x/Late Submission - render_pt (3).rs", Some(("x/", 3))),
            ("Ann Lee_11_assignsubmission_file_render_pt.rs", Some(("ann lee_11", 0))),
            ("render_pt (old).rs", None),
            ("render_pt_2.rs", None),
            ("my_render_pt.rs", None),
            ("render_pt (99999999999).rs", None),
            ("render_pt.rs.txt", None),
        ] {
            let expected = expected.map(|(place, number)| (place.to_owned(), number));
            assert_eq!(version(name, "render_pt.rs"), expected, "{name}");
        }
    }

    #[test]
    fn shown_names_keep_their_end_and_no_control_characters() {
        let long = format!("{}/render_pt.rs", "a".repeat(65_000));
        let name = shown("x.zip", &long);
        assert!(name.ends_with("/render_pt.rs") && name.chars().count() < 200, "{name}");
        assert_eq!(shown("", "\u{1b}[2J\u{202e}a"), "\\u{1b}[2J\\u{202e}a");
    }

    #[test]
    fn a_file_is_picked_by_the_end_of_its_path() {
        for (name, wanted, expected) in [
            ("a.zip/x/render_pt.rs", "x/render_pt.rs", true),
            ("a.zip/x/render_pt.rs", "./a.zip/x/render_pt.rs", true),
            ("a.zip/xx/render_pt.rs", "x/render_pt.rs", false),
            ("render_pt.rs", "", false),
        ] {
            assert_eq!(is_at(name, wanted), expected, "{name} {wanted}");
        }
    }
}
