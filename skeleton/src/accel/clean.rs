//! Removal of degenerate and duplicate triangles.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::exact;
use crate::dedup::{MIN_PER_THREAD, dedup};

/// The triangles that are kept.
pub(super) struct Cleaned {
    /// Triangles that can be hit, without duplicates.
    pub(super) triangles: Vec<[Vec3; 3]>,
    /// Index of each triangle in the input.
    pub(super) primitives: Vec<u32>,
    /// Number of triangles removed because they have no area or are not finite.
    pub(super) degenerate: usize,
    /// Triangles removed because an earlier one has the same vertices, in any order; each with that one.
    pub(super) duplicates: Vec<[u32; 2]>,
}

/// Removes triangles without an area, which no ray can hit, and duplicates, of which a ray could hit any.
///
/// The area of f32 coordinates is computed in f64, where it is 0 only if it is exactly 0: slivers that close a mesh are kept,
/// however thin.
pub(super) fn clean(all: &[[Vec3; 3]]) -> Cleaned {
    let mut cleaned =
        Cleaned { triangles: Vec::new(), primitives: Vec::new(), degenerate: 0, duplicates: Vec::new() };
    // Adding 0 turns −0 into 0.
    let prepared = |corners: &[Vec3; 3]| corners.map(|corner| corner + 0.0);
    let can_be_hit = |(primitive, corners): (usize, &[Vec3; 3])| {
        let finite = corners.iter().all(|corner| corner.is_finite());
        (finite && exact::normal(&prepared(corners)) != DVec3::ZERO).then_some(primitive as u32)
    };
    let kept: Vec<u32> =
        all.par_iter().with_min_len(MIN_PER_THREAD).enumerate().filter_map(can_be_hit).collect();
    cleaned.degenerate = all.len() - kept.len();
    let first_equal = dedup(kept.len(), |index| {
        let mut key = prepared(&all[kept[index] as usize]).map(|corner| corner.to_array().map(f32::to_bits));
        key.sort_unstable();
        key
    });
    for (index, (&primitive, &first)) in kept.iter().zip(&first_equal).enumerate() {
        if first as usize == index {
            cleaned.triangles.push(prepared(&all[primitive as usize]));
            cleaned.primitives.push(primitive);
        } else {
            cleaned.duplicates.push([primitive, kept[first as usize]]);
        }
    }
    cleaned
}
