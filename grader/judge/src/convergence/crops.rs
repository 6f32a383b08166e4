//! Crops that show the error: the same part of a picture by each program, in equal processor time.

use arty::integrator::Settings;
use arty::sampler::batch_seed;
use host::protocol::RenderJob;

use verdict::convergence::{Convergence, Crop, Crops, Curve, Panel, Role};

use super::MeasuredProgram;
use crate::image_error::{Truth, relative_mse, relative_weight};
use crate::pictures::{DisplayReference, half_size_reference};
use crate::reference::SIZE;
use harness::host_process::HostProcess;
use harness::job::apart;
use harness::workspace::Workspace;
use verdict::error::Result;

/// Target processor time of each rendering, in seconds.
const SECONDS: f64 = 0.25;

/// Width and height of a crop in pixels, and the grid of candidate positions.
const CROP: usize = 48;
const STEP: usize = 8;

/// Renders crops for all panels, at the position where the solution (or without it the first program) has the largest
/// error. Omits programs that give no valid answer and scenes without a display reference.
///
/// # Errors
/// If the grader itself fails.
pub fn crops(
    workspace: &Workspace,
    programs: &[MeasuredProgram<'_>],
    convergence: &Convergence,
) -> Result<Vec<Crops>> {
    let mut all = Vec::new();
    for panel in &convergence.panels {
        all.extend(of_panel(workspace, programs, convergence, panel)?);
    }
    Ok(all)
}

fn of_panel(
    workspace: &Workspace,
    programs: &[MeasuredProgram<'_>],
    convergence: &Convergence,
    panel: &Panel,
) -> Result<Option<Crops>> {
    let description = arty::scene::file::load(&workspace.scene_file(&panel.scene))?.description;
    let Some(display) = half_size_reference(workspace, &panel.scene, &description) else { return Ok(None) };
    let DisplayReference { reference, width, height, max_bounces } = &display;
    let (width, height) = (*width, *height);
    let mut rendered: Vec<(&Curve, u64, Vec<[f64; 3]>)> = Vec::new();
    for curve in &panel.curves {
        // There is one baseline, whose name in the curve may have a suffix.
        let is_its = |it: &&MeasuredProgram<'_>| {
            it.role == curve.role && (it.role == Role::Baseline || it.name == curve.name)
        };
        let Some(program) = programs.iter().find(is_its) else { continue };
        let Some(samples) = samples(curve, width * height) else { continue };
        let mut process = HostProcess::start(program.program, convergence.threads)?;
        let Ok(scene) = apart(process.load(&description))? else { continue };
        let job = RenderJob::new(
            scene,
            Settings { technique: curve.technique, max_bounces: *max_bounces },
            [width as u32, height as u32],
            vec![batch_seed(convergence.seed, 0)],
            samples,
        );
        let Ok(answer) = apart(process.render(&job))? else { continue };
        if let Some(picture) = answer.batches.into_iter().next() {
            rendered.push((curve, samples, picture.iter().map(|pixel| pixel.map(f64::from)).collect()));
        }
    }
    let solution = rendered.iter().find(|(curve, ..)| curve.role == Role::Solution);
    let Some((_, _, guide)) = solution.or(rendered.first()) else { return Ok(None) };
    let corner = worst_corner(guide, reference, (width, height));
    let (columns, rows) = (CROP.min(width), CROP.min(height));
    let part = |picture: &[[f64; 3]]| {
        let row = |y: usize| &picture[(corner.1 + y) * width + corner.0..][..columns];
        (0..rows).flat_map(row).copied().collect::<Vec<[f64; 3]>>()
    };
    let truth = Truth { mean: reference, variance: None };
    let mut list: Vec<Crop> = rendered
        .iter()
        .map(|(curve, samples, picture)| Crop {
            name: curve.name.clone(),
            samples: Some(*samples),
            relative_mse: Some(relative_mse(picture, truth)),
            pixels: part(picture),
            width: columns,
            height: rows,
        })
        .collect();
    list.push(Crop {
        name: "reference".to_owned(),
        samples: None,
        relative_mse: None,
        pixels: part(reference),
        width: columns,
        height: rows,
    });
    Ok(Some(Crops { scene: panel.scene.clone(), technique: panel.technique, seconds: SECONDS, list }))
}

/// Samples per pixel that take [`SECONDS`] for this many pixels, extrapolated from the longest renderings; at least
/// one. `None` if the curve has no usable point.
fn samples(curve: &Curve, pixels: usize) -> Option<u64> {
    let point = curve.points.last().filter(|point| point.seconds > 0.0 && point.samples > 0)?;
    let of_one = point.seconds / (point.samples * u64::from(SIZE.0 * SIZE.1)) as f64;
    Some(((SECONDS / (of_one * pixels as f64)).round() as u64).clamp(1, 1 << 16))
}

/// The upper left corner of the crop with the largest relative squared error.
fn worst_corner(
    picture: &[[f64; 3]],
    reference: &[[f64; 3]],
    (width, height): (usize, usize),
) -> (usize, usize) {
    let error = |index: usize| -> f64 {
        let pairs = picture[index].iter().zip(&reference[index]);
        pairs.map(|(x, &r)| relative_weight(r) * (x - r).powi(2)).sum()
    };
    let of_crop = |&(left, top): &(usize, usize)| -> f64 {
        let rows = top..(top + CROP).min(height);
        rows.flat_map(|y| (left..(left + CROP).min(width)).map(move |x| y * width + x)).map(error).sum()
    };
    let corners = (0..=height.saturating_sub(CROP))
        .step_by(STEP)
        .flat_map(|top| (0..=width.saturating_sub(CROP)).step_by(STEP).map(move |left| (left, top)));
    corners.max_by(|a, b| of_crop(a).total_cmp(&of_crop(b))).unwrap_or((0, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crop_contains_the_largest_error() {
        let reference = vec![[1.0; 3]; 160 * 128];
        let mut picture = reference.clone();
        picture[100 * 160 + 130] = [5.0; 3];
        let (left, top) = worst_corner(&picture, &reference, (160, 128));
        assert!((left..left + CROP).contains(&130) && (top..top + CROP).contains(&100), "{left}, {top}");
        assert_eq!(worst_corner(&reference[..4], &reference[..4], (2, 2)), (0, 0), "smaller than a crop");
    }
}
