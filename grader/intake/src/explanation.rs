//! Written explanations, which a tutor marks.

use verdict::submission::{Explanation, ExplanationKind};

use super::names::base;
use super::text::decode;

/// Makes an explanation from a file.
pub(super) fn explanation(name: &str, bytes: &[u8]) -> Explanation {
    let is_pdf = base(name).to_lowercase().ends_with(".pdf");
    let text = if is_pdf { None } else { decode(bytes, &mut Vec::new()).ok() };
    Explanation {
        name: name.to_owned(),
        kind: if text.is_some() { ExplanationKind::Text } else { ExplanationKind::Binary },
        bytes: bytes.len(),
        hash: blake3::hash(bytes).to_hex().to_string(),
        text,
    }
}

/// True for texts of the project or its tools, which are in a submission if a student sends the whole checkout.
pub(super) fn is_ordinary(explanation: &Explanation) -> bool {
    let name = base(&explanation.name).to_lowercase();
    let ordinary = ["readme", "architecture", "sheet", "kill-matrix", "license", "licence", "cmakelists"];
    ordinary.iter().any(|start| name.starts_with(start))
}
