//! From the root to the triangles.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::lanes::Lanes;
use super::packet::Nearest;
use super::ray::{PreparedRay, Slabs};
use super::tree::{Child, Kind, Node, Tree};

/// Room for children that wait for their turn. A tree made by halving needs no more than seven for each of its
/// levels, of which there are at most 32.
pub(super) const STACK_SIZE: usize = 7 * 32 + 1;

/// Children that wait for their turn, each with the distance at which its box begins.
///
/// Not cleared at the start, which would take as long as the traversal of a small scene.
struct Stack {
    entries: [MaybeUninit<Entry>; STACK_SIZE],
    length: usize,
}

/// A child and the distance at which its box begins, which is not negative.
///
/// The distance is in the upper half: bits of numbers that are not negative are ordered as the numbers are.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u64);

impl Entry {
    #[inline(always)]
    fn new(distance: f32, child: Child) -> Self {
        Self(u64::from(distance.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn distance(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; STACK_SIZE], length: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: Entry) {
        self.entries[self.length] = MaybeUninit::new(entry);
        self.length += 1;
    }

    /// Pushes onto the sorted entries from `start` on, and keeps them sorted, the nearest last.
    #[inline(always)]
    fn push_sorted(&mut self, start: usize, entry: Entry) {
        let mut position = self.length;
        self.push(entry);
        while position > start && self.get(position - 1) < entry {
            self.entries[position] = self.entries[position - 1];
            position -= 1;
        }
        self.entries[position] = MaybeUninit::new(entry);
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
        unsafe { self.entries[index].assume_init() }
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
}

impl Tree {
    /// Replaces `nearest` by the nearest hit.
    #[inline(always)]
    pub(super) fn intersect<V: Lanes>(&self, ray: &PreparedRay, nearest: &mut Nearest) {
        if self.nodes.is_empty() {
            for packet in &self.packets {
                packet.intersect::<V>(ray, nearest);
            }
            return;
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut stack = Stack::new();
        let mut next = Child::ROOT;
        loop {
            match next.kind() {
                Kind::Packet(packet) => self.packets[packet].intersect::<V>(ray, nearest),
                Kind::Node(node) => {
                    let node = &self.nodes[node];
                    let (mut met, distances) = node.meet::<V>(&slabs, nearest.t);
                    let distances = distances.store();
                    let start = stack.length;
                    while met != 0 {
                        let lane = met.trailing_zeros() as usize;
                        met &= met - 1;
                        stack.push_sorted(start, Entry::new(distances.0[lane], node.children[lane]));
                    }
                }
            }
            next = loop {
                match stack.pop() {
                    None => return,
                    Some(entry) if entry.distance() <= nearest.t => break entry.child(),
                    Some(_) => {}
                }
            };
        }
    }

    /// True if a triangle separates the ray's origin from `target`, which is one length of the direction away.
    #[inline(always)]
    pub(super) fn occluded<V: Lanes>(&self, ray: &PreparedRay, target: Vec3, reach: f32) -> bool {
        if self.nodes.is_empty() {
            return self.packets.iter().any(|packet| packet.occludes::<V>(ray, target, reach));
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut stack = Stack::new();
        let mut next = Child::ROOT;
        loop {
            match next.kind() {
                Kind::Packet(packet) => {
                    if self.packets[packet].occludes::<V>(ray, target, reach) {
                        return true;
                    }
                }
                Kind::Node(node) => {
                    let node = &self.nodes[node];
                    // The nearest next, the others in any order: the first blocker found ends it all.
                    let (mut met, distances) = node.meet::<V>(&slabs, 1.0);
                    let distances = distances.store();
                    let mut nearest = Entry(u64::MAX);
                    while met != 0 {
                        let lane = met.trailing_zeros() as usize;
                        met &= met - 1;
                        let entry = Entry::new(distances.0[lane], node.children[lane]);
                        let other = nearest.max(entry);
                        nearest = nearest.min(entry);
                        if other != Entry(u64::MAX) {
                            stack.push(other);
                        }
                    }
                    if nearest != Entry(u64::MAX) {
                        next = nearest.child();
                        continue;
                    }
                }
            }
            match stack.pop() {
                None => return false,
                Some(entry) => next = entry.child(),
            }
        }
    }
}
