//! YAML: the only module that knows which crate reads it.

use std::path::Path;

use super::keys::SceneFile;
use super::text::{self, Reference};
use crate::scene::Diagnostic;

/// More than any scene file written by hand or by a script needs.
const MAX_BYTES: u64 = 4 << 20;

/// Far deeper than the format goes. The parser's time grows with the square of the depth.
const MAX_DEPTH: usize = 256;

/// Reads a scene file, but none of the files that it names.
pub(super) fn read(path: &Path) -> Result<SceneFile, Diagnostic> {
    let text = text::read(path, MAX_BYTES, None)?;
    if text.trim().is_empty() {
        return Err(Diagnostic::about(path, "is empty, but a scene has at least `meshes` and `camera`"));
    }
    if let Some(line) = line_nested_too_deeply(&text) {
        return Err(Diagnostic::at(
            path,
            line,
            "too many brackets are open; a scene needs no more than five",
        ));
    }
    serde_yaml::from_str(&text).map_err(|error| {
        let mut message = error.to_string();
        let Some(location) = error.location() else { return Diagnostic::about(path, message) };
        message = message.replace(&format!(" at line {} column {}", location.line(), location.column()), "");
        let line = line_of_word(&text, &message, location.line());
        let words = text.lines().nth(line - 1).unwrap_or_default().trim_start_matches(' ');
        if words.starts_with('\t') {
            message.push_str("; lines must be indented with spaces, not with a tab");
        }
        Diagnostic::at(path, line, message)
    })
}

/// The line of the word that a message is about, if the parser knows only where the list or mapping starts
/// that has it: so it is with unknown tags and with keys that are there twice.
fn line_of_word(text: &str, message: &str, start: usize) -> usize {
    let quoted = message.split('`').nth(1);
    let nth_line = |word: String, nth: usize| {
        let mut lines = text.lines().enumerate().skip(start - 1).filter(|(_, line)| line.contains(&word));
        lines.nth(nth).map(|(index, _)| index + 1)
    };
    let found = match quoted {
        Some(tag) if message.contains("unknown variant") => nth_line(format!("!{tag}"), 0),
        Some(key) if message.contains("duplicate field") => nth_line(format!("{key}:"), 1),
        _ => None,
    };
    found.unwrap_or(start)
}

/// The line in which more brackets are open than [`MAX_DEPTH`].
///
/// Brackets in comments and quotes count too: this is a guard, not a parser.
fn line_nested_too_deeply(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut line = 1;
    for byte in text.bytes() {
        match byte {
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.saturating_sub(1),
            b'\n' => line += 1,
            _ => {}
        }
        if depth > MAX_DEPTH {
            return Some(line);
        }
    }
    None
}

/// Where a scene file names `file`.
///
/// The parser keeps no positions, so this looks for the text; a name that was written with escapes is not
/// found, and the reference is then to the file as a whole.
pub(super) fn reference_to_mesh(scene: &Path, file: &str) -> Reference {
    let line = std::fs::read_to_string(scene).ok().and_then(|text| {
        let names_it = |line: &str| !line.trim_start().starts_with('#') && line.contains(file);
        text.lines().position(names_it).map(|index| index + 1)
    });
    Reference { file: scene.to_owned(), line }
}
