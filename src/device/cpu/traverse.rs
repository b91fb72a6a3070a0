// SPDX-License-Identifier: MIT OR Apache-2.0
//! Closest hit and any hit of a packet: `device/twin/traverse.rs` lane by lane.

use super::lanes::{Floats, Lanes, Mask, Words, lanes_of};
use super::packet::{Rays, Stack, Walk};
use super::triangle_test::RayTests;
use crate::device::twin::SceneArgs;
use crate::device::twin::traverse::is_hole;
use crate::layout::{FAR_AWAY, NO_TRIANGLE, TRIANGLE_CUTOUT, TRIANGLE_GLASS};

/// Hits of a vector of rays.
#[derive(Clone, Copy)]
pub struct Hits<L: Lanes> {
    /// Distance along the ray in lengths of its direction.
    pub t: Floats<L>,
    /// Barycentric weight of the second corner.
    pub u: Floats<L>,
    /// Barycentric weight of the third corner.
    pub v: Floats<L>,
    /// Triangle id, or [`NO_TRIANGLE`].
    pub triangle: Words<L>,
}

/// Of `lanes`, those where the triangle is no hole at `(u, v)`.
#[inline(always)]
fn solid<L: Lanes>(l: L, scene: &SceneArgs, triangle: u32, (u, v): (Floats<L>, Floats<L>), lanes: Mask<L>) -> Mask<L> {
    let (u, v) = (u.to_array(), v.to_array());
    let mut bits = lanes.bits();
    for lane in lanes_of(bits) {
        if is_hole(scene, triangle, u[lane], v[lane]) {
            bits &= !(1 << lane);
        }
    }
    Mask::from_bits(l, bits)
}

/// The closest hit of each ray: the one with the least (t, triangle id).
#[inline(always)]
pub fn closest_hit<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    rays: &Rays<L, K>,
    stack: &mut Stack<L, K>,
) -> [Hits<L>; K] {
    l.enter(
        #[inline(always)]
        || closest_hit_inlined(l, scene, rays, stack),
    )
}

#[inline(always)]
fn closest_hit_inlined<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    rays: &Rays<L, K>,
    stack: &mut Stack<L, K>,
) -> [Hits<L>; K] {
    let zero = Floats::splat(l, 0.0);
    let far = Floats::splat(l, FAR_AWAY);
    let mut best = [Hits { t: far, u: zero, v: zero, triangle: Words::splat(l, NO_TRIANGLE) }; K];
    let Some(mut walk) = Walk::begin(l, scene.nodes, scene.frame, rays, &[far; K], stack) else { return best };
    let tests = RayTests::begin(
        l,
        rays,
        #[inline(always)]
        |k| walk.inverse(k),
    );
    loop {
        let entries = walk.descend(l);
        let inside = walk.inside(l);
        for &id in &scene.leaf_triangles[entries] {
            let triangle = &scene.triangles[id as usize];
            let bits = triangle.corners[0][3].to_bits();
            tests.cross(
                l,
                triangle,
                &inside,
                #[inline(always)]
                |k, c| {
                    let ahead = if bits & TRIANGLE_GLASS != 0 { c.ahead + c.error * 2.0 } else { c.ahead };
                    let t = ahead / c.slope;
                    let best = &mut best[k];
                    let tie = t.equals(best.t) & Words::splat(l, id).lt(best.triangle);
                    let mut better = c.lanes & (t.lt(best.t) | tie);
                    if !better.any() {
                        return;
                    }
                    let (u, v) = c.weights(l);
                    if bits & TRIANGLE_CUTOUT != 0 {
                        better = solid(l, scene, id, (u, v), better);
                    }
                    best.t = better.select(t, best.t);
                    best.u = better.select(u, best.u);
                    best.v = better.select(v, best.v);
                    best.triangle = better.select_words(Words::splat(l, id), best.triangle);
                },
            );
        }
        let mut t_end = [far; K];
        for k in 0..K {
            t_end[k] = best[k].t;
        }
        if !walk.next_cell(l, &t_end) {
            return best;
        }
    }
}

/// Rays on which anything that casts a shadow lies before `t_limit`, by more than roundings explain.
#[inline(always)]
pub fn any_hit<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    rays: &Rays<L, K>,
    t_limit: &[Floats<L>; K],
    stack: &mut Stack<L, K>,
) -> [Mask<L>; K] {
    l.enter(
        #[inline(always)]
        || any_hit_inlined(l, scene, rays, t_limit, stack),
    )
}

#[inline(always)]
fn any_hit_inlined<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    rays: &Rays<L, K>,
    t_limit: &[Floats<L>; K],
    stack: &mut Stack<L, K>,
) -> [Mask<L>; K] {
    let mut shadowed = [Mask::splat(l, false); K];
    let Some(mut walk) = Walk::begin(l, scene.nodes, scene.frame, rays, t_limit, stack) else { return shadowed };
    let tests = RayTests::begin(
        l,
        rays,
        #[inline(always)]
        |k| walk.inverse(k),
    );
    // Where rays end: nowhere any more once something is found.
    let mut t_end = *t_limit;
    loop {
        let entries = walk.descend(l);
        let mut wanted = walk.inside(l);
        for k in 0..K {
            wanted[k] = wanted[k].without(shadowed[k]);
        }
        for &id in &scene.leaf_triangles[entries] {
            let triangle = &scene.triangles[id as usize];
            let bits = triangle.corners[0][3].to_bits();
            if bits & TRIANGLE_GLASS != 0 {
                continue;
            }
            let searched = wanted;
            tests.cross(
                l,
                triangle,
                &searched,
                #[inline(always)]
                |k, c| {
                    let mut lanes = c.lanes & (c.ahead + c.error).lt(t_limit[k] * c.slope);
                    if bits & TRIANGLE_CUTOUT != 0 && lanes.any() {
                        lanes = solid(l, scene, id, c.weights(l), lanes);
                    }
                    shadowed[k] = shadowed[k] | lanes;
                    wanted[k] = wanted[k].without(lanes);
                    t_end[k] = lanes.select(Floats::splat(l, -1.0), t_end[k]);
                },
            );
        }
        if !walk.next_cell(l, &t_end) {
            return shadowed;
        }
    }
}
