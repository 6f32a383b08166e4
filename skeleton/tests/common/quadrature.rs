//! Quadrature over directions, in double precision.

use std::f64::consts::{PI, TAU};

use arty::math::Vec3;
use glam::DVec3;

/// Axes for polar coordinates: the angle α from `axis`, and φ around it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polar {
    axis: DVec3,
    x: DVec3,
    y: DVec3,
}

impl Polar {
    pub(crate) fn around(axis: DVec3) -> Self {
        let axis = axis.normalize();
        let x = axis.any_orthonormal_vector();
        Self { axis, x, y: axis.cross(x) }
    }

    /// The direction at 1 − cos α = `t`.
    pub(crate) fn direction(&self, t: f64, phi: f64) -> Vec3 {
        let sin = (t * (2.0 - t)).max(0.0).sqrt();
        (sin * (phi.cos() * self.x + phi.sin() * self.y) + (1.0 - t) * self.axis).normalize().as_vec3()
    }

    /// (1 − cos α, φ / 2π) of a direction; accurate close to the axis, unlike the cosine.
    pub(crate) fn coordinates(&self, direction: Vec3) -> (f64, f64) {
        let w = direction.as_dvec3().normalize();
        let phi = w.dot(self.y).atan2(w.dot(self.x));
        (0.5 * (w - self.axis).length_squared(), (phi / TAU).rem_euclid(1.0))
    }
}

/// The integral of `density` over a part of a ring around the axis of `polar`: 1 − cos α between the two bounds of
/// `t`, φ / 2π between those of `turn`. Midpoint rule over `steps²` patches for each doubling of t, so that narrow
/// lobes are resolved.
pub(crate) fn over_ring(
    polar: &Polar,
    (t_low, t_high): (f64, f64),
    (turn_low, turn_high): (f64, f64),
    steps: usize,
    density: &impl Fn(Vec3) -> f64,
) -> f64 {
    let mut total = 0.0;
    let mut low = t_low;
    while low < t_high {
        let next: f64 = if low == 0.0 { 1e-9 } else { 2.0 * low };
        // Powers of the cosine vanish at a right angle, some of them with a jump.
        let next = if low < 1.0 { next.min(1.0) } else { next };
        let high = next.min(t_high);
        let patch = (high - low) * (turn_high - turn_low) * TAU / (steps * steps) as f64;
        for i in 0..steps {
            let t = low + (high - low) * (i as f64 + 0.5) / steps as f64;
            for j in 0..steps {
                let turn = turn_low + (turn_high - turn_low) * (j as f64 + 0.5) / steps as f64;
                total += patch * density(polar.direction(t, turn * TAU));
            }
        }
        low = high;
    }
    total
}

/// The integral over all directions.
pub(crate) fn over_sphere(polar: &Polar, steps: usize, density: &impl Fn(Vec3) -> f64) -> f64 {
    over_ring(polar, (0.0, 2.0), (0.0, 1.0), steps, density)
}

/// The integral of a smooth function of (u, v) over the unit square (midpoint rule).
pub(crate) fn over_square(steps: usize, value: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |i: usize| (i as f64 + 0.5) / steps as f64;
    let sum: f64 =
        (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))).map(|(i, j)| value(at(i), at(j))).sum();
    sum / (steps * steps) as f64
}

/// Evenly distributed directions with equal solid angles (Fibonacci spiral).
pub(crate) fn spiral(count: usize) -> impl Iterator<Item = (Vec3, f64)> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let phi = i as f64 * PI * (3.0 - 5f64.sqrt());
        let r = (1.0 - z * z).sqrt();
        (DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3(), 4.0 * PI / count as f64)
    })
}
