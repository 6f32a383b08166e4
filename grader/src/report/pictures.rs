//! Pictures for the report page: what the hand-in renders, beside what the scene looks like.

use arty::image::exr::ExrFile;
use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use host::protocol::{RenderJob, Switches};
use serde::{Deserialize, Serialize};

use super::{Report, Verdict};
use crate::build::HandInProgram;
use crate::error::Result;
use crate::host_process::HostProcess;
use crate::image_error::{Truth, hdr_flip, mse, relative_mse, smape};
use crate::rubric::CheckKind;
use crate::workspace::Workspace;

/// A hand-in's picture of a scene. All lists are row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The scene.
    pub scene: String,
    /// The technique.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples of each pixel of the hand-in.
    pub samples: u64,
    /// What the hand-in renders.
    pub submission: Vec<[f64; 3]>,
    /// What is right.
    pub reference: Vec<[f64; 3]>,
    /// For each pixel the difference of the means around it, in standard errors.
    pub z: Vec<f64>,
    /// For each pixel how different it looks, from 0 to 1.
    pub flip: Vec<f64>,
}

/// **reference-image**: how far a picture with few samples is from the reference. Reported, and never deciding: most of
/// it is noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageError {
    /// The scene.
    pub scene: String,
    /// The technique.
    pub technique: Technique,
    /// The largest number of bounces.
    pub max_bounces: u32,
    /// Samples of each pixel of the hand-in.
    pub samples: u64,
    /// Mean squared error, in radiance squared.
    pub mse: f64,
    /// The same, relative to the reference.
    pub relative_mse: f64,
    /// Symmetric mean absolute error, from 0 to 1.
    pub smape: f64,
    /// How different it looks, from 0 to 1: the mean of HDR-FLIP. None where a picture is too small for it.
    pub flip: Option<f64>,
}

impl Picture {
    /// Its errors.
    pub fn error(&self) -> ImageError {
        let truth = Truth { mean: &self.reference, variance: None };
        let pixels = self.flip.len() as f64;
        ImageError {
            scene: self.scene.clone(),
            technique: self.technique,
            max_bounces: self.max_bounces,
            samples: self.samples,
            mse: mse(&self.submission, truth),
            relative_mse: relative_mse(&self.submission, truth),
            smape: smape(&self.submission, &self.reference),
            flip: (pixels > 0.0).then(|| self.flip.iter().sum::<f64>() / pixels),
        }
    }
}

/// The most pictures of a page.
const MOST: usize = 3;

/// What is shown where nothing is wrong.
const TELLING: [(&str, Technique); MOST] =
    [("cornell_box", Technique::Nee), ("cornell_box_glossy", Technique::Mis), ("veach_mis", Technique::Mis)];

/// Independent renderings, and samples of each pixel in each.
const BATCHES: u64 = 8;
const SAMPLES: u64 = 2;

/// By how much the stored references are rounded, as a share of their value: where nothing varies, that is no error.
const HALF_ROUNDING: f64 = 1.0 / 2048.0;

/// Pixels to each side that a z value takes in.
const RADIUS: usize = 2;

/// Pictures of the scenes and techniques whose means are wrong, else of a few that tell much. What cannot be shown is
/// left out: no picture decides anything.
///
/// # Errors
/// What is not the hand-in's doing.
pub fn pictures(
    workspace: &Workspace,
    hand_in: &HandInProgram,
    report: &Report,
    threads: usize,
    seed: u64,
) -> Result<Vec<Picture>> {
    let wrong = report.checks.iter().filter(|check| check.verdict == Verdict::Fail);
    let wrong = wrong.filter(|check| check.check == CheckKind::MeanBias);
    let wanted = wrong.map(|check| (check.scene.as_str(), check.technique)).chain(TELLING);
    let mut seen = Vec::new();
    let mut list = Vec::new();
    for wanted in wanted {
        if list.len() == MOST {
            break;
        }
        if !seen.contains(&wanted) {
            seen.push(wanted);
            list.extend(picture(workspace, hand_in, wanted, threads, seed)?);
        }
    }
    Ok(list)
}

