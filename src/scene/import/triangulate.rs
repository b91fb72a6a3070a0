// SPDX-License-Identifier: MIT OR Apache-2.0
//! Polygons into triangles: fans where the polygon is convex and has few corners, halves of halves where it has many, ear
//! clipping in the best-fit plane elsewhere.
//!
//! The plane's normal is Newell's (the sum of the cross products of successive corners), so that slightly bent
//! polygons do well. Ear clipping follows Meisters ("Polygons have ears", 1975) with the book-keeping of Eberly
//! ("Triangulation by ear clipping"): only a clipped ear's neighbours are looked at again, which makes it
//! O(corners x reflex corners).

use glam::{DVec2, DVec3, Vec3};

use crate::Result;
use crate::monitor::Monitor;

/// Convex polygons of more corners do not become fans.
const FAN_MOST: usize = 8;

/// Most corner tests spent on all polygons of a scene (some seconds); what is left then becomes fans.
const MAX_TESTS: u64 = 1_000_000_000;

/// Corner tests after which it is asked whether the work is to end: less than a millisecond.
const TESTS_AT_ONCE: u64 = 1 << 18;

/// The corner tests that may still be spent on the polygons of a scene.
pub(super) struct Work<'a> {
    tests_left: u64,
    unasked: u64,
    monitor: &'a Monitor,
}

impl<'a> Work<'a> {
    /// For all polygons of a scene.
    pub(super) fn new(monitor: &'a Monitor) -> Self {
        Work { tests_left: MAX_TESTS, unasked: 0, monitor }
    }

    fn spend(&mut self, tests: u64) -> Result<()> {
        self.tests_left = self.tests_left.saturating_sub(tests);
        self.unasked += tests;
        if self.unasked >= TESTS_AT_ONCE {
            self.unasked = 0;
            self.monitor.check()?;
        }
        Ok(())
    }
}

/// How a polygon was split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Split {
    /// Its triangles cover it exactly.
    Exact,
    /// It crosses itself or is far too large: the triangles are a best effort.
    Approximate,
    /// It has no area.
    Degenerate,
}

/// Splits the polygon with these corners; appends triangles of corner numbers to `out`, wound as the polygon is.
///
/// # Errors
/// [`crate::Error::Cancelled`].
pub(super) fn split(corners: &[Vec3], work: &mut Work, out: &mut Vec<[u32; 3]>) -> Result<Split> {
    let n = corners.len();
    if n < 3 {
        return Ok(Split::Degenerate);
    }
    // Relative to the first corner, where differences of floats are most exact.
    let origin = corners[0].as_dvec3();
    let points: Vec<DVec3> = corners.iter().map(|c| c.as_dvec3() - origin).collect();
    let mut normal = DVec3::ZERO;
    for i in 0..n {
        normal += points[i].cross(points[(i + 1) % n]);
    }
    if normal == DVec3::ZERO {
        return Ok(Split::Degenerate);
    }
    let flat = flatten(&points, normal);
    // Corners at the place of the one before them would only make empty triangles.
    let mut ring: Vec<u32> = Vec::with_capacity(n);
    for i in 0..n {
        if ring.last().is_none_or(|&last| points[last as usize] != points[i]) {
            ring.push(i as u32);
        }
    }
    while ring.len() > 1 && points[ring[0] as usize] == points[ring[ring.len() - 1] as usize] {
        ring.pop();
    }
    if ring.len() < 3 {
        return Ok(Split::Degenerate);
    }
    if is_convex(&ring, &flat) {
        if ring.len() > FAN_MOST && turns_everywhere(&ring, &flat) {
            halve(&ring, &points, out);
            return Ok(Split::Exact);
        }
        out.extend((1..ring.len() - 1).map(|i| [ring[0], ring[i], ring[i + 1]]));
        return Ok(Split::Exact);
    }
    let first = out.len();
    let outcome = clip_ears(&ring, &flat, work, out)?;
    // Triangles that cover a polygon without overlap have its area; those of one that crosses itself have more.
    let flat_area = |corners: &[u32]| {
        let at = |i: usize| flat[corners[i % corners.len()] as usize];
        (1..corners.len() - 1).map(|i| area2(at(0), at(i), at(i + 1))).sum::<f64>().abs()
    };
    let covered: f64 = out[first..].iter().map(|t| flat_area(t)).sum();
    let whole = flat_area(&ring);
    Ok(if (covered - whole).abs() > 1.0e-6 * covered { Split::Approximate } else { outcome })
}

