// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets of rays on their way through the kd-tree: `K` vectors of lanes that share nodes, branches and a stack.
//!
//! What a ray finds does not depend on its way: the closest hit is the one with the least (t, triangle id) among all
//! triangles, and a packet looks into every cell that one of its rays enters, intervals widened as the twin's are. So
//! packets of any size and any mix of directions find what `device/twin/traverse.rs` finds, bit for bit.

use super::lanes::{Floats, Lanes, Mask};
use super::vectors::Vectors;
use crate::device::twin::traverse::{DIRECTION_FLOOR, WIDEN_DOWN, WIDEN_UP};
use crate::layout::FrameParams;
use crate::prepare::kdtree::{KdNode, MAX_DEPTH};

/// The rays of a packet.
#[derive(Clone, Copy)]
pub struct Rays<L: Lanes, const K: usize> {
    /// Where they start.
    pub origin: [Vectors<L>; K],
    /// Their directions.
    pub direction: [Vectors<L>; K],
    /// Lanes that have a ray.
    pub alive: [Mask<L>; K],
}

/// A cell that waits for its turn: a node, and the part of each ray within it.
#[derive(Clone, Copy)]
struct Cell<L: Lanes, const K: usize> {
    node: u32,
    t_min: [Floats<L>; K],
    t_max: [Floats<L>; K],
}

/// The stack of packets that a thread traces one after the other: made once, since it is large.
pub struct Stack<L: Lanes, const K: usize>(Box<[Cell<L, K>]>);

impl<L: Lanes, const K: usize> Stack<L, K> {
    /// An empty stack.
    #[inline(always)]
    pub fn new(l: L) -> Self {
        let zero = [Floats::splat(l, 0.0); K];
        Stack(vec![Cell { node: 0, t_min: zero, t_max: zero }; MAX_DEPTH].into_boxed_slice())
    }
}

/// A packet on its way.
pub struct Walk<'a, L: Lanes, const K: usize> {
    nodes: &'a [KdNode],
    stack: &'a mut Stack<L, K>,
    depth: usize,
    /// By axis and vector; the fourth axis spares a check of bounds.
    origin: [[Floats<L>; K]; 4],
    inverse: [[Floats<L>; K]; 4],
    /// Lanes that go down an axis.
    negative: [[Mask<L>; K]; 4],
    /// Per axis whether the upper child comes first, and whether that is so for all rays.
    upper_first: [bool; 4],
    agreed: [bool; 4],
    cell: Cell<L, K>,
}

/// Inverse of a direction's component, kept finite.
#[inline(always)]
pub fn safe_inverse<L: Lanes>(l: L, d: Floats<L>) -> Floats<L> {
    let floor = Floats::splat(l, DIRECTION_FLOOR);
    Floats::splat(l, 1.0) / d.abs().lt(floor).select(floor.with_sign_of(d), d)
}

/// How many lanes are set: tells which of two children most rays meet first, and whether all do.
#[inline(always)]
fn count<L: Lanes, const K: usize>(masks: &[Mask<L>; K]) -> u32 {
    let mut n = 0;
    for mask in masks {
        n += mask.bits().count_ones();
    }
    n
}

impl<'a, L: Lanes, const K: usize> Walk<'a, L, K> {
    /// `None` if all rays pass by the tree's box. Rays end at `t_limit`.
    #[inline(always)]
    pub fn begin(
        l: L,
        nodes: &'a [KdNode],
        frame: &FrameParams,
        rays: &Rays<L, K>,
        t_limit: &[Floats<L>; K],
        stack: &'a mut Stack<L, K>,
    ) -> Option<Self> {
        let (zero, none) = (Floats::splat(l, 0.0), Mask::splat(l, false));
        let mut walk = Walk {
            nodes,
            stack,
            depth: 0,
            origin: [[zero; K]; 4],
            inverse: [[zero; K]; 4],
            negative: [[none; K]; 4],
            upper_first: [false; 4],
            agreed: [true; 4],
            cell: Cell { node: 0, t_min: [zero; K], t_max: [zero; K] },
        };
        let mut any = none;
        for k in 0..K {
            let (o, d) = (rays.origin[k], rays.direction[k]);
            let (mut enter, mut leave) = (zero, zero);
            for (axis, (o, d)) in [(o.x, d.x), (o.y, d.y), (o.z, d.z)].into_iter().enumerate() {
                let inverse = safe_inverse(l, d);
                walk.origin[axis][k] = o;
                walk.inverse[axis][k] = inverse;
                walk.negative[axis][k] = inverse.lt(zero);
                let a = (Floats::splat(l, frame.bounds_min[axis]) - o) * inverse;
                let b = (Floats::splat(l, frame.bounds_max[axis]) - o) * inverse;
                let (first, last) = (a.min2(b), a.max2(b));
                (enter, leave) = if axis == 0 { (first, last) } else { (enter.max2(first), leave.min2(last)) };
            }
            let t_min = zero.max2(enter * WIDEN_DOWN);
            let t_max = t_limit[k].min2(leave * WIDEN_UP);
            let inside = rays.alive[k] & t_min.le(t_max);
            walk.cell.t_min[k] = t_min;
            walk.cell.t_max[k] = inside.select(t_max, Floats::splat(l, -1.0));
            any = any | inside;
        }
        for axis in 0..3 {
            let mut down = walk.negative[axis];
            for k in 0..K {
                down[k] = down[k] & rays.alive[k];
            }
            let (down, all) = (count(&down), count(&rays.alive));
            walk.upper_first[axis] = 2 * down > all;
            walk.agreed[axis] = down == 0 || down == all;
        }
        any.any().then_some(walk)
    }

