//! Round shapes: spheres and a knot.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;

use crate::surface::Surface;

/// A sphere of `20 · 4^subdivisions` triangles of nearly equal size, with its front outside: an icosahedron
/// whose triangles are repeatedly split into four.
pub(crate) fn icosphere(center: DVec3, radius: f64, subdivisions: u32) -> Surface {
    let (mut directions, mut triangles) = icosahedron();
    for _ in 0..subdivisions {
        let mut middles = BTreeMap::new();
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| {
                    *middles.entry((from.min(to), from.max(to))).or_insert_with(|| {
                        directions.push((directions[from] + directions[to]).normalize());
                        directions.len() - 1
                    })
                });
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    Surface::new(directions.into_iter().map(|direction| center + radius * direction).collect(), triangles)
}

/// An icosphere with smooth normals.
pub(crate) fn smooth_sphere(center: DVec3, radius: f64, subdivisions: u32) -> Surface {
    let mut sphere = icosphere(center, radius, subdivisions);
    sphere.normals = sphere.positions.iter().map(|&position| (position - center).normalize()).collect();
    sphere
}

/// Corners on the unit sphere and triangles with their front outside.
fn icosahedron() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut corners = Vec::new();
    for (short, long) in [(-1.0, -golden), (1.0, -golden), (-1.0, golden), (1.0, golden)] {
        corners.push(DVec3::new(0.0, short, long));
        corners.push(DVec3::new(short, long, 0.0));
        corners.push(DVec3::new(long, 0.0, short));
    }
    // Corners of one triangle are two units apart; any other two are farther from each other.
    let near = |a: usize, b: usize| corners[a].distance_squared(corners[b]) < 4.5;
    let mut triangles = Vec::new();
    for a in 0..corners.len() {
        for b in a + 1..corners.len() {
            for c in b + 1..corners.len() {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = corners[a].dot(corners[b].cross(corners[c])) > 0.0;
                    triangles.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    (corners.into_iter().map(DVec3::normalize).collect(), triangles)
}

/// How a [`knot`] is cut into triangles.
pub(crate) struct KnotResolution {
    /// Steps along the rope.
    pub(crate) along: usize,
    /// Steps around the rope.
    pub(crate) around: usize,
}

/// A rope tied to a trefoil: a (2, 3) torus knot with a twisted relief of five strands, smooth, with its
/// front outside. It lies flat; its outer radius is about 1.7 and it is about 1.5 high.
pub(crate) fn knot(resolution: &KnotResolution) -> Surface {
    let KnotResolution { along, around } = *resolution;
    let mut positions = Vec::new();
    for step in 0..along {
        let t = TAU * step as f64 / along as f64;
        let (point, normal, binormal) = knot_frame(t);
        for turn in 0..around {
            let angle = TAU * turn as f64 / around as f64;
            // Twelve turns of the five strands, so that the relief meets itself after one round.
            let strands = 0.5 + 0.5 * (5.0 * angle + 12.0 * t).cos();
            let radius = 0.235 + 0.045 * strands.sqrt() + 0.02 * (9.0 * t).sin();
            positions.push(point + radius * (angle.cos() * normal + angle.sin() * binormal));
        }
    }
    let mut triangles = Vec::new();
    for step in 0..along {
        for turn in 0..around {
            let here = |forwards: usize, sideways: usize| {
                (step + forwards) % along * around + (turn + sideways) % around
            };
            triangles.push([here(0, 0), here(0, 1), here(1, 1)]);
            triangles.push([here(0, 0), here(1, 1), here(1, 0)]);
        }
    }
    Surface::new(positions, triangles).smooth()
}

/// A point of the knot's centre line, and two unit vectors across the line. They come from the torus that the
/// knot winds around, hence they return to themselves after one round without a twist.
fn knot_frame(t: f64) -> (DVec3, DVec3, DVec3) {
    const TORUS_RADIUS: f64 = 1.0;
    const TUBE_RADIUS: f64 = 0.46;
    let point = |t: f64| {
        let distance = TORUS_RADIUS + TUBE_RADIUS * (3.0 * t).cos();
        DVec3::new(distance * (2.0 * t).cos(), TUBE_RADIUS * (3.0 * t).sin(), distance * (2.0 * t).sin())
    };
    let around_tube =
        DVec3::new((3.0 * t).cos() * (2.0 * t).cos(), (3.0 * t).sin(), (3.0 * t).cos() * (2.0 * t).sin());
    const STEP: f64 = 1e-4;
    let tangent = (point(t + STEP) - point(t - STEP)).normalize();
    (point(t), around_tube, tangent.cross(around_tube))
}