/// Projects along the axis that `normal` is nearest to, keeping the winding counter-clockwise.
fn flatten(points: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let a = normal.abs();
    let project: fn(DVec3) -> DVec2 = match (a.x >= a.y && a.x >= a.z, a.y >= a.z) {
        (true, _) if normal.x > 0.0 => |p| DVec2::new(p.y, p.z),
        (true, _) => |p| DVec2::new(p.z, p.y),
        (false, true) if normal.y > 0.0 => |p| DVec2::new(p.z, p.x),
        (false, true) => |p| DVec2::new(p.x, p.z),
        (false, false) if normal.z > 0.0 => |p| DVec2::new(p.x, p.y),
        (false, false) => |p| DVec2::new(p.y, p.x),
    };
    points.iter().map(|&p| project(p)).collect()
}

/// Twice the signed area of a triangle.
fn area2(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether every corner turns left (or goes straight on) and the corners go around once.
fn is_convex(ring: &[u32], flat: &[DVec2]) -> bool {
    let at = |i: usize| flat[ring[i % ring.len()] as usize];
    let turns_left = (0..ring.len()).all(|i| area2(at(i), at(i + 1), at(i + 2)) >= 0.0);
    // Seen from corner 0, the others must follow each other counter-clockwise; a pentagram's do not.
    turns_left && (1..ring.len() - 1).all(|i| area2(at(0), at(i), at(i + 1)) >= 0.0)
}

/// Whether every corner turns left.
fn turns_everywhere(ring: &[u32], flat: &[DVec2]) -> bool {
    let at = |i: usize| flat[ring[i % ring.len()] as usize];
    (0..ring.len()).all(|i| area2(at(i), at(i + 1), at(i + 2)) > 0.0)
}

/// Splits a convex polygon into a triangle of corners a third of the way around from each other, and what is left on each
/// side of it in the middle, again and again. A fan of a disc is all needles from rim to rim, each of which a ray near its
/// corner must be tested against; these are as short as the part of the rim that they fill.
fn halve(ring: &[u32], points: &[DVec3], out: &mut Vec<[u32; 3]>) {
    let n = ring.len();
    let at = |i: usize| points[ring[i % n] as usize];
    // The way along the rim from the first corner to each, and around.
    let mut way = vec![0.0; n + 1];
    for i in 0..n {
        way[i + 1] = way[i] + at(i).distance(at(i + 1));
    }
    // The corner between two others nearest to a place on the way.
    let nearest = |from: usize, to: usize, place: f64| {
        let after = way[from + 1..to].partition_point(|&w| w < place) + from + 1;
        let before = (after - 1).max(from + 1);
        let after = after.min(to - 1);
        if place - way[before] <= way[after] - place { before } else { after }
    };
    let first = nearest(0, n - 1, way[n] / 3.0);
    let second = nearest(first, n, way[n] * 2.0 / 3.0);
    out.push([ring[0], ring[first], ring[second]]);
    let mut left = vec![(second, n), (first, second), (0, first)];
    while let Some((from, to)) = left.pop() {
        if to - from > 1 {
            let middle = nearest(from, to, (way[from] + way[to]) * 0.5);
            out.push([ring[from], ring[middle], ring[to % n]]);
            left.extend([(middle, to), (from, middle)]);
        }
    }
}

/// The polygon that is left while ears are clipped.
struct Clipper<'a, 'w> {
    flat: &'a [DVec2],
    /// Corner numbers; the links below are places in this list.
    ring: &'a [u32],
    next: Vec<u32>,
    previous: Vec<u32>,
    clipped: Vec<bool>,
    /// Places that may be reflex (or straight); those that are not any more are skipped.
    reflex: Vec<u32>,
    work: &'a mut Work<'w>,
}

impl Clipper<'_, '_> {
    fn point(&self, place: u32) -> DVec2 {
        self.flat[self.ring[place as usize] as usize]
    }

    fn neighbours(&self, place: u32) -> (u32, u32) {
        (self.previous[place as usize], self.next[place as usize])
    }

    fn turn(&self, place: u32) -> f64 {
        let (p, n) = self.neighbours(place);
        area2(self.point(p), self.point(place), self.point(n))
    }

    /// Whether the triangle at `place` has an area and no reflex corner lies in it. `lenient`: corners on its edges
    /// do not count (a bridge to a hole has two edges at the same place).
    fn is_ear(&mut self, place: u32, lenient: bool) -> Result<bool> {
        if self.turn(place) <= 0.0 {
            return Ok(false);
        }
        let (p, n) = self.neighbours(place);
        let (a, b, c) = (self.point(p), self.point(place), self.point(n));
        let mut tests = 0;
        let blocked = self.reflex.iter().any(|&r| {
            tests += 1;
            if self.clipped[r as usize] || r == p || r == n || r == place {
                return false;
            }
            let q = self.point(r);
            if q == a || q == b || q == c {
                return false;
            }
            let (u, v, w) = (area2(a, b, q), area2(b, c, q), area2(c, a, q));
            if lenient { u > 0.0 && v > 0.0 && w > 0.0 } else { u >= 0.0 && v >= 0.0 && w >= 0.0 }
        });
        self.work.spend(tests)?;
        Ok(!blocked)
    }

    /// Takes a corner out of the polygon.
    fn clip(&mut self, place: u32) -> [u32; 3] {
        let (p, n) = self.neighbours(place);
        self.next[p as usize] = n;
        self.previous[n as usize] = p;
        self.clipped[place as usize] = true;
        [self.ring[p as usize], self.ring[place as usize], self.ring[n as usize]]
    }
}

fn clip_ears(ring: &[u32], flat: &[DVec2], work: &mut Work, out: &mut Vec<[u32; 3]>) -> Result<Split> {
    let count = ring.len() as u32;
    let mut clipper = Clipper {
        flat,
        ring,
        next: (0..count).map(|i| (i + 1) % count).collect(),
        previous: (0..count).map(|i| (i + count - 1) % count).collect(),
        clipped: vec![false; ring.len()],
        reflex: Vec::new(),
        work,
    };
    clipper.reflex = (0..count).filter(|&i| clipper.turn(i) <= 0.0).collect();
    let mut left = count;
    let mut outcome = Split::Exact;
    let mut lenient = false;
    let mut anchor = 0; // a place that is still in the polygon
    'rounds: while left > 3 {
        // All places that are left are looked at; then only neighbours of clipped ears.
        let mut candidates: Vec<u32> = Vec::with_capacity(left as usize);
        let mut place = anchor;
        for _ in 0..left {
            candidates.push(place);
            place = clipper.next[place as usize];
        }
        candidates.reverse();
        let before = left;
        while let Some(place) = candidates.pop() {
            if clipper.work.tests_left == 0 {
                outcome = Split::Approximate;
                break 'rounds;
            }
            if left <= 3 || clipper.clipped[place as usize] || !clipper.is_ear(place, lenient)? {
                continue;
            }
            let (p, n) = clipper.neighbours(place);
            out.push(clipper.clip(place));
            left -= 1;
            anchor = n;
            // The far neighbour first: going on with the corner after next keeps triangles from becoming slivers.
            candidates.extend([p, n]);
        }
        clipper.reflex.retain(|&r| !clipper.clipped[r as usize]);
        if before != left {
            lenient = false;
        } else if !lenient {
            lenient = true;
        } else {
            // No ears: what is left has no area, or crosses itself.
            let mut place = anchor;
            let bends = (0..left).any(|_| {
                place = clipper.next[place as usize];
                clipper.turn(place) != 0.0
            });
            if bends {
                outcome = Split::Approximate;
            } else {
                left = 0;
            }
            break;
        }
    }
    // The last triangle, or a fan of what could not be clipped.
    if left >= 3 {
        let first = anchor;
        let mut b = clipper.next[first as usize];
        let mut c = clipper.next[b as usize];
        while c != first {
            out.push([ring[first as usize], ring[b as usize], ring[c as usize]]);
            (b, c) = (c, clipper.next[c as usize]);
        }
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn points(flat: &[(f32, f32)]) -> Vec<Vec3> {
        flat.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect()
    }

    fn split_all(corners: &[Vec3], out: &mut Vec<[u32; 3]>) -> Split {
        split(corners, &mut Work::new(&Monitor::default()), out).unwrap()
    }

    /// Signed area above the xy plane.
    fn signed_area(corners: &[Vec3], triangles: &[[u32; 3]]) -> f64 {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| corners[i as usize].as_dvec3().truncate());
            area2(a, b, c) * 0.5
        };
        triangles.iter().map(area).sum()
    }

    /// Splits, and checks that no triangle is turned over and that all have `area` together.
    fn split_well(corners: &[Vec3], area: f64) -> Vec<[u32; 3]> {
        let mut out = Vec::new();
        assert_eq!(split_all(corners, &mut out), Split::Exact);
        for t in &out {
            assert!(signed_area(corners, &[*t]) * area.signum() >= 0.0, "triangle {t:?} is turned over");
        }
        let sum = signed_area(corners, &out);
        assert!((sum - area).abs() < 1e-5 * area.abs(), "area {sum} instead of {area}");
        out
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(split_well(&square, 1.0), [[0, 1, 2], [0, 2, 3]]);
        let clockwise: Vec<Vec3> = square.iter().rev().copied().collect();
        assert_eq!(split_well(&clockwise, -1.0).len(), 2);
    }

    #[test]
    fn large_discs_have_no_needles_across() {
        for n in [9usize, 10, 100, 1000, 5000] {
            // Corners crowd on one side.
            let corner = |i: usize| {
                let t = i as f32 / n as f32;
                (std::f32::consts::TAU * (0.5 * t + 0.5 * t * t)).sin_cos()
            };
            let disc: Vec<Vec3> = points(&(0..n).map(corner).collect::<Vec<_>>()).into_iter().rev().collect();
            let area = |c: &[Vec3]| {
                (0..c.len()).map(|i| c[i].as_dvec3().cross(c[(i + 1) % c.len()].as_dvec3()).z).sum::<f64>() * 0.5
            };
            let triangles = split_well(&disc, area(&disc));
            assert_eq!(triangles.len(), n - 2);
            // The sides of all triangles are some rims long; those of a fan, nearly n times as long as half the disc.
            let side = |a: u32, b: u32| f64::from(disc[a as usize].distance(disc[b as usize]));
            let sides: f64 = triangles.iter().map(|&[a, b, c]| side(a, b) + side(b, c) + side(c, a)).sum();
            assert!(sides < 6.3 * 2.0 * (n as f64).log2(), "{n}: {sides}");
            let fan: f64 = (1..n as u32 - 1).map(|i| side(0, i) + side(i, i + 1) + side(i + 1, 0)).sum();
            assert!(fan > sides, "{n}");
        }
    }

    #[test]
    fn each_axis_keeps_the_winding() {
        let flat = points(&[(0.0, 0.0), (2.0, -1.0), (1.0, 0.0), (2.0, 1.0)]);
        for turn in 0..3 {
            for mirrored in [1.0, -1.0] {
                let corners: Vec<Vec3> = flat
                    .iter()
                    .map(|p| {
                        let p = [p.x, p.y * mirrored, 0.25 * p.x];
                        Vec3::new(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3])
                    })
                    .collect();
                let mut out = Vec::new();
                assert_eq!(split_all(&corners, &mut out), Split::Exact);
                let whole: Vec3 = (0..4).map(|i| corners[i].cross(corners[(i + 1) % 4])).sum();
                let parts: Vec<Vec3> =
                    out.iter().map(|t| t.map(|i| corners[i as usize])).map(|[a, b, c]| (b - a).cross(c - a)).collect();
                assert!(parts.iter().all(|n| n.dot(whole) > 0.0));
                assert!((parts.iter().copied().sum::<Vec3>() - whole).length() < 1e-6);
            }
        }
    }

    #[test]
    fn a_spiral_a_bridge_to_a_hole_and_straight_corners_are_covered() {
        // A band that winds inwards three times.
        let mut spiral = Vec::new();
        let arm = |turns: f32, r: f32| (turns.cos() * r, turns.sin() * r);
        let steps = 300;
        for i in 0..=steps {
            let a = i as f32 / steps as f32 * 18.0;
            spiral.push(arm(a, 10.0 - a * 0.5));
        }
        for i in (0..=steps).rev() {
            let a = i as f32 / steps as f32 * 18.0;
            spiral.push(arm(a, 9.0 - a * 0.5));
        }
        let spiral = points(&spiral);
        let n = spiral.len();
        let shoelace: f64 =
            (0..n).map(|i| spiral[i].as_dvec3().cross(spiral[(i + 1) % n].as_dvec3()).z).sum::<f64>() * 0.5;
        assert_eq!(split_well(&spiral, shoelace).len(), n - 2);
        // A square with a square hole, joined by a bridge that is walked twice.
        let frame = points(&[
            (0.0, 0.0),
            (4.0, 0.0),
            (4.0, 4.0),
            (0.0, 4.0),
            (0.0, 0.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (3.0, 3.0),
            (3.0, 1.0),
            (1.0, 1.0),
        ]);
        split_well(&frame, 12.0);
        // Corners on edges.
        let notched = points(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 2.0), (1.0, 1.0), (0.0, 1.0)]);
        split_well(&notched, 3.0);
    }

    #[test]
    fn what_is_no_simple_polygon_is_told() {
        let mut out = Vec::new();
        assert_eq!(split_all(&points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]), &mut out), Split::Degenerate);
        assert_eq!(split_all(&points(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0), (1.0, 0.0)]), &mut out), Split::Degenerate);
        assert!(out.is_empty());
        let bow_tie = points(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 1.0)]);
        assert_eq!(split_all(&bow_tie, &mut out), Split::Approximate);
        let star: Vec<(f32, f32)> = (0..5).map(|i| (i as f32 * 2.513_274).sin_cos()).collect();
        assert_eq!(split_all(&points(&star), &mut out), Split::Approximate);
    }

    #[test]
    fn a_comb_of_many_thousand_corners_takes_no_time_to_speak_of() {
        let mut comb: Vec<(f32, f32)> = (0..20_000).map(|i| (i as f32, (i % 2) as f32)).collect();
        comb.extend([(19_999.0, -1.0), (0.0, -1.0)]);
        split_well(&points(&comb), -29_998.5);
    }

    #[test]
    fn a_polygon_that_takes_long_can_be_cancelled() {
        // A star of 4000 points: half of its corners are reflex, each of which every ear is tested against.
        let corner = |i: u32| {
            let (s, c) = (i as f32 / 4000.0 * std::f32::consts::PI).sin_cos();
            let r = if i.is_multiple_of(2) { 1.0 } else { 0.9 };
            (r * c, r * s)
        };
        let star = points(&(0..8000).map(corner).collect::<Vec<_>>());
        let monitor = Monitor::default();
        let mut out = Vec::new();
        assert_eq!(split(&star, &mut Work::new(&monitor), &mut out).unwrap(), Split::Exact);
        monitor.cancel().cancel();
        let mut work = Work::new(&monitor);
        assert!(matches!(split(&star, &mut work, &mut out), Err(crate::Error::Cancelled)));
        assert!(MAX_TESTS - work.tests_left < 2 * TESTS_AT_ONCE);
    }

    #[test]
    fn without_time_left_a_concave_polygon_becomes_a_fan() {
        let arrow = points(&[(0.0, 0.0), (2.0, -1.0), (1.0, 0.0), (2.0, 1.0)]);
        let mut out = Vec::new();
        let monitor = Monitor::default();
        let mut spent = Work { tests_left: 0, ..Work::new(&monitor) };
        assert_eq!(split(&arrow, &mut spent, &mut out).unwrap(), Split::Approximate);
        assert_eq!(out.len(), 2);
    }
}
