// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/triangle_test.clh`: where a ray crosses a triangle.

use glam::Vec3;

use crate::layout::{PLANE_ERROR, TRIANGLE_AXIS_SHIFT, TRIANGLE_ONE_SIDED, Triangle};
use crate::math::{dot, max2, min2};

fn pick(axis: u32, x: f32, y: f32, z: f32) -> f32 {
    match axis {
        0 => x,
        1 => y,
        _ => z,
    }
}

fn longest_axis(d: Vec3) -> u32 {
    let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
    if x > y {
        if x > z { 0 } else { 2 }
    } else if y > z {
        1
    } else {
        2
    }
}

/// A normal of the triangle's plane, 1 along its longest axis, pointing to either side.
pub fn plane_normal(triangle: &Triangle) -> Vec3 {
    let [a, b, c] = &triangle.corners;
    let (p, q) = (b[3], c[3]);
    let axis = a[3].to_bits() >> TRIANGLE_AXIS_SHIFT;
    Vec3::new(pick(axis, 1.0, q, p), pick(axis, p, 1.0, q), pick(axis, q, p, 1.0))
}

/// What a ray has ready for all triangles (`BEGIN_TESTS`).
pub(super) struct RayTests {
    o: [f32; 4],
    /// The longest axis of the direction, and the two that follow it.
    k: [usize; 3],
    x: f32,
    y: f32,
    z: f32,
}

fn on_one_side(a: f32, b: f32, c: f32) -> bool {
    min2(a, min2(b, c)) > 0.0 || max2(a, max2(b, c)) < 0.0
}

/// Where a ray crosses a triangle; the words are those of `INTERSECT`.
pub(super) struct Crossing {
    pub ahead: f32,
    pub slope: f32,
    pub error: f32,
    pub bits: u32,
    wb: f32,
    wc: f32,
    sum: f32,
}

impl Crossing {
    /// Barycentric weights of the second and third corner.
    #[inline]
    pub fn weights(&self) -> (f32, f32) {
        let inverse_sum = 1.0 / self.sum;
        (self.wb * inverse_sum, self.wc * inverse_sum)
    }
}

impl RayTests {
    /// `inv`: the inverse of the direction, component by component.
    #[inline]
    pub fn begin(o: Vec3, d: Vec3, inv: [f32; 4]) -> Self {
        let axis = longest_axis(d);
        let z = pick(axis, inv[0], inv[1], inv[2]);
        let (x, y) = (pick(axis, d.y, d.z, d.x) * z, pick(axis, d.z, d.x, d.y) * z);
        let k = axis as usize;
        RayTests { o: [o.x, o.y, o.z, 0.0], k: [k, (k + 1) % 3, (k + 2) % 3], x, y, z }
    }

    /// `None` where the ray does not cross the triangle, or from where it starts.
    #[inline]
    pub fn crossing(&self, triangle: &Triangle) -> Option<Crossing> {
        let [a, b, c] = &triangle.corners;
        // Spares the check of bounds; axes are below 3.
        let [kz, kx, ky] = self.k.map(|k| k & 3);
        let from = |corner: &[f32; 4], k: usize| corner[k] - self.o[k];
        let (za, zb, zc) = (from(a, kz), from(b, kz), from(c, kz));
        let (xa, xb, xc) = (from(a, kx) - self.x * za, from(b, kx) - self.x * zb, from(c, kx) - self.x * zc);
        if on_one_side(xa, xb, xc) {
            return None;
        }
        let (ya, yb, yc) = (from(a, ky) - self.y * za, from(b, ky) - self.y * zb, from(c, ky) - self.y * zc);
        let (wa, wb, wc) = (xc * yb - yc * xb, xa * yc - ya * xc, xb * ya - yb * xa);
        if min2(wa, min2(wb, wc)) < 0.0 && max2(wa, max2(wb, wc)) > 0.0 {
            return None;
        }
        let sum = wa + wb + wc;
        let bits = a[3].to_bits();
        let from_behind = (sum < 0.0) != (self.z < 0.0);
        if sum == 0.0 || from_behind && bits & TRIANGLE_ONE_SIDED != 0 {
            return None;
        }
        let n = plane_normal(triangle);
        let to_a = Vec3::new(from(a, 0), from(a, 1), from(a, 2));
        let k = kz as u32;
        let across = pick(k, n.x, n.y, n.z) + self.x * pick(k, n.y, n.z, n.x) + self.y * pick(k, n.z, n.x, n.y);
        let height = dot(n, to_a) * self.z;
        let ahead = if across < 0.0 { -height } else { height };
        let error = (to_a.x.abs() + to_a.y.abs() + to_a.z.abs()) * self.z.abs() * PLANE_ERROR;
        (ahead > error).then_some(Crossing { ahead, slope: across.abs(), error, bits, wb, wc, sum })
    }
}
