//! A tree of boxes: each node has up to eight children, each a node or a block of triangles.
//!
//! [`obvhs`] makes a good binary tree. Here its upper levels are merged into nodes of eight, which fit the eight
//! lanes that the traversal works with, and its lower ones into blocks. Among all ways to do so, the one with
//! the min expected cost is found by dynamic programming (Ylitie, Karras, Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 4).

use glam::Vec3;

use super::binary::{BinaryNode, BinaryTree};
use super::exact::Plane;
use super::lanes::Row;
use super::triangle_block::{Planes, TriangleBlock};

/// Expected cost of visiting a node, where visiting a block costs 1.
const NODE_COST: f32 = 1.0;

/// Up to this many blocks are tested one by one, without a tree: making a ray ready for boxes and sorting children
/// cost more than the blocks that a tree would leave out (measured with the 32 triangles of a Cornell box).
const SCANNED_PACKETS: usize = 5;

/// The children's boxes, and where the children are.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// The planes that bound the boxes: minimum x, y, z, then maximum x, y, z. Unused lanes have empty boxes.
    pub(super) planes: [Row; 6],
    /// Where the children are among the tree's blocks or, if they are nodes, among its nodes.
    pub(super) children: [u32; 8],
    /// A bit for each child that is a block.
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
    /// The root is node 0. Empty if all blocks are tested one by one.
    pub(super) nodes: Vec<Node>,
    /// Minimum and maximum coordinates.
    pub(super) bounds: [Vec3; 2],
    /// The leaves.
    pub(super) blocks: Vec<TriangleBlock>,
    /// The planes of each block.
    pub(super) planes: Vec<Planes>,
    /// Nodes on the longest way from the root to a block.
    pub(super) depth: usize,
    /// The most nodes that can be waiting for their turn at one time in a depth-first traversal.
    pub(super) waiting: usize,
}

/// What the dynamic programme finds for a node of the binary tree.
#[derive(Clone, Copy, Default)]
struct Plan {
    /// `cost[i]`: the min cost of showing the subtree as at most i + 1 children of one node.
    cost: [f32; 7],
    /// `left[i]`: how many of them come from the left child; 0 if one fewer than allowed (or one) is as good.
    left: [u8; 7],
    /// The same for the subtree as a node with eight children of its own.
    left_of_eight: u8,
    /// Whether the subtree as one child is a block.
    block: bool,
}

impl Tree {
    /// Merges a binary tree over `triangles`; `primitives` has the index of each in the caller's list.
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

/// Chooses for every node of the binary tree, children before parents.
fn plan(binary: &BinaryTree) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); binary.nodes.len()];
    for (index, node) in binary.nodes.iter().enumerate().rev() {
        let area = node.half_area();
        let block_cost = if node.triangles <= 8 { area } else { f32::INFINITY };
        let Some([left, right]) = node.children() else {
            plans[index] = Plan { cost: [block_cost; 7], block: true, ..Plan::default() };
            continue;
        };
        // The min cost of showing both children as `count` children in all, and the share of the left one.
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
    /// Adds a node for the root of the binary tree and everything below, depth first.
    fn add_nodes(&mut self) {
        self.tree.nodes.push(Node::EMPTY);
        // Nodes to fill: their index, the binary node they stand for, their depth, and how many children can be
        // waiting while they are visited.
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

    /// The up to eight binary nodes that become the children of one.
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

    /// Adds blocks of all triangles below the root, all but the last of them full.
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

    /// The triangles below a binary node, neighbours next to each other.
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
