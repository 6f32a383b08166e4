//! A binary tree over triangles, one triangle a leaf.

use glam::Vec3;
use obvhs::Boundable;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::dedup::dedup;

/// Up to this depth a tree is worth improving. Trees over meshes have about half of it.
const DEPTH_WORTH_IMPROVING: usize = 64;

/// Nodes, the root first, parents before their children.
pub(super) struct BinaryTree {
    /// The nodes; none if there is no triangle.
    pub(super) nodes: Vec<BinaryNode>,
}

/// A node with two children or, if it has one triangle only, a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    /// Minimum coordinates of all triangles below.
    pub(super) min: Vec3,
    /// Maximum coordinates.
    pub(super) max: Vec3,
    /// How many triangles there are below.
    pub(super) triangles: u32,
    /// The first of two children, one after the other; in a leaf the index of the triangle.
    pub(super) first: u32,
}

impl BinaryNode {
    /// The indices of the two children; `None` for a leaf.
    #[inline]
    pub(super) fn children(&self) -> Option<[usize; 2]> {
        (self.triangles > 1).then_some([self.first as usize, self.first as usize + 1])
    }

    /// Half the area of the box's surface: how likely a ray meets it.
    pub(super) fn half_area(&self) -> f32 {
        let size = self.max - self.min;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// The box around a triangle.
struct Bounds([Vec3; 2]);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        Aabb::new(self.0[0].into(), self.0[1].into())
    }
}

fn bounds(&[a, b, c]: &[Vec3; 3]) -> [Vec3; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// What a node is still to be made of.
enum Source {
    /// A node of the tree that obvhs made.
    Obvhs(usize),
    /// A range of the list of triangles, to be halved until single triangles are left.
    Range(usize, usize),
}

impl BinaryTree {
    /// The tree that obvhs makes: locally ordered clustering, improved by reinsertion.
    ///
    /// Triangles with the same box are one to obvhs, which else makes a level for each of them.
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

    /// A tree by halving the number of triangles at every node: never deeper than the logarithm of their number,
    /// rounded up, but slower to traverse.
    pub(super) fn halve(triangles: &[[Vec3; 3]]) -> Self {
        let order: Vec<u32> = (0..triangles.len() as u32).collect();
        let all = Source::Range(0, order.len());
        Self::expand(triangles, order, all, &Bvh2::default(), &[])
    }

    /// Makes the nodes from what they are to be made of. `starts` says where in `order` the triangles of each of
    /// the boxes begin that `obvhs` knows.
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

/// Orders triangles along the axis on which their middles are farthest apart, so far that the first `middle` of
/// them come before all others.
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

/// Levels of a tree whose parents come before their children.
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
