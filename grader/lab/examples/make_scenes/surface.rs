//! Triangles of one material: positions, and normals and texture coordinates where wanted.

use glam::{DVec2, DVec3};

use crate::number::snap_point;

/// A piece of surface. The front of a triangle is the side from which its corners run counter-clockwise.
#[derive(Clone, Default)]
pub(crate) struct Surface {
    /// Corners, already rounded to what can be written.
    pub(crate) positions: Vec<DVec3>,
    /// One unit normal for each position, or none at all for flat shading.
    pub(crate) normals: Vec<DVec3>,
    /// One texture coordinate for each position, or none at all.
    pub(crate) uvs: Vec<DVec2>,
    /// Indices into all three lists.
    pub(crate) triangles: Vec<[usize; 3]>,
}

impl Surface {
    /// A flat-shaded surface.
    pub(crate) fn new(positions: Vec<DVec3>, triangles: Vec<[usize; 3]>) -> Self {
        let positions = positions.into_iter().map(snap_point).collect();
        Self { positions, normals: Vec::new(), uvs: Vec::new(), triangles }
    }

    /// The same with front and back swapped.
    pub(crate) fn flipped(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        for normal in &mut self.normals {
            *normal = -*normal;
        }
        self
    }

    /// The same with normals that are means over the triangles around each corner, weighted by their area.
    pub(crate) fn smooth(mut self) -> Self {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            for &corner in triangle {
                sums[corner] += self.cross(triangle);
            }
        }
        self.normals = sums.into_iter().map(DVec3::normalize).collect();
        self
    }

    /// The same with another surface added. Both or neither must have normals; likewise texture coordinates.
    pub(crate) fn joined(mut self, other: Self) -> Self {
        let offset = self.positions.len();
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.uvs.extend(other.uvs);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|corner| corner + offset)));
        self
    }

    /// The three corners of a triangle.
    pub(crate) fn corners(&self, triangle: &[usize; 3]) -> [DVec3; 3] {
        triangle.map(|corner| self.positions[corner])
    }

    /// Twice the area of a triangle along its front normal.
    pub(crate) fn cross(&self, triangle: &[usize; 3]) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    /// The area of all triangles.
    pub(crate) fn area(&self) -> f64 {
        self.triangles.iter().map(|triangle| self.cross(triangle).length() / 2.0).sum()
    }
}
