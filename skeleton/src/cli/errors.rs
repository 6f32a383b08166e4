//! The error of the picture while it is rendered, for plots of error against time.

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

/// A row of the table is due when there are this many times the samples of the row before.
const STEP: f64 = 1.2;

/// The names of the columns.
const HEADER: &str = "samples_per_pixel,seconds,relative_mse,trimmed_relative_mse,mse\n";

/// The picture that the rendering is compared with.
#[derive(Debug)]
pub(super) struct Reference {
    path: PathBuf,
    width: u32,
    height: u32,
    /// How often its paths were scattered at most, where the file says so.
    max_bounces: Option<u32>,
    mean: Vec<[f64; 3]>,
    /// The variance of the mean, where the file has it.
    variance: Option<Vec<[f64; 3]>>,
}

impl Reference {
    /// The reference that the command line names, if it names one. One of another scene is warned of.
    ///
    /// # Errors
    ///
    /// If the file is no OpenEXR file with a colour picture of finite numbers in it.
    pub(super) fn open(args: &Args, scene: &SceneDescription) -> Result<Option<Self>, Diagnostic> {
        let Some(path) = &args.reference else { return Ok(None) };
        let file = ExrFile::read(path)?;
        let refuse = |message: &str| Diagnostic::about(path, message);
        let picture =
            file.layer("").ok_or_else(|| refuse("there is no picture with channels R, G, B in it"))?;
        if picture.pixels().iter().any(|pixel| !pixel.is_finite()) {
            return Err(refuse("not every pixel is a finite number, so nothing can be compared with it"));
        }
        if file.metadata.get("arty:scene_hash").is_some_and(|hash| *hash != scene.hash()) {
            messages::warning(refuse("it shows another scene, or this one before it was changed"));
        }
        let sides = (u32::try_from(file.width), u32::try_from(file.height));
        let (Ok(width), Ok(height)) = sides else { return Err(refuse("it is too large")) };
        let variance = file.layer("variance").map(|layer| values(&layer));
        let variance = variance.filter(|list| list.iter().flatten().all(|value| value.is_finite()));
        let max_bounces = file.metadata.get("arty:max_bounces").and_then(|text| text.parse().ok());
        Ok(Some(Self { path: path.clone(), width, height, max_bounces, mean: values(&picture), variance }))
    }

    /// The defaults of a scene with the size of this picture, and as many bounces.
    pub(super) fn defaults(&self, of_scene: Defaults) -> Defaults {
        let max_bounces = self.max_bounces.or(of_scene.max_bounces);
        Defaults { width: Some(self.width), height: Some(self.height), max_bounces }
    }

    fn truth(&self) -> Truth<'_> {
        Truth { mean: &self.mean, variance: self.variance.as_deref() }
    }
}

/// The errors so far.
#[derive(Debug)]
pub(super) struct ErrorLog {
    reference: Reference,
    file: PathBuf,
    quiet: bool,
    /// The table as it will be written.
    text: String,
    /// Samples per pixel of the last row.
    last: u64,
}

impl ErrorLog {
    /// A log for a rendering as planned.
    ///
    /// # Errors
    ///
    /// If the picture is to have another size than the reference, or the file cannot be written.
    pub(super) fn new(reference: Reference, args: &Args, plan: &Plan) -> Result<Self, Failure> {
        let Reference { width, height, max_bounces, ref path, .. } = reference;
        if (width, height) != (plan.width, plan.height) {
            let message = format!(
                "the reference has {width} x {height} pixels and the picture is to have {} x {}; \
                 leave out --width and --height to render it like the reference",
                plan.width, plan.height
            );
            return Err(Diagnostic::about(path, message).into());
        }
        if let (Algorithm::PathTracer(settings), Some(bounces)) = (plan.algorithm, max_bounces)
            && settings.max_bounces != bounces
        {
            let message = format!(
                "it has up to {}, the picture {}",
                counted(bounces.into(), "bounce"),
                settings.max_bounces
            );
            messages::warning(Diagnostic::about(path, message));
        }
        let file = args.errors.clone().unwrap_or_else(|| default_file(&args.scene));
        check_writable(&file)?;
        Ok(Self { reference, file, quiet: args.quiet, text: HEADER.to_owned(), last: 0 })
    }

    /// Takes a row, if it is time for one: as often as is good for a logarithmic axis.
    pub(super) fn update(&mut self, film: &Film, seconds: f64, progress: &Progress) {
        if film.samples() as f64 >= STEP * self.last as f64 {
            self.row(film, seconds, progress);
        }
    }

    /// Takes the last row and writes the file.
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
                // Not `println`, which panics if nobody reads any more.
                let _ = std::io::Write::write_all(&mut std::io::stdout(), format!("{line}\n").as_bytes());
            });
        }
    }
}

fn values(image: &Image) -> Vec<[f64; 3]> {
    image.pixels().iter().map(|pixel| pixel.to_array().map(f64::from)).collect()
}

/// The table of a scene's picture, in the current folder.
fn default_file(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("picture".as_ref()).to_owned();
    name.push(".errors.csv");
    name.into()
}
