//! Everything in the window: pictures, wipe, paths, panels.

use arty::camera::Camera;
use arty::film::Anomaly;
use arty::image::Image;

use crate::canvas::{Canvas, Ink};
use crate::fit::Fit;
use crate::keys::HELP;
use crate::path;
use crate::path::vertices::Areas;
use crate::reference::Reference;
use crate::renderer::Frame;
use crate::view::{Against, name};
use crate::viewer::Viewer;

/// Colour of text in panels, `0x00RRGGBB`.
const TEXT: u32 = 0xe8_e8_e8;
/// Colour of errors.
const ERROR: u32 = 0xff_90_70;
/// Colour around the picture.
const GROUND: u32 = 0x20_20_20;

/// What is shown besides the state of the viewer.
pub struct Shown<'a> {
    /// The latest pictures; `None` before the first.
    pub frame: Option<&'a Frame>,
    /// The reference.
    pub reference: Option<&'a Reference>,
    /// Lights of the scene.
    pub lights: Areas<'a>,
    /// Why there is no new picture: messages of the compiler, or of a panic.
    pub failure: Option<&'a str>,
}

/// Paints the window.
pub fn paint(canvas: &mut Canvas<'_>, viewer: &Viewer, shown: &Shown<'_>) {
    let window = (canvas.width as u32, canvas.height as u32);
    let fit = Fit::new(viewer.size(), window);
    // On fine screens, letters of 8 pixels would be too small.
    let scale = (canvas.height as i32 / 700).max(1);
    canvas.pixels.fill(GROUND);
    if let Some(frame) = shown.frame {
        pictures(canvas, &fit, viewer, frame, shown.reference);
        if viewer.wipe.is_some() {
            labels(canvas, &fit, viewer, frame, scale);
        }
    }
    if let Some(traced) = viewer.paths() {
        let camera = Camera::new(&viewer.camera.now(), viewer.size().0, viewer.size().1);
        path::draw(canvas, &fit, &camera, traced, shown.lights);
        if viewer.numbers {
            canvas.panel(4, 4, scale, &path::describe(traced, shown.lights));
        }
    }
    if viewer.help {
        let lines = HELP.map(|(keys, what)| (format!("{keys:<24}{what}"), TEXT));
        canvas.panel(4, 4, scale, &lines);
    }
    messages(canvas, viewer, shown, scale);
}

fn pictures(
    canvas: &mut Canvas<'_>,
    fit: &Fit,
    viewer: &Viewer,
    frame: &Frame,
    reference: Option<&Reference>,
) {
    let left = frame.pictures.first().map(|picture| &picture.image);
    let right = match frame.view.against {
        Some(Against::Algorithm(_)) => frame.pictures.get(1).map(|picture| &picture.image),
        Some(Against::Reference) => reference.map(|reference| &reference.image),
        None => None,
    };
    let Some(left) = left else { return };
    let divider = right.map_or(f32::INFINITY, |_| viewer.divider * viewer.size().0 as f32);
    let (left, right) = (Colors::new(left, viewer), right.map(|image| Colors::new(image, viewer)));
    for y in 0..canvas.height {
        let row = &mut canvas.pixels[y * canvas.width..][..canvas.width];
        for (x, pixel) in row.iter_mut().enumerate() {
            let place = fit.to_picture((x as f32 + 0.5, y as f32 + 0.5));
            let colors = if place.0 < divider { &left } else { right.as_ref().unwrap_or(&left) };
            *pixel = colors.at(place).unwrap_or(GROUND);
        }
    }
}

/// The colours of a picture on the screen.
struct Colors {
    width: usize,
    height: usize,
    colors: Vec<u32>,
    /// Pixels of this picture per pixel of one that is not coarse.
    ratio: (f32, f32),
}

impl Colors {
    fn new(image: &Image, viewer: &Viewer) -> Self {
        let (width, height) = (image.width(), image.height());
        let colors = image.pixels().iter().map(|&pixel| viewer.look.color(pixel)).collect();
        let full = viewer.size();
        Self { width, height, colors, ratio: (width as f32 / full.0 as f32, height as f32 / full.1 as f32) }
    }

    /// The colour at a place in the picture; `None` outside.
    fn at(&self, (x, y): (f32, f32)) -> Option<u32> {
        let inside = |place: f32, size: usize| (0.0..size as f32).contains(&place).then_some(place as usize);
        let (x, y) = (inside(x * self.ratio.0, self.width)?, inside(y * self.ratio.1, self.height)?);
        self.colors.get(y * self.width + x).copied()
    }
}

/// The divider of a wipe, and what is at both sides.
fn labels(canvas: &mut Canvas<'_>, fit: &Fit, viewer: &Viewer, frame: &Frame, scale: i32) {
    let (width, height) = viewer.size();
    let column = viewer.divider * width as f32;
    let (top, bottom) = (fit.to_window((column, 0.0)), fit.to_window((column, height as f32)));
    canvas.line(top, bottom, 1.0, Ink(0xff_ff_ff, 0.8));
    let label = |index: usize| {
        frame.pictures.get(index).map_or("reference".to_owned(), |picture| {
            let error = picture.relative_mse.map_or(String::new(), |error| format!(", relMSE {error:.2e}"));
            let (samples, seconds) = (picture.samples, picture.time.as_secs_f64());
            format!("{} {samples} spp {seconds:.1} s{error}", name(picture.algorithm))
        })
    };
    let (left, right) = (label(0), label(1));
    let (x, y) = (bottom.0 as i32, bottom.1 as i32 - 22 * scale);
    let width = 8 * scale * (left.chars().count() as i32 + 1) + 4 * scale;
    canvas.panel(x - width - 4, y, scale, &[(left, TEXT)]);
    canvas.panel(x + 4, y, scale, &[(right, TEXT)]);
}

/// What was done last, samples that no correct estimator returns, and why there is no new picture.
fn messages(canvas: &mut Canvas<'_>, viewer: &Viewer, shown: &Shown<'_>, scale: i32) {
    let mut lines: Vec<(String, u32)> = Vec::new();
    let longest = (canvas.width as i32 / (8 * scale) - 2).max(8) as usize;
    if let Some(failure) = shown.failure {
        lines.extend(failure.lines().map(|line| (line.chars().take(longest).collect(), ERROR)));
    }
    for picture in shown.frame.iter().flat_map(|frame| &frame.pictures) {
        let anomalies = &picture.anomalies;
        // The place of a coarse picture is not that of the picture.
        if let Some(Anomaly { x, y, sample, .. }) = anomalies.first.first()
            && picture.samples > 0
        {
            let count = anomalies.non_finite + anomalies.negative;
            let text =
                format!("{count} samples are NaN, infinite or negative: first ({x}, {y}), sample {sample}");
            lines.push((text, ERROR));
        }
    }
    lines.extend(viewer.message.iter().map(|message| (message.clone(), TEXT)));
    if !lines.is_empty() {
        let height = 11 * scale * lines.len() as i32 + 5 * scale;
        canvas.panel(4, canvas.height as i32 - height - 4, scale, &lines);
    }
}
