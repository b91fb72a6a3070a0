// SPDX-License-Identifier: MIT OR Apache-2.0
//! What part of a triangle lies in a cell: exact clipping, and the widening that keeps it conservative.
//!
//! Traversal computes hit points in 32-bit floats, so a hit may lie a few units in the last place outside the triangle.
//! A triangle therefore counts as lying in every cell that comes within [`cell_epsilon`] of it. A wall in a plane becomes
//! a slab with a candidate plane on either side, so it need not be duplicated; triangles that meet in a plane of constant
//! x, y or z reach over it by epsilon, which costs 0 to 5 % of expected cost and 10 to 80 % more leaf entries than a tree
//! without epsilon (measured on six scenes), whatever epsilon is.
//! The polygon is clipped
//! (Sutherland and Hodgman, "Reentrant polygon clipping", CACM 1974) in 64-bit floats against the box widened by
//! epsilon, and its bounds are widened by epsilon again; as each cut starts from the triangle's own corners, nothing
//! adds up from level to level. The clipped bounds are what "perfect splits" means in Wald and Havran, "On building fast
//! kd-trees for ray tracing, and on doing that in O(N log N)" (2006), section 4.

/// Epsilon in units in the last place of the scene's largest coordinate. Rounding of `o + t d` is about two of them.
const EPSILON_ULPS: f32 = 4.0;

/// How far from a triangle a point may lie and still count as on it, for a scene whose coordinates reach `largest`.
pub(crate) fn cell_epsilon(largest: f32) -> f32 {
    // The lower end keeps boxes from being empty when all corners sit in the origin.
    (largest * f32::EPSILON * EPSILON_ULPS).max(1.0e-30)
}

/// An axis-parallel box, closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub lo: [f32; 3],
    pub hi: [f32; 3],
}

impl Cell {
    /// The two parts on both sides of a plane.
    pub fn split(&self, axis: usize, position: f32) -> (Cell, Cell) {
        let (mut lower, mut upper) = (*self, *self);
        lower.hi[axis] = position;
        upper.lo[axis] = position;
        (lower, upper)
    }

    /// Half of the surface area, in 64 bits so that it cannot overflow.
    pub fn half_area(&self) -> f64 {
        let d = [0, 1, 2].map(|a| self.hi[a] as f64 - self.lo[a] as f64);
        d[0] * d[1] + d[1] * d[2] + d[2] * d[0]
    }
}

/// A triangle in a cell: the widened bounds of what lies in it. `lo < hi` on every axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Primitive {
    pub lo: [f32; 3],
    pub id: u32,
    pub hi: [f32; 3],
    pub unused: u32,
}

/// A triangle's corners.
pub(super) type Corners = [[f64; 3]; 3];

/// The whole triangle `id`.
pub(super) fn whole(id: u32, corners: [glam::Vec3; 3], epsilon: f32) -> Primitive {
    let lo = corners[0].min(corners[1]).min(corners[2]) - epsilon;
    let hi = corners[0].max(corners[1]).max(corners[2]) + epsilon;
    Primitive { lo: lo.to_array(), id, hi: hi.to_array(), unused: 0 }
}

/// A triangle has at most one corner more after each of six cuts.
const MOST_CORNERS: usize = 9;

/// A convex polygon.
struct Polygon {
    corners: [[f64; 3]; MOST_CORNERS],
    count: usize,
}

/// Where the edge from `p` to `q` meets a plane that separates them.
#[inline]
fn crossing(p: &[f64; 3], q: &[f64; 3], axis: usize, plane: f64) -> [f64; 3] {
    let t = (plane - p[axis]) / (q[axis] - p[axis]);
    let mut point = [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])];
    point[axis] = plane;
    point
}

impl Polygon {
    fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: [f64; 3]) {
        // More corners cannot be, but the compiler does not know.
        if self.count < MOST_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Writes the part with `sign * coordinate <= sign * plane` to `part`.
    fn cut(&self, axis: usize, plane: f64, sign: f64, part: &mut Polygon) {
        part.count = 0;
        let Some(mut p) = self.corners().last() else { return };
        let mut p_inside = sign * p[axis] <= sign * plane;
        for q in self.corners() {
            let q_inside = sign * q[axis] <= sign * plane;
            if p_inside != q_inside {
                part.push(crossing(p, q, axis, plane));
            }
            if q_inside {
                part.push(*q);
            }
            (p, p_inside) = (q, q_inside);
        }
    }

    /// Bounds of the part with `sign * coordinate <= sign * plane`; `lo > hi` if nothing is left.
    fn bounds_of_part(&self, axis: usize, plane: f64, sign: f64) -> ([f64; 3], [f64; 3]) {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut add = |point: &[f64; 3]| {
            for a in 0..3 {
                lo[a] = if point[a] < lo[a] { point[a] } else { lo[a] };
                hi[a] = if point[a] > hi[a] { point[a] } else { hi[a] };
            }
        };
        if let Some(mut p) = self.corners().last() {
            let mut p_inside = sign * p[axis] <= sign * plane;
            for q in self.corners() {
                let q_inside = sign * q[axis] <= sign * plane;
                if p_inside != q_inside {
                    add(&crossing(p, q, axis, plane));
                }
                if q_inside {
                    add(q);
                }
                (p, p_inside) = (q, q_inside);
            }
        }
        (lo, hi)
    }
}

