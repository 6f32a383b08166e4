//! Time and memory against the number of triangles and lights and the length of paths.

use std::time::Instant;

use arty::integrator::{Settings, Technique};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::Scene;

use super::Context;
use super::transport::{floor_below_points, furnace};
use crate::limits::sweep::{Point, Series, Sweep, decades};
use judge::extreme::measure::MinPaths;
use verdict::error::Result;

/// Costs have no limit: the summary shows how fast they grow.
const NO_LIMIT: f64 = f64::INFINITY;

/// Resident memory of this process in bytes; 0 where the system does not tell.
fn memory() -> f64 {
    let pages = std::fs::read_to_string("/proc/self/statm").ok();
    let resident = pages.as_deref().and_then(|text| text.split(' ').nth(1)?.parse::<f64>().ok());
    4096.0 * resident.unwrap_or(0.0)
}

/// Building and intersecting meshes of up to two million triangles.
pub(super) fn triangles(seed: u64) -> Sweep {
    let names = ["build, µs per triangle", "intersection, µs per ray", "memory, kB per triangle"];
    let mut series = names.map(|name| Series { name: name.to_owned(), points: Vec::new() });
    for subdivisions in 0..=9 {
        let description = furnace(subdivisions, 0.5);
        let count = description.meshes[0].triangles.len() as f64;
        let before = memory();
        let start = Instant::now();
        let scene = Scene::new(&description);
        let building = start.elapsed().as_secs_f64();
        let after = memory();
        let start = Instant::now();
        let rays = 200_000;
        let mut hits = 0u32;
        for sample in 0..rays {
            let mut sampler = Sampler::new(seed, (0, 0), sample);
            let (u, v) = sampler.next_2d();
            let aim = arty::math::Vec3::new(u - 0.5, v - 0.5, sampler.next_1d() - 0.5).normalize_or_zero();
            hits += u32::from(scene.intersect(&Ray::new(description.camera.eye, aim)).is_some());
        }
        let intersecting = start.elapsed().as_secs_f64() / rays as f64;
        let note = format!("{} of {rays} rays miss", rays - u64::from(hits));
        let values = [1e6 * building / count, 1e6 * intersecting, (after - before).max(0.0) / count / 1e3];
        for (series, y) in series.iter_mut().zip(values) {
            series.points.push(Point { x: count, y, note: note.clone(), ..Point::default() });
        }
    }
    Sweep {
        name: "triangles",
        about: "A sphere of 8 to 2,097,152 triangles, all of them lights. The memory of small scenes is below what can be measured.",
        axis: "triangles",
        measure: "cost",
        limit: NO_LIMIT,
        series: series.into(),
    }
}

/// Sampling one of many lights.
pub(super) fn lights(context: &Context<'_>) -> Result<Sweep> {
    let settings = Settings { technique: Technique::Mis, max_bounces: 1 };
    let mut points = Vec::new();
    for count in decades(0, 6) {
        let measured = context.measure(&floor_below_points(count as usize), settings, MinPaths(1 << 17))?;
        let y = 1e6 * measured.seconds / measured.paths as f64;
        points.push(Point { x: count, y, anomalies: measured.non_finite, ..Point::default() });
    }
    Ok(Sweep {
        name: "lights",
        about: "A floor lit by up to a million point lights.",
        axis: "lights",
        measure: "cost",
        limit: NO_LIMIT,
        series: vec![Series { name: "µs per path".to_owned(), points }],
    })
}

/// Paths of up to a billion bounces.
pub(super) fn bounces(context: &Context<'_>) -> Result<Sweep> {
    // Russian roulette ends most paths long before: this is about the others.
    let scene = furnace(2, 0.9);
    let truth = |bounces: f64| (1.0 - 0.9f64.powf(bounces + 1.0)) / 0.1;
    let (mut cost, mut errors) = (Vec::new(), Vec::new());
    for count in decades(0, 9) {
        let settings = Settings { technique: Technique::Mis, max_bounces: count as u32 };
        let measured = context.measure(&scene, settings, MinPaths(1 << 16))?;
        let y = 1e6 * measured.seconds / measured.paths as f64;
        let anomalies = measured.non_finite + measured.negative;
        cost.push(Point { x: count, y, anomalies, ..Point::default() });
        let (y, noise) = (measured.error(truth(count)).abs(), measured.noise(truth(count)));
        errors.push(Point { x: count, y, noise, anomalies, ..Point::default() });
    }
    Ok(Sweep {
        name: "bounces",
        about: "A furnace of reflectance 0.9 with up to a billion bounces.",
        axis: "maximum number of bounces",
        measure: "cost and relative error",
        limit: NO_LIMIT,
        series: vec![
            Series { name: "µs per path".to_owned(), points: cost },
            Series { name: "relative error".to_owned(), points: errors },
        ],
    })
}