fn picture(
    workspace: &Workspace,
    hand_in: &HandInProgram,
    (scene, technique): (&str, Technique),
    threads: usize,
    seed: u64,
) -> Result<Option<Picture>> {
    let description = arty::scene::file::load(&workspace.scene_file(scene))?.description;
    let Some((reference, width, height, max_bounces)) = half_size(workspace, scene, &description.hash())
    else {
        return Ok(None);
    };
    let mut process = HostProcess::start(hand_in, threads)?;
    let Ok(index) = process.load(&description)? else { return Ok(None) };
    let job = RenderJob {
        scene: index,
        settings: Settings { technique, max_bounces },
        width: width as u32,
        height: height as u32,
        seeds: (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect(),
        first_sample: 0,
        samples: SAMPLES,
        switches: Switches::default(),
    };
    let Ok(rendered) = process.render(&job)? else { return Ok(None) };
    let batches = rendered.batches;
    let mean_of = |pixel: usize| -> [f64; 3] {
        std::array::from_fn(|c| {
            batches.iter().map(|batch| f64::from(batch[pixel][c])).sum::<f64>() / BATCHES as f64
        })
    };
    let submission: Vec<[f64; 3]> = (0..reference.len()).map(mean_of).collect();
    let gray = |pixel: &[f32; 3]| pixel.iter().map(|&value| f64::from(value)).sum::<f64>();
    let variance_of_mean = |pixel: usize| {
        let mean = submission[pixel].iter().sum::<f64>();
        let squares: f64 = batches.iter().map(|batch| (gray(&batch[pixel]) - mean).powi(2)).sum();
        let rounding = HALF_ROUNDING * reference[pixel].iter().sum::<f64>();
        squares / (BATCHES - 1) as f64 / BATCHES as f64 + rounding * rounding
    };
    let variances: Vec<f64> = (0..reference.len()).map(variance_of_mean).collect();
    let differences = submission.iter().zip(&reference);
    let differences: Vec<f64> =
        differences.map(|(x, r)| x.iter().sum::<f64>() - r.iter().sum::<f64>()).collect();
    let flip = hdr_flip(&submission, &reference, width, height).map(|flip| flip.map).unwrap_or_default();
    Ok(Some(Picture {
        scene: scene.to_owned(),
        technique,
        max_bounces,
        width,
        height,
        samples: BATCHES * SAMPLES,
        z: z_map(&differences, &variances, width, height),
        flip,
        submission,
        reference,
    }))
}

/// The reference for looking at, at half its size, with its size and bounces; `None` if it is not there, shows another
/// scene, or does not say how many bounces it has.
fn half_size(workspace: &Workspace, scene: &str, hash: &str) -> Option<(Vec<[f64; 3]>, usize, usize, u32)> {
    let file = ExrFile::read(&workspace.picture_file(scene)).ok()?;
    let max_bounces = file.metadata.get("arty:max_bounces")?.parse().ok()?;
    let image =
        file.layer("").filter(|_| file.metadata.get("arty:scene_hash").is_some_and(|other| other == hash))?;
    let (width, height) = (image.width() / 2, image.height() / 2);
    let of_four = |x: usize, y: usize| -> [f64; 3] {
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| image[(2 * x + i, 2 * y + j)].to_array());
        std::array::from_fn(|c| four.iter().map(|pixel| f64::from(pixel[c])).sum::<f64>() / 4.0)
    };
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of_four(x, y)).collect();
    Some((pixels, width, height, max_bounces))
}

/// Sums of differences over a small square around each pixel, divided by the root of the sum of their variances: a
/// single pixel of few samples would say nothing. 0 where nothing varies and nothing differs.
fn z_map(differences: &[f64], variances: &[f64], width: usize, height: usize) -> Vec<f64> {
    let around = |list: &[f64], x: usize, y: usize| -> f64 {
        let rows = y.saturating_sub(RADIUS)..(y + RADIUS + 1).min(height);
        rows.map(|row| {
            let columns = x.saturating_sub(RADIUS)..(x + RADIUS + 1).min(width);
            list[row * width..][columns].iter().sum::<f64>()
        })
        .sum()
    };
    let z = |x: usize, y: usize| {
        let (sum, variance) = (around(differences, x, y), around(variances, x, y));
        // Black surroundings have no variance; a tiny one keeps true differences visible there.
        if sum == 0.0 { 0.0 } else { (sum / (variance + 1e-12).sqrt()).clamp(-1e4, 1e4) }
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| z(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::z_map;

    #[test]
    fn a_difference_stands_out_around_where_it_is() {
        let mut differences = vec![0.0; 12 * 10];
        differences[4 * 12 + 6] = 3.0;
        let z = z_map(&differences, &vec![1.0; 120], 12, 10);
        assert!((z[4 * 12 + 6] - 3.0 / 5.0).abs() < 1e-9, "one pixel of 25");
        assert_eq!((z[4 * 12 + 9], z[0]), (0.0, 0.0));
        assert!((z[2 * 12 + 4] - 0.6).abs() < 1e-9, "the corner of the square");
    }
}
