//! Image files.

use std::path::{Path, PathBuf};

use super::Algorithm;
use super::exit::Failure;
use super::messages;
use super::plan::Plan;
use super::session::Rendering;
use crate::diagnostic::Diagnostic;
use crate::film::{Film, Pixel};
use crate::image::exr::{ExrFile, Precision};
use crate::image::{Image, check_writable, write_png};
use crate::math::Rgb;
use crate::sampler::SamplerKind;
use crate::scene::SceneDescription;

/// An output file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Output {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Png,
    Exr,
}

impl Output {
    /// An output file; its extension determines the format.
    ///
    /// # Errors
    ///
    /// If the name ends in neither `.png` nor `.exr`.
    pub(super) fn new(path: PathBuf) -> Result<Self, String> {
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        let format = match extension.as_deref().and_then(|extension| extension.to_str()) {
            Some("png") => Format::Png,
            Some("exr") => Format::Exr,
            _ => return Err("must end in .png or .exr".to_owned()),
        };
        Ok(Self { path, format })
    }

    /// A PNG file with any name.
    pub(super) fn png(path: PathBuf) -> Self {
        Self { path, format: Format::Png }
    }

    /// The path of the file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Checks that the file can be written.
    ///
    /// # Errors
    ///
    /// As [`check_writable`].
    pub(super) fn check(&self) -> Result<(), Diagnostic> {
        check_writable(&self.path)
    }

    fn save(&self, plan: &Plan, provenance: &Provenance, rendering: &Rendering) -> Result<(), Diagnostic> {
        match self.format {
            Format::Png => write_png(&self.path, &mean(&rendering.film), plan.exposure),
            Format::Exr => provenance.exr(rendering).write(&self.path, Precision::Full),
        }
    }
}

/// Writes all output files.
///
/// # Errors
///
/// The last file that cannot be written; earlier failures are printed. All other files are written.
pub(super) fn save_all(
    plan: &Plan,
    provenance: &Provenance,
    rendering: &Rendering,
    quiet: bool,
) -> Result<(), Failure> {
    let mut failure = None;
    for output in &plan.outputs {
        match output.save(plan, provenance, rendering) {
            Ok(()) if quiet => {}
            Ok(()) => messages::plain(format_args!("saved {}", output.path().display())),
            Err(error) => {
                if let Some(earlier) = failure.replace(error) {
                    messages::error(earlier);
                }
            }
        }
    }
    failure.map_or(Ok(()), |error| Err(error.into()))
}

/// Metadata on how an image was rendered, as far as it is known before rendering.
///
/// The scene is identified by its file name and content hash, not by its folder, which means nothing on another
/// machine.
#[derive(Clone, Debug)]
pub(super) struct Provenance {
    scene: String,
    sampler: SamplerKind,
    entries: Vec<(&'static str, String)>,
}

impl Provenance {
    /// The metadata of an image of the scene in the given file.
    pub(super) fn new(scene: &Path, description: &SceneDescription, plan: &Plan) -> Self {
        let scene = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut entries = vec![
            ("arty:scene", scene.clone()),
            ("arty:scene_hash", description.hash()),
            ("arty:seed", plan.streams.seed.to_string()),
            ("arty:sampler", plan.streams.kind.name().to_owned()),
        ];
        match plan.algorithm {
            Algorithm::Debug(view) => {
                entries.push(("arty:algorithm", "debug".to_owned()));
                entries.push(("arty:show", view.name().to_owned()));
            }
            Algorithm::PathTracer(settings) => {
                entries.push(("arty:algorithm", "pt".to_owned()));
                entries.push(("arty:technique", settings.technique.to_string()));
                entries.push(("arty:max_bounces", settings.max_bounces.to_string()));
            }
        }
        Self { scene, sampler: plan.streams.kind, entries }
    }

    /// The name of the image in a viewer.
    pub(super) fn title(&self) -> &str {
        &self.scene
    }

    /// The OpenEXR file: `R`, `G`, `B` are the mean of the samples, `variance.R`, … the variance of that mean.
    ///
    /// With fewer than two samples per pixel, or samples that are not independent, the variance cannot be estimated, and
    /// the layer is omitted.
    fn exr(&self, rendering: &Rendering) -> ExrFile {
        let film = &rendering.film;
        let mut file = ExrFile::new(&mean(film));
        if film.samples() >= 2 && self.sampler == SamplerKind::Independent {
            file = file.with_layer("variance", &image(film, Pixel::variance_of_mean));
        }
        let anomalies = film.anomalies();
        let results = [
            ("arty:samples_per_pixel", film.samples().to_string()),
            ("arty:render_seconds", format!("{:.6}", rendering.elapsed.as_secs_f64())),
            ("arty:non_finite", anomalies.non_finite.to_string()),
            ("arty:negative", anomalies.negative.to_string()),
            ("arty:interrupted", rendering.interrupted.to_string()),
        ];
        let entries = self.entries.iter().map(|(name, value)| (*name, value.clone())).chain(results);
        entries.fold(file, |file, (name, value)| file.with_metadata(name, value))
    }
}

/// The mean of each pixel: the estimate of its radiance.
pub(super) fn mean(film: &Film) -> Image {
    image(film, Pixel::mean)
}

fn image(film: &Film, value: impl Fn(&Pixel) -> Rgb) -> Image {
    let pixels = film.pixels().iter().map(value).collect();
    Image::from_pixels(film.width() as usize, film.height() as usize, pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_determines_the_format() {
        let format = |name: &str| Output::new(name.into()).map(|output| output.format);
        assert_eq!(format("a/x.png"), Ok(Format::Png));
        assert_eq!(format("x.EXR"), Ok(Format::Exr));
        for name in ["x", "x.jpg", ".png", "x.png/", "x.pn g", ""] {
            let expected = if name == "x.png/" { Ok(Format::Png) } else { Err("must end".to_owned()) };
            assert_eq!(format(name).map_err(|message| message[..8].to_owned()), expected, "{name}");
        }
    }
}
