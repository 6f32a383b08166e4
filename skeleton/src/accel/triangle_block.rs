//! Intersection of a ray with eight triangles.
//!
//! The test is that of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013): the ray
//! becomes the z axis of a sheared space, and three edge functions tell on which side of each edge it passes. Two triangles
//! that share an edge compute the same two products for it, and rounding preserves the order of products, so at worst an
//! edge function is wrongly 0 in both of them. Since 0 counts as inside, no ray passes between the two.
//!
//! The distance only decides whether a triangle is in front of a point or behind it. Where rounding could change the result,
//! [`exact`] decides.

use glam::Vec3;

use super::exact::{self, Plane};
use super::lanes::{Indices, Lanes, Row, take_lowest};
use super::ray::PreparedRay;

/// Up to eight triangles, as a structure of arrays. Unused lanes are NaN and never hit.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// Coordinates by vertex and axis.
    pub(super) corners: [[Row; 3]; 3],
    /// Indices of the triangles in the input.
    pub(super) primitives: Indices,
}

/// The planes of a block's triangles for [`exact`]. Separate from the block, which is read far more often.
pub(super) type Planes = [Plane; 8];

/// The index of no triangle.
pub(super) const NO_PRIMITIVE: u32 = u32::MAX;

/// The nearest hit so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    /// Distance in multiples of the direction's length; initially the end of the ray.
    pub(super) t: f32,
    /// Index of the triangle.
    pub(super) primitive: u32,
    /// Barycentric weights of vertices 1 and 2, times `weight_sum`.
    pub(super) weights: [f32; 2],
    /// Sum of all three weights; 0 if nothing has been hit.
    pub(super) weight_sum: f32,
}

/// Intersections of a ray with the planes of eight triangles.
struct Crossing<V> {
    /// Mask of the lanes where the line of the ray passes through the triangle; without the excluded one.
    inside: u32,
    /// Unnormalized barycentric weights of vertices 1 and 2.
    weights: [V; 2],
    /// Sum of all three weights. Times the direction's largest component it is n · d, n = e₁ × e₂.
    weight_sum: V,
    /// n · (v₀ − o): the origin's signed distance from the plane, times |n|.
    height: V,
    /// Maximum absolute x or y of a vertex in sheared space.
    breadth: V,
    /// Maximum absolute z of a vertex.
    depth: V,
}

impl TriangleBlock {
    /// An empty block.
    pub(super) const EMPTY: Self =
        Self { corners: [[Row([f32::NAN; 8]); 3]; 3], primitives: Indices([NO_PRIMITIVE; 8]) };

    /// Sets the triangle of a lane.
    pub(super) fn set(&mut self, lane: usize, triangle: &[Vec3; 3], primitive: u32) {
        for (rows, corner) in self.corners.iter_mut().zip(triangle) {
            for (row, coordinate) in rows.iter_mut().zip(corner.to_array()) {
                row.0[lane] = coordinate;
            }
        }
        self.primitives.0[lane] = primitive;
    }

    /// Vertex 0 of the triangle in a lane.
    #[inline(always)]
    fn first_corner(&self, lane: usize) -> Vec3 {
        Vec3::from_array([0, 1, 2].map(|axis| self.corners[0][axis].0[lane]))
    }

    /// Computes the distance to the triangle in a lane in f64; `None` if it is not ahead.
    #[inline(always)]
    fn distance_ahead(&self, planes: &Planes, lane: usize, ray: &PreparedRay) -> Option<f32> {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        exact::distance_ahead(&planes[lane], self.first_corner(lane), origin, direction)
    }

    /// Decides in f64 whether the triangle in a lane separates the ray's origin from `target`.
    #[inline(always)]
    fn separates(&self, planes: &Planes, lane: usize, ray: &PreparedRay, target: Vec3) -> bool {
        exact::separates(&planes[lane], self.first_corner(lane), Vec3::from(ray.origin), target)
    }

    /// Updates `nearest` with the nearest hit in this block.
    #[inline(always)]
    pub(super) fn intersect<V: Lanes>(&self, planes: &Planes, ray: &PreparedRay, nearest: &mut Nearest) {
        let Some(crossing) = self.cross::<V>(ray) else { return };
        let zero = V::splat(0.0);
        let z_scale = V::splat(1.0 / ray.direction[ray.axes[2]]);
        let t = crossing.height.div(crossing.weight_sum) * z_scale;
        let unclear = crossing.inside & crossing.height.abs().le(crossing.height_error(0.0, 0.0));
        let hit = crossing.inside & !unclear & zero.lt(t) & t.lt(V::splat(nearest.t));
        if hit | unclear == 0 {
            return;
        }
        let (t, sum) = (t.store(), crossing.weight_sum.store());
        let (first, second) = (crossing.weights[0].store(), crossing.weights[1].store());
        let mut lanes = hit | unclear;
        while lanes != 0 {
            let lane = take_lowest(&mut lanes);
            let t = if unclear >> lane & 1 == 0 {
                t.0[lane]
            } else {
                match self.distance_ahead(planes, lane, ray) {
                    Some(t) => t,
                    None => continue,
                }
            };
            if t < nearest.t {
                *nearest = Nearest {
                    t,
                    primitive: self.primitives.0[lane],
                    weights: [first.0[lane], second.0[lane]],
                    weight_sum: sum.0[lane],
                };
            }
        }
    }

