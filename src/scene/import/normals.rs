// SPDX-License-Identifier: MIT OR Apache-2.0
//! Shading normals for corners that have none.
//!
//! The normal of a corner is the mean of the face normals around its vertex that lie within [`CREASE_DEGREES`] of the
//! face's own, weighted by the angle that each face has at the vertex (Thürmer and Wüthrich, "Computing vertex normals
//! from polygonal facets", 1998) times its area. The area keeps large flat faces flat beside their narrow bevels: by
//! angle alone a bevelled mirror reflects like a curved one. Faces meet where they share a vertex index. Sums run in
//! the order of triangles: the same bits on every machine.
//!
//! Where the file has smoothing groups, they decide instead of the angle: see [`Smoothing`].

use glam::Vec3;

use super::options::filled;
use crate::Result;
use crate::math::{cross, dot, pack_normal};
use crate::monitor::Monitor;

/// What an OBJ file says about the shading of a face: its `s` line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) enum Smoothing {
    /// Nothing: smooth with faces that say nothing, within the crease angle.
    #[default]
    Unsaid,
    /// `s off` or `s 0`: flat.
    Off,
    /// `s N`: smooth with the faces of this group at any angle.
    Group(u32),
}

impl Smoothing {
    /// The value of an `s` line; `None` if it is none.
    pub(super) fn parse(text: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(text).ok()?.trim();
        match text {
            _ if text.eq_ignore_ascii_case("off") => Some(Smoothing::Off),
            // Without a value, as some exporters write it.
            "" => Some(Smoothing::Off),
            _ => text.parse().ok().map(|n| if n == 0 { Smoothing::Off } else { Smoothing::Group(n) }),
        }
    }
}

/// Faces of one smoothing group that lie back to back would cancel each other: from this cosine on they do not count.
const BACK_TO_BACK: f32 = -0.95;

/// Faces that meet at a larger angle have a visible edge between them.
pub(crate) const CREASE_DEGREES: f32 = 30.0;

/// Cosine of [`CREASE_DEGREES`].
const CREASE_COSINE: f32 = 0.866_025_4;

/// Vertices with more faces than this sum up their neighbours by direction, not one by one: every pair would take
/// minutes at the tip of a cone of 100,000 faces.
const MOST_PAIRED: usize = 128;

/// After so many vertices it is asked whether the work is to end.
const VERTICES_AT_ONCE: usize = 1024;

/// What messages name.
const PLACE: &str = "computing normals";

/// Cells along each side of the octahedral grid of directions.
const GRID: usize = 24;

/// Computes the marked corners' normals (bits 0 to 2 of `missing`: the corner has none). `smoothing` has an entry for
/// each triangle, or none at all.
///
/// # Errors
/// [`crate::Error::Cancelled`]; no memory.
pub(super) fn compute(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    missing: &[u8],
    smoothing: &[Smoothing],
    corner_normals: &mut [[u32; 3]],
    monitor: &Monitor,
) -> Result<()> {
    let wanted = |t: usize| missing[t] != 0;
    if !(0..triangles.len()).any(wanted) {
        return Ok(());
    }
    // Corners by vertex: `first[v]..first[v + 1]` of `corners` (triangle * 3 + corner, ascending).
    let mut first = filled(0u32, positions.len() + 1, PLACE)?;
    for t in (0..triangles.len()).filter(|&t| wanted(t)) {
        for v in triangles[t] {
            first[v as usize + 1] += 1;
        }
    }
    for v in 0..positions.len() {
        first[v + 1] += first[v];
    }
    let mut fill = filled(0u32, first.len(), PLACE)?;
    fill.copy_from_slice(&first);
    let mut corners = filled(0u32, first[positions.len()] as usize, PLACE)?;
    for t in (0..triangles.len()).filter(|&t| wanted(t)) {
        for (k, v) in triangles[t].into_iter().enumerate() {
            corners[fill[v as usize] as usize] = (t * 3 + k) as u32;
            fill[v as usize] += 1;
        }
    }
    drop(fill);

    let mut around: Vec<Around> = Vec::new();
    for v in 0..positions.len() {
        if v % VERTICES_AT_ONCE == 0 {
            monitor.check()?;
            monitor.tell(v as f32 / positions.len() as f32);
        }
        let corners = &corners[first[v] as usize..first[v + 1] as usize];
        around.clear();
        around.extend(corners.iter().map(|&c| Around::new(positions, triangles, smoothing, c)));
        let sums = if around.len() > MOST_PAIRED { Some(sums_of_many(&around)) } else { None };
        for (i, here) in around.iter().enumerate() {
            let (t, k) = (here.corner as usize / 3, here.corner as usize % 3);
            if missing[t] & (1 << k) == 0 {
                continue;
            }
            let sum = match &sums {
                Some(sums) => sums[i],
                None => around
                    .iter()
                    .filter(|other| here.is_smooth_with(other))
                    .fold(Vec3::ZERO, |sum, other| sum + other.normal * other.weight),
            };
            // The face itself always counts unless its weight is 0; faces within the crease angle cannot cancel it.
            let normal = if sum.abs().max_element() > f32::MIN_POSITIVE { sum } else { here.normal };
            corner_normals[t][k] = pack_normal(normal);
        }
    }
    Ok(())
}

