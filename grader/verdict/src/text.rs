//!
//! Sanitizing untrusted text before it enters a report.
//!
//! A submission controls panic messages and compiler errors. They are sanitized once, here; each report format then
//! escapes its own special characters.

use std::path::Path;

/// Maximum number of characters that are kept of a text.
const MAX_LENGTH: usize = 64 << 10;

/// Removes everything that terminals, editors or CI systems would interpret: escape sequences, control characters,
/// bidirectional overrides, lines that start with `::`, and `##[`.
pub fn clean(text: &str) -> String {
    let mut cleaned = String::new();
    let mut left = MAX_LENGTH;
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        if left == 0 {
            cleaned.push_str(" … (shortened)");
            break;
        }
        left -= 1;
        match character {
            '\n' | '\t' => cleaned.push(character),
            '\u{1b}' => skip_escape_sequence(&mut characters),
            _ if character.is_control() || is_invisible(character) => {}
            _ => cleaned.push(character),
        }
    }
    disarm_commands(&cleaned)
}

/// Skips the rest of a terminal escape sequence: `[` up to a letter, `]` up to its terminator.
fn skip_escape_sequence(characters: &mut std::iter::Peekable<std::str::Chars<'_>>) {
    match characters.peek() {
        Some('[') => {
            characters.next();
            while characters.next_if(|&c| matches!(c, ' '..='?')).is_some() {}
            characters.next_if(|&c| matches!(c, '@'..='~'));
        }
        Some(']' | 'P' | 'X' | '^' | '_') => {
            characters.next();
            while let Some(&next) = characters.peek() {
                // Without a terminator it ends with the line, so that it cannot hide the rest of the text.
                if next == '\n' {
                    break;
                }
                characters.next();
                if next == '\u{7}' || next == '\u{9c}' {
                    break;
                }
                if next == '\u{1b}' {
                    characters.next_if_eq(&'\\');
                    break;
                }
            }
        }
        _ => {
            characters.next_if(|&c| matches!(c, ' '..='~'));
        }
    }
}

/// True for zero-width characters and bidirectional overrides, which make text look different from what it is.
fn is_invisible(character: char) -> bool {
    matches!(
        character,
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
    )
}

/// Breaks up the markers that GitHub, GitLab and Azure interpret as commands in a log.
fn disarm_commands(text: &str) -> String {
    let disarmed = text.replace("##[", "# #[").replace("##vso[", "# #vso[");
    let mut lines = Vec::new();
    for line in disarmed.split('\n') {
        let start = line.len() - line.trim_start().len();
        let (blanks, rest) = line.split_at(start);
        lines.push(match rest.strip_prefix("::") {
            Some(command) => format!("{blanks}: :{command}"),
            None => line.to_owned(),
        });
    }
    lines.join("\n")
}

/// A name that is safe to print: control characters, zero-width characters and bidirectional overrides are escaped, and
/// long names are cut.
pub fn harmless(name: &str) -> String {
    const MAX_LENGTH: usize = 200;
    let mut text = String::new();
    for (index, letter) in name.chars().enumerate() {
        if index == MAX_LENGTH {
            text.push('…');
            break;
        }
        if letter.is_control() || is_invisible(letter) {
            text.extend(letter.escape_unicode());
        } else {
            text.push(letter);
        }
    }
    text
}

/// A message that is safe to print and short enough to be read: what terminals would interpret is removed, and of a line
/// that quotes a file at length, the start is kept.
pub fn message(text: &str) -> String {
    const MAX_LINE: usize = 600;
    let short = |line: &str| match line.char_indices().nth(MAX_LINE) {
        Some((end, _)) => format!("{} … (shortened)", &line[..end]),
        None => line.to_owned(),
    };
    clean(text).lines().map(short).collect::<Vec<_>>().join("\n")
}

/// A path quoted as a shell argument.
pub fn quote(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+@".contains(c);
    if text.chars().all(plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_is_unchanged() {
        let text = "error[E0599]: kein `bsdv` für `Hit`\n  --> render_pt.rs:12\n\t| std::f32::NAN <b> ≠ 🙂\n";
        assert_eq!(clean(text), text);
    }

    #[test]
    fn terminal_escape_sequences_are_removed() {
        assert_eq!(clean("\u{1b}[31mred\u{1b}[0m \u{1b}[2J\u{1b}[1;1Hhome"), "red home");
        assert_eq!(clean("\u{1b}]0;title\u{7}a \u{1b}]8;;http://x\u{1b}\\link\u{1b}]8;;\u{1b}\\"), "a link");
        assert_eq!(clean("\u{1b}]never ended\nnext line"), "\nnext line");
        assert_eq!(clean("70 points\r0\u{8}\u{0}\u{7}\u{9b}31m"), "70 points031m");
        assert_eq!(clean("a\u{202e}cba\u{2066}\u{200b}"), "acba");
        assert_eq!(clean("\u{1b}c\u{1b}"), "");
    }

    #[test]
    fn log_commands_are_disarmed() {
        assert_eq!(
            clean("x\n::error file=a::b\n  ::set-output name=x::y"),
            "x\n: :error file=a::b\n  : :set-output name=x::y"
        );
        assert_eq!(clean("a ##[error]b ##vso[task.x]c"), "a # #[error]b # #vso[task.x]c");
        // Nor does a command appear once an escape sequence inside it is removed.
        assert_eq!(clean("\u{1b}[0m::error::x\n:\u{200b}:error::x"), ": :error::x\n: :error::x");
        assert_eq!(clean("#\u{0}#[error]"), "# #[error]");
    }

    #[test]
    fn long_text_is_shortened() {
        assert!(clean(&"x".repeat(10_000_000)).len() < 100_000);
    }

    #[test]
    fn messages_do_not_quote_a_file_at_length() {
        let quoted = format!("marks.csv:3: `{}` is not a number\nsecond line", "x\u{1b}[2J".repeat(450_000));
        let short = message(&quoted);
        assert!(short.starts_with("marks.csv:3: `xxx") && short.len() < 700, "{}", short.len());
        assert_eq!(message("a.yml:1: no such key\n"), "a.yml:1: no such key");
    }

    #[test]
    fn names_are_printed_without_terminal_controls() {
        assert_eq!(harmless("a\u{1b}[31m\u{202e}sr.tp ü 🎨"), "a\\u{1b}[31m\\u{202e}sr.tp ü 🎨");
        assert_eq!(harmless(&"x".repeat(1000)).chars().count(), 201);
    }
}
