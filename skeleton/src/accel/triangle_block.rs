//! Eight triangles against one ray.
//!
//! The test is that of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2(1), 2013): the ray
//! becomes the z axis of a sheared space, and three edge functions say on which side of each edge it passes.
//! Two triangles that share an edge work out the same two products for it, and rounding keeps the order of
//! products, so at worst an edge function is 0 where it should not be, in both of them alike. With 0 taken as
//! inside, no ray passes between the two.
//!
//! The distance decides little: whether a triangle lies before or behind a point. Where rounding could change
//! the answer, [`exact`] gives it.

use glam::Vec3;

use super::exact::{self, Plane};
use super::lanes::{Indices, Lanes, Row, take_lowest};
use super::ray::PreparedRay;

/// Up to eight triangles, as a structure of arrays. Unused lanes are not numbers and so never hit.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// Coordinates by corner and axis.
    pub(super) corners: [[Row; 3]; 3],
    /// The triangles' indices in the list that the structure was built from.
    pub(super) primitives: Indices,
}

/// The planes of a block's triangles, for close calls: apart from the block, which is read far more often.
pub(super) type Planes = [Plane; 8];

/// The index of no triangle.
pub(super) const NO_PRIMITIVE: u32 = u32::MAX;

/// The nearest hit so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest {
    /// Distance in lengths of the direction; at first the end of the ray.
    pub(super) t: f32,
    /// Index of the triangle.
    pub(super) primitive: u32,
    /// Weights of corners 1 and 2, each times `weight_sum`.
    pub(super) weights: [f32; 2],
    /// Sum of all three weights; 0 if nothing has been hit.
    pub(super) weight_sum: f32,
}

/// Where a ray passes eight triangles' planes.
struct Crossing<V> {
    /// Lanes in which it passes through the triangle, before its origin or behind; not that which it leaves.
    inside: u32,
    /// Unnormalised barycentric weights of corners 1 and 2.
    weights: [V; 2],
    /// Sum of all three weights. Times the direction's longest component it is n · d, n = e₁ × e₂.
    weight_sum: V,
    /// n · (v₀ − o): the origin's signed distance from the plane, times |n|.
    height: V,
    /// Largest absolute x or y of a corner in sheared space.
    breadth: V,
    /// Largest absolute z of a corner.
    depth: V,
}

impl TriangleBlock {
    /// A block without triangles.
    pub(super) const EMPTY: Self =
        Self { corners: [[Row([f32::NAN; 8]); 3]; 3], primitives: Indices([NO_PRIMITIVE; 8]) };

    /// Puts a triangle into a lane.
    pub(super) fn set(&mut self, lane: usize, triangle: &[Vec3; 3], primitive: u32) {
        for (rows, corner) in self.corners.iter_mut().zip(triangle) {
            for (row, coordinate) in rows.iter_mut().zip(corner.to_array()) {
                row.0[lane] = coordinate;
            }
        }
        self.primitives.0[lane] = primitive;
    }

    /// Corner 0 of the triangle in a lane.
    #[inline(always)]
    fn first_corner(&self, lane: usize) -> Vec3 {
        Vec3::from_array([0, 1, 2].map(|axis| self.corners[0][axis].0[lane]))
    }

    /// Settles in f64 at what distance the triangle in a lane is ahead, if it is.
    #[inline(always)]
    fn distance_ahead(&self, planes: &Planes, lane: usize, ray: &PreparedRay) -> Option<f32> {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        exact::distance_ahead(&planes[lane], self.first_corner(lane), origin, direction)
    }

    /// Settles in f64 whether the triangle in a lane separates the ray's origin from `target`.
    #[inline(always)]
    fn separates(&self, planes: &Planes, lane: usize, ray: &PreparedRay, target: Vec3) -> bool {
        exact::separates(&planes[lane], self.first_corner(lane), Vec3::from(ray.origin), target)
    }

    /// Replaces `nearest` by the nearest hit in this block if that is nearer.
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

    /// True if a triangle has `target` and the ray's origin on different sides and the ray passes through it
    /// between them. `target` is where the ray is after one length of its direction.
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
        // The distance of the target from the plane, where it is behind it: |step| − |height|.
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

    /// Where the ray passes the eight planes; `None` if it passes through no triangle.
    #[inline(always)]
    fn cross<V: Lanes>(&self, ray: &PreparedRay) -> Option<Crossing<V>> {
        let [a, b, c]: [[V; 3]; 3] = [self.corner(0, ray), self.corner(1, ray), self.corner(2, ray)];
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        let zero = V::splat(0.0);
        let weight_sum = u + v + w;
        // None is negative, or none is positive.
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

    /// A corner of all eight triangles in sheared space.
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
    /// A bound on the error of `height`, and of `height` minus `step` times the direction's longest component.
    ///
    /// With u = 2⁻²⁴, b = breadth, z = depth, m = b + z (no coordinate of a corner relative to the origin is
    /// greater, since the shears are at most 1): sheared coordinates are within 5um, so an edge function is
    /// within 24umb, their sum within 72umb, and the sum weighted with the z coordinates within 96umbz.
    /// `reach`, a bound on the coordinates of a point that is itself rounded to f32, brings in up to
    /// u·reach·(|n₁| + |n₂| + |n₃|), and no component of n is greater than 24b(b + z).
    #[inline(always)]
    fn height_error(&self, step: f32, reach: f32) -> V {
        let size = self.breadth + self.depth;
        V::splat(128.0 * f32::EPSILON / 2.0)
            * (size + V::splat(reach))
            * self.breadth
            * (size + V::splat(step))
    }
}