/// One face at a vertex.
#[derive(Clone, Copy)]
struct Around {
    corner: u32,
    smoothing: Smoothing,
    /// Of unit length.
    normal: Vec3,
    /// Angle at the vertex in radians times twice the area in squared scene units.
    weight: f32,
}

impl Around {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]], smoothing: &[Smoothing], corner: u32) -> Self {
        let (t, k) = (corner as usize / 3, corner as usize % 3);
        let p = |k: usize| positions[triangles[t][k % 3] as usize];
        let (a, b, c) = (p(0), p(1), p(2));
        let (e, f) = (p(k + 1) - p(k), p(k + 2) - p(k));
        let cosine = dot(e, f) / (dot(e, e) * dot(f, f)).sqrt();
        let angle = if cosine.is_finite() { arc_cosine(cosine) } else { 0.0 };
        let area_vector = cross(b - a, c - a);
        let smoothing = smoothing.get(t).copied().unwrap_or_default();
        Around { corner, smoothing, normal: unit(area_vector), weight: angle * area_vector.length() }
    }

    /// Whether `other`, at the same vertex, counts for this face's normal.
    fn is_smooth_with(&self, other: &Around) -> bool {
        let cosine = dot(self.normal, other.normal);
        match (self.smoothing, other.smoothing) {
            (Smoothing::Unsaid, Smoothing::Unsaid) => cosine >= CREASE_COSINE,
            (Smoothing::Group(a), Smoothing::Group(b)) => a == b && cosine > BACK_TO_BACK,
            _ => self.corner == other.corner,
        }
    }
}

/// A vector of unit length, also for very short and long ones.
fn unit(v: Vec3) -> Vec3 {
    let largest = v.abs().max_element();
    if largest > 0.0 { crate::math::normalize(v / largest) } else { Vec3::Z }
}

/// Angle in radians, within 1e-4 (Abramowitz and Stegun 4.4.45): the system's own differs from one to the next.
fn arc_cosine(x: f32) -> f32 {
    let a = x.abs().min(1.0);
    let r = (1.0 - a).sqrt() * (1.570_728_8 + a * (-0.212_114_4 + a * (0.074_261 - a * 0.018_729_3)));
    if x < 0.0 { std::f32::consts::PI - r } else { r }
}

