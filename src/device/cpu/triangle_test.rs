// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the rays of a packet cross a triangle: `device/twin/triangle_test.rs` lane by lane.

use super::lanes::{Floats, Lanes, Mask, inlined};
use super::packet::Rays;
use super::vectors::Vectors;
use crate::device::twin::triangle_test::plane_normal;
use crate::layout::{PLANE_ERROR, TRIANGLE_ONE_SIDED, Triangle};

/// The rays of a packet whose directions are longest along one axis: they look at triangles along that axis.
#[derive(Clone, Copy)]
struct Group<L: Lanes, const K: usize> {
    axis: usize,
    lanes: [Mask<L>; K],
    x: [Floats<L>; K],
    y: [Floats<L>; K],
    z: [Floats<L>; K],
}

/// What a packet has ready for all triangles. There is one group in most packets.
pub struct RayTests<L: Lanes, const K: usize> {
    origin: [[Floats<L>; K]; 3],
    groups: [Group<L, K>; 3],
    group_count: usize,
}

/// Where rays cross a triangle; the words are those of the twin.
pub struct Crossing<L: Lanes> {
    /// Lanes whose ray crosses it, ahead of where it starts.
    pub lanes: Mask<L>,
    pub ahead: Floats<L>,
    pub slope: Floats<L>,
    pub error: Floats<L>,
    wb: Floats<L>,
    wc: Floats<L>,
    sum: Floats<L>,
}

impl<L: Lanes> Crossing<L> {
    /// Barycentric weights of the second and third corner.
    #[inline(always)]
    pub fn weights(&self, l: L) -> (Floats<L>, Floats<L>) {
        let inverse_sum = Floats::splat(l, 1.0) / self.sum;
        (self.wb * inverse_sum, self.wc * inverse_sum)
    }
}

/// Lanes by the longest axis of their direction.
#[inline(always)]
fn longest_axis<L: Lanes>(d: Vectors<L>) -> [Mask<L>; 3] {
    let Vectors { x, y, z } = d.abs();
    let (xy, xz, yz) = (x.gt(y), x.gt(z), y.gt(z));
    let (is_x, is_y) = (xy & xz, yz.without(xy));
    [is_x, is_y, !(is_x | is_y)]
}

impl<L: Lanes, const K: usize> RayTests<L, K> {
    /// `inverse`: of a vector's directions, component by component.
    #[inline(always)]
    pub fn begin(l: L, rays: &Rays<L, K>, inverse: impl Fn(usize) -> Vectors<L>) -> Self {
        let zero = Floats::splat(l, 0.0);
        let none = Mask::splat(l, false);
        let group = Group { axis: 0, lanes: [none; K], x: [zero; K], y: [zero; K], z: [zero; K] };
        let mut tests = RayTests { origin: [[zero; K]; 3], groups: [group; 3], group_count: 0 };
        let mut by_axis = [[none; K]; 3];
        for k in 0..K {
            let o = rays.origin[k];
            (tests.origin[0][k], tests.origin[1][k], tests.origin[2][k]) = (o.x, o.y, o.z);
            let lanes = longest_axis(rays.direction[k]);
            for axis in 0..3 {
                by_axis[axis][k] = lanes[axis] & rays.alive[k];
            }
        }
        for (axis, lanes) in by_axis.into_iter().enumerate() {
            let mut any = none;
            for k in 0..K {
                any = any | lanes[k];
            }
            if !any.any() {
                continue;
            }
            let group = &mut tests.groups[tests.group_count];
            (group.axis, group.lanes) = (axis, lanes);
            for k in 0..K {
                let (d, inverse) = (rays.direction[k], inverse(k));
                let (z, dx, dy) = match axis {
                    0 => (inverse.x, d.y, d.z),
                    1 => (inverse.y, d.z, d.x),
                    _ => (inverse.z, d.x, d.y),
                };
                (group.x[k], group.y[k], group.z[k]) = (dx * z, dy * z, z);
            }
            tests.group_count += 1;
        }
        tests
    }

    /// Tests a triangle, and calls `found` with each vector in which a ray crosses it. Only `wanted` lanes count.
    #[inline(always)]
    pub fn cross(&self, l: L, triangle: &Triangle, wanted: &[Mask<L>; K], mut found: impl FnMut(usize, Crossing<L>)) {
        for group in &self.groups[..self.group_count] {
            for k in 0..K {
                let lanes = wanted[k] & group.lanes[k];
                if let Some(crossing) = self.cross_vector(l, group, k, triangle, lanes) {
                    found(k, crossing);
                }
            }
        }
    }

    #[inline(always)]
    fn cross_vector(
        &self,
        l: L,
        group: &Group<L, K>,
        k: usize,
        triangle: &Triangle,
        mut lanes: Mask<L>,
    ) -> Option<Crossing<L>> {
        let zero = Floats::splat(l, 0.0);
        let [a, b, c] = &triangle.corners;
        let [kz, kx, ky] = match group.axis {
            0 => [0, 1, 2],
            1 => [1, 2, 0],
            _ => [2, 0, 1],
        };
        let from = inlined(
            #[inline(always)]
            |corner: &[f32; 4], axis: usize| Floats::splat(l, corner[axis]) - self.origin[axis][k],
        );
        let (x, y, z) = (group.x[k], group.y[k], group.z[k]);
        let (za, zb, zc) = (from(a, kz), from(b, kz), from(c, kz));
        let (ra, rb, rc) = (from(a, kx), from(b, kx), from(c, kx));
        let (xa, xb, xc) = (ra - x * za, rb - x * zb, rc - x * zc);
        let on_one_side = xa.min2(xb.min2(xc)).gt(zero) | xa.max2(xb.max2(xc)).lt(zero);
        lanes = lanes.without(on_one_side);
        if !lanes.any() {
            return None;
        }
        let (qa, qb, qc) = (from(a, ky), from(b, ky), from(c, ky));
        let (ya, yb, yc) = (qa - y * za, qb - y * zb, qc - y * zc);
        let (wa, wb, wc) = (xc * yb - yc * xb, xa * yc - ya * xc, xb * ya - yb * xa);
        let outside = wa.min2(wb.min2(wc)).lt(zero) & wa.max2(wb.max2(wc)).gt(zero);
        let sum = wa + wb + wc;
        lanes = lanes.without(outside | sum.equals(zero));
        if a[3].to_bits() & TRIANGLE_ONE_SIDED != 0 {
            lanes = lanes.without(sum.lt(zero) ^ z.lt(zero));
        }
        if !lanes.any() {
            return None;
        }
        let n = plane_normal(triangle).to_array();
        let across = Floats::splat(l, n[kz]) + x * n[kx] + y * n[ky];
        // The vector to the first corner, in the order of the axes: sums depend on it.
        let (to_x, to_y, to_z) = match group.axis {
            0 => (za, ra, qa),
            1 => (qa, za, ra),
            _ => (ra, qa, za),
        };
        let height = (to_x * n[0] + to_y * n[1] + to_z * n[2]) * z;
        let ahead = across.lt(zero).select(-height, height);
        let error = (to_x.abs() + to_y.abs() + to_z.abs()) * z.abs() * PLANE_ERROR;
        lanes = lanes & ahead.gt(error);
        lanes.any().then(|| Crossing { lanes, ahead, slope: across.abs(), error, wb, wc, sum })
    }
}
