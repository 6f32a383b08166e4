//! Written explanations, which a tutor marks.

use verdict::submission::{Explanation, ExplanationKind};
use verdict::text::clean;

use super::names::base;
use super::text::decode_text;

/// Makes an explanation from a file. Of its text, what terminals would interpret is removed, and a long text is
/// shortened.
pub(super) fn explanation(name: &str, bytes: &[u8]) -> Explanation {
    let lower = base(name).to_lowercase();
    let is_text = [".txt", ".md", ".html", ".htm", ".tex"].iter().any(|end| lower.ends_with(end));
    let text = if is_text { decode_text(start_of(bytes), &mut Vec::new()).ok() } else { None };
    Explanation {
        name: name.to_owned(),
        kind: if text.is_some() { ExplanationKind::Text } else { ExplanationKind::Binary },
        bytes: bytes.len(),
        hash: blake3::hash(bytes).to_hex().to_string(),
        text: text.map(|text| clean(&text)),
    }
}

/// The part of a text that is kept, cut between two characters.
fn start_of(bytes: &[u8]) -> &[u8] {
    const MAX_BYTES: usize = 256 << 10;
    let is_start = |at: &usize| bytes[*at] & 0xc0 != 0x80;
    let end = if bytes.len() > MAX_BYTES { (MAX_BYTES - 4..MAX_BYTES).rev().find(is_start) } else { None };
    &bytes[..end.unwrap_or(bytes.len().min(MAX_BYTES))]
}

/// True for texts of the project or its tools, which are in a submission if a student sends the whole checkout.
pub(super) fn is_ordinary(explanation: &Explanation) -> bool {
    const ORDINARY: [&str; 16] = [
        "readme",
        "architecture",
        "sheet",
        "handout",
        "tutors",
        "sandbox",
        "report.html",
        "report-tutor.html",
        "kill-matrix",
        "calibration.md",
        "confusion.md",
        "limits.md",
        "features.md",
        "license",
        "licence",
        "cmakelists",
    ];
    let name = base(&explanation.name).to_lowercase();
    ORDINARY.iter().any(|start| name.starts_with(start))
}
