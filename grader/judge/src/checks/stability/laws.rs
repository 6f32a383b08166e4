//! Invariance of the picture under scaling and brightening of the scene.
//!
//! All factors are powers of two, so that scaling is exact in floating-point arithmetic: with the same random numbers,
//! a correct submission reproduces the picture to the last bit. A constant in the submission, such as an epsilon or a
//! limit on radiance, breaks the invariance.

use arty::sampler::batch_seed;
use glam::DVec3;
use harness::host_process::HostProcess;
use host::protocol::{AnomalousSample, RenderJob, Rendered};
use verdict::check::{Deviation, NumericalCause, Place, StabilityFinding};
use verdict::replay::ReplayTarget;

use super::{PartResult, StabilityContext, anomaly, cause_of, is_radiance};
use crate::extreme::measure::mean_and_error;
use crate::scenes::{changed, room};
use harness::job::JobError;

/// Width and height of the picture.
const SIZE: [u32; 2] = [16, 16];

/// Number of tiles along each side of the picture.
const TILES: u32 = 4;

/// Number of renderings with one sample per pixel. Each pixel value is then one sample, which can be replayed.
const BATCHES: u64 = 64;

/// Relative differences that are tolerated.
const TOLERATED: f64 = 1e-3;

/// Number of standard errors that count as noise, for submissions that are not repeatable. With 63 degrees of freedom,
/// one of 17 regions in 16 renderings exceeds it once in a hundred million submissions.
const NOISE: f64 = 8.0;

/// Exponents n of the factors 2ⁿ on lengths and on emission.
const LAWS: [(i32, i32); 10] =
    [(-10, 0), (10, 0), (0, -10), (0, 10), (-20, 0), (20, 0), (-40, 0), (0, -80), (0, 60), (0, 90)];

/// Exponents are graded from the negative of this up to this.
const GRADED: i32 = 10;

pub(super) fn find(stability: &StabilityContext<'_>, process: &mut HostProcess) -> PartResult {
    let base = render(stability, process, (0, 0))?;
    let mut paths = base.batches.len() as u64 * u64::from(SIZE[0] * SIZE[1]);
    let mut findings: Vec<StabilityFinding> = anomalies(stability, &base, (0, 0)).into_iter().collect();
    for law in LAWS {
        let (_, brighter) = law;
        let seen = render(stability, process, law)?;
        paths += seen.batches.len() as u64 * u64::from(SIZE[0] * SIZE[1]);
        // Samples that are not radiance explain a wrong mean.
        let found = anomalies(stability, &seen, law).or_else(|| {
            worst_region(&base, &seen, f64::from(brighter).exp2())
                .map(|difference| describe(stability, &base, &seen, law, difference))
        });
        findings.extend(found);
    }
    Ok((findings, paths))
}

fn render(
    stability: &StabilityContext<'_>,
    process: &mut HostProcess,
    (larger, brighter): (i32, i32),
) -> Result<Rendered, JobError> {
    let scene = changed(&room(), f64::from(larger).exp2(), DVec3::ZERO, (brighter as f32).exp2());
    let scene = process.load(&scene)?;
    let seeds = (0..BATCHES).map(|batch| batch_seed(stability.seed, batch)).collect();
    process.render(&RenderJob::new(scene, stability.settings, SIZE, seeds, 1))
}

/// The relative difference of the mean of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference {
    /// Column and row of the tile; `None` for the whole picture.
    tile: Option<[u32; 2]>,
    relative: f64,
}

impl Difference {
    fn holds(&self, pixel: u32) -> bool {
        let place = [pixel % SIZE[0] * TILES / SIZE[0], pixel / SIZE[0] * TILES / SIZE[1]];
        self.tile.is_none_or(|tile| tile == place)
    }
}

