//! Rays inside a closed mesh: how many leak, and how many hit the face that they start from.

use arty::math::{Vec3, direction_and_distance};
use arty::ray::Ray;
use arty::sampler::Sampler;
use arty::scene::{Scene, SceneDescription};
use glam::DVec3;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::limits::sweep::{Point, Series, Sweep, decades};
use judge::scenes::{add, changed, empty, grey, hollow_ball};

/// Paths per measurement.
const PATHS: u64 = 20_000;

/// Bounces per path.
const HITS: usize = 8;

/// Subdivisions of the mesh: 2048 triangles.
const SUBDIVISIONS: u32 = 4;

/// Rays, and what went wrong with them.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    /// Rays that start inside and miss.
    leaks: u64,
    /// Rays that hit the face that they start from.
    acne: u64,
    /// Shadow rays inside the sphere that are occluded.
    shadows: u64,
    /// Shadow rays through the sphere that are not occluded.
    holes: u64,
    /// Rays traced.
    rays: u64,
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            leaks: self.leaks + other.leaks,
            acne: self.acne + other.acne,
            shadows: self.shadows + other.shadows,
            holes: self.holes + other.holes,
            rays: self.rays + other.rays,
        }
    }
}

/// Leaks and acne against the size of the mesh.
pub(super) fn scale_of_rays(seed: u64) -> Sweep {
    sweep(
        "scale-of-rays",
        "Rays inside a closed sphere of 2,048 triangles, of all sizes.",
        "scale of the sphere",
        decades(-38, 38),
        |base, scale| changed(base, scale, DVec3::ZERO, 1.0),
        seed,
    )
}

/// Leaks and acne against the distance from the origin.
pub(super) fn offset_of_rays(seed: u64) -> Sweep {
    sweep(
        "offset-of-rays",
        "Rays inside the same sphere, moved away from the origin.",
        "distance from the origin in radii",
        decades(-1, 9),
        |base, distance| changed(base, 1.0, 2.0 * distance * DVec3::new(0.6, 0.48, 0.64), 1.0),
        seed,
    )
}

fn sweep(
    name: &'static str,
    about: &'static str,
    axis: &'static str,
    xs: impl Iterator<Item = f64>,
    place: impl Fn(&SceneDescription, f64) -> SceneDescription,
    seed: u64,
) -> Sweep {
    let mut base = empty();
    add(&mut base, &hollow_ball(2.0, SUBDIVISIONS), grey(0.5, 0.0));
    // The camera marks the centre of the sphere.
    base.camera.eye = Vec3::ZERO;
    type Kind = (&'static str, fn(&Counts) -> u64);
    let kinds: [Kind; 4] = [
        ("leaks", |counts| counts.leaks),
        ("acne", |counts| counts.acne),
        ("false shadows", |counts| counts.shadows),
        ("missing shadows", |counts| counts.holes),
    ];
    let mut series = kinds.map(|(name, _)| Series { name: name.to_owned(), points: Vec::new() });
    for x in xs {
        let description = place(&base, x);
        let scene = Scene::new(&description);
        let counts = (0..PATHS)
            .into_par_iter()
            .map(|path| follow(&scene, description.camera.eye, seed, path))
            .reduce(Counts::default, Counts::plus);
        for (series, (_, count)) in series.iter_mut().zip(&kinds) {
            let y = count(&counts) as f64 / counts.rays.max(1) as f64;
            series.points.push(Point { x, y, note: scene.warnings().join("; "), ..Point::default() });
        }
    }
    Sweep { name, about, axis, measure: "fraction of rays", limit: 0.0, series: series.into() }
}

/// A uniformly distributed direction.
fn unit(sampler: &mut Sampler) -> Vec3 {
    let (u, v) = sampler.next_2d();
    let (z, (sin, cos)) = (1.0 - 2.0 * u, (std::f32::consts::TAU * v).sin_cos());
    let radius = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(radius * cos, radius * sin, z)
}

fn follow(scene: &Scene, middle: Vec3, seed: u64, path: u64) -> Counts {
    let mut sampler = Sampler::new(seed, (0, 0), path);
    let mut counts = Counts::default();
    let mut ray = Ray::new(middle, unit(&mut sampler));
    let Some(mut hit) = scene.intersect(&ray) else { return Counts { leaks: 1, rays: 1, ..counts } };
    for _ in 0..HITS {
        // Into the sphere.
        let wi = unit(&mut sampler);
        let wi = if wi.dot(hit.geometric_normal) < 0.0 { -wi } else { wi };
        // A grazing ray is closer to the face than rounding errors.
        if wi.dot(hit.geometric_normal) < 1e-3 {
            continue;
        }
        ray = hit.spawn(wi);
        counts.rays += 3;
        let Some(next) = scene.intersect(&ray) else {
            counts.leaks += 1;
            return counts;
        };
        // No two faces of a convex sphere have the same normal.
        if next.geometric_normal == hit.geometric_normal {
            counts.acne += 1;
            return counts;
        }
        counts.shadows += u64::from(scene.occluded(&hit, next.point));
        let (outwards, distance) = direction_and_distance(hit.point, next.point);
        let beyond = next.point + 0.5 * distance * outwards;
        // A point within rounding errors of the face counts as lying on it: see `Scene::occluded`.
        let height = 0.5 * distance * outwards.dot(next.geometric_normal).abs();
        let clear = height > 8.0 * f32::EPSILON * beyond.abs().max_element();
        counts.holes += u64::from(clear && !scene.occluded(&hit, beyond));
        hit = next;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_leaks_within_the_documented_limits_and_much_does_far_out() {
        let rays = offset_of_rays(1);
        for series in &rays.series {
            for point in series.points.iter().filter(|point| point.x <= 1e3) {
                assert_eq!(point.y, 0.0, "{} at {:e}", series.name, point.x);
            }
        }
        // The test can fail: at a billion radii all vertices round to the same point.
        assert!(rays.series[0].points.last().is_some_and(|point| point.y > 0.5));
    }
}
