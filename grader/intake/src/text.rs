//! Decoding of sources and explanations.

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};

use super::{Note, Refusal};

/// Decodes a source. Bytes that are neither UTF-8 nor marked as UTF-16 are read as Windows-1252, so that an umlaut in a
/// comment does not cost all points.
pub(super) fn decode(bytes: &[u8], notes: &mut Vec<Note>) -> Result<String, Refusal> {
    match something_else(bytes) {
        Some(what) => Err(Refusal::NotSource(what.to_owned())),
        None => decode_text(bytes, notes),
    }
}

/// Decodes a text of any format.
pub(super) fn decode_text(bytes: &[u8], notes: &mut Vec<Note>) -> Result<String, Refusal> {
    let text = match Encoding::for_bom(bytes) {
        Some((encoding, length)) => {
            notes.push(if encoding == UTF_8 { Note::ByteOrderMark } else { Note::Utf16 });
            let (text, wrong) = encoding.decode_without_bom_handling(&bytes[length..]);
            if wrong && encoding != UTF_8 {
                return Err(Refusal::Encoding);
            }
            if wrong { windows_1252(&bytes[length..], notes) } else { text.into_owned() }
        }
        None => windows_1252(bytes, notes),
    };
    if text.contains('\0') {
        return Err(Refusal::NulBytes);
    }
    if text.trim().is_empty() {
        return Err(Refusal::Empty);
    }
    if text.contains('\r') {
        notes.push(Note::LineEnds);
    }
    Ok(with_our_line_ends(&text))
}

/// Decodes UTF-8, or else Windows-1252.
fn windows_1252(bytes: &[u8], notes: &mut Vec<Note>) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(error) => {
            let before = &bytes[..error.valid_up_to()];
            notes.push(Note::Windows1252(1 + before.iter().filter(|&&byte| byte == b'\n').count()));
            WINDOWS_1252.decode_without_bom_handling(bytes).0.into_owned()
        }
    }
}

/// Replaces line ends by `\n`.
pub(super) fn with_our_line_ends(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}

/// Recognizes files that are often renamed to `.rs`, by their first bytes; `None` for anything else.
fn something_else(bytes: &[u8]) -> Option<&'static str> {
    let kinds: [(&[u8], &str); 8] = [
        (b"PK\x03\x04", "a zip archive or an Office document"),
        (b"\xd0\xcf\x11\xe0", "an old Word document"),
        (b"%PDF", "a PDF"),
        (b"{\\rtf", "an RTF document"),
        (b"\x1f\x8b", "a gzip archive"),
        (b"\x7fELF", "a program"),
        (b"MZ\x90", "a program"),
        (b"<!DOCTYPE html", "a web page"),
    ];
    kinds.iter().find(|(start, _)| bytes.starts_with(start)).map(|&(_, what)| what)
}