/// The whole picture if its mean differs significantly, or else the tile with the largest significant difference;
/// `None` if there is no significant difference.
fn worst_region(base: &Rendered, seen: &Rendered, factor: f64) -> Option<Difference> {
    let tiles = (0..TILES * TILES).map(|tile| Some([tile % TILES, tile / TILES]));
    let compare = |tile: Option<[u32; 2]>| {
        let region = Difference { tile, relative: 0.0 };
        let sum = |batch: &[[f32; 3]]| -> f64 {
            let pixels = batch.iter().zip(0..).filter(|(_, pixel)| region.holds(*pixel));
            pixels.map(|(value, _)| f64::from(value[1])).sum()
        };
        let pairs = base.batches.iter().zip(&seen.batches).map(|(a, b)| (sum(a), sum(b) / factor));
        let (sums, differences): (Vec<f64>, Vec<f64>) = pairs.map(|(a, b)| (a, b - a)).unzip();
        let (mean, _) = mean_and_error(&sums);
        let (difference, error) = mean_and_error(&differences);
        let excess = difference.abs() - TOLERATED * mean - NOISE * error;
        (excess > 0.0).then(|| Difference { tile, relative: difference / mean })
    };
    compare(None)
        .or_else(|| tiles.filter_map(compare).max_by(|a, b| a.relative.abs().total_cmp(&b.relative.abs())))
}

/// A finding if some samples are not radiance.
fn anomalies(stability: &StabilityContext<'_>, seen: &Rendered, law: (i32, i32)) -> Option<StabilityFinding> {
    let first = seen.first_anomalies.first()?;
    let value = first.value.into_iter().find(|&value| !is_radiance(value)).unwrap_or(f32::NAN);
    Some(StabilityFinding {
        place: place(law),
        deviation: Deviation::Anomalies { non_finite: seen.non_finite, negative: seen.negative },
        likely_cause: cause_of(value),
        is_graded: is_graded(law),
        first: Some(anomaly(first, Some(replay(stability, law)))),
        replay: None,
    })
}

fn describe(
    stability: &StabilityContext<'_>,
    base: &Rendered,
    seen: &Rendered,
    law: (i32, i32),
    difference: Difference,
) -> StabilityFinding {
    let factor = f64::from(law.1).exp2();
    let pairs = base.batches.iter().zip(&seen.batches).zip(0..).flat_map(|((base, seen), batch)| {
        base.iter()
            .zip(seen)
            .zip(0..)
            .map(move |((a, b), pixel)| (batch, pixel, f64::from(a[1]), f64::from(b[1])))
    });
    let (batch, pixel, expected, found) = pairs
        .filter(|(_, pixel, ..)| difference.holds(*pixel))
        .find(|(_, _, a, b)| (b / factor - a).abs() > TOLERATED * a.abs().max(b / factor))
        .unwrap_or((0, 0, f64::NAN, f64::NAN));
    let sample = AnomalousSample {
        seed: batch_seed(stability.seed, batch),
        x: pixel % SIZE[0],
        y: pixel / SIZE[0],
        sample: 0,
        value: [found as f32; 3],
    };
    let pixels = difference.tile.map(|[x, y]| {
        let range = |tile: u32, size: u32| [tile * size / TILES, (tile + 1) * size / TILES - 1];
        [range(x, SIZE[0]), range(y, SIZE[1])]
    });
    StabilityFinding {
        place: place(law),
        deviation: Deviation::Region {
            pixels,
            relative: difference.relative.into(),
            expected: (expected * factor).into(),
        },
        likely_cause: cause(seen, law, difference),
        is_graded: is_graded(law),
        first: Some(anomaly(&sample, Some(replay(stability, law)))),
        replay: None,
    }
}

