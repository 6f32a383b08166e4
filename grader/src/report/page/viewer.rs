//! One picture of the page, with its controls and its data.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use half::f16;
use maud::{Markup, PreEscaped, html};

use crate::report::pictures::Picture;

/// What can be shown: the value that the script knows, and its label.
const MODES: [(&str, &str); 5] = [
    ("submission", "hand-in"),
    ("reference", "reference"),
    ("difference", "difference"),
    ("z", "z (±5)"),
    ("flip", "FLIP"),
];

/// A figure that the script of the page brings to life. Names of radio buttons end in `index`.
pub(super) fn figure(index: usize, picture: &Picture) -> Markup {
    let Picture { scene, technique, width, height, samples, max_bounces, .. } = picture;
    let planes = [
        ("submission", encode(picture.submission.iter().flatten())),
        ("reference", encode(picture.reference.iter().flatten())),
        ("z", encode(picture.z.iter())),
        ("flip", encode(picture.flip.iter())),
    ];
    let label = format!("{scene}, {technique}");
    let error = picture.error();
    let flip = error.flip.map_or(String::new(), |flip| format!(", FLIP {flip:.3}"));
    let errors =
        format!("relMSE {:.3}, MSE {:.3}, SMAPE {:.3}{flip}", error.relative_mse, error.mse, error.smape);
    html! {
        figure data-width=(width) data-height=(height) {
            figcaption { b { (label) } " " span.soft { (samples) " samples per pixel, up to " (max_bounces) " bounces; with so few of them: " (errors) } }
            div.viewer {
                div { canvas width=(width) height=(height) tabindex="0" aria-label=(label) {} }
                div.controls {
                    p { @for (value, text) in MODES { label {
                        input type="radio" name={ "mode" (index) } value=(value) checked[value == "submission"]; " " (text)
                    } } }
                    p { label { "exposure " input type="range" name={ "exposure" (index) } min="-6" max="8" step="0.25" value="0"; } }
                    p { label { "wipe to the reference " input type="range" name={ "wipe" (index) } min="0" max="100" value="100"; } }
                    p { label { "tone map " select name={ "curve" (index) } {
                        option value="clip" { "sRGB, cut off" } option value="aces" { "ACES" } option value="reinhard" { "Reinhard" }
                    } } }
                    p.soft { "In difference and z, orange is too bright and blue too dark. z takes in 5 × 5 pixels." }
                    pre.probe {}
                }
            }
            @for (name, data) in planes { script type="text/plain" data-plane=(name) { (PreEscaped(data)) } }
        }
    }
}

/// Half floats, little endian, in Base64.
fn encode<'a>(values: impl Iterator<Item = &'a f64>) -> String {
    let bytes: Vec<u8> = values.flat_map(|&value| f16::from_f64(value).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}
