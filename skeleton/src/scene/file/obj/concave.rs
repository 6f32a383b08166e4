//! Triangulation of concave polygons.
//!
//! `tobj` divides each polygon into a fan around its first corner. That is right for convex ones, which stay as they are.

use earcut::Earcut;
use glam::DVec3;

use super::outline::Polygon;

/// Replaces the fans of concave polygons. The number of triangles stays: where corners on a straight line make some of
/// them superfluous, these have no area.
pub(super) fn triangulate(mesh: &mut tobj::Mesh, polygons: &[Polygon]) {
    let (mut earcut, mut ears, mut corners) = (Earcut::<f64>::new(), Vec::<u32>::new(), Vec::new());
    for polygon in polygons {
        corners.clear();
        corners.extend(fan(polygon).map(|slot| position(mesh, mesh.indices[slot])));
        let Some(normal) = normal_if_concave(&corners) else { continue };
        earcut.earcut(projected(&corners, normal), &[], &mut ears);
        // A polygon that crosses itself has no right triangles.
        if ears.is_empty() || ears.len() > 3 * (polygon.corners - 2) {
            continue;
        }
        for ear in ears.chunks_exact_mut(3) {
            let [a, b, c] = [ear[0], ear[1], ear[2]].map(|corner| corners[corner as usize]);
            if (b - a).cross(c - a).dot(normal) < 0.0 {
                ear.swap(1, 2);
            }
        }
        for indices in [&mut mesh.indices, &mut mesh.texcoord_indices, &mut mesh.normal_indices] {
            if !indices.is_empty() {
                replace(indices, polygon, &ears);
            }
        }
    }
}

/// Writes the triangles of a polygon over its fan.
fn replace(indices: &mut [u32], polygon: &Polygon, ears: &[u32]) {
    let of_corner: Vec<u32> = fan(polygon).map(|slot| indices[slot]).collect();
    let slots = &mut indices[3 * polygon.first..3 * (polygon.first + polygon.corners - 2)];
    let without_area = std::iter::repeat(&0);
    for (slot, corner) in slots.iter_mut().zip(ears.iter().chain(without_area)) {
        *slot = of_corner[*corner as usize];
    }
}

/// Where the index of each corner of a polygon is found in its fan: 0 1 2, 0 2 3, 0 3 4, …
fn fan(polygon: &Polygon) -> impl Iterator<Item = usize> {
    let start = 3 * polygon.first;
    let others = (1..polygon.corners - 1).map(move |triangle| start + 3 * triangle - 1);
    [start, start + 1].into_iter().chain(others)
}

fn position(mesh: &tobj::Mesh, index: u32) -> DVec3 {
    let start = 3 * index as usize;
    DVec3::from_array([0, 1, 2].map(|axis| f64::from(mesh.positions[start + axis])))
}

/// The normal of a polygon, twice its area long, if it turns the other way at some corner.
fn normal_if_concave(corners: &[DVec3]) -> Option<DVec3> {
    let next = |index: usize| corners[(index + 1) % corners.len()];
    let origin = *corners.first()?;
    let all = 0..corners.len();
    let normal: DVec3 = all.clone().map(|at| (corners[at] - origin).cross(next(at) - origin)).sum();
    // Corners on a straight line, up to rounding, are no reason to cut a polygon differently.
    let is_concave = |at: usize| {
        let (one, other) = (next(at) - corners[at], next((at + 1) % corners.len()) - next(at));
        one.cross(other).dot(normal) < -ROUNDING * one.length() * other.length() * normal.length()
    };
    all.into_iter().any(is_concave).then_some(normal)
}

/// Sine of the largest angle that counts as rounding.
const ROUNDING: f64 = 1e-5;

/// The corners in the coordinate plane that the polygon is most parallel to.
fn projected(corners: &[DVec3], normal: DVec3) -> impl Iterator<Item = [f64; 2]> {
    let size = normal.abs();
    let axes = if size.x >= size.y && size.x >= size.z {
        [1, 2]
    } else if size.y >= size.z {
        [2, 0]
    } else {
        [0, 1]
    };
    corners.iter().map(move |corner| axes.map(|axis| corner[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of the triangles of a polygon, and the area of its fan.
    fn areas(corners: &[[f32; 3]]) -> [f64; 2] {
        let last = corners.len() as u32 - 1;
        let fan: Vec<u32> = (1..last).flat_map(|corner| [0, corner, corner + 1]).collect();
        let mut mesh = tobj::Mesh { positions: corners.concat(), indices: fan, ..tobj::Mesh::default() };
        let area = |mesh: &tobj::Mesh| {
            let area = |triangle: &[u32]| {
                let [a, b, c] = [0, 1, 2].map(|corner| position(mesh, triangle[corner]));
                (b - a).cross(c - a).length() / 2.0
            };
            mesh.indices.chunks_exact(3).map(area).sum()
        };
        let before = area(&mesh);
        triangulate(&mut mesh, &[Polygon { first: 0, corners: corners.len() }]);
        [area(&mesh), before]
    }

    #[test]
    fn the_area_of_a_concave_polygon_is_its_own() {
        let arrow = [[2.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]];
        // All four beginnings, both orientations, in three planes.
        for start in 0..4 {
            for plane in 0..3 {
                let turned = |index: usize| {
                    let mut corner = arrow[(start + index) % 4];
                    corner.rotate_right(plane);
                    corner
                };
                let forward: Vec<_> = (0..4).map(turned).collect();
                let backward: Vec<_> = forward.iter().rev().copied().collect();
                for corners in [forward, backward] {
                    let [area, _] = areas(&corners);
                    assert!((area - 1.0).abs() < 1e-9, "{area} of {corners:?}");
                }
            }
        }
        assert!(areas(&arrow)[1] > 1.4, "the fan covers too much");
        // A comb with teeth of area 1 each, and a corner on a straight line.
        let comb = [
            [0., 0.],
            [3., 0.],
            [5., 0.],
            [5., 1.],
            [4., 1.],
            [4., 2.],
            [3., 2.],
            [3., 1.],
            [2., 1.],
            [2., 2.],
            [1., 2.],
            [1., 1.],
            [0., 1.],
        ];
        let [area, before] = areas(&comb.map(|[x, y]: [f32; 2]| [x, y, 0.0]));
        assert!((area - 7.0).abs() < 1e-9 && before > 7.0, "{area}, {before}");
    }

    #[test]
    fn a_convex_polygon_stays_a_fan_and_a_hopeless_one_does_no_harm() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(areas(&square), [1.0, 1.0]);
        for hopeless in [[[0.0; 3]; 5], [[0., 0., 0.], [1., 1., 0.], [1., 0., 0.], [0., 1., 0.], [0.; 3]]] {
            assert!(areas(&hopeless)[0].is_finite());
        }
    }
}
