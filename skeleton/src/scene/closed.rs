//! Tests whether closed surfaces enclose the camera.

use glam::DVec3;
use rayon::slice::ParallelSliceMut;

use crate::dedup::dedup;
use crate::math::Vec3;

/// True if `eye` is inside a closed surface.
///
/// Triangles that share an edge form a surface. It is closed if each of its edges belongs to an even number of its
/// triangles, and encloses the eye if a ray from the eye crosses it an odd number of times. Orientation does not matter, and
/// duplicate triangles cancel. Surfaces that touch without sharing vertices count as open: "closed" is reliable, "open" is
/// not.
pub(super) fn encloses(triangles: &[[Vec3; 3]], eye: Vec3) -> bool {
    let corners = || triangles.as_flattened().iter().copied();
    let (Some(min), Some(max)) = (corners().reduce(Vec3::min), corners().reduce(Vec3::max)) else {
        return false;
    };
    // A quick test: most eyes that are not enclosed are outside the bounding box.
    if eye.cmplt(min).any() || eye.cmpgt(max).any() {
        return false;
    }
    let mut sets = DisjointSets::new(triangles.len());
    let mut alone = Vec::new();
    for owners in edges(triangles).chunk_by(|a, b| a.0 == b.0) {
        for pair in owners.windows(2) {
            sets.union(pair[0].1, pair[1].1);
        }
        if owners.len() % 2 == 1 {
            alone.push(owners[0].1);
        }
    }
    let mut open = vec![false; triangles.len()];
    for triangle in alone {
        open[sets.find(triangle) as usize] = true;
    }
    // For each surface and direction, whether the number of crossings is odd.
    let mut odd = vec![[false; DIRECTIONS.len()]; triangles.len()];
    for (index, vertices) in triangles.iter().enumerate() {
        let set = sets.find(index as u32) as usize;
        if !open[set] {
            let corners = vertices.map(|vertex| vertex.as_dvec3() - eye.as_dvec3());
            for (odd, direction) in odd[set].iter_mut().zip(DIRECTIONS) {
                *odd ^= crosses(corners, direction);
            }
        }
    }
    odd.contains(&[true; DIRECTIONS.len()])
}

/// Directions without simple ratios, so that they are not parallel to diagonals of boxes. One would do; the others guard
/// against coincidences. Their lengths do not matter.
const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.567_143_290_4, 0.739_085_133_2, 0.261_497_212_8),
    DVec3::new(-0.618_033_988_7, 0.141_592_653_5, 0.773_239_104_1),
    DVec3::new(0.271_828_182_8, -0.577_215_664_9, -0.763_932_022_5),
];

/// True if the ray from the origin crosses the triangle.
fn crosses([a, b, c]: [DVec3; 3], direction: DVec3) -> bool {
    // The side of each edge on which the ray passes. Both triangles at an edge compute the same bits up to the sign, so no
    // ray slips between them.
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| direction.dot(from.cross(to)));
    let inside = sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0);
    inside && (a.dot(b.cross(c)) > 0.0) == (sides[0] > 0.0)
}

/// The edges of all triangles, as pairs of vertex numbers with the index of the triangle, sorted.
fn edges(triangles: &[[Vec3; 3]]) -> Vec<([u32; 2], u32)> {
    let corners = triangles.as_flattened();
    // Adding zero turns -0 into 0.
    let numbers = dedup(corners.len(), |corner| (corners[corner] + Vec3::ZERO).to_array().map(f32::to_bits));
    let mut edges = Vec::with_capacity(numbers.len());
    for (index, &[a, b, c]) in numbers.as_chunks().0.iter().enumerate() {
        for mut edge in [[a, b], [b, c], [c, a]] {
            edge.sort_unstable();
            edges.push((edge, index as u32));
        }
    }
    edges.par_sort_unstable();
    edges
}

/// Connected sets of triangles (union–find with path halving).
struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn find(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let grandparent = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = grandparent;
            member = grandparent;
        }
        member
    }

    fn union(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a as usize] = b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cube [-1, 1]³, triangle by triangle.
    fn cube() -> Vec<[Vec3; 3]> {
        let corner =
            |bits: usize| Vec3::from([0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 }));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .map(|corners| corners.map(corner))
            .collect()
    }

    const INSIDE: Vec3 = Vec3::new(0.1, -0.2, 0.3);

    #[test]
    fn a_cube_encloses_its_interior_only() {
        assert!(encloses(&cube(), INSIDE));
        assert!(encloses(&cube(), Vec3::splat(0.999)));
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(!encloses(&cube(), 1.001 * axis) && !encloses(&cube(), -1.001 * axis));
        }
    }

    #[test]
    fn a_missing_triangle_opens_the_surface() {
        for left_out in 0..12 {
            let mut cube = cube();
            cube.remove(left_out);
            assert!(!encloses(&cube, INSIDE));
        }
    }

    #[test]
    fn the_orientation_of_triangles_does_not_matter() {
        for turned in 0..1 << 12 {
            let mut cube = cube();
            for (index, triangle) in cube.iter_mut().enumerate() {
                if turned >> index & 1 == 1 {
                    triangle.swap(0, 1);
                }
            }
            assert!(encloses(&cube, INSIDE));
            // From just outside a face, signed solid angles would add up to a full sphere.
            assert!(!encloses(&cube, Vec3::new(0.0, 0.0, 1.01)));
        }
    }

    #[test]
    fn a_duplicated_sheet_encloses_nothing() {
        let sheet = [[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y]];
        let twice = [sheet, sheet].concat();
        assert!(
            !encloses(&twice, Vec3::new(0.5, 0.5, 0.01)) && !encloses(&twice, Vec3::new(0.5, 0.5, -0.01))
        );
    }
}
