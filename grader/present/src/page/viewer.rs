//! The pictures of the page, one figure a scene, with their controls and their data.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};

use verdict::pictures::{ImageError, Picture};
use verdict::report::Report;
use verdict::text::quote;

use super::paths;
use crate::words;

/// What can be shown: the value that the script knows, and its label.
const MODES: [(&str, &str); 5] = [
    ("submission", "submission"),
    ("reference", "reference"),
    ("difference", "difference"),
    ("z", "z (±5)"),
    ("flip", "FLIP"),
];

/// Keys, and what they do while a picture has the focus.
const KEYS: [(&str, &str); 10] = [
    ("←↑↓→", "move to another pixel (with Shift: by ten)"),
    ("1 … 5", "submission, reference, difference, z, FLIP"),
    ("b n m", "technique: BSDF sampling, NEE, MIS"),
    ("f", "toggle between this picture and the reference"),
    ("+ −", "zoom; also Ctrl + wheel, or a double click"),
    ("e d", "exposure up, down"),
    ("[ ]", "wipe, to the reference or another technique"),
    ("p", "paths of the pixel that differs most"),
    (", .", "previous, next sample"),
    ("0", "reset"),
];

/// All pictures; nothing if there are none.
pub(super) fn section(report: &Report, pictures: &[&Picture]) -> Markup {
    html! {
        @if !pictures.is_empty() {
            h2 { "Pictures" }
            p.soft { "Move over a picture to read its pixels; click to hold one. Pictures with few samples are noisy: the checks \
                decide, not these pictures." }
            noscript { p { "The pictures need JavaScript, which is disabled in your browser." } }
            details.keys { summary { "keys" } dl { @for (key, what) in KEYS { div { dt { kbd { (key) } } dd { (what) } } } } }
            @for (index, picture) in pictures.iter().enumerate() { (figure(index, picture, report)) }
        }
    }
}

/// A figure that the script of the page brings to life. Names of radio buttons end in `index`.
fn figure(index: usize, picture: &Picture, report: &Report) -> Markup {
    let Picture { scene, width, height, samples, max_bounces, seeds, .. } = picture;
    let [path, scene_name] = [&report.submission.path, scene].map(|text| quote(text.as_ref()));
    let replay = format!(
        "cargo grader replay {path} --scene={scene_name} --max-bounces={max_bounces} --size={width}x{height}"
    );
    let seeds: Vec<String> = seeds.iter().map(u64::to_string).collect();
    let count = seeds.len() as u64 * samples;
    let last = picture.rendered.last().map(|rendered| rendered.technique);
    html! {
        figure.pictures data-width=(width) data-height=(height) data-replay=(replay) data-seeds=(seeds.join(" ")) data-samples=(samples) {
            figcaption { b { (scene) } " " span.soft { (words::count(count as usize, "sample")) " per pixel, at most " (words::count(*max_bounces as usize, "bounce")) } }
            div.viewer {
                div.stage {
                    div.over {
                        canvas.view tabindex="0" aria-label={ "pictures of " (scene) "; arrow keys move the pixel that is read" } {}
                        (paths::overlays(picture))
                    }
                    fieldset.techniques {
                        legend { "technique" }
                        @for rendered in &picture.rendered {
                            label {
                                input type="radio" name={ "technique" (index) } value=(rendered.technique) checked[last == Some(rendered.technique)];
                                canvas data-strip=(rendered.technique) {}
                                span { (rendered.technique) }
                                small.soft { (short(&rendered.error)) }
                            }
                        }
                        label.still { canvas data-strip="reference" {} span { "reference" } }
                    }
                }
                div.side {
                    div.controls {
                        fieldset { legend { "show" } @for (value, text) in MODES { label {
                            input type="radio" name={ "mode" (index) } value=(value) checked[value == "submission"]; " " (text)
                        } } }
                        p { label { "exposure " input type="range" name="exposure" min="-6" max="8" step="0.25" value="0"; } " " output name="stops" { "0" } }
                        p { label { "wipe " input type="range" name="wipe" min="0" max="100" value="100"; } " "
                            label { "to " select name="against" {
                                option value="reference" { "reference" }
                                @for rendered in &picture.rendered { option value=(rendered.technique) { (rendered.technique) } }
                            } } }
                        p { label { "zoom " input type="range" name="zoom" min="0" max="5" step="0.5" value="0"; } }
                        p { label { "tone map " select name="curve" {
                            option value="clip" { "sRGB, clipped" } option value="aces" { "ACES" } option value="reinhard" { "Reinhard" }
                        } } }
                        @if paths::are_there(picture) {
                            p { label { input type="checkbox" name="paths"; " paths of the pixel that differs most" } }
                            p.soft.rays hidden {
                                "Yellow: bounces. Shadow rays: green if they arrive, red and dashed if they are blocked; grey and dotted \
                                to light samples without one. The sample chosen below is bold." }
                        }
                        p.soft { "Difference and z: orange is too bright, blue too dark. z: difference in standard errors, over 5 × 5 pixels. \
                            Magenta: NaN or infinity." }
                    }
                    pre.probe aria-live="polite" {}
                    p.soft.again { label { "Replay sample " input type="number" name="sample" min="1" max=(count) value="1"; } " of this pixel (in a window with " code { "--view" } "):" }
                    pre.replay.command tabindex="0" {}
                }
            }
            (plane("reference", "", half_floats(&picture.reference)))
            @for rendered in &picture.rendered {
                @let technique = rendered.technique.to_string();
                (plane("submission", &technique, half_floats(&rendered.radiance)))
                (plane("z", &technique, rendered.z.iter().map(|z| z.cast_unsigned()).collect()))
                (plane("flip", &technique, rendered.flip.clone()))
            }
        }
    }
}

/// Numbers of one picture for the script, in Base64.
fn plane(name: &str, technique: &str, bytes: Vec<u8>) -> Markup {
    html! { script type="text/plain" data-plane=(name) data-technique=(technique) { (PreEscaped(STANDARD.encode(bytes))) } }
}

/// Half floats, little endian.
fn half_floats(bits: &[u16]) -> Vec<u8> {
    bits.iter().flat_map(|bits| bits.to_le_bytes()).collect()
}

/// The errors of a picture, in few words.
fn short(error: &ImageError) -> String {
    let flip = error.flip.map_or(String::new(), |flip| format!(", FLIP {flip:.3}"));
    format!("relMSE {:.3}, SMAPE {:.3}{flip}", error.relative_mse, error.smape)
}
