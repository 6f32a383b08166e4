//! The error against a reference during rendering, for plots over time.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::Algorithm;
use super::args::Args;
use super::exit::Failure;
use super::messages;
use super::numbers::counted;
use super::plan::Plan;
use super::progress::Progress;
use crate::diagnostic::Diagnostic;
use crate::film::Film;
use crate::image::error::{Truth, mse, relative_mse, trimmed_relative_mse};
use crate::image::exr::ExrFile;
use crate::image::{Image, check_writable, write_aside};
use crate::scene::{Defaults, SceneDescription};

/// Ratio of the numbers of samples of two consecutive rows: enough for a logarithmic axis.
const STEP: f64 = 1.2;

/// Column names.
const HEADER: &str = "samples_per_pixel,seconds,relative_mse,trimmed_relative_mse,mse\n";

/// The reference image.
#[derive(Debug)]
pub(super) struct Reference {
    path: PathBuf,
    width: u32,
    height: u32,
    /// Maximum number of bounces, `None` if the file does not tell.
    max_bounces: Option<u32>,
    mean: Vec<[f64; 3]>,
    /// Variance of the mean, `None` if the file has none.
    variance: Option<Vec<[f64; 3]>>,
}

impl Reference {
    /// Reads the reference given on the command line, if any. Warns if it shows another scene.
    ///
    /// # Errors
    ///
    /// If the file is not an OpenEXR file with a colour image of finite values.
    pub(super) fn open(args: &Args, scene: &SceneDescription) -> Result<Option<Self>, Diagnostic> {
        let Some(path) = &args.reference else { return Ok(None) };
        let file = ExrFile::read(path)?;
        let refuse = |message: &str| Diagnostic::about(path, message);
        let picture = file.layer("").ok_or_else(|| {
            let names: Vec<&str> = file.channels.keys().map(String::as_str).collect();
            refuse(&format!(
                "it has no channels R, G and B, but {}; save the layer that you mean as R, G and B",
                names.join(", ")
            ))
        })?;
        if picture.pixels().iter().any(|pixel| !pixel.is_finite()) {
            return Err(refuse("it contains NaN or infinite values"));
        }
        if file.metadata.get("arty:scene_hash").is_some_and(|hash| *hash != scene.hash()) {
            messages::warning(refuse(
                "it was rendered from another scene, or from an earlier version of this one",
            ));
        }
        let sides = (u32::try_from(file.width), u32::try_from(file.height));
        let (Ok(width), Ok(height)) = sides else { return Err(refuse("it is too large")) };
        let variance = file.layer("variance").map(|layer| values(&layer));
        let variance = variance.filter(|list| list.iter().flatten().all(|value| value.is_finite()));
        let max_bounces = file.metadata.get("arty:max_bounces").and_then(|text| text.parse().ok());
        Ok(Some(Self { path: path.clone(), width, height, max_bounces, mean: values(&picture), variance }))
    }

    /// The defaults of a scene, with the size and the maximum number of bounces of this reference.
    pub(super) fn defaults(&self, of_scene: Defaults) -> Defaults {
        let max_bounces = self.max_bounces.or(of_scene.max_bounces);
        Defaults { width: Some(self.width), height: Some(self.height), max_bounces }
    }

    fn truth(&self) -> Truth<'_> {
        Truth { mean: &self.mean, variance: self.variance.as_deref() }
    }
}

/// The table of errors.
#[derive(Debug)]
pub(super) struct ErrorLog {
    reference: Reference,
    file: PathBuf,
    quiet: bool,
    /// The contents of the CSV file.
    text: String,
    /// Samples per pixel in the last row.
    last: u64,
}

impl ErrorLog {
    /// Starts a log.
    ///
    /// # Errors
    ///
    /// If the image size differs from that of the reference, or the file cannot be written.
    pub(super) fn new(reference: Reference, args: &Args, plan: &Plan) -> Result<Self, Failure> {
        let Reference { width, height, max_bounces, ref path, .. } = reference;
        if (width, height) != (plan.width, plan.height) {
            let message = format!(
                "the reference has {width} x {height} pixels, the image would have {} x {}; omit --width and --height \
                 to render it in the size of the reference",
                plan.width, plan.height
            );
            return Err(Diagnostic::about(path, message).into());
        }
        if let (Algorithm::PathTracer(settings), Some(bounces)) = (plan.algorithm, max_bounces)
            && settings.max_bounces != bounces
        {
            let message = format!(
                "it was rendered with up to {}, the image has {}",
                counted(bounces.into(), "bounce"),
                settings.max_bounces
            );
            messages::warning(Diagnostic::about(path, message));
        }
        let file = args.errors.clone().unwrap_or_else(|| default_file(&args.scene));
        check_writable(&file)?;
        Ok(Self { reference, file, quiet: args.quiet, text: HEADER.to_owned(), last: 0 })
    }

    /// Adds a row if it is due.
    pub(super) fn update(&mut self, film: &Film, seconds: f64, progress: &Progress) {
        if film.samples() as f64 >= STEP * self.last as f64 {
            self.row(film, seconds, progress);
        }
    }

    /// Adds the last row and writes the file.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub(super) fn finish(mut self, film: &Film, seconds: f64) -> Result<(), Diagnostic> {
        if film.samples() > self.last {
            self.row(film, seconds, &Progress::Hidden);
        }
        write_aside(&self.file, |writer| std::io::Write::write_all(writer, self.text.as_bytes()))?;
        if !self.quiet {
            messages::plain(format_args!("saved {}", self.file.display()));
        }
        Ok(())
    }

    fn row(&mut self, film: &Film, seconds: f64, progress: &Progress) {
        let samples = film.samples();
        if samples == 0 {
            return;
        }
        let picture: Vec<[f64; 3]> =
            film.pixels().iter().map(|pixel| pixel.mean().to_array().map(f64::from)).collect();
        let truth = self.reference.truth();
        let (relative, trimmed) = (relative_mse(&picture, truth), trimmed_relative_mse(&picture, truth));
        let absolute = mse(&picture, truth);
        // Writing into a string cannot fail.
        let _ = writeln!(self.text, "{samples},{seconds:.6},{relative:e},{trimmed:e},{absolute:e}");
        self.last = samples;
        if !self.quiet {
            progress.interject(|| {
                let line = format!(
                    "{samples:>8} samples {seconds:>9.2} s   relMSE {relative:.3e}   MSE {absolute:.3e}"
                );
                // `println` panics if the reader has closed the pipe.
                let _ = std::io::Write::write_all(&mut std::io::stdout(), format!("{line}\n").as_bytes());
            });
        }
    }
}

fn values(image: &Image) -> Vec<[f64; 3]> {
    image.pixels().iter().map(|pixel| pixel.to_array().map(f64::from)).collect()
}

/// The default CSV file of a scene, in the current folder.
fn default_file(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("image".as_ref()).to_owned();
    name.push(".errors.csv");
    name.into()
}
