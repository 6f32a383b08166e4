//! The acceleration structure: the nearest hit of a ray, and visibility between two points.
//!
//! Triangles are grouped into blocks of eight (`triangle_block`) at the leaves of an 8-wide bounding volume hierarchy
//! (`tree`, `traverse`). It is watertight: rays leak neither through edges and vertices nor because they start or end next
//! to a surface (`exact`).
//!
//! # Where the speed comes from
//! Measured on the paths of a path tracer, one ray at a time, since that is how integrators trace them.
//!
//! - Eight triangles or eight boxes are tested at once (`lanes`), in a few dozen instructions. The remaining time
//!   is spent waiting: for mispredicted branches, for divisions, and for memory that was written in parts and is
//!   read as a whole. So vectors enter the traversal in registers (`Pairs`), the stack's length stays in a register,
//!   and a hit is written in one piece.
//! - The blocks of a node are tested together with the node, and only nodes wait on the stack, while they are
//!   fetched from memory. With nodes and blocks in one queue, the processor mispredicts which of them comes next.
//! - Shadow rays visit the farthest children first: what surrounds their origin seldom blocks them.
//! - A ray excludes the triangle that it starts on (`Ray::exclude`, set by `Hit::spawn`). Otherwise each ray starts
//!   with a predicate that has to be decided in f64. The images are identical to the last bit.
//! - Equal triangles, boxes and corners are found by sorting their hashes on all cores (`dedup`): a hash table
//!   waits for memory at each step.
//! - Features that a scene does not have cost nothing: purely diffuse materials take a path of their own that is
//!   small enough to be inlined (`Bsdf::only_diffuse`), and normals and texture coordinates are stored only for
//!   triangles that have them.
//!
//! Tried and not faster: testing all blocks of a small scene without branches, other costs for nodes and blocks in
//! `tree`, compiling the whole program for AVX2, and inlining all lobes.

mod binary;
mod clean;
mod exact;
mod lanes;
mod offset;
mod ray;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;
mod triangle_block;

use glam::Vec3;

pub use offset::{offset_origin, point_on};

use binary::BinaryTree;
use lanes::{Lanes, Portable};
use ray::PreparedRay;
use tree::Tree;
use triangle_block::{NO_PRIMITIVE, Nearest};

/// A bounding volume hierarchy over triangles.
#[derive(Clone, Debug)]
pub struct Accel {
    tree: Tree,
    /// Power of two by which coordinates are scaled, so that products of three lengths are within the range of f32.
    scale: f32,
    /// Whether to use the code compiled for AVX2.
    #[cfg(target_arch = "x86_64")]
    avx2: bool,
    stats: AccelStats,
    duplicates: Vec<[u32; 2]>,
}

/// Statistics of the acceleration structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AccelStats {
    /// Number of triangles that can be hit.
    pub triangles: usize,
    /// Number of triangles ignored because they have no area or a coordinate that is not finite.
    pub degenerate: usize,
    /// Number of triangles ignored because an earlier one has the same three vertices, in any order.
    pub duplicates: usize,
    /// Number of nodes; 0 if all blocks are tested one by one.
    pub nodes: usize,
    /// Maximum number of nodes from the root to a block.
    pub depth: usize,
    /// Number of blocks of up to eight triangles.
    pub blocks: usize,
}

/// The intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance from the origin in multiples of the direction's length; positive.
    pub t: f32,
    /// Index into the triangles that the structure was built from.
    pub primitive: u32,
    /// Barycentric weights of vertices 1 and 2: non-negative, with a sum of at most 1.
    pub barycentrics: [f32; 2],
}

impl Accel {
    /// Builds the structure over triangles given by their vertices. Triangles are two-sided.
    ///
    /// Degenerate and duplicate triangles are ignored ([`stats`](Self::stats) has their numbers); of duplicates the first is
    /// kept.
    pub fn build(triangles: &[[Vec3; 3]]) -> Self {
        let mut cleaned = clean::clean(triangles);
        let corners = cleaned.triangles.as_flattened_mut();
        let scale =
            scale_for(corners.iter().fold(0.0, |max: f32, corner| max.max(corner.abs().max_element())));
        corners.iter_mut().for_each(|corner| *corner *= scale);
        let mut tree =
            Tree::collapse(&BinaryTree::cluster(&cleaned.triangles), &cleaned.triangles, &cleaned.primitives);
        if tree.waiting > traverse::STACK_SIZE {
            tree = Tree::collapse(
                &BinaryTree::halve(&cleaned.triangles),
                &cleaned.triangles,
                &cleaned.primitives,
            );
        }
        let stats = AccelStats {
            triangles: cleaned.triangles.len(),
            degenerate: cleaned.degenerate,
            duplicates: cleaned.duplicates.len(),
            nodes: tree.nodes.len(),
            depth: tree.depth,
            blocks: tree.blocks.len(),
        };
        Self {
            scale,
            #[cfg(target_arch = "x86_64")]
            avx2: std::arch::is_x86_feature_detected!("avx2"),
            stats,
            duplicates: cleaned.duplicates,
            tree,
        }
    }

    /// Statistics.
    pub fn stats(&self) -> AccelStats {
        self.stats
    }

