//! YAML files. The only module that depends on a YAML crate.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::diagnostic::Diagnostic;
use crate::input;

/// Maximum file size, more than any reasonable file needs.
const MAX_BYTES: u64 = 4 << 20;

/// Maximum nesting depth, far more than any format here needs. The parser takes quadratic time in the depth.
const MAX_DEPTH: usize = 256;

/// Reads a file of at most 4 MiB. Returns the value and the text of the file.
///
/// # Errors
/// If the file cannot be read, or the first mismatch with `T`, with its line.
pub fn read<T: DeserializeOwned>(path: &Path) -> Result<(T, String), Diagnostic> {
    let text = input::read(path, MAX_BYTES, None)?;
    if text.lines().all(|line| line.trim().is_empty() || line.starts_with('#')) {
        return Err(Diagnostic::about(path, "is empty"));
    }
    if let Some(line) = line_nested_too_deeply(&text) {
        return Err(Diagnostic::at(path, line, "brackets are nested too deeply"));
    }
    match serde_yaml::from_str(&text) {
        Ok(value) => Ok((value, text)),
        Err(error) => Err(diagnostic(path, &text, &error)),
    }
}

fn diagnostic(path: &Path, text: &str, error: &serde_yaml::Error) -> Diagnostic {
    let mut message = error.to_string();
    let Some(location) = error.location() else { return Diagnostic::about(path, shortened(&message)) };
    message = message.replace(&format!(" at line {} column {}", location.line(), location.column()), "");
    let line = line_to_blame(text, &message, location.line());
    let words = text.lines().nth(line - 1).unwrap_or_default().trim_start_matches(' ');
    if words.starts_with('\t') {
        message.push_str("; use spaces instead of tabs for indentation");
    }
    if words.contains('"') && words.contains('\\') {
        message.push_str("; in double quotes, `\\` begins an escape: write `/`, or use single quotes");
    }
    Diagnostic::at(path, line, shortened(&message))
}

/// The message, shortened in the middle if it quotes a very long value.
fn shortened(message: &str) -> String {
    const KEPT: usize = 200;
    if message.chars().nth(2 * KEPT).is_none() {
        return message.to_owned();
    }
    let characters: Vec<char> = message.chars().collect();
    let (start, end) = (&characters[..KEPT], &characters[characters.len() - KEPT..]);
    start.iter().chain(&['…']).chain(end).collect()
}

/// The line of an error, where the parser reports a different one: for unknown tags and duplicate keys it reports the
/// start of the list or mapping, for forbidden characters their offset.
fn line_to_blame(text: &str, message: &str, given: usize) -> usize {
    let quoted = message.split('`').nth(1);
    let nth_line = |word: String, nth: usize| {
        let mut lines =
            text.lines().enumerate().skip(given.saturating_sub(1)).filter(|(_, line)| line.contains(&word));
        lines.nth(nth).map(|(index, _)| index + 1)
    };
    let found = match quoted {
        Some(tag) if message.contains("unknown variant") => nth_line(format!("!{tag}"), 0),
        Some(key) if message.contains("duplicate field") => nth_line(format!("{key}:"), 1),
        _ => message.split_once(" at position ").and_then(|(_, offset)| {
            let before = text.as_bytes().get(..offset.parse().ok()?)?;
            Some(before.iter().filter(|byte| **byte == b'\n').count() + 1)
        }),
    };
    found.unwrap_or(given).max(1)
}

/// The line where brackets are nested more deeply than [`MAX_DEPTH`].
///
/// Brackets in comments and quotes count, too: this is a guard, not a parser.
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