/// The most frequent cause of such a difference.
fn cause(seen: &Rendered, (larger, brighter): (i32, i32), difference: Difference) -> NumericalCause {
    if larger != 0 {
        let size = f64::from(larger).exp2() * room_size();
        return if larger.abs() > 20 {
            NumericalCause::PowerOfLength { size }
        } else {
            NumericalCause::FixedEpsilon { size, is_large: larger < 0 }
        };
    }
    let max = seen.batches.iter().flatten().map(|value| value[1]).fold(0.0, f32::max);
    let clamped = seen.batches.iter().flatten().filter(|value| value[1] == max).count();
    if brighter > 0 && difference.relative < 0.0 {
        if clamped > 2 {
            NumericalCause::ClampedRadiance { limit: max.into(), samples: clamped as u64 }
        } else {
            NumericalCause::LimitedRadiance
        }
    } else if brighter < 0 && difference.relative < 0.0 {
        NumericalCause::DroppedContributions
    } else {
        NumericalCause::ConstantInRadiance
    }
}

fn room_size() -> f64 {
    let vertices = |scene: &arty::scene::SceneDescription| -> Vec<_> {
        scene.meshes.iter().flat_map(|mesh| mesh.positions.clone()).collect()
    };
    vertices(&room()).iter().fold(0.0, |max: f64, position| max.max(2.0 * f64::from(position.length())))
}

fn is_graded((larger, brighter): (i32, i32)) -> bool {
    larger.abs().max(brighter.abs()) <= GRADED
}

fn place(law: (i32, i32)) -> Place {
    match law {
        (0, 0) => Place::Unchanged,
        (larger, 0) => Place::Scaled(larger),
        (_, brighter) => Place::Brightened(brighter),
    }
}

fn replay(stability: &StabilityContext<'_>, (larger, brighter): (i32, i32)) -> ReplayTarget {
    ReplayTarget {
        scale: f64::from(larger).exp2(),
        emission: (brighter as f32).exp2(),
        ..stability.replay(ReplayTarget::ROOM, stability.settings, SIZE)
    }
}

#[cfg(test)]
mod tests {
    use arty::scene::Scene;

    use super::*;

    fn rendered(value: impl Fn(u64, u32) -> f32) -> Rendered {
        let batch = |batch| (0..SIZE[0] * SIZE[1]).map(|pixel| [value(batch, pixel); 3]).collect();
        Rendered {
            batches: (0..BATCHES).map(batch).collect(),
            non_finite: 0,
            negative: 0,
            first_anomalies: Vec::new(),
            rays: 0,
            cpu_seconds: 0.0,
        }
    }

    fn noise(seed: u64, pixel: u32) -> f32 {
        arty::sampler::Sampler::new(seed, (pixel, 0), 0).next_1d()
    }

    #[test]
    fn clamped_pictures_differ_and_exact_copies_do_not() {
        let base = rendered(noise);
        assert_eq!(worst_region(&base, &rendered(|b, p| 1024.0 * noise(b, p)), 1024.0), None);
        let clamped = worst_region(&base, &rendered(|b, p| (1024.0 * noise(b, p)).min(900.0)), 1024.0);
        assert!(clamped.is_some_and(|it| it.tile.is_none() && it.relative < -1e-3), "{clamped:?}");
        let corner = |b, p| if p == 255 { 0.0 } else { noise(b, p) };
        assert_eq!(worst_region(&base, &rendered(corner), 1.0).map(|it| it.tile), Some(None));
    }

    #[test]
    fn other_random_numbers_are_not_a_difference() {
        // A false alarm here would be one in ten million.
        let base = rendered(noise);
        for seed in 1..20 {
            assert_eq!(worst_region(&base, &rendered(|b, p| noise(b + 1000 * seed, p)), 1.0), None);
        }
    }

    #[test]
    fn black_pictures_are_equal() {
        assert_eq!(worst_region(&rendered(|_, _| 0.0), &rendered(|_, _| 0.0), 1024.0), None);
        let appeared = worst_region(&rendered(|_, _| 0.0), &rendered(|_, _| 1.0), 1.0);
        assert!(appeared.is_some());
    }

    #[test]
    fn the_room_has_lights_and_something_to_see() {
        let scene = Scene::new(&room());
        assert_eq!((scene.features().area_lights, scene.features().point_lights), (2, 1));
        assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    }
}