    /// The triangles ignored as duplicates, each with the earlier one that was kept.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// The nearest hit with a distance strictly between 0 and `t_max`, in multiples of `direction`'s length.
    ///
    /// `direction` may have any length well within the range of f32. Rays with a zero direction or with NaN or infinite
    /// coordinates hit nothing. `exclude` is a triangle that is not tested: the one that the ray starts on, whose origin must
    /// be offset from it anyway.
    #[inline]
    pub fn intersect(
        &self,
        origin: Vec3,
        direction: Vec3,
        t_max: f32,
        exclude: Option<u32>,
    ) -> Option<TriangleHit> {
        let (ray, exclude) = (Pairs::of(origin, direction), exclude.unwrap_or(NO_PRIMITIVE));
        #[cfg(target_arch = "x86_64")]
        if self.avx2 {
            // SAFETY: `build` has checked that the machine has AVX2.
            return unsafe { self.intersect_avx2(ray.x, ray.y, ray.z, t_max, exclude) };
        }
        self.intersect_portable(ray.x, ray.y, ray.z, t_max, exclude)
    }

    /// True if a triangle other than `exclude` is strictly between `origin` and `target`.
    ///
    /// A triangle is between them if they are strictly on opposite sides of its plane and their connecting line intersects it.
    /// `target` may be rounded: a triangle that contains it up to the rounding of coordinates to f32, such as that of a light,
    /// does not count. There is no such tolerance for `origin`: a point on a surface must be offset first
    /// ([`offset_origin`]).
    #[inline]
    pub fn occluded(&self, origin: Vec3, target: Vec3, exclude: Option<u32>) -> bool {
        let (ends, exclude) = (Pairs::of(origin, target), exclude.unwrap_or(NO_PRIMITIVE));
        #[cfg(target_arch = "x86_64")]
        if self.avx2 {
            // SAFETY: `build` has checked that the machine has AVX2.
            return unsafe { self.occluded_avx2(ends.x, ends.y, ends.z, exclude) };
        }
        self.occluded_portable(ends.x, ends.y, ends.z, exclude)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn intersect_avx2(&self, x: Pair, y: Pair, z: Pair, t_max: f32, exclude: u32) -> Option<TriangleHit> {
        self.intersect_with::<lanes::Avx>(Pairs { x, y, z }, t_max, exclude)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn occluded_avx2(&self, x: Pair, y: Pair, z: Pair, exclude: u32) -> bool {
        self.occluded_with::<lanes::Avx>(Pairs { x, y, z }, exclude)
    }

    #[inline(never)]
    fn intersect_portable(&self, x: Pair, y: Pair, z: Pair, t_max: f32, exclude: u32) -> Option<TriangleHit> {
        self.intersect_with::<Portable>(Pairs { x, y, z }, t_max, exclude)
    }

    #[inline(never)]
    fn occluded_portable(&self, x: Pair, y: Pair, z: Pair, exclude: u32) -> bool {
        self.occluded_with::<Portable>(Pairs { x, y, z }, exclude)
    }

    #[inline(always)]
    fn intersect_with<V: Lanes>(&self, ray: Pairs, t_max: f32, exclude: u32) -> Option<TriangleHit> {
        let [origin, direction] = ray.vectors();
        let ray = PreparedRay::new(origin * self.scale, direction * self.scale, exclude)?;
        // With an infinite end, the empty boxes of unused lanes would be hit if rounding takes the origin to infinity.
        let end = if t_max > f32::MAX { f32::MAX } else { t_max };
        let mut nearest = Nearest { t: end, primitive: 0, weights: [0.0; 2], weight_sum: 0.0 };
        self.tree.intersect::<V>(&ray, &mut nearest);
        let Nearest { t, primitive, weights, weight_sum } = nearest;
        if weight_sum == 0.0 {
            return None;
        }
        let first = weights[0] / weight_sum;
        let second = (weights[1] / weight_sum).min(1.0 - first);
        Some(TriangleHit { t, primitive, barycentrics: [first, second] })
    }

    #[inline(always)]
    fn occluded_with<V: Lanes>(&self, ends: Pairs, exclude: u32) -> bool {
        let [origin, target] = ends.vectors();
        let (origin, target) = (origin * self.scale, target * self.scale);
        // A single rounding; f64 would give the same result.
        let Some(ray) = PreparedRay::new(origin, target - origin, exclude) else { return false };
        let reach = origin.abs().max_element() + target.abs().max_element();
        self.tree.occluded::<V>(&ray, target, reach)
    }
}

/// Coordinates of two vectors along one axis.
type Pair = (f32, f32);

/// Two vectors, by axis.
///
/// Pairs are passed in registers, vectors in memory: there the caller has just written them coordinate by coordinate, and a
/// wide load would stall until all stores are complete.
#[derive(Clone, Copy)]
struct Pairs {
    x: Pair,
    y: Pair,
    z: Pair,
}

impl Pairs {
    #[inline(always)]
    fn of(first: Vec3, second: Vec3) -> Self {
        Self { x: (first.x, second.x), y: (first.y, second.y), z: (first.z, second.z) }
    }

    #[inline(always)]
    fn vectors(self) -> [Vec3; 2] {
        [Vec3::new(self.x.0, self.y.0, self.z.0), Vec3::new(self.x.1, self.y.1, self.z.1)]
    }
}

/// The power of two that scales coordinates of magnitude up to `max` such that products of three of them, or of differences
/// a million times smaller, are well within the range of f32. Almost always 1.
fn scale_for(max: f32) -> f32 {
    const MIN: f32 = 1.0 / (1 << 15) as f32;
    const MAX: f32 = (1u64 << 35) as f32;
    if max == 0.0 || (MIN..MAX).contains(&max) {
        return 1.0;
    }
    // The negated exponent of `max`, within the range of f32.
    let exponent = max.log2().floor().clamp(-126.0, 126.0);
    (-exponent).exp2()
}
