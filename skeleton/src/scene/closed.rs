//! Is the camera enclosed?

use std::collections::HashMap;

use super::Triangle;
use crate::math::Vec3;

/// True if `eye` lies inside a surface without a hole.
///
/// Triangles that share an edge belong together. A set of them has no hole if each of its edges belongs to an even
/// number of its triangles; whether it encloses the eye is told by its winding number, the sum of the solid angles
/// of its triangles (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983) over 4π. Surfaces that only
/// touch without sharing vertices count as open, so that "closed" can be relied on and "open" cannot.
pub(super) fn encloses(triangles: &[Triangle], eye: Vec3) -> bool {
    let (triangle_vertices, edges) = edges(triangles);
    let mut sets = DisjointSets::new(triangles.len());
    for owners in edges.values() {
        for pair in owners.windows(2) {
            sets.union(pair[0], pair[1]);
        }
    }
    let mut open = vec![false; triangles.len()];
    for owners in edges.values().filter(|owners| owners.len() % 2 == 1) {
        open[sets.find(owners[0]) as usize] = true;
    }
    let mut solid_angles = vec![0.0; triangles.len()];
    for (index, vertices) in triangle_vertices.iter().enumerate() {
        let set = sets.find(index as u32) as usize;
        if !open[set] {
            solid_angles[set] += solid_angle(vertices.map(|vertex| (vertex - eye).as_dvec3()));
        }
    }
    solid_angles.iter().any(|angle: &f64| angle.abs() > 2.0 * std::f64::consts::PI)
}

type Edge = [[u32; 3]; 2];

/// The corners of each triangle, and for each edge, by the bits of its end points, the triangles it belongs to.
fn edges(triangles: &[Triangle]) -> (Vec<[Vec3; 3]>, HashMap<Edge, Vec<u32>>) {
    let mut edges: HashMap<Edge, Vec<u32>> = HashMap::new();
    let mut vertices = Vec::with_capacity(triangles.len());
    for (index, triangle) in triangles.iter().enumerate() {
        // Adding zero makes -0 into 0.
        let key = triangle.vertices.map(|vertex| (vertex + Vec3::ZERO).to_array().map(f32::to_bits));
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let mut edge = [key[a], key[b]];
            edge.sort_unstable();
            edges.entry(edge).or_default().push(index as u32);
        }
        vertices.push(triangle.vertices);
    }
    (vertices, edges)
}

/// The solid angle of a triangle seen from the origin, positive if it is seen from its back.
fn solid_angle([a, b, c]: [glam::DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(denominator)
}

/// Sets of triangles that grow together (union by path halving).
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
