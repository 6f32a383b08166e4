//! The same scene larger or brighter.
//!
//! All factors are powers of two, so that scaling is exact in floating-point numbers: whatever a correct hand-in does,
//! with the same random numbers it gives the same picture, to the last bit. A constant of its own, such as an epsilon or
//! a limit on radiance, breaks that.

use arty::sampler::batch_seed;
use glam::DVec3;
use host::protocol::{AnomalousSample, RenderJob, Rendered, Switches};

use super::{Asked, Finding, Found};
use crate::extreme::build::{changed, room};
use crate::extreme::measure::mean_and_error;
use crate::replay::Place;
use harness::host_process::{Fault, HostProcess};
use verdict::error::Result;

/// Width and height of the picture.
const SIZE: [u32; 2] = [16, 16];

/// Tiles along each side of it.
const TILES: u32 = 4;

/// Renderings of one sample a pixel each: so each value of a rendering is one sample, and can be replayed.
const BATCHES: u64 = 64;

/// Relative differences up to this are nobody's matter.
const TOLERATED: f64 = 1e-3;

/// Standard errors that are noise, for hand-ins that do not give the same numbers twice. With 63 degrees of freedom one
/// of 17 regions in 16 renderings is beyond them once in a hundred million hand-ins.
const NOISE: f64 = 8.0;

/// Powers of two by which the scene is made larger, and by which its lights are made brighter.
const LAWS: [(i32, i32); 10] =
    [(-10, 0), (10, 0), (0, -10), (0, 10), (-20, 0), (20, 0), (-40, 0), (0, -80), (0, 60), (0, 90)];

/// Powers of two up to this on either side are in the range that is judged.
const JUDGED: i32 = 10;

pub(super) fn find(asked: &Asked<'_>, process: &mut HostProcess) -> Found {
    let base = match render(asked, process, (0, 0))? {
        Ok(base) => base,
        Err(fault) => return Ok(Err(fault)),
    };
    let mut paths = base.batches.len() as u64 * u64::from(SIZE[0] * SIZE[1]);
    let mut findings: Vec<Finding> = anomalies(asked, &base, (0, 0)).into_iter().collect();
    for law in LAWS {
        let (_, brighter) = law;
        let seen = match render(asked, process, law)? {
            Ok(seen) => seen,
            Err(fault) => return Ok(Err(fault)),
        };
        paths += seen.batches.len() as u64 * u64::from(SIZE[0] * SIZE[1]);
        // Where samples are no radiance, their mean is wrong for that reason.
        let found = anomalies(asked, &seen, law).or_else(|| {
            worst_region(&base, &seen, f64::from(brighter).exp2())
                .map(|difference| describe(asked, &base, &seen, law, difference))
        });
        findings.extend(found);
    }
    Ok(Ok((findings, paths)))
}

fn render(
    asked: &Asked<'_>,
    process: &mut HostProcess,
    (larger, brighter): (i32, i32),
) -> Result<std::result::Result<Rendered, Fault>> {
    let scene = changed(&room(), f64::from(larger).exp2(), DVec3::ZERO, (brighter as f32).exp2());
    let scene = match process.load(&scene)? {
        Ok(scene) => scene,
        Err(fault) => return Ok(Err(fault)),
    };
    process.render(&RenderJob {
        scene,
        settings: asked.settings,
        width: SIZE[0],
        height: SIZE[1],
        seeds: (0..BATCHES).map(|batch| batch_seed(asked.seed, batch)).collect(),
        first_sample: 0,
        samples: 1,
        switches: Switches::default(),
    })
}

/// A region with the relative difference of its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference {
    /// The tile by column and row; none for the whole picture.
    tile: Option<[u32; 2]>,
    relative: f64,
}

impl Difference {
    fn holds(&self, pixel: u32) -> bool {
        let place = [pixel % SIZE[0] * TILES / SIZE[0], pixel / SIZE[0] * TILES / SIZE[1]];
        self.tile.is_none_or(|tile| tile == place)
    }
}

/// The region whose mean differs most, beyond what is tolerated and what is noise; the whole picture goes first.
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

/// Samples that are no radiance.
fn anomalies(asked: &Asked<'_>, seen: &Rendered, law: (i32, i32)) -> Option<Finding> {
    let first = seen.first_anomalies.first()?;
    let value =
        first.value.into_iter().find(|value| !(value.is_finite() && *value >= 0.0)).unwrap_or(f32::NAN);
    let cause = if value.is_nan() {
        "0/0, ∞/∞ or the root or arc cosine of what is out of its range"
    } else if value.is_infinite() {
        "a division by 0, or a product or sum that is beyond 3.4e38"
    } else {
        "a cosine whose sign was not looked at"
    };
    let (non_finite, negative) = (seen.non_finite, seen.negative);
    Some(Finding {
        text: format!(
            "{}: {non_finite} samples are NaN or infinite and {negative} negative; the first: pixel ({}, {}), sample {}, \
             value {:?}; likely cause: {cause}; {}",
            name(law),
            first.x,
            first.y,
            first.sample,
            first.value,
            again(asked, law, first)
        ),
        judged: is_judged(law),
        anomalies: [non_finite, negative],
    })
}

