//! Diagnostics for the numbers of `v`, `vt` and `vn`, which `tobj` reads.

use std::path::Path;

use super::outline::shown;
use crate::diagnostic::Diagnostic;
use crate::scene::file::text::{Statement, statements};

/// The permitted numbers of arguments of a keyword, and their description.
fn expected_counts(keyword: &str) -> (&'static [usize], &'static str) {
    match keyword {
        "v" => (&[3, 4, 6], "3 numbers (or 4 with a weight, or 6 with a colour)"),
        "vt" => (&[2, 3], "2 numbers (or 3)"),
        _ => (&[3], "3 numbers"),
    }
}

/// A quick check: false if the number of arguments is wrong or they contain unexpected characters.
pub(super) fn look_right(statement: &Statement<'_>) -> bool {
    let (mut words, mut odd, mut after_space) = (0, false, true);
    for byte in statement.arguments.bytes() {
        let space = byte == b' ' || byte == b'\t';
        words += usize::from(after_space && !space);
        odd |= !(space || byte.is_ascii_digit() || matches!(byte, b'-' | b'.' | b'e' | b'E' | b'+'));
        after_space = space;
    }
    !odd && expected_counts(statement.keyword).0.contains(&words)
}

/// The thorough but slow check.
///
/// # Errors
/// What is wrong.
pub(super) fn check(statement: &Statement<'_>) -> Result<(), String> {
    let keyword = statement.keyword;
    let (counts, expected) = expected_counts(keyword);
    let mut values = Vec::new();
    for word in statement.uncommented().split_ascii_whitespace() {
        match word.parse::<f32>() {
            Ok(value) if value.is_finite() => values.push(value),
            Ok(_) => {
                return Err(format!("`{keyword}`: the number `{}` is not finite", shown(word)));
            }
            Err(_) => {
                return Err(format!("`{keyword}` needs {expected}, but `{}` is not a number", shown(word)));
            }
        }
    }
    if !counts.contains(&values.len()) {
        return Err(format!("`{keyword}` needs {expected}, but has {}", values.len()));
    }
    if keyword == "v" && values.len() == 4 && values[..3].iter().any(|value| !(value / values[3]).is_finite())
    {
        return Err(format!("weight {} leads to infinite coordinates", values[3]));
    }
    Ok(())
}

/// True for a vertex with a colour: three more numbers.
pub(super) fn has_colour(statement: &Statement<'_>) -> bool {
    statement.keyword == "v" && statement.uncommented().split_ascii_whitespace().count() == 6
}

/// The first line with numbers that `tobj` cannot read.
pub(super) fn first_wrong_line(file: &Path, text: &str) -> Option<Diagnostic> {
    let has_numbers = |statement: &Statement<'_>| matches!(statement.keyword, "v" | "vt" | "vn");
    statements(text).filter(has_numbers).find_map(|statement| {
        check(&statement).err().map(|message| Diagnostic::at(file, statement.line, message))
    })
}

/// The first line with a normal of length zero.
pub(super) fn first_zero_normal(text: &str) -> Option<usize> {
    let is_zero = |word: &str| word.parse::<f32>().is_ok_and(|value| value == 0.0);
    statements(text)
        .find(|statement| {
            statement.keyword == "vn" && statement.uncommented().split_ascii_whitespace().all(is_zero)
        })
        .map(|statement| statement.line)
}
