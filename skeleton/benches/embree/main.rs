//! Comparison with [Embree](https://www.embree.org): identical rays, single-ray calls, one thread, interleaved within one
//! process.
//!
//! `ARTY_EMBREE=…/libembree4.so.4 cargo bench -p arty --bench embree`, with the path of an Embree 4 library, such as
//! that of a distribution's package. Without it, nothing is measured.
//!
//! Prints millions of rays per second, and the speed relative to Embree with its defaults and with its watertight ("robust")
//! triangle test; arty is always watertight. Medians over rounds, and the fraction of rays for which the hits of arty and
//! robust Embree differ. Rays start as with `Hit::spawn`, and arty excludes the triangle they start on, as in a path tracer.
//! Embree's interface does not support this: in the Cornell box, some rays hit the triangle they start on. Elsewhere the
//! hits differ at edges.

mod library;
mod rays;

use std::hint::black_box;
use std::path::PathBuf;
use std::time::Instant;

use arty::accel::Accel;
use library::{Embree, EmbreeScene};
use rays::{Rays, Segment, Start, geometries};

/// Interleaved, so that other load affects all of them.
const ROUNDS: usize = 15;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Some(path) = std::env::var_os("ARTY_EMBREE").map(PathBuf::from) else {
        println!("not measured: ARTY_EMBREE does not name an Embree 4 library (libembree4.so.4)");
        return Ok(());
    };
    let embree = Embree::load(&path)?;
    println!(
        "{:<24} {:>8} {:>8} {:>8}  {:>9} {:>9}  {:>9}",
        "rays", "arty", "Embree", "robust", "/ Embree", "/ robust", "disagree"
    );
    for geometry in geometries() {
        let own = Accel::build(&geometry.triangles);
        let scenes = [embree.scene(&geometry.triangles, false)?, embree.scene(&geometry.triangles, true)?];
        let rays = Rays::of(&geometry, &own);
        for (kind, starts) in [("primary", &rays.primary), ("bounce", &rays.bounces)] {
            let own = |ray: &Start| {
                own.intersect(ray.origin, ray.direction, f32::INFINITY, ray.exclude).map(|hit| hit.primitive)
            };
            let other = |scene: &EmbreeScene<'_>, ray: &Start| scene.intersect(ray.origin, ray.direction);
            compare(&format!("{} {kind}", geometry.name), starts, own, &scenes, other);
        }
        let between = |segment: &Segment| own.occluded(segment.origin, segment.target, Some(segment.exclude));
        let other =
            |scene: &EmbreeScene<'_>, segment: &Segment| scene.occluded(segment.origin, segment.target);
        compare(&format!("{} shadow", geometry.name), &rays.shadow, between, &scenes, other);
    }
    Ok(())
}

/// Measures all three with the same rays and prints a line.
fn compare<R, A: PartialEq>(
    name: &str,
    rays: &[R],
    own: impl Fn(&R) -> A,
    scenes: &[EmbreeScene<'_>; 2],
    other: impl Fn(&EmbreeScene<'_>, &R) -> A,
) {
    let mut speeds: [Vec<f64>; 3] = Default::default();
    for _ in 0..ROUNDS {
        speeds[0].push(speed(rays, &own));
        for (speeds, scene) in speeds[1..].iter_mut().zip(scenes) {
            speeds.push(speed(rays, |ray| other(scene, ray)));
        }
    }
    let ratio =
        |to: usize| median(speeds[0].iter().zip(&speeds[to]).map(|(own, other)| own / other).collect());
    let disagree = rays.iter().filter(|ray| own(ray) != other(&scenes[1], ray)).count();
    println!(
        "{name:<24} {:>8.1} {:>8.1} {:>8.1}  {:>9.2} {:>9.2}  {:>9.1e}",
        median(speeds[0].clone()),
        median(speeds[1].clone()),
        median(speeds[2].clone()),
        ratio(1),
        ratio(2),
        disagree as f64 / rays.len() as f64
    );
}

/// Millions of rays per second.
fn speed<R, A>(rays: &[R], trace: impl Fn(&R) -> A) -> f64 {
    let start = Instant::now();
    for ray in rays {
        black_box(trace(ray));
    }
    rays.len() as f64 / start.elapsed().as_secs_f64() / 1e6
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
