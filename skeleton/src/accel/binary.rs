//! Binary trees over triangles, with one triangle per leaf.

use glam::Vec3;
use obvhs::Boundable;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::dedup::dedup;

/// Maximum depth of trees that are optimized. Typical meshes have half of it.
const DEPTH_WORTH_IMPROVING: usize = 64;

/// Nodes, the root first, parents before their children.
pub(super) struct BinaryTree {
    /// The nodes; empty without triangles.
    pub(super) nodes: Vec<BinaryNode>,
}

/// A node with two children, or a leaf with one triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    /// Minimum corner of the bounding box.
    pub(super) min: Vec3,
    /// Maximum corner of the bounding box.
    pub(super) max: Vec3,
    /// Number of triangles in the subtree.
    pub(super) triangles: u32,
    /// Index of the first of two consecutive children; in a leaf the index of the triangle.
    pub(super) first: u32,
}

impl BinaryNode {
    /// The indices of the two children; `None` for a leaf.
    #[inline]
    pub(super) fn children(&self) -> Option<[usize; 2]> {
        (self.triangles > 1).then_some([self.first as usize, self.first as usize + 1])
    }

    /// Half the surface area of the box, which is proportional to the probability that a ray hits it.
    pub(super) fn half_area(&self) -> f32 {
        let size = self.max - self.min;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// The bounding box of a triangle.
struct Bounds([Vec3; 2]);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        Aabb::new(self.0[0].into(), self.0[1].into())
    }
}

fn bounds(&[a, b, c]: &[Vec3; 3]) -> [Vec3; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// What a node is built from.
enum Source {
    /// A node of the tree from obvhs.
    Obvhs(usize),
    /// A range of triangles, to be split in halves.
    Range(usize, usize),
}

impl BinaryTree {
    /// Builds the tree with obvhs: locally ordered clustering, optimized by reinsertion.
    ///
    /// Triangles with equal boxes are passed to obvhs as one; otherwise it would make a level for each of them.
    pub(super) fn cluster(triangles: &[[Vec3; 3]]) -> Self {
        let same_box = dedup(triangles.len(), |triangle| {
            bounds(&triangles[triangle]).map(|corner| corner.to_array().map(f32::to_bits))
        });
        let mut boxes = Vec::with_capacity(triangles.len());
        let mut groups: Vec<usize> = Vec::with_capacity(triangles.len());
        for (index, (triangle, &first)) in triangles.iter().zip(&same_box).enumerate() {
            if first as usize == index {
                groups.push(boxes.len());
                boxes.push(Bounds(bounds(triangle)));
            } else {
                groups.push(groups[first as usize]);
            }
        }
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        order.sort_by_key(|triangle| groups[*triangle as usize]);
        let mut starts: Vec<usize> = Vec::with_capacity(boxes.len() + 1);
        for (position, triangle) in order.iter().enumerate() {
            if groups[*triangle as usize] == starts.len() {
                starts.push(position);
            }
        }
        starts.push(order.len());

        let indices = (0..boxes.len() as u32).collect();
        let mut obvhs = PlocBuilder::with_capacity(boxes.len()).build(
            PlocSearchDistance::Medium,
            &boxes,
            indices,
            SortPrecision::U64,
            3,
        );
        if depth(&obvhs) <= DEPTH_WORTH_IMPROVING {
            let mut optimizer = ReinsertionOptimizer::default();
            optimizer.run(&mut obvhs, 0.05, None);
            optimizer.run(&mut obvhs, 0.1, None);
        }
        let root = if obvhs.nodes.is_empty() { Source::Range(0, 0) } else { Source::Obvhs(0) };
        Self::expand(triangles, order, root, &obvhs, &starts)
    }

    /// Builds a tree by splitting at the median: its depth is the logarithm of the number of triangles, rounded up, but it is
    /// slower to traverse.
    pub(super) fn halve(triangles: &[[Vec3; 3]]) -> Self {
        let order: Vec<u32> = (0..triangles.len() as u32).collect();
        let all = Source::Range(0, order.len());
        Self::expand(triangles, order, all, &Bvh2::default(), &[])
    }

    /// Builds the nodes from their sources. `starts` has the index into `order` of the first triangle of each box passed to
    /// `obvhs`.
    fn expand(
        triangles: &[[Vec3; 3]],
        mut order: Vec<u32>,
        root: Source,
        obvhs: &Bvh2,
        starts: &[usize],
    ) -> Self {
        let blank = BinaryNode { min: Vec3::ZERO, max: Vec3::ZERO, triangles: 0, first: 0 };
        let mut nodes = Vec::with_capacity(2 * triangles.len());
        let mut open = Vec::new();
        if !triangles.is_empty() {
            nodes.push(blank);
            open.push((0, root));
        }
        while let Some((index, source)) = open.pop() {
            let halves = match source {
                Source::Obvhs(node) => {
                    let node = &obvhs.nodes[node];
                    let first = node.first_index as usize;
                    if node.is_leaf() {
                        let group = obvhs.primitive_indices[first] as usize;
                        open.push((index, Source::Range(starts[group], starts[group + 1])));
                        continue;
                    }
                    [Source::Obvhs(first), Source::Obvhs(first + 1)]
                }
                Source::Range(start, end) if end - start == 1 => {
                    let triangle = order[start];
                    let [min, max] = bounds(&triangles[triangle as usize]);
                    nodes[index] = BinaryNode { min, max, triangles: 1, first: triangle };
                    continue;
                }
                Source::Range(start, end) => {
                    let middle = (end - start) / 2;
                    separate(triangles, &mut order[start..end], middle);
                    [Source::Range(start, start + middle), Source::Range(start + middle, end)]
                }
            };
            let first = nodes.len();
            nodes[index].first = first as u32;
            nodes.extend([blank; 2]);
            open.extend(halves.into_iter().enumerate().map(|(side, half)| (first + side, half)));
        }
        for index in (0..nodes.len()).rev() {
            if nodes[index].triangles == 0 {
                let first = nodes[index].first as usize;
                let [left, right]: [BinaryNode; 2] = [nodes[first], nodes[first + 1]];
                let node = &mut nodes[index];
                node.min = left.min.min(right.min);
                node.max = left.max.max(right.max);
                node.triangles = left.triangles + right.triangles;
            }
        }
        Self { nodes }
    }
}

/// Partitions triangles along the axis of the largest extent of their centres, such that the first `middle` of them come
/// before all others.
fn separate(triangles: &[[Vec3; 3]], order: &mut [u32], middle: usize) {
    let position = |triangle: u32, axis: usize| {
        let [min, max] = bounds(&triangles[triangle as usize]);
        min[axis] + max[axis]
    };
    let spread = |axis: usize| {
        let (min, max) = order.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(min, max), triangle| {
            let position = position(*triangle, axis);
            (min.min(position), max.max(position))
        });
        max - min
    };
    let spreads = [0, 1, 2].map(spread);
    let axis = (0..3).max_by(|a, b| spreads[*a].total_cmp(&spreads[*b])).unwrap_or(0);
    order.select_nth_unstable_by(middle, |a, b| position(*a, axis).total_cmp(&position(*b, axis)));
}

/// Depth of a tree whose parents come before their children.
fn depth(tree: &Bvh2) -> usize {
    let mut depths = vec![1; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate() {
        if !node.is_leaf() {
            let child = node.first_index as usize;
            depths[child] = depths[index] + 1;
            depths[child + 1] = depths[index] + 1;
        }
    }
    depths.into_iter().max().unwrap_or(0)
}
