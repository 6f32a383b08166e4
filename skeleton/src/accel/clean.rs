//! Which triangles are worth keeping.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::exact;
use crate::dedup::{MIN_PER_THREAD, dedup};

/// What is left of a list of triangles.
pub(super) struct Cleaned {
    /// The triangles that can be hit, each once.
    pub(super) triangles: Vec<[Vec3; 3]>,
    /// The index of each in the list.
    pub(super) primitives: Vec<u32>,
    /// How many were left out because they have no area or are not finite.
    pub(super) degenerate: usize,
    /// Those that were left out because an earlier one has the same corners, in any order; with that one.
    pub(super) duplicates: Vec<[u32; 2]>,
}

/// Leaves out triangles without area, which no ray can hit, and duplicates, of which it could hit any.
///
/// The area is taken from f32 coordinates in f64, where it is 0 only if it truly is: slivers that are needed to
/// close a mesh are kept, however thin.
pub(super) fn clean(all: &[[Vec3; 3]]) -> Cleaned {
    let mut cleaned =
        Cleaned { triangles: Vec::new(), primitives: Vec::new(), degenerate: 0, duplicates: Vec::new() };
    // Adding 0 makes −0 the same as 0.
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
