//! Tests of the acceleration structure; shared here: random numbers, closed meshes, placements.

mod build;
mod ends;
mod hits;
mod leaks;

use glam::{DVec3, Vec3};

type Triangle = [Vec3; 3];

/// SplitMix64, with fixed seeds.
struct Random(u64);

impl Random {
    /// In [0, 1).
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 40) as f32 / (1u64 << 24) as f32
    }

    fn index(&mut self, count: usize) -> usize {
        (self.next() * count as f32) as usize % count
    }

    /// In the cube from −1 to 1.
    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let point = self.point();
            if (0.01..1.0).contains(&point.length_squared()) {
                return point.normalize();
            }
        }
    }

    /// Barycentric weights of vertices 1 and 2, uniform over a triangle.
    fn barycentrics(&mut self) -> [f32; 2] {
        let (v, w) = (self.next(), self.next());
        if v + w > 1.0 { [1.0 - v, 1.0 - w] } else { [v, w] }
    }
}

/// A closed ball with a rough surface: each face of an octahedron is divided into `n`² triangles. It contains the ball of
/// half its radius and is star-shaped around its centre.
fn ball(n: usize, roughness: f32, place: impl Fn(Vec3) -> Vec3) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let sign = Vec3::new(
            if octant & 1 == 0 { 1.0 } else { -1.0 },
            if octant & 2 == 0 { 1.0 } else { -1.0 },
            if octant & 4 == 0 { 1.0 } else { -1.0 },
        );
        let at = |i: usize, j: usize| {
            let grid = Vec3::new(i as f32, j as f32, (n - i - j) as f32) * sign;
            // The radius depends on the vertex only, so that the mesh is closed.
            let seed = (grid.x as i64 * 1_000_003 + grid.y as i64 * 1_009 + grid.z as i64) as u64;
            place(grid.normalize() * (1.0 - roughness * Random(seed).next()))
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 2 <= n {
                    triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    triangles
}

/// The cube from −1 to 1, each face divided into `n`² squares.
fn cube(n: usize, place: impl Fn(Vec3) -> Vec3) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let at = |i: usize| 2.0 * i as f32 / n as f32 - 1.0;
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |u: usize, v: usize| {
                        let mut point = Vec3::splat(side);
                        point[(axis + 1) % 3] = at(i + u);
                        point[(axis + 2) % 3] = at(j + v);
                        place(point)
                    };
                    triangles.push([corner(0, 0), corner(1, 0), corner(1, 1)]);
                    triangles.push([corner(0, 0), corner(1, 1), corner(0, 1)]);
                }
            }
        }
    }
    triangles
}

/// Placements of scenes: scaled, and moved by a thousand times their size.
const PLACES: [(f32, f32); 6] = [(1.0, 0.0), (1e-4, 0.0), (1e4, 0.0), (1.0, 1e3), (1e-4, 1e3), (1e4, 1e3)];

fn place((scale, offset): (f32, f32)) -> impl Fn(Vec3) -> Vec3 {
    move |point| (point + offset * Vec3::new(1.0, -0.7, 0.4)) * scale
}

fn unit_normal(triangle: &Triangle) -> DVec3 {
    super::exact::normal(triangle).normalize()
}
