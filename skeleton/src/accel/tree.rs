//! An 8-wide bounding volume hierarchy: each node has up to eight children, nodes or blocks of triangles.
//!
//! [`obvhs`] builds a good binary tree. Its upper levels are merged into nodes with eight children, one per SIMD lane, and its
//! lower ones into blocks. Among all ways to do so, the one with the minimum expected cost is found by dynamic programming (Ylitie, Karras, Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 4).

use glam::Vec3;

use super::binary::{BinaryNode, BinaryTree};
use super::exact::Plane;
use super::lanes::Row;
use super::triangle_block::{Planes, TriangleBlock};

/// Expected cost of visiting a node, relative to that of a block.
const NODE_COST: f32 = 1.0;

/// Maximum number of blocks that are tested one by one, without a tree: preparing a ray for box tests and sorting children
/// would cost more than the tree saves (measured with the 32 triangles of a Cornell box).
const SCANNED_PACKETS: usize = 5;

/// The boxes and indices of up to eight children.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// The planes of the boxes: minimum x, y, z, then maximum x, y, z. Unused lanes have empty boxes.
    pub(super) planes: [Row; 6],
    /// Indices of the children among the tree's blocks or nodes.
    pub(super) children: [u32; 8],
    /// Mask of the children that are blocks.
    pub(super) blocks: u32,
}

const _: () = assert!(size_of::<Node>() == 256, "a node is four cache lines");

impl Node {
    const EMPTY: Self = Self {
        planes: {
            let (min, max) = (Row([f32::INFINITY; 8]), Row([f32::NEG_INFINITY; 8]));
            [min, min, min, max, max, max]
        },
        children: [0; 8],
        blocks: 0,
    };
}

/// Nodes and blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// The nodes, the root first; empty if all blocks are tested one by one.
    pub(super) nodes: Vec<Node>,
    /// The bounding box.
    pub(super) bounds: [Vec3; 2],
    /// The leaves.
    pub(super) blocks: Vec<TriangleBlock>,
    /// The planes of each block.
    pub(super) planes: Vec<Planes>,
    /// Maximum number of nodes from the root to a block.
    pub(super) depth: usize,
    /// Maximum size of the stack in a depth-first traversal.
    pub(super) waiting: usize,
}

/// Result of the dynamic programming for a node of the binary tree.
#[derive(Clone, Copy, Default)]
struct Plan {
    /// `cost[i]`: minimum cost of representing the subtree by at most i + 1 children of one node.
    cost: [f32; 7],
    /// `left[i]`: how many of them represent the left child; 0 if one fewer than allowed (or one) is as good.
    left: [u8; 7],
    /// The same for the subtree as a node with eight children.
    left_of_eight: u8,
    /// Whether the subtree as a single child is a block.
    block: bool,
}

impl Tree {
    /// Collapses a binary tree over `triangles`; `primitives` has the index of each in the input.
    pub(super) fn collapse(binary: &BinaryTree, triangles: &[[Vec3; 3]], primitives: &[u32]) -> Self {
        let plans = plan(binary);
        let corners = triangles.as_flattened().iter().copied();
        let bounds = [corners.clone().reduce(Vec3::min), corners.reduce(Vec3::max)];
        let mut tree = Self { bounds: bounds.map(Option::unwrap_or_default), ..Self::default() };
        if binary.nodes.is_empty() {
            return tree;
        }
        let mut builder = Builder { binary, plans: &plans, triangles, primitives, tree: &mut tree };
        if triangles.len() <= 8 * SCANNED_PACKETS {
            builder.add_blocks();
        } else {
            builder.add_nodes();
        }
        tree
    }
}

/// Computes the plans of all nodes of the binary tree, children before parents.
fn plan(binary: &BinaryTree) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); binary.nodes.len()];
    for (index, node) in binary.nodes.iter().enumerate().rev() {
        let area = node.half_area();
        let block_cost = if node.triangles <= 8 { area } else { f32::INFINITY };
        let Some([left, right]) = node.children() else {
            plans[index] = Plan { cost: [block_cost; 7], block: true, ..Plan::default() };
            continue;
        };
        // The minimum cost of representing both subtrees by `count` children, and the number of those on the left.
        let split = |count: usize| {
            (1..count)
                .filter(|from_left| *from_left <= 7 && count - from_left <= 7)
                .map(|from_left| {
                    (
                        plans[left].cost[from_left - 1] + plans[right].cost[count - from_left - 1],
                        from_left as u8,
                    )
                })
                .fold((f32::INFINITY, 1), |best, option| if option.0 < best.0 { option } else { best })
        };
        let mut plan = Plan::default();
        let (node_cost, left_of_eight) = split(8);
        let node_cost = node_cost + area * NODE_COST;
        plan.left_of_eight = left_of_eight;
        plan.block = block_cost <= node_cost;
        plan.cost[0] = block_cost.min(node_cost);
        for count in 2..=7 {
            let (cost, from_left) = split(count);
            let fewer = plan.cost[count - 2];
            (plan.cost[count - 1], plan.left[count - 1]) =
                if cost < fewer { (cost, from_left) } else { (fewer, 0) };
        }
        plans[index] = plan;
    }
    plans
}