    /// True if the ray passes through a triangle between its origin and `target`, the point at one length of its direction.
    #[inline(always)]
    pub(super) fn occludes<V: Lanes>(
        &self,
        planes: &Planes,
        ray: &PreparedRay,
        target: Vec3,
        reach: f32,
    ) -> bool {
        let Some(crossing) = self.cross::<V>(ray) else { return false };
        let zero = V::splat(0.0);
        let z = ray.direction[ray.axes[2]];
        let (height, step) = (crossing.height, crossing.weight_sum * V::splat(z));
        let error = crossing.height_error(z.abs(), reach);
        // The distance of the target behind the plane: |step| − |height|.
        let clearance = step.abs() - height.abs();
        let ahead = !(height.lt(zero) ^ step.lt(zero));
        let near_origin = height.abs().le(error);
        let possible = crossing.inside & (ahead | near_origin) & (zero - error).le(clearance);
        let certain = possible & !near_origin & error.lt(clearance);
        if certain != 0 {
            return true;
        }
        let mut lanes = possible;
        while lanes != 0 {
            let lane = take_lowest(&mut lanes);
            if self.separates(planes, lane, ray, target) {
                return true;
            }
        }
        false
    }

    /// Intersections with the eight planes; `None` if the ray passes through no triangle.
    #[inline(always)]
    fn cross<V: Lanes>(&self, ray: &PreparedRay) -> Option<Crossing<V>> {
        let [a, b, c]: [[V; 3]; 3] = [self.corner(0, ray), self.corner(1, ray), self.corner(2, ray)];
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        let zero = V::splat(0.0);
        let weight_sum = u + v + w;
        // All are non-negative, or all are non-positive.
        let inside =
            zero.le(u.min(v).min(w).max(zero - u.max(v).max(w))) & !V::equal(&self.primitives, ray.exclude);
        if inside == 0 {
            return None;
        }
        let inside = inside & zero.lt(weight_sum.abs());
        let (x, y, z) = (largest(a[0], b[0], c[0]), largest(a[1], b[1], c[1]), largest(a[2], b[2], c[2]));
        Some(Crossing {
            inside,
            weights: [v, w],
            weight_sum,
            height: u * a[2] + v * b[2] + w * c[2],
            breadth: x.max(y),
            depth: z,
        })
    }

    /// A vertex of all eight triangles in sheared space.
    #[inline(always)]
    fn corner<V: Lanes>(&self, corner: usize, ray: &PreparedRay) -> [V; 3] {
        let [kx, ky, kz] = ray.axes;
        let rows = &self.corners[corner];
        let z = V::load(&rows[kz]) - V::splat(ray.origin[kz]);
        let x = V::load(&rows[kx]) - V::splat(ray.origin[kx]) - V::splat(ray.shear[0]) * z;
        let y = V::load(&rows[ky]) - V::splat(ray.origin[ky]) - V::splat(ray.shear[1]) * z;
        [x, y, z]
    }
}

#[inline(always)]
fn largest<V: Lanes>(a: V, b: V, c: V) -> V {
    a.abs().max(b.abs()).max(c.abs())
}

impl<V: Lanes> Crossing<V> {
    /// A bound on the error of `height`, and of `height` minus `step` times the direction's largest component.
    ///
    /// With u = 2⁻²⁴, b = breadth, z = depth, m = b + z (a bound on the coordinates of vertices relative to the
    /// origin, since the shears are at most 1): sheared coordinates have an error of up to 5um, edge functions 24umb, their
    /// sum 72umb, and the sum weighted by the z coordinates 96umbz. `reach` bounds the coordinates of a point that is itself
    /// rounded to f32; it adds up to u·reach·(|n₁| + |n₂| + |n₃|), and the components of n are at most 24b(b + z).
    #[inline(always)]
    fn height_error(&self, step: f32, reach: f32) -> V {
        let size = self.breadth + self.depth;
        V::splat(128.0 * f32::EPSILON / 2.0)
            * (size + V::splat(reach))
            * self.breadth
            * (size + V::splat(step))
    }
}