/// For each face the weighted sum over the faces that are smooth with it, in far less than a step for every pair.
fn sums_of_many(around: &[Around]) -> Vec<Vec3> {
    let mut order: Vec<usize> = (0..around.len()).collect();
    order.sort_by_key(|&i| around[i].smoothing);
    let mut sums: Vec<Vec3> = around.iter().map(|a| a.normal * a.weight).collect();
    for alike in order.chunk_by(|&a, &b| around[a].smoothing == around[b].smoothing) {
        match around[alike[0]].smoothing {
            Smoothing::Off => {}
            Smoothing::Group(_) => {
                let sum = alike.iter().fold(Vec3::ZERO, |sum, &i| sum + around[i].normal * around[i].weight);
                alike.iter().for_each(|&i| sums[i] = sum);
            }
            Smoothing::Unsaid => {
                let unsaid: Vec<Around> = alike.iter().map(|&i| around[i]).collect();
                alike.iter().zip(sums_by_direction(&unsaid)).for_each(|(&i, sum)| sums[i] = sum);
            }
        }
    }
    sums
}

/// For each face the weighted sum over faces of like direction, where directions are taken together in cells.
fn sums_by_direction(around: &[Around]) -> Vec<Vec3> {
    let mut cells = vec![Vec3::ZERO; GRID * GRID];
    let cell_of = |n: Vec3| {
        let packed = pack_normal(n);
        let along =
            |half: u32| ((half as u16 as i16 as f32 / 32767.0 * 0.5 + 0.5) * (GRID - 1) as f32).round() as usize;
        along(packed) + along(packed >> 16) * GRID
    };
    let places: Vec<usize> = around.iter().map(|a| cell_of(a.normal)).collect();
    for (a, &place) in around.iter().zip(&places) {
        cells[place] += a.normal * a.weight;
    }
    let used: Vec<(usize, Vec3)> =
        (0..cells.len()).filter(|&i| cells[i] != Vec3::ZERO).map(|i| (i, unit(cells[i]))).collect();
    let mut sums = vec![Vec3::ZERO; cells.len()];
    for &(i, direction) in &used {
        sums[i] = used
            .iter()
            .filter(|(_, other)| dot(direction, *other) >= CREASE_COSINE)
            .fold(Vec3::ZERO, |sum, &(j, _)| sum + cells[j]);
    }
    places.iter().map(|&place| sums[place]).collect()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::{PI, TAU};

    use super::*;
    use crate::math::unpack_normal;

    fn normals_of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 3]> {
        let mut packed = vec![[0; 3]; triangles.len()];
        compute(positions, triangles, &vec![7; triangles.len()], &[], &mut packed, &Monitor::default()).unwrap();
        packed.into_iter().map(|c| c.map(unpack_normal)).collect()
    }

    /// A tube around y of `sides` squares, each in the smoothing group that `group` gives; its normals' angles to those
    /// of a cylinder, and to those of the faces.
    fn tube(sides: u32, group: impl Fn(u32) -> Smoothing) -> Vec<(f32, f32)> {
        let mut positions = Vec::new();
        for i in 0..sides {
            let (s, c) = (i as f32 / sides as f32 * TAU).sin_cos();
            positions.extend([Vec3::new(c, 0.0, -s), Vec3::new(c, 1.0, -s)]);
        }
        let at = |i: u32| 2 * (i % sides);
        let triangles: Vec<_> =
            (0..sides).flat_map(|i| [[at(i), at(i + 1), at(i + 1) + 1], [at(i), at(i + 1) + 1, at(i) + 1]]).collect();
        let smoothing: Vec<_> = (0..sides).flat_map(|i| [group(i); 2]).collect();
        let mut packed = vec![[0; 3]; triangles.len()];
        compute(&positions, &triangles, &vec![7; triangles.len()], &smoothing, &mut packed, &Monitor::default())
            .unwrap();
        let mut angles = Vec::new();
        for (triangle, normals) in triangles.iter().zip(packed) {
            let [a, b, c] = triangle.map(|v| positions[v as usize]);
            let face = unit(cross(b - a, c - a));
            for (v, n) in triangle.iter().zip(normals.map(unpack_normal)) {
                let round = positions[*v as usize] * Vec3::new(1.0, 0.0, 1.0);
                angles.push((dot(round, n).min(1.0).acos(), dot(face, n).min(1.0).acos()));
            }
        }
        angles
    }

    #[test]
    fn smoothing_groups_decide_instead_of_the_crease_angle() {
        // Eight sides meet at 45 degrees, 24 at 15; 45 at one vertex would be summed by direction if there were more.
        let near = |a: f32| a < 0.01;
        assert!(tube(8, |_| Smoothing::Group(1)).iter().all(|&(round, _)| near(round)));
        assert!(tube(8, |_| Smoothing::Unsaid).iter().all(|&(_, face)| near(face)));
        assert!(tube(24, |_| Smoothing::Off).iter().all(|&(_, face)| near(face)));
        assert!(tube(24, |_| Smoothing::Unsaid).iter().all(|&(round, _)| near(round)));
        // Each side a group of its own.
        assert!(tube(24, Smoothing::Group).iter().all(|&(_, face)| near(face)));
        assert!(tube(24, |i| if i < 12 { Smoothing::Unsaid } else { Smoothing::Group(1) }).iter().any(|a| !near(a.0)));
    }

    #[test]
    fn groups_hold_at_vertices_of_very_many_faces_too() {
        // Two fans of 100 faces each around one vertex, at right angles.
        let mut positions = vec![Vec3::ZERO];
        for i in 0..=100 {
            let (s, c) = (i as f32 / 100.0).sin_cos();
            positions.extend([Vec3::new(c, 0.0, -s), Vec3::new(0.0, c, s)]);
        }
        let flat = (0..100).map(|i| [0, 1 + 2 * i, 3 + 2 * i]);
        let upright = (0..100).map(|i| [0, 2 + 2 * i, 4 + 2 * i]);
        let triangles: Vec<[u32; 3]> = flat.chain(upright).collect();
        let tip = |first: Smoothing, second: Smoothing| {
            let smoothing: Vec<_> = (0..200).map(|i| if i < 100 { first } else { second }).collect();
            let mut packed = vec![[0; 3]; 200];
            compute(&positions, &triangles, &[7; 200], &smoothing, &mut packed, &Monitor::default()).unwrap();
            [unpack_normal(packed[0][0]), unpack_normal(packed[199][0])]
        };
        let (up, side) = (Vec3::Y, Vec3::X);
        let near = |a: Vec3, b: Vec3| (a - b).length() < 0.02;
        for (first, second) in [(Smoothing::Group(1), Smoothing::Group(2)), (Smoothing::Off, Smoothing::Off)] {
            let [a, b] = tip(first, second);
            assert!(near(a, up) && near(b, side), "{a} {b}");
        }
        let [a, b] = tip(Smoothing::Group(1), Smoothing::Group(1));
        assert!(near(a, (up + side).normalize()) && near(a, b), "{a} {b}");
        let [a, b] = tip(Smoothing::Unsaid, Smoothing::Unsaid);
        assert!(near(a, up) && near(b, side), "{a} {b}");
    }

    #[test]
    fn values_of_s_lines() {
        let parse = |text: &str| Smoothing::parse(text.as_bytes());
        for text in ["off", "OFF", "0", ""] {
            assert_eq!(parse(text), Some(Smoothing::Off), "{text}");
        }
        assert_eq!(parse("7"), Some(Smoothing::Group(7)));
        for text in ["x", "-1", "1.5", "1 2", "99999999999"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn the_crease_angle_is_what_its_name_says() {
        assert!((CREASE_DEGREES.to_radians().cos() - CREASE_COSINE).abs() < 1e-6);
        // Two faces that meet at an edge along x, folded by an angle.
        for (degrees, smooth) in [(29.0f32, true), (31.0, false)] {
            let (s, c) = degrees.to_radians().sin_cos();
            let positions = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, -1.0, 0.0), Vec3::new(0.5, c, s)];
            let second = Vec3::new(0.0, -s, c);
            // Wound the other way round, the first face is never smooth with the second.
            let against = normals_of(&positions, &[[0, 1, 2], [0, 1, 3]]);
            assert!((against[0][0] - Vec3::NEG_Z).length() < 1e-3, "{degrees}: {}", against[0][0]);
            let folded = normals_of(&positions, &[[0, 2, 1], [0, 1, 3]]);
            let mean = (Vec3::Z + second).normalize();
            let expected = if smooth { mean } else { Vec3::Z };
            assert!((folded[0][0] - expected).length() < 1e-3, "{degrees}: {}", folded[0][0]);
            assert!((folded[0][1] - Vec3::Z).length() < 1e-3, "a corner off the edge");
        }
    }

    #[test]
    fn a_cube_stays_sharp_and_its_diagonals_do_not_show() {
        let positions: Vec<Vec3> =
            (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32)).collect();
        let top = [[4, 5, 7], [4, 7, 6]];
        let front = [[0, 1, 5], [0, 5, 4]];
        let triangles = [top[0], top[1], front[0], front[1]];
        let normals = normals_of(&positions, &triangles);
        for (corners, expected) in normals.iter().zip([Vec3::Z, Vec3::Z, Vec3::NEG_Y, Vec3::NEG_Y]) {
            assert!(corners.iter().all(|n| (*n - expected).length() < 1e-4), "{corners:?}");
        }
    }

    #[test]
    fn a_sphere_gets_its_own_normals_and_a_wide_cone_its_tip_in_time() {
        // Rings of a sphere around y.
        let (rings, sectors) = (24u32, 48u32);
        let mut positions = Vec::new();
        for r in 0..=rings {
            for s in 0..sectors {
                let (theta, phi) = (r as f32 / rings as f32 * PI, s as f32 / sectors as f32 * TAU);
                positions.push(Vec3::new(theta.sin() * phi.cos(), theta.cos(), -theta.sin() * phi.sin()));
            }
        }
        let mut triangles = Vec::new();
        for r in 1..rings - 1 {
            for s in 0..sectors {
                let at = |r: u32, s: u32| r * sectors + s % sectors;
                triangles.push([at(r, s), at(r + 1, s), at(r + 1, s + 1)]);
                triangles.push([at(r, s), at(r + 1, s + 1), at(r, s + 1)]);
            }
        }
        for (triangle, normals) in triangles.iter().zip(normals_of(&positions, &triangles)) {
            for (v, n) in triangle.iter().zip(normals) {
                let p = positions[*v as usize];
                // Rings next to the open poles have faces on one side only.
                assert!(p.y.abs() > 0.95 || (n - p).length() < 0.02, "{p}: {n}");
            }
        }
        // A flat cone of 60,000 sides: its tip points along the axis. Pair by pair this would take minutes.
        let sides = 60_000u32;
        let mut positions = vec![Vec3::new(0.0, 0.1, 0.0)];
        positions.extend((0..sides).map(|i| {
            let (s, c) = (i as f32 / sides as f32 * TAU).sin_cos();
            Vec3::new(c, 0.0, -s)
        }));
        let triangles: Vec<[u32; 3]> = (0..sides).map(|i| [0, 1 + i, 1 + (i + 1) % sides]).collect();
        let normals = normals_of(&positions, &triangles);
        assert!(normals.iter().all(|n| (n[0] - Vec3::Y).length() < 0.02));
    }

    #[test]
    fn angles_are_close_to_the_standard_library() {
        for i in -1000..=1000 {
            let x = i as f32 / 1000.0;
            assert!((arc_cosine(x) - x.acos()).abs() < 1.0e-4, "{x}");
        }
    }

    #[test]
    fn corners_that_have_normals_keep_them() {
        let mut packed = vec![[1, 2, 3]];
        compute(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], &[0b010], &[], &mut packed, &Monitor::default())
            .unwrap();
        assert_eq!((packed[0][0], packed[0][2]), (1, 3));
        assert_eq!(unpack_normal(packed[0][1]), Vec3::Z);
    }
}
