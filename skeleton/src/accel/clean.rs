//! Which triangles are worth keeping.

use std::collections::hash_map::Entry;

use foldhash::{HashMap, HashMapExt};
use glam::{DVec3, Vec3};

use super::exact;

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
    let mut seen = HashMap::with_capacity(all.len());
    for (primitive, corners) in all.iter().enumerate() {
        // Adding 0 makes −0 the same as 0.
        let triangle = corners.map(|corner| corner + 0.0);
        if !corners.iter().all(|corner| corner.is_finite()) || exact::normal(&triangle) == DVec3::ZERO {
            cleaned.degenerate += 1;
            continue;
        }
        let mut key = triangle.map(|corner| corner.to_array().map(f32::to_bits));
        key.sort_unstable();
        match seen.entry(key) {
            Entry::Occupied(first) => {
                cleaned.duplicates.push([primitive as u32, *first.get()]);
                continue;
            }
            Entry::Vacant(entry) => entry.insert(primitive as u32),
        };
        cleaned.triangles.push(triangle);
        cleaned.primitives.push(primitive as u32);
    }
    cleaned
}