    /// Lanes whose ray enters the cell.
    #[inline(always)]
    pub fn inside(&self, l: L) -> [Mask<L>; K] {
        let mut inside = [Mask::splat(l, false); K];
        for k in 0..K {
            inside[k] = self.cell.t_min[k].le(self.cell.t_max[k]);
        }
        inside
    }

    /// Inverse directions of a vector.
    #[inline(always)]
    pub fn inverse(&self, k: usize) -> Vectors<L> {
        Vectors { x: self.inverse[0][k], y: self.inverse[1][k], z: self.inverse[2][k] }
    }

    /// Goes down to the next leaf and returns the range of its entries.
    #[inline(always)]
    pub fn descend(&mut self, l: L) -> std::ops::Range<usize> {
        loop {
            let node = self.nodes[self.cell.node as usize];
            if node.is_leaf() {
                let first = node.split_or_first as usize;
                return first..first + node.payload() as usize;
            }
            let axis = (node.axis() & 3) as usize;
            let lower = node.payload();
            let split = Floats::splat(l, node.split());
            let Cell { t_min, t_max, .. } = self.cell;
            // Where rays leave the child that they meet first, and where they enter the other one.
            let (mut near_max, mut far_min) = (t_max, t_min);
            let none = Mask::splat(l, false);
            let (mut any_near, mut any_far) = (none, none);
            if self.agreed[axis] {
                for k in 0..K {
                    let t = (split - self.origin[axis][k]) * self.inverse[axis][k];
                    near_max[k] = t_max[k].min2(t * WIDEN_UP);
                    far_min[k] = t_min[k].max2(t * WIDEN_DOWN);
                    any_near = any_near | t_min[k].le(near_max[k]);
                    any_far = any_far | far_min[k].le(t_max[k]);
                }
                let upper_first = u32::from(self.upper_first[axis]);
                let (near, far) = (lower + upper_first, lower + 1 - upper_first);
                if !any_far.any() {
                    self.cell.node = near;
                } else if !any_near.any() {
                    self.cell.node = far;
                } else {
                    self.push(Cell { node: far, t_min: far_min, t_max });
                    self.cell.node = near;
                    self.cell.t_max = near_max;
                }
            } else {
                // Both children's parts of each ray, in the order that most rays want.
                let flip = Mask::splat(l, self.upper_first[axis]);
                let mut first = self.cell;
                let mut second = self.cell;
                for k in 0..K {
                    let t = (split - self.origin[axis][k]) * self.inverse[axis][k];
                    let near_max = t_max[k].min2(t * WIDEN_UP);
                    let far_min = t_min[k].max2(t * WIDEN_DOWN);
                    let near_is_first = !(self.negative[axis][k] ^ flip);
                    first.t_min[k] = near_is_first.select(t_min[k], far_min);
                    first.t_max[k] = near_is_first.select(near_max, t_max[k]);
                    second.t_min[k] = near_is_first.select(far_min, t_min[k]);
                    second.t_max[k] = near_is_first.select(t_max[k], near_max);
                    any_near = any_near | first.t_min[k].le(first.t_max[k]);
                    any_far = any_far | second.t_min[k].le(second.t_max[k]);
                }
                let upper_first = u32::from(self.upper_first[axis]);
                (first.node, second.node) = (lower + upper_first, lower + 1 - upper_first);
                if !any_far.any() {
                    self.cell = first;
                } else {
                    if any_near.any() {
                        self.push(second);
                        self.cell = first;
                    } else {
                        self.cell = second;
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn push(&mut self, cell: Cell<L, K>) {
        self.stack.0[self.depth] = cell;
        self.depth += 1;
    }

    /// Goes to the next cell that a ray enters before its `t_end`; `false` if there is none.
    #[inline(always)]
    pub fn next_cell(&mut self, l: L, t_end: &[Floats<L>; K]) -> bool {
        while self.depth > 0 {
            self.depth -= 1;
            let mut cell = self.stack.0[self.depth];
            let mut any = Mask::splat(l, false);
            for k in 0..K {
                cell.t_max[k] = cell.t_max[k].min2(t_end[k]);
                any = any | cell.t_min[k].le(cell.t_max[k]);
            }
            if any.any() {
                self.cell = cell;
                return true;
            }
        }
        false
    }
}