/// Cuts `primitive` at a plane strictly within its bounds; a side is `None` where the triangle does not reach it.
pub(super) fn split_primitive(
    primitive: &Primitive,
    corners: &Corners,
    axis: usize,
    position: f32,
    epsilon: f32,
) -> (Option<Primitive>, Option<Primitive>) {
    let epsilon = epsilon as f64;
    let mut buffers = [const { Polygon { corners: [[0.0; 3]; MOST_CORNERS], count: 0 } }; 2];
    let [polygon, spare] = &mut buffers;
    let (mut polygon, mut spare) = (polygon, spare);
    polygon.corners[..3].copy_from_slice(corners);
    polygon.count = 3;
    for a in 0..3 {
        let (lo, hi) = (primitive.lo[a] as f64 - epsilon, primitive.hi[a] as f64 + epsilon);
        if corners.iter().any(|p| p[a] < lo) {
            polygon.cut(a, lo, -1.0, spare);
            (polygon, spare) = (spare, polygon);
        }
        if corners.iter().any(|p| p[a] > hi) {
            polygon.cut(a, hi, 1.0, spare);
            (polygon, spare) = (spare, polygon);
        }
    }
    let fitted = |outer: Primitive, (lo, hi): ([f64; 3], [f64; 3])| {
        let mut part = outer;
        for a in 0..3 {
            // Conversion to 32 bits loses an eighth of epsilon at most.
            part.lo[a] = part.lo[a].max((lo[a] - epsilon) as f32);
            part.hi[a] = part.hi[a].min((hi[a] + epsilon) as f32);
        }
        let reaches = (0..3).all(|a| part.lo[a] < part.hi[a]);
        reaches.then_some(part)
    };
    let (mut lower, mut upper) = (*primitive, *primitive);
    lower.hi[axis] = position;
    upper.lo[axis] = position;
    let plane = position as f64;
    (
        fitted(lower, polygon.bounds_of_part(axis, plane + epsilon, 1.0)),
        fitted(upper, polygon.bounds_of_part(axis, plane - epsilon, -1.0)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const EPSILON: f32 = 1.0e-6;

    fn parts(corners: [Vec3; 3], axis: usize, position: f32) -> (Option<Primitive>, Option<Primitive>) {
        let exact = corners.map(|p| p.as_dvec3().to_array());
        split_primitive(&whole(7, corners, EPSILON), &exact, axis, position, EPSILON)
    }

    fn near(p: Option<Primitive>, lo: [f32; 3], hi: [f32; 3]) -> bool {
        let close = |a: [f32; 3], b: [f32; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 4.0 * EPSILON);
        p.is_some_and(|p| p.id == 7 && close(p.lo, lo) && close(p.hi, hi))
    }

    #[test]
    fn parts_are_bounded_tightly() {
        let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 1.0)];
        let (lower, upper) = parts(corners, 0, 1.0);
        assert!(near(lower, [0.0; 3], [1.0, 0.5, 0.25]), "{lower:?}");
        assert!(near(upper, [1.0, 0.0, 0.0], [4.0, 2.0, 1.0]), "{upper:?}");
        let (lower, upper) = parts(corners, 1, 1.0);
        assert!(near(lower, [0.0; 3], [4.0, 1.0, 0.5]), "{lower:?}");
        assert!(near(upper, [2.0, 1.0, 0.5], [4.0, 2.0, 1.0]), "{upper:?}");
    }

    #[test]
    fn cutting_a_part_again_starts_from_the_triangle() {
        let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 1.0)];
        let exact = corners.map(|p| p.as_dvec3().to_array());
        let (_, upper) = parts(corners, 1, 1.0);
        let (lower, upper) = upper.map_or((None, None), |p| split_primitive(&p, &exact, 0, 3.0, EPSILON));
        assert!(near(lower, [2.0, 1.0, 0.5], [3.0, 1.5, 0.75]), "{lower:?}");
        assert!(near(upper, [3.0, 1.0, 0.5], [4.0, 2.0, 1.0]), "{upper:?}");
    }

    #[test]
    fn a_side_that_only_the_bounds_reach_is_empty() {
        // The part of the box near the corner (0, 2) holds nothing of the triangle.
        let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 0.0)];
        let exact = corners.map(|p| p.as_dvec3().to_array());
        let corner_box = Primitive { lo: [0.0, 0.9, -1.0], id: 7, hi: [2.5, 2.0, 1.0], unused: 0 };
        let (lower, upper) = split_primitive(&corner_box, &exact, 0, 1.5, EPSILON);
        assert_eq!(lower, None);
        assert!(near(upper, [1.8, 0.9, 0.0], [2.5, 1.25, 0.0]), "{upper:?}");
    }

    #[test]
    fn touching_within_epsilon_counts_on_both_sides() {
        let corners = [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let (lower, upper) = parts(corners, 0, 0.5 * EPSILON);
        assert!(lower.is_some() && upper.is_some());
        let (lower, upper) = parts(corners, 2, 0.5 * EPSILON);
        assert!(lower.is_some() && upper.is_some(), "a flat triangle within epsilon of the plane");
    }
}
