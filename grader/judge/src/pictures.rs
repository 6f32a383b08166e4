//! Rendering a submission's pictures for the report page.

mod paths;

use arty::camera::Camera;
use arty::image::exr::ExrFile;
use arty::integrator::{Settings, Technique};
use arty::sampler::batch_seed;
use arty::scene::SceneDescription;
use host::protocol::RenderJob;
use rayon::prelude::*;

use crate::image_error::hdr_flip;
use harness::build::SubmissionProgram;
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::workspace::Workspace;
use verdict::check::{CheckKind, Reason, Verdict};
use verdict::error::Result;
use verdict::pictures::{Picture, THUMBNAIL_SCENE, half_bits};
use verdict::report::Report;
use verdict::rubric::Rubric;

/// Maximum number of scenes on a page: each takes 0.8 of 3 megabytes.
pub const MAX_PICTURES: usize = 3;

/// Number of batches, and samples per pixel of each batch.
const BATCHES: u64 = 8;
const SAMPLES: u64 = 2;

/// Relative rounding error of the stored references, which are half floats.
const HALF_ROUNDING: f64 = 1.0 / 2048.0;

/// Radius in pixels of the square that a z value covers.
const RADIUS: usize = 2;

/// Renders at most `max_pictures` pictures: of the thumbnail scene, for the overview of a class, of scenes whose mean is
/// wrong, and of those that the rubric names. Scenes without a display reference are omitted. A submission that crashed or exceeded its time limit is not
/// rendered.
///
/// # Errors
/// If the grader itself fails.
pub fn pictures(
    workspace: &Workspace,
    rubric: &Rubric,
    submission: &SubmissionProgram,
    report: &Report,
    threads: usize,
    seed: u64,
    max_pictures: usize,
) -> Result<Vec<Picture>> {
    let mut list = Vec::new();
    if report.checks.iter().any(|check| matches!(check.reason, Reason::Timeout | Reason::Crash)) {
        return Ok(list);
    }
    let wrong = report.checks.iter().filter(|check| check.verdict == Verdict::Fail);
    let wrong =
        wrong.filter(|check| check.id.kind == CheckKind::MeanBias).map(|check| check.id.scene.as_str());
    let mut seen: Vec<&str> = Vec::new();
    let named = rubric.pictures.iter().map(String::as_str);
    for scene in [THUMBNAIL_SCENE].into_iter().chain(wrong).chain(named) {
        if list.len() == max_pictures {
            break;
        }
        if !seen.contains(&scene) {
            seen.push(scene);
            list.extend(picture(workspace, &rubric.techniques, submission, scene, threads, seed)?);
        }
    }
    Ok(list)
}

fn picture(
    workspace: &Workspace,
    techniques: &[Technique],
    submission: &SubmissionProgram,
    scene: &str,
    threads: usize,
    seed: u64,
) -> Result<Option<Picture>> {
    let description = arty::scene::file::load(&workspace.scene_file(scene))?.description;
    let Some(DisplayReference { reference, width, height, max_bounces }) =
        half_size_reference(workspace, scene, &description)
    else {
        return Ok(None);
    };
    let mut process = HostProcess::start(submission, threads)?;
    let Ok(index) = apart(process.load(&description))? else { return Ok(None) };
    let mut picture = Picture {
        scene: scene.to_owned(),
        max_bounces,
        width,
        height,
        seeds: (0..BATCHES).map(|batch| batch_seed(seed, batch)).collect(),
        samples: SAMPLES,
        reference: half_bits(&reference),
        rendered: Vec::new(),
    };
    let mut all = Vec::new();
    for &technique in techniques {
        let job = RenderJob::new(
            index,
            Settings { technique, max_bounces },
            [width as u32, height as u32],
            picture.seeds.clone(),
            SAMPLES,
        );
        let Ok(rendered) = apart(process.render(&job))? else { break };
        all.push((technique, rendered.batches));
    }
    // The submission waits; the comparisons run in parallel, one per technique.
    let compared = all.par_iter().map(|(technique, batches)| {
        let (means, z) = mean_and_z(batches, &reference, width, height);
        let flip = hdr_flip(&means, &reference, width, height).map(|flip| flip.map).unwrap_or_default();
        (*technique, means, z, flip)
    });
    let camera = Camera::new(&description.camera, width as u32, height as u32);
    for (technique, means, z, flip) in compared.collect::<Vec<_>>() {
        picture.add(technique, (&means, &reference), &z, &flip);
        let settings = Settings { technique, max_bounces };
        let worst = worst_pixel(&means, &reference, &z);
        let pixel = [(worst % width) as u32, (worst / width) as u32];
        let paths = paths::record(&mut process, index, settings, &picture, &camera, pixel)?;
        if let Some(rendered) = picture.rendered.last_mut() {
            rendered.paths = paths;
        }
    }
    Ok((!picture.rendered.is_empty()).then_some(picture))
}

