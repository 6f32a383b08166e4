//! The albedo of a surface, by quadrature.

use std::f64::consts::PI;

use arty::math::Vec3;
use arty::ray::Ray;
use arty::scene::Hit;

/// Number of polar angles and of azimuths.
const ANGLES: (usize, usize) = (48, 72);

/// An albedo by channel.
pub(super) struct Albedo {
    pub(super) value: [f64; 3],
    /// Error of the quadrature: the largest difference from the same with half as many angles, which is an upper
    /// bound where the quadrature converges.
    pub(super) error: f64,
}

/// Quadrature over the hemisphere, in two resolutions.
pub(super) struct Quadrature {
    fine: Vec<Node>,
    coarse: Vec<Node>,
}

/// A direction around the normal, on one side of the plane of incidence, and its share of the integral over the projected
/// hemisphere, together with its mirror image.
struct Node {
    direction: Vec3,
    weight: f64,
}

impl Quadrature {
    /// Prepares the nodes, which do not depend on the surface.
    pub(super) fn new() -> Self {
        Self { fine: nodes(ANGLES), coarse: nodes((ANGLES.0 / 2, ANGLES.1 / 2)) }
    }

    /// ∫ f cos θ dω where a ray hits an isotropic surface.
    pub(super) fn albedo(&self, ray: &Ray, hit: &Hit<'_>) -> Albedo {
        let (value, coarse) = (integrate(ray, hit, &self.fine), integrate(ray, hit, &self.coarse));
        let error = (0..3).map(|channel| (value[channel] - coarse[channel]).abs()).fold(0.0, f64::max);
        Albedo { value, error }
    }
}

/// Spherical coordinates around the normal, so that the horizon, where a lobe is cut off, is the end of an interval. Gauss
/// and Legendre's rule for the polar angle, equal steps of the azimuth: both converge exponentially for smooth lobes. An
/// isotropic lobe is symmetric about the plane of incidence, from which azimuths are measured.
fn nodes((polar, azimuths): (usize, usize)) -> Vec<Node> {
    let ring = |(node, weight): (f64, f64)| {
        let (sin, cos) = (0.25 * PI * (1.0 + node)).sin_cos();
        let solid_angle = 0.25 * PI * weight * sin * 2.0 * PI / azimuths as f64;
        (0..azimuths / 2).map(move |step| {
            let azimuth = 2.0 * PI * (step as f64 + 0.5) / azimuths as f64;
            let direction = Vec3::new((sin * azimuth.cos()) as f32, (sin * azimuth.sin()) as f32, cos as f32);
            Node { direction, weight: 2.0 * cos * solid_angle }
        })
    };
    gauss_legendre(polar).flat_map(ring).collect()
}

fn integrate(ray: &Ray, hit: &Hit<'_>, nodes: &[Node]) -> [f64; 3] {
    let bsdf = hit.bsdf();
    let [x, y, z] = axes(ray.direction, hit.normal);
    let mut sum = [0.0; 3];
    for node in nodes {
        let local = node.direction;
        let f = bsdf.eval(local.x * x + local.y * y + local.z * z).to_array();
        (0..3).for_each(|channel| sum[channel] += f64::from(f[channel]) * node.weight);
    }
    sum
}

/// Axes with the normal as the third, and the first in the plane of incidence.
fn axes(incident: Vec3, normal: Vec3) -> [Vec3; 3] {
    let across = incident.reject_from_normalized(normal).try_normalize();
    let tangent = across.unwrap_or_else(|| normal.any_orthonormal_vector());
    [tangent, normal.cross(tangent), normal]
}

/// Nodes in [−1, 1] and weights: the roots of the Legendre polynomial of this degree, by Newton's method.
fn gauss_legendre(degree: usize) -> impl Iterator<Item = (f64, f64)> {
    let n = degree as f64;
    (0..degree).map(move |i| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=degree {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use arty::math::Rgb;
    use arty::scene::{Material, Scene, Specular};

    use super::*;
    use crate::scenes;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for (power, exact) in [(0, 2.0), (1, 0.0), (2, 2.0 / 3.0), (30, 2.0 / 31.0)] {
            let sum: f64 = gauss_legendre(16).map(|(x, weight)| weight * x.powi(power)).sum();
            assert!((sum - exact).abs() < 1e-12, "x^{power}: {sum}");
        }
    }

    /// The Phong lobe in double precision, around the mirror direction, with midpoints: another formula, another rule.
    fn exact(cos_viewer: f64, exponent: f64) -> f64 {
        const STEPS: (u32, u32) = (2000, 500);
        let sin_viewer = (1.0 - cos_viewer * cos_viewer).sqrt();
        let mut sum = 0.0;
        for i in 0..STEPS.0 {
            let angle = 0.5 * PI * (f64::from(i) + 0.5) / f64::from(STEPS.0);
            let (sin, cos) = angle.sin_cos();
            for j in 0..STEPS.1 {
                let azimuth = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(STEPS.1);
                let height = cos * cos_viewer + sin * azimuth.cos() * sin_viewer;
                sum += cos.powf(exponent) * height.max(0.0) * sin;
            }
        }
        let cell = 0.5 * PI / f64::from(STEPS.0) * 2.0 * PI / f64::from(STEPS.1);
        (exponent + 2.0) / (2.0 * PI) * sum * cell
    }

    #[test]
    fn the_stated_error_covers_the_difference_from_an_independent_integration() {
        for exponent in [4.0, 20.0, 60.0] {
            let reflectance = Rgb::gray(0.5);
            let material = Material {
                specular: Specular::Phong { reflectance, exponent: exponent as f32 },
                ..scenes::grey(0.0, 0.0)
            };
            let mut description = scenes::empty();
            scenes::add(&mut description, &scenes::floor(0.0, 8.0), material);
            let scene = Scene::new(&description);
            for cos in [1.0f64, 0.8, 0.4, 0.1] {
                let back = Vec3::new((1.0 - cos * cos).sqrt() as f32, cos as f32, 0.0);
                let ray = Ray::new(2.0 * back, -back);
                let hit = scene.intersect(&ray).expect("it hits the floor");
                let albedo = Quadrature::new().albedo(&ray, &hit);
                let difference = (albedo.value[0] - 0.5 * exact(cos, exponent)).abs();
                assert!(albedo.error < 1e-3, "{exponent}, {cos}: {}", albedo.error);
                // 1e-5 for single precision and for the midpoints.
                assert!(
                    difference <= albedo.error + 1e-5,
                    "{exponent}, {cos}: {difference} > {}",
                    albedo.error
                );
            }
        }
    }
}
