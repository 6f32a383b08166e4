//! From the root to the triangles.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::lanes::{Lanes, Row, take_lowest};
use super::ray::{PreparedRay, Slabs};
use super::tree::{Node, Tree};
use super::triangle_block::Nearest;

/// Room for nodes that wait for their turn. A tree made by halving needs no more than seven for each of its
/// levels, of which there are at most 32.
pub(super) const STACK_SIZE: usize = 7 * 32 + 1;

/// A node's place and the distance at which its box begins, which is not negative.
///
/// The distance is in the upper half: bits of numbers that are not negative are ordered as the numbers are.
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

/// Room for a stack.
///
/// Not cleared at the start, which would take as long as the traversal of a small scene.
type Room = [MaybeUninit<Entry>; STACK_SIZE];

const ROOM: Room = [const { MaybeUninit::uninit() }; STACK_SIZE];

/// Nodes that wait for their turn.
///
/// It borrows its room, so that its length is not part of an array that is written to at varying places: then it stays
/// in a register.
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

    /// Pushes onto the sorted entries from `start` on, and keeps them sorted, the nearest last.
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
        // SAFETY: only called with indices below what `length` was at the last push, and `push` has written those.
        unsafe { self.room[index].assume_init() }
    }
}

impl Node {
    /// A bit for each child whose box the ray meets before `end`, and the distances at which the boxes begin.
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
            // Not a number if the ray runs within the plane; then the other operand stands.
            near = enter.max(near);
            far = leave.min(far);
        }
        (near.le(far), near)
    }

    /// Takes the lowest bit off, and gives the node that it stands for.
    #[inline(always)]
    fn entry(&self, distances: &Row, bits: &mut u32) -> Entry {
        let lane = take_lowest(bits);
        Entry::new(distances.0[lane], self.children[lane])
    }
}

impl Tree {
    /// Has memory begin to send a node that waits for its turn.
    #[inline(always)]
    fn fetch<V: Lanes>(&self, entry: Entry) {
        V::fetch(self.nodes.as_ptr().wrapping_add(entry.node()));
    }

    /// Replaces `nearest` by the nearest hit.
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
            // Blocks at once, in any order: which of a node's children come next is hard to foretell, and each time
            // that the processor thinks of a block where there is a node costs more than a block too many.
            while blocks != 0 {
                let lane = take_lowest(&mut blocks);
                if distances.0[lane] <= nearest.t {
                    let block = node.children[lane] as usize;
                    self.blocks[block].intersect::<V>(&self.planes[block], ray, nearest);
                }
            }
            if nodes != 0 {
                // The nearest next, the others later in order.
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

    /// True if a triangle separates the ray's origin from `target`, which is one length of the direction away.
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
                // The farthest next, the others in any order: the first blocker found ends it all, and it is seldom in what
                // surrounds the origin.
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