fn describe(
    asked: &Asked<'_>,
    base: &Rendered,
    seen: &Rendered,
    law: (i32, i32),
    difference: Difference,
) -> Finding {
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
        seed: batch_seed(asked.seed, batch),
        x: pixel % SIZE[0],
        y: pixel / SIZE[0],
        sample: 0,
        value: [found as f32; 3],
    };
    let place = match difference.tile {
        None => "the whole picture".to_owned(),
        Some([x, y]) => format!(
            "pixels {}–{} × {}–{}",
            x * SIZE[0] / TILES,
            (x + 1) * SIZE[0] / TILES - 1,
            y * SIZE[1] / TILES,
            (y + 1) * SIZE[1] / TILES - 1
        ),
    };
    let text = format!(
        "{}: {place} is {:.1} % too {} compared with the scene as it is; the first: pixel ({}, {}), sample 0, {found:.4e} \
         instead of {:.4e}; likely cause: {}; {}",
        name(law),
        100.0 * difference.relative.abs(),
        if difference.relative < 0.0 { "dark" } else { "bright" },
        sample.x,
        sample.y,
        expected * factor,
        cause(seen, law, difference),
        again(asked, law, &sample)
    );
    Finding { text, judged: is_judged(law), anomalies: [0; 2] }
}

/// What most often does such a thing.
fn cause(seen: &Rendered, (larger, brighter): (i32, i32), difference: Difference) -> String {
    if larger != 0 {
        let size = f64::from(larger).exp2() * room_size();
        return if larger.abs() > 20 {
            format!("a square or cube of lengths over- or underflows in a scene {size:.0e} units large")
        } else {
            let fate = if larger < 0 { "large" } else { "small" };
            format!("a fixed epsilon or distance, which is {fate} in a scene {size:.0e} units large")
        };
    }
    let greatest = seen.batches.iter().flatten().map(|value| value[1]).fold(0.0, f32::max);
    let capped = seen.batches.iter().flatten().filter(|value| value[1] == greatest).count();
    if brighter > 0 && difference.relative < 0.0 {
        if capped > 2 {
            format!("radiance is limited to {greatest}, which {capped} samples have to the last bit")
        } else {
            "radiance is limited or compressed, or what overflows is turned into 0".to_owned()
        }
    } else if brighter < 0 && difference.relative < 0.0 {
        "small contributions are dropped below a fixed limit, or underflow".to_owned()
    } else {
        "a constant is added to or compared with radiance".to_owned()
    }
}

fn room_size() -> f64 {
    let vertices = |scene: &arty::scene::SceneDescription| -> Vec<_> {
        scene.meshes.iter().flat_map(|mesh| mesh.positions.clone()).collect()
    };
    vertices(&room()).iter().fold(0.0, |most: f64, position| most.max(2.0 * f64::from(position.length())))
}

fn is_judged((larger, brighter): (i32, i32)) -> bool {
    larger.abs().max(brighter.abs()) <= JUDGED
}

/// "2^-10 times as large".
fn name(law: (i32, i32)) -> String {
    match law {
        (0, 0) => "in the scene as it is".to_owned(),
        (larger, 0) => format!("in a scene 2^{larger} times as large"),
        (_, brighter) => format!("with lights 2^{brighter} times as bright"),
    }
}

fn again(asked: &Asked<'_>, (larger, brighter): (i32, i32), sample: &AnomalousSample) -> String {
    let place = Place {
        scene: Place::ROOM.to_owned(),
        description: room(),
        scale: f64::from(larger).exp2(),
        emission: (brighter as f32).exp2(),
        technique: asked.settings.technique,
        max_bounces: asked.settings.max_bounces,
        size: SIZE,
        seed: asked.seed,
        pixel: [0, 0],
        sample: 0,
        switches: Switches::default(),
    };
    format!("see it again with `{}`", place.of(sample).command(&asked.bench.path))
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
            cpu_seconds: 0.0,
        }
    }

    fn noise(seed: u64, pixel: u32) -> f32 {
        arty::sampler::Sampler::new(seed, (pixel, 0), 0).next_1d()
    }

    #[test]
    fn exact_copies_differ_nowhere_and_clamped_ones_do() {
        let base = rendered(noise);
        assert_eq!(worst_region(&base, &rendered(|b, p| 1024.0 * noise(b, p)), 1024.0), None);
        let clamped = worst_region(&base, &rendered(|b, p| (1024.0 * noise(b, p)).min(900.0)), 1024.0);
        assert!(clamped.is_some_and(|it| it.tile.is_none() && it.relative < -1e-3), "{clamped:?}");
        let corner = |b, p| if p == 255 { 0.0 } else { noise(b, p) };
        assert_eq!(worst_region(&base, &rendered(corner), 1.0).map(|it| it.tile), Some(None));
    }

    #[test]
    fn other_random_numbers_are_no_difference() {
        // A false alarm here would be one in ten million.
        let base = rendered(noise);
        for seed in 1..20 {
            assert_eq!(worst_region(&base, &rendered(|b, p| noise(b + 1000 * seed, p)), 1.0), None);
        }
    }

    #[test]
    fn black_pictures_are_alike() {
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
