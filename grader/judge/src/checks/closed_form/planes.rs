//! Two parallel diffuse planes that face each other.

use arty::scene::{Material, Scene, SceneDescription};
use glam::DVec3;
use verdict::check::WhyNot;

use super::pixels::Pixels;

/// Minimum extent of the planes in both directions, relative to their distance.
const MIN_EXTENT: f64 = 100.0;

/// Two parallel planes.
pub(super) struct Planes<'a> {
    /// Normal of the front side of the first plane.
    normal: DVec3,
    /// Materials of the two planes.
    materials: [&'a Material; 2],
}

/// Recognises a scene of two parallel planes; `None` for any other scene.
pub(super) fn recognise(description: &SceneDescription) -> Option<Planes<'_>> {
    if !description.lights.is_empty() || description.environment.is_some() {
        return None;
    }
    let mut planes: Vec<(u32, DVec3, f64)> = Vec::new();
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for mesh in &description.meshes {
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.positions.map(|corner| mesh.positions[corner as usize].as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            for corner in [a, b, c] {
                (low, high) = (low.min(corner), high.max(corner));
            }
            let plane = (triangle.material, normal, normal.dot(a));
            let known = |other: &(u32, DVec3, f64)| {
                other.0 == plane.0 && other.1.dot(normal) > 1.0 - 1e-9 && (other.2 - plane.2).abs() < 1e-6
            };
            if !planes.iter().any(known) {
                planes.push(plane);
            }
        }
    }
    let [first, second] = planes[..] else { return None };
    let gap = -(first.2 + second.2);
    let facing = first.1.dot(second.1) < -(1.0 - 1e-9) && gap > 0.0;
    let mut extents = (high - low).to_array();
    extents.sort_by(f64::total_cmp);
    let material = |index: u32| description.materials.get(index as usize);
    (facing && extents[1] > MIN_EXTENT * gap)
        .then_some(Planes { normal: first.1, materials: [material(first.0)?, material(second.0)?] })
}

impl Planes<'_> {
    /// With up to k bounces, each plane has the radiance L⁽ᵏ⁾ = L_e + ρ L′⁽ᵏ⁻¹⁾, where L′ is that of the other plane.
    pub(super) fn picture(&self, scene: &Scene, max_bounces: u32, rays: u32) -> Result<Pixels, WhyNot> {
        let emitted = self.materials.map(|material| material.emission.to_array().map(f64::from));
        let albedo = self.materials.map(|material| material.diffuse.to_array().map(f64::from));
        let mut radiance = emitted;
        for _ in 0..max_bounces {
            let next = |plane: usize| -> [f64; 3] {
                std::array::from_fn(|channel| {
                    emitted[plane][channel] + albedo[plane][channel] * radiance[1 - plane][channel]
                })
            };
            radiance = [next(0), next(1)];
        }
        Pixels::integrate(scene, rays, |ray| {
            let first = self.normal.dot(ray.direction.as_dvec3()) < 0.0;
            Ok(scene.intersect(ray).map_or([0.0; 3], |_| radiance[usize::from(!first)]))
        })
    }
}
