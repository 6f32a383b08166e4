//! From the root to the triangles.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::lanes::{Lanes, Row};
use super::packet::Nearest;
use super::ray::{PreparedRay, Slabs};
use super::tree::{Child, Kind, Node, Tree};

/// Room for children that wait for their turn. A tree made by halving needs no more than seven for each of its
/// levels, of which there are at most 32.
pub(super) const STACK_SIZE: usize = 7 * 32 + 1;

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

/// Room for a stack.
///
/// Not cleared at the start, which would take as long as the traversal of a small scene.
type Room = [MaybeUninit<Entry>; STACK_SIZE];

const ROOM: Room = [const { MaybeUninit::uninit() }; STACK_SIZE];

/// Children that wait for their turn.
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

    /// Takes the lowest bit off, and gives the child that it stands for.
    #[inline(always)]
    fn entry(&self, distances: &Row, bits: &mut u32) -> Entry {
        let lane = bits.trailing_zeros() as usize;
        *bits &= *bits - 1;
        Entry::new(distances.0[lane], self.children[lane])
    }
}

impl Tree {
    /// Replaces `nearest` by the nearest hit.
    #[inline(always)]
    pub(super) fn intersect<V: Lanes>(&self, ray: &PreparedRay, nearest: &mut Nearest) {
        if self.nodes.is_empty() {
            for (packet, planes) in self.packets.iter().zip(&self.planes) {
                packet.intersect::<V>(planes, ray, nearest);
            }
            return;
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut room = ROOM;
        let mut stack = Stack::new(&mut room);
        let mut next = Child::ROOT;
        loop {
            match next.kind() {
                Kind::Packet(packet) => {
                    self.packets[packet].intersect::<V>(&self.planes[packet], ray, nearest)
                }
                Kind::Node(node) => {
                    let node = &self.nodes[node];
                    let (mut met, distances) = node.meet::<V>(&slabs, nearest.t);
                    if met != 0 {
                        // The nearest next, the others later in order.
                        let distances = distances.store();
                        let mut first = node.entry(&distances, &mut met);
                        let start = stack.length;
                        while met != 0 {
                            let entry = node.entry(&distances, &mut met);
                            stack.push_sorted(start, first.max(entry));
                            first = first.min(entry);
                        }
                        next = first.child();
                        continue;
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
            return self
                .packets
                .iter()
                .zip(&self.planes)
                .any(|(packet, planes)| packet.occludes::<V>(planes, ray, target, reach));
        }
        let slabs = Slabs::new(ray, self.bounds);
        let mut room = ROOM;
        let mut stack = Stack::new(&mut room);
        let mut next = Child::ROOT;
        loop {
            match next.kind() {
                Kind::Packet(packet) => {
                    if self.packets[packet].occludes::<V>(&self.planes[packet], ray, target, reach) {
                        return true;
                    }
                }
                Kind::Node(node) => {
                    let node = &self.nodes[node];
                    let (mut met, distances) = node.meet::<V>(&slabs, 1.0);
                    if met != 0 {
                        // The nearest next, the others in any order: the first blocker found ends it all.
                        let distances = distances.store();
                        let mut first = node.entry(&distances, &mut met);
                        while met != 0 {
                            let entry = node.entry(&distances, &mut met);
                            stack.push(first.max(entry));
                            first = first.min(entry);
                        }
                        next = first.child();
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
