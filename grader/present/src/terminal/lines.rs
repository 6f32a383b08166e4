//! Lines of text on a terminal.

use std::io::{self, Write};

use anstyle::{AnsiColor, Style};

use crate::words::verdict as verdict_word;
use verdict::check::Verdict;

/// A text, indented; broken at the width of a terminal.
pub(super) fn paragraph(
    out: &mut impl Write,
    indent: &str,
    text: &str,
    width: Option<usize>,
) -> io::Result<()> {
    match width {
        Some(width) => {
            let options = textwrap::Options::new(width).initial_indent(indent).subsequent_indent(indent);
            // Commands and paths are not broken inside.
            let options = options
                .break_words(false)
                .word_splitter(textwrap::WordSplitter::NoHyphenation)
                .word_separator(textwrap::WordSeparator::AsciiSpace);
            writeln!(out, "{}", textwrap::fill(text, options))
        }
        None => writeln!(out, "{indent}{text}"),
    }
}

/// As much of a text as fits in a line of the terminal.
pub(crate) fn one_line(text: &str) -> String {
    let width = textwrap::termwidth().saturating_sub(1).max(20);
    let text = text.lines().next().unwrap_or_default();
    if text.chars().count() <= width {
        return text.to_owned();
    }
    text.chars().take(width - 1).chain(['…']).collect()
}

/// A text in the colour of a verdict.
pub(crate) fn paint(verdict: &Verdict, text: &str) -> String {
    let color = match verdict {
        Verdict::Pass => AnsiColor::Green,
        Verdict::Inconclusive | Verdict::Skipped { .. } => AnsiColor::Yellow,
        Verdict::Fail | Verdict::NotRun { .. } => AnsiColor::Red,
    };
    let style = color.on_default();
    format!("{style}{text}{style:#}")
}

/// A text in bold letters.
pub(super) fn bold(text: &str) -> String {
    let style = Style::new().bold();
    format!("{style}{text}{style:#}")
}

/// The word for a verdict, where failures must be found at a glance.
pub(crate) fn loud(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Fail => "FAIL",
        other => verdict_word(other),
    }
}
