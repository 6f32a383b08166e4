//! Statements of OBJ and MTL files.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The path of a file named in another one, relative to that; both `/` and `\` separate folders.
pub(super) fn relative_to(file: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    file.parent().unwrap_or(Path::new("")).join(name)
}

/// Joins lines that end in `\` with the next one. Empty lines are inserted after them to preserve line numbers.
pub(super) fn join_continued_lines(text: &str) -> Cow<'_, str> {
    if !text.contains("\\\n") && !text.contains("\\\r\n") {
        return Cow::Borrowed(text);
    }
    let mut joined = String::with_capacity(text.len());
    let mut owed = 0;
    for line in text.lines() {
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            owed += 1;
        } else {
            joined.push_str(line);
            (0..=owed).for_each(|_| joined.push('\n'));
            owed = 0;
        }
    }
    Cow::Owned(joined)
}

/// One line of an OBJ or MTL file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    /// Counted from 1.
    pub(super) line: usize,
    /// The first word.
    pub(super) keyword: &'a str,
    /// The rest of the line, trimmed.
    pub(super) arguments: &'a str,
    /// The whole line including its line ending.
    pub(super) text: &'a str,
    /// Byte offset of the line in the file.
    pub(super) start: usize,
}

impl<'a> Statement<'a> {
    /// The arguments without a trailing comment.
    pub(super) fn uncommented(&self) -> &'a str {
        self.arguments.split('#').next().unwrap_or_default().trim_ascii_end()
    }
}

/// The statements of an OBJ or MTL file: all lines except empty ones and comments.
pub(super) fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut end_of_last = 0;
    text.split_inclusive('\n').enumerate().filter_map(move |(index, text)| {
        let start = end_of_last;
        end_of_last += text.len();
        let words = text.trim_ascii();
        if words.is_empty() || words.starts_with('#') {
            return None;
        }
        let end = words.bytes().position(|byte| byte.is_ascii_whitespace()).unwrap_or(words.len());
        let (keyword, arguments) = words.split_at(end);
        Some(Statement { line: index + 1, keyword, arguments: arguments.trim_ascii_start(), text, start })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joining_continued_lines_preserves_line_numbers() {
        let joined = join_continued_lines("f 1 2 \\\n 3\\\r\n 4\r\nv 0 0 0\n");
        let seen: Vec<_> = statements(&joined)
            .map(|statement| (statement.line, statement.keyword, statement.arguments))
            .collect();
        assert_eq!(seen, [(1, "f", "1 2   3  4"), (4, "v", "0 0 0")]);
    }
}
