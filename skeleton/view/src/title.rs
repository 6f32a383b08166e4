//! The title of the window.

use arty::cli::Algorithm;

use crate::part::Picture;
use crate::renderer::Frame;
use crate::view::{Against, Balance, name};
use crate::viewer::Viewer;

/// The title: scene, technique, samples, speed, time, error.
pub fn title(scene: &str, viewer: &Viewer, frame: Option<&Frame>) -> String {
    let view = viewer.view();
    let bounces = match view.algorithm {
        Algorithm::PathTracer(settings) => format!(", {} bounces", settings.max_bounces),
        Algorithm::Debug(_) => String::new(),
    };
    let paused = if viewer.paused { "paused, " } else { "" };
    // The state of another view would be read as that of this one.
    let pictures = match frame {
        Some(frame) if frame.view == view => frame.pictures.iter().map(state).collect::<Vec<_>>().join(" | "),
        _ => name(view.algorithm).to_owned(),
    };
    let balance = match (view.against, view.balance) {
        (Some(Against::Algorithm(_)), Balance::EqualSamples) => ", equal samples",
        (Some(Against::Algorithm(_)), Balance::EqualTime) => ", equal time",
        (Some(Against::Reference), _) => " | reference",
        (None, _) => "",
    };
    format!("{scene}: {paused}{pictures}{balance}{bounces} (? shows the keys)")
}

fn state(picture: &Picture) -> String {
    let Picture { samples, time, .. } = *picture;
    let seconds = time.as_secs_f64();
    let all = (picture.image.pixels().len() as u64 * samples) as f64;
    let error = picture.relative_mse.map_or(String::new(), |error| format!(", relMSE {error:.2e}"));
    let speed = all / seconds.max(1e-9) * 1e-6;
    format!("{} {samples} spp, {speed:.2} M samples/s, {seconds:.1} s{error}", name(picture.algorithm))
}
