//! Words of others, before they enter a report.
//!
//! Panic messages and errors of the compiler say what the submission wants them to say. They are cleaned once, here,
//! when they are taken over; each format of the report then escapes what is special in it.

use std::path::Path;

/// Characters of one text that are kept.
const LONGEST: usize = 64 << 10;

/// The text without what terminals, editors or CI systems would take for a command: escape sequences, control
/// characters, changes of the direction of writing, lines that begin with `::`, and `##[`.
pub fn clean(text: &str) -> String {
    let mut cleaned = String::new();
    let mut left = LONGEST;
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

/// Passes over the rest of an escape sequence of a terminal: `[` up to a letter, `]` up to its end mark.
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
                // Without an end mark it ends with the line, so that it cannot swallow what comes after.
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

/// Characters without a width, and those that turn the direction of writing: text would not be what it looks like.
fn is_invisible(character: char) -> bool {
    matches!(
        character,
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
    )
}

/// Makes plain text of what GitHub, GitLab and Azure take for commands in a log.
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

/// A name that can be printed: without characters that move the cursor, colour a terminal, hide text or change the
/// direction of writing, and not longer than a line or two.
pub fn harmless(name: &str) -> String {
    const LONGEST: usize = 200;
    let mut text = String::new();
    for (index, letter) in name.chars().enumerate() {
        if index == LONGEST {
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

/// A path as an argument for a shell.
pub fn quote(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+@".contains(c);
    if text.chars().all(plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_stays_as_it_is() {
        let text = "error[E0599]: kein `bsdv` für `Hit`\n  --> render_pt.rs:12\n\t| std::f32::NAN <b> ≠ 🙂\n";
        assert_eq!(clean(text), text);
    }

    #[test]
    fn nothing_reaches_a_terminal_that_it_would_obey() {
        assert_eq!(clean("\u{1b}[31mred\u{1b}[0m \u{1b}[2J\u{1b}[1;1Hhome"), "red home");
        assert_eq!(clean("\u{1b}]0;title\u{7}a \u{1b}]8;;http://x\u{1b}\\link\u{1b}]8;;\u{1b}\\"), "a link");
        assert_eq!(clean("\u{1b}]never ended\nnext line"), "\nnext line");
        assert_eq!(clean("70 points\r0\u{8}\u{0}\u{7}\u{9b}31m"), "70 points031m");
        assert_eq!(clean("a\u{202e}cba\u{2066}\u{200b}"), "acba");
        assert_eq!(clean("\u{1b}c\u{1b}"), "");
    }

    #[test]
    fn nothing_in_a_log_is_taken_for_a_command() {
        assert_eq!(
            clean("x\n::error file=a::b\n  ::set-output name=x::y"),
            "x\n: :error file=a::b\n  : :set-output name=x::y"
        );
        assert_eq!(clean("a ##[error]b ##vso[task.x]c"), "a # #[error]b # #vso[task.x]c");
        // Not even one that only appears once something else is taken out of it.
        assert_eq!(clean("\u{1b}[0m::error::x\n:\u{200b}:error::x"), ": :error::x\n: :error::x");
        assert_eq!(clean("#\u{0}#[error]"), "# #[error]");
    }

    #[test]
    fn what_is_endless_is_shortened() {
        assert!(clean(&"x".repeat(10_000_000)).len() < 100_000);
    }

    #[test]
    fn names_are_shown_without_what_steers_a_terminal() {
        assert_eq!(harmless("a\u{1b}[31m\u{202e}sr.tp ü 🎨"), "a\\u{1b}[31m\\u{202e}sr.tp ü 🎨");
        assert_eq!(harmless(&"x".repeat(1000)).chars().count(), 201);
    }
}
