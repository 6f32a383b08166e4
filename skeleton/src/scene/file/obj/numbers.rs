//! The numbers of `v`, `vt` and `vn`: `tobj` reads them, this says what is wrong with them.

use std::path::Path;

use super::outline::shown;
use crate::diagnostic::Diagnostic;
use crate::scene::file::text::{Statement, statements};

/// How many numbers may follow `keyword`.
fn expected_counts(keyword: &str) -> (&'static [usize], &'static str) {
    match keyword {
        "v" => (&[3, 4, 6], "3 numbers (or 4 with a weight, or 6 with a colour)"),
        "vt" => (&[2, 3], "2 numbers (or 3)"),
        _ => (&[3], "3 numbers"),
    }
}

/// A quick look: false if [`check`] would find the count of the numbers wrong, or a letter in them.
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

/// The slow but thorough check; an error says what is wrong.
pub(super) fn check(statement: &Statement<'_>) -> Result<(), String> {
    let keyword = statement.keyword;
    let (counts, expected) = expected_counts(keyword);
    let mut values = Vec::new();
    for word in statement.uncommented().split_ascii_whitespace() {
        match word.parse::<f32>() {
            Ok(value) if value.is_finite() => values.push(value),
            Ok(_) => {
                return Err(format!("`{keyword}` has the number `{}`, which is not finite", shown(word)));
            }
            Err(_) => return Err(format!("`{keyword}` wants {expected}, but `{}` is none", shown(word))),
        }
    }
    if !counts.contains(&values.len()) {
        return Err(format!("`{keyword}` wants {expected}, but has {}", values.len()));
    }
    if keyword == "v" && values.len() == 4 && values[..3].iter().any(|value| !(value / values[3]).is_finite())
    {
        return Err(format!("the weight {} of the vertex leads to infinite coordinates", values[3]));
    }
    Ok(())
}

/// Finds the first line that is to blame for `tobj`'s being unable to read the numbers of a file.
pub(super) fn first_wrong_line(file: &Path, text: &str) -> Option<Diagnostic> {
    let has_numbers = |statement: &Statement<'_>| matches!(statement.keyword, "v" | "vt" | "vn");
    let wrong = statements(text).filter(has_numbers).find_map(|statement| {
        check(&statement).err().map(|message| Diagnostic::at(file, statement.line, message))
    });
    wrong.or_else(|| {
        let has_colour =
            |statement: &Statement<'_>| statement.uncommented().split_ascii_whitespace().count() == 6;
        let mut vertices = statements(text).filter(|statement| statement.keyword == "v");
        let first = has_colour(&vertices.next()?);
        let other = vertices.find(|statement| has_colour(statement) != first)?;
        Some(Diagnostic::at(file, other.line, "either every vertex must have a colour or none"))
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
