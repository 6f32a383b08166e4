//! Traversal.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::lanes::{Lanes, Row, take_lowest};
use super::ray::{PreparedRay, Slabs};
use super::tree::{Node, Tree};
use super::triangle_block::Nearest;

/// Maximum size of the stack. A tree built by splitting at the median needs at most seven entries per level, and has at
/// most 32 levels.
pub(super) const STACK_SIZE: usize = 7 * 32 + 1;

/// The index of a node and the non-negative distance to its box.
///
/// The distance is in the upper half: the bits of non-negative floats are ordered like their values.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u64);

impl Entry {
    #[inline(always)]
    fn new(distance: f32, node: u32) -> Self {
        Self(u64::from(distance.to_bits()) << 32 | u64::from(node))
    }

    #[inline(always)]
    fn distance(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn node(self) -> usize {
        self.0 as u32 as usize
    }
}

/// Memory of a stack.
///
/// Uninitialized: clearing it would take as long as the traversal of a small scene.
type Room = [MaybeUninit<Entry>; STACK_SIZE];

const ROOM: Room = [const { MaybeUninit::uninit() }; STACK_SIZE];

/// The stack of nodes to visit.
///
/// It borrows its memory: this way its length is not stored next to an array with variable indices, and stays in a
/// register.
struct Stack<'a> {
    room: &'a mut Room,
    length: usize,
}

impl<'a> Stack<'a> {
    #[inline(always)]
    fn new(room: &'a mut Room) -> Self {
        Self { room, length: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: Entry) {
        self.room[self.length] = MaybeUninit::new(entry);
        self.length += 1;
    }

    /// Inserts an entry, keeping the entries from `start` on sorted with the nearest last.
    #[inline(always)]
    fn push_sorted(&mut self, start: usize, entry: Entry) {
        let mut position = self.length;
        self.push(entry);
        while position > start && self.get(position - 1) < entry {
            self.room[position] = self.room[position - 1];
            position -= 1;
        }
        self.room[position] = MaybeUninit::new(entry);
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Entry> {
        if self.length == 0 {
            return None;
        }
        self.length -= 1;
        Some(self.get(self.length))
    }

    #[inline(always)]
    fn get(&self, index: usize) -> Entry {
        // SAFETY: only called with indices below `length` at the last push, which `push` has written.
        unsafe { self.room[index].assume_init() }
    }
}

impl Node {
    /// Mask of the children whose boxes the ray hits before `end`, and the distances to the boxes.
    #[inline(always)]
    fn meet<V: Lanes>(&self, ray: &Slabs, end: f32) -> (u32, V) {
        let mut near = V::splat(0.0);
        let mut far = V::splat(end);
        for axis in 0..3 {
            let (first, last) = if ray.reversed[axis] { (axis + 3, axis) } else { (axis, axis + 3) };
            let enter = (V::load(&self.planes[first]) - V::splat(ray.near_origin[axis]))
                * V::splat(ray.near_inverse[axis]);
            let leave = (V::load(&self.planes[last]) - V::splat(ray.far_origin[axis]))
                * V::splat(ray.far_inverse[axis]);
            // NaN if the ray is within the plane; then the other operand is returned.
            near = enter.max(near);
            far = leave.min(far);
        }
        (near.le(far), near)
    }

    /// Clears the lowest bit of a mask and returns the entry of its child.
    #[inline(always)]
    fn entry(&self, distances: &Row, bits: &mut u32) -> Entry {
        let lane = take_lowest(bits);
        Entry::new(distances.0[lane], self.children[lane])
    }
}

impl Tree {
    /// Prefetches a node on the stack.
    #[inline(always)]
    fn fetch<V: Lanes>(&self, entry: Entry) {
        V::fetch(self.nodes.as_ptr().wrapping_add(entry.node()));
    }

    /// Updates `nearest` with the nearest hit.
    #[inline(always)]
    pub(super) fn intersect<V: Lanes>(&self, ray: &PreparedRay, nearest: &mut Nearest) {
        if self.nodes.is_empty() {
            for (block, planes) in self.blocks.iter().zip(&self.planes) {
                block.intersect::<V>(planes, ray, nearest);
            }
            return;
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut room = ROOM;
        let mut stack = Stack::new(&mut room);
        let mut next = 0;
        loop {
            let node = &self.nodes[next];
            let (met, distances) = node.meet::<V>(&slabs, nearest.t);
            let (mut blocks, mut nodes) = (met & node.blocks, met & !node.blocks);
            let distances = distances.store();
            // Blocks first, in any order: branches between blocks and nodes are hard to predict, and a misprediction costs
            // more than an unnecessary block.
            while blocks != 0 {
                let lane = take_lowest(&mut blocks);
                if distances.0[lane] <= nearest.t {
                    let block = node.children[lane] as usize;
                    self.blocks[block].intersect::<V>(&self.planes[block], ray, nearest);
                }
            }
            if nodes != 0 {
                // The nearest next, the others later, in order.
                let mut first = node.entry(&distances, &mut nodes);
                let start = stack.length;
                while nodes != 0 {
                    let entry = node.entry(&distances, &mut nodes);
                    let later = first.max(entry);
                    self.fetch::<V>(later);
                    stack.push_sorted(start, later);
                    first = first.min(entry);
                }
                next = first.node();
                continue;
            }
            next = loop {
                match stack.pop() {
                    None => return,
                    Some(entry) if entry.distance() <= nearest.t => break entry.node(),
                    Some(_) => {}
                }
            };
        }
    }

    /// True if a triangle separates the ray's origin from `target`, the point at one length of its direction.
    #[inline(always)]
    pub(super) fn occluded<V: Lanes>(&self, ray: &PreparedRay, target: Vec3, reach: f32) -> bool {
        if self.nodes.is_empty() {
            return self
                .blocks
                .iter()
                .zip(&self.planes)
                .any(|(block, planes)| block.occludes::<V>(planes, ray, target, reach));
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut room = ROOM;
        let mut stack = Stack::new(&mut room);
        let mut next = 0;
        loop {
            let node = &self.nodes[next];
            let (met, distances) = node.meet::<V>(&slabs, 1.0);
            let (mut blocks, mut nodes) = (met & node.blocks, met & !node.blocks);
            while blocks != 0 {
                let block = node.children[take_lowest(&mut blocks)] as usize;
                if self.blocks[block].occludes::<V>(&self.planes[block], ray, target, reach) {
                    return true;
                }
            }
            if nodes != 0 {
                // The farthest next, the others in any order: any occluder ends the traversal, and it is rarely near the
                // origin.
                let distances = distances.store();
                let mut first = node.entry(&distances, &mut nodes);
                while nodes != 0 {
                    let entry = node.entry(&distances, &mut nodes);
                    let later = first.min(entry);
                    self.fetch::<V>(later);
                    stack.push(later);
                    first = first.max(entry);
                }
                next = first.node();
                continue;
            }
            match stack.pop() {
                None => return false,
                Some(entry) => next = entry.node(),
            }
        }
    }
}