struct Builder<'a> {
    binary: &'a BinaryTree,
    plans: &'a [Plan],
    triangles: &'a [[Vec3; 3]],
    primitives: &'a [u32],
    tree: &'a mut Tree,
}

impl Builder<'_> {
    /// Adds nodes for the whole binary tree, depth first.
    fn add_nodes(&mut self) {
        self.tree.nodes.push(Node::EMPTY);
        // Nodes to fill: index, binary node, depth, and the size of the stack when they are visited.
        let mut open = vec![(0, 0, 1, 0)];
        while let Some((index, binary_index, depth, waiting)) = open.pop() {
            let children = self.children(binary_index);
            let waiting = waiting + children.iter().filter(|child| !self.plans[**child].block).count();
            self.tree.depth = self.tree.depth.max(depth);
            self.tree.waiting = self.tree.waiting.max(waiting);
            for (lane, child) in children.into_iter().enumerate() {
                let is_block = self.plans[child].block;
                let place = if is_block {
                    self.add_block(&self.leaves(child))
                } else {
                    self.tree.nodes.push(Node::EMPTY);
                    let added = self.tree.nodes.len() - 1;
                    open.push((added, child, depth + 1, waiting - 1));
                    added as u32
                };
                let BinaryNode { min, max, .. } = self.binary.nodes[child];
                let node = &mut self.tree.nodes[index];
                node.children[lane] = place;
                node.blocks |= u32::from(is_block) << lane;
                for axis in 0..3 {
                    node.planes[axis].0[lane] = min[axis];
                    node.planes[3 + axis].0[lane] = max[axis];
                }
            }
        }
    }

    /// The binary nodes that become the children of a node.
    fn children(&self, binary_index: usize) -> Vec<usize> {
        let mut children = Vec::with_capacity(8);
        let left = self.plans[binary_index].left_of_eight;
        let mut open: Vec<(usize, u8)> = Vec::new();
        let divide = |open: &mut Vec<(usize, u8)>, index: usize, left: u8, count: u8| {
            if let Some([left_child, right_child]) = self.binary.nodes[index].children() {
                open.push((right_child, count - left));
                open.push((left_child, left));
            }
        };
        divide(&mut open, binary_index, left, 8);
        while let Some((index, mut count)) = open.pop() {
            let plan = &self.plans[index];
            while count > 1 && plan.left[count as usize - 1] == 0 {
                count -= 1;
            }
            if count == 1 {
                children.push(index);
            } else {
                divide(&mut open, index, plan.left[count as usize - 1], count);
            }
        }
        children
    }

    /// Adds blocks of all triangles; all except the last one are full.
    fn add_blocks(&mut self) {
        let leaves = self.leaves(0);
        for eight in leaves.chunks(8) {
            self.add_block(eight);
        }
    }

    /// Adds a block and returns its index.
    fn add_block(&mut self, triangles: &[usize]) -> u32 {
        let (mut block, mut planes) = (TriangleBlock::EMPTY, [Plane::NONE; 8]);
        for (lane, triangle) in triangles.iter().enumerate() {
            block.set(lane, &self.triangles[*triangle], self.primitives[*triangle]);
            planes[lane] = Plane::new(&self.triangles[*triangle]);
        }
        self.tree.planes.push(planes);
        self.tree.blocks.push(block);
        self.tree.blocks.len() as u32 - 1
    }

    /// The triangles below a binary node, in depth-first order.
    fn leaves(&self, binary_index: usize) -> Vec<usize> {
        let mut leaves = Vec::new();
        let mut open = vec![binary_index];
        while let Some(index) = open.pop() {
            let node = &self.binary.nodes[index];
            match node.children() {
                Some([left, right]) => open.extend([right, left]),
                None => leaves.push(node.first as usize),
            }
        }
        leaves
    }
}