/// Means over all batches, and their z values against the reference.
fn mean_and_z(
    batches: &[Vec<[f32; 3]>],
    reference: &[[f64; 3]],
    width: usize,
    height: usize,
) -> (Vec<[f64; 3]>, Vec<f64>) {
    let count = batches.len() as f64;
    let mean_of = |pixel: usize| -> [f64; 3] {
        std::array::from_fn(|c| batches.iter().map(|batch| f64::from(batch[pixel][c])).sum::<f64>() / count)
    };
    let means: Vec<[f64; 3]> = (0..reference.len()).map(mean_of).collect();
    let gray = |pixel: &[f32; 3]| pixel.iter().map(|&value| f64::from(value)).sum::<f64>();
    let variance_of_mean = |pixel: usize| {
        let mean = means[pixel].iter().sum::<f64>();
        let squares: f64 = batches.iter().map(|batch| (gray(&batch[pixel]) - mean).powi(2)).sum();
        let rounding = HALF_ROUNDING * reference[pixel].iter().sum::<f64>();
        squares / (count - 1.0) / count + rounding * rounding
    };
    let variances: Vec<f64> = (0..reference.len()).map(variance_of_mean).collect();
    let pairs = means.iter().zip(reference);
    let differences: Vec<f64> = pairs.map(|(x, r)| x.iter().sum::<f64>() - r.iter().sum::<f64>()).collect();
    let z = z_map(&differences, &variances, width, height);
    (means, z)
}

/// Index of the pixel that differs most from the reference: the first that is not finite, or else that with the greatest z
/// of those that are not black in both, as beside an object, where there are no paths.
fn worst_pixel(means: &[[f64; 3]], reference: &[[f64; 3]], z: &[f64]) -> usize {
    let rank = |pixel: usize| {
        if [means[pixel], reference[pixel]] == [[0.0; 3]; 2] {
            return -1.0;
        }
        let is_finite = means[pixel].iter().all(|value| value.is_finite());
        // Beside a pixel that is not finite, z is NaN.
        if is_finite { z[pixel].abs().max(0.0) } else { f64::INFINITY }
    };
    (0..means.len()).rev().max_by(|&a, &b| rank(a).total_cmp(&rank(b))).unwrap_or(0)
}

/// A reference picture for display.
pub(crate) struct DisplayReference {
    /// Linear radiance, row by row from the top.
    pub(crate) reference: Vec<[f64; 3]>,
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) max_bounces: u32,
}

/// The display reference at half its size; `None` if it does not exist, shows another version of the scene, or does not
/// record its number of bounces.
pub(crate) fn half_size_reference(
    workspace: &Workspace,
    scene: &str,
    description: &SceneDescription,
) -> Option<DisplayReference> {
    let file = ExrFile::read(&workspace.picture_file(scene)).ok()?;
    let max_bounces = file.metadata.get("arty:max_bounces")?.parse().ok()?;
    let hash = description.hash();
    let image = file
        .layer("")
        .filter(|_| file.metadata.get("arty:scene_hash").is_some_and(|other| *other == hash))?;
    let (width, height) = (image.width() / 2, image.height() / 2);
    let of_four = |x: usize, y: usize| -> [f64; 3] {
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| image[(2 * x + i, 2 * y + j)].to_array());
        std::array::from_fn(|c| four.iter().map(|pixel| f64::from(pixel[c])).sum::<f64>() / 4.0)
    };
    let reference =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of_four(x, y)).collect();
    Some(DisplayReference { reference, width, height, max_bounces })
}

/// For each pixel, the sum of differences over the square around it, in standard errors: a single pixel has too few
/// samples. 0 where nothing differs. Clamped to ±1e4.
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
        // Black regions have no variance; a small constant keeps differences there finite.
        if sum == 0.0 { 0.0 } else { (sum / (variance + 1e-12).sqrt()).clamp(-1e4, 1e4) }
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| z(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::{worst_pixel, z_map};

    #[test]
    fn the_worst_pixel_is_the_first_that_is_not_finite_or_has_the_greatest_difference() {
        let (mut means, mut z) = (vec![[1.0; 3]; 4], vec![0.0, -3.0, f64::NAN, 2.0]);
        let mut reference = vec![[0.0; 3]; 4];
        assert_eq!(worst_pixel(&means, &reference, &z), 1);
        z[3] = 3.0;
        assert_eq!(worst_pixel(&means, &reference, &z), 1, "the first of two");
        means[1] = [0.0; 3];
        assert_eq!(worst_pixel(&means, &reference, &z), 3, "nothing is seen in the first");
        reference[1] = [1.0; 3];
        assert_eq!(worst_pixel(&means, &reference, &z), 1, "something should have been");
        means[2][1] = f64::NAN;
        means[3][0] = f64::INFINITY;
        assert_eq!(worst_pixel(&means, &reference, &z), 2);
    }

    #[test]
    fn a_difference_shows_in_the_square_around_it() {
        let mut differences = vec![0.0; 12 * 10];
        differences[4 * 12 + 6] = 3.0;
        let z = z_map(&differences, &vec![1.0; 120], 12, 10);
        assert!((z[4 * 12 + 6] - 3.0 / 5.0).abs() < 1e-9, "one pixel of 25");
        assert_eq!((z[4 * 12 + 9], z[0]), (0.0, 0.0));
        assert!((z[2 * 12 + 4] - 0.6).abs() < 1e-9, "the corner of the square");
    }
}
