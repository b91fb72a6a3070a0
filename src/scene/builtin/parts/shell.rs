// SPDX-License-Identifier: MIT OR Apache-2.0
//! Shells: a profile carried around an outline, as a lathe carries one around a circle. Sinks, bath tubs, cushions.

use glam::{Vec2, Vec3};

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin, smooth_path};

/// A rounded rectangle about the y axis, seen from above.
#[derive(Debug, Clone, Copy)]
pub struct Outline {
    /// Half its size along x and z.
    pub half: Vec2,
    /// Radius of its corners.
    pub radius: f32,
}

/// Part of a quarter of an outline that each of its two straight pieces takes.
const STRAIGHT: f32 = 0.2;

impl Outline {
    /// An outline of two half sizes and a radius.
    pub const fn new(half_x: f32, half_z: f32, radius: f32) -> Self {
        Outline { half: Vec2::new(half_x, half_z), radius }
    }

    /// The point at `u`, from 0 to 1 counter-clockwise from +x as seen from above, and the normal there; `y` is -z.
    fn point(&self, u: f32) -> (Vec2, Vec2) {
        let quarter = ((u * 4.0) as i32).clamp(0, 3);
        let t = u * 4.0 - quarter as f32;
        // Each second quarter is the first one in a looking glass.
        let t = if quarter % 2 == 1 { 1.0 - t } else { t };
        let (a, b, r) = (self.half.x, self.half.y, self.radius);
        let (p, n) = if t <= STRAIGHT {
            (Vec2::new(a, (b - r) * t / STRAIGHT), Vec2::X)
        } else if t >= 1.0 - STRAIGHT {
            (Vec2::new((a - r) * (1.0 - t) / STRAIGHT, b), Vec2::Y)
        } else {
            let (c, s) = cos_sin(0.25 * (t - STRAIGHT) / (1.0 - 2.0 * STRAIGHT));
            (Vec2::new(a - r + c * r, b - r + s * r), Vec2::new(c, s))
        };
        let side = [Vec2::ONE, Vec2::new(-1.0, 1.0), Vec2::NEG_ONE, Vec2::new(1.0, -1.0)][quarter as usize];
        (p * side, n * side)
    }
}

/// A profile of (offset, height) points carried around an outline; positive offsets lie outside it.
///
/// As with [`Mesh::lathe`], the profile runs upwards along the outside, and corners sharper than 40 degrees stay sharp.
/// `low` and `high` say whether flat faces close the first ring, downwards, and the last one, upwards. No offset may
/// reach further inwards than the outline's radius. `sides` is made a multiple of 20.
pub fn swept(profile: &[(f32, f32)], outline: Outline, sides: u32, [low, high]: [bool; 2]) -> Mesh {
    let sides = sides.next_multiple_of(20);
    let ring: Vec<(Vec2, Vec2)> = (0..=sides).map(|i| outline.point((i % sides) as f32 / sides as f32)).collect();
    let points: Vec<Vec2> = profile.iter().map(|&p| p.into()).collect();
    let segments = points.len() - 1;
    let normal = |k: usize| {
        let d = points[k + 1] - points[k];
        Vec2::new(d.y, -d.x).normalize()
    };
    let blend = |k: usize, other: Option<usize>| match other {
        // cos 40 degrees
        Some(o) if normal(k).dot(normal(o)) > 0.766 => (normal(k) + normal(o)).normalize(),
        _ => normal(k),
    };
    let closed = points[0] == points[segments];
    let mut mesh = Mesh::default();
    let mut along = 0.0;
    for k in 0..segments {
        let before = if k > 0 { Some(k - 1) } else { closed.then_some(segments - 1) };
        let after = if k + 1 < segments { Some(k + 1) } else { closed.then_some(0) };
        let (n0, n1) = (blend(k, before), blend(k, after));
        let (p0, p1) = (points[k], points[k + 1]);
        let (v0, v1) = (along, along + (p1 - p0).length());
        along = v1;
        let first = mesh.positions.len() as u32;
        for (i, &(p, d)) in ring.iter().enumerate() {
            for (q, n, v) in [(p0, n0, v0), (p1, n1, v1)] {
                let at_ring = p + d * q.x;
                mesh.positions.push(at(at_ring.x, q.y, -at_ring.y));
                mesh.normals.push(at(d.x * n.x, n.y, -d.y * n.x));
                mesh.texcoords.push(Vec2::new(i as f32 / sides as f32, v));
            }
        }
        for i in 0..sides {
            let a = first + i * 2;
            mesh.triangles.push([a, a + 2, a + 1]);
            mesh.triangles.push([a + 1, a + 2, a + 3]);
        }
    }
    for (wanted, q, up) in [(low, points[0], false), (high, points[segments], true)] {
        if wanted {
            cap(&mut mesh, &ring, q, up);
        }
    }
    mesh
}

/// Closes a ring with a flat face.
fn cap(mesh: &mut Mesh, ring: &[(Vec2, Vec2)], q: Vec2, up: bool) {
    let first = mesh.positions.len() as u32;
    let n = if up { Vec3::Y } else { -Vec3::Y };
    let mut vertex = |p: Vec2| {
        mesh.positions.push(at(p.x, q.y, -p.y));
        mesh.normals.push(n);
        mesh.texcoords.push(p);
    };
    vertex(Vec2::ZERO);
    for &(p, d) in ring {
        vertex(p + d * q.x);
    }
    for i in 1..ring.len() as u32 {
        let (a, b) = if up { (first + i, first + i + 1) } else { (first + i + 1, first + i) };
        mesh.triangles.push([first, a, b]);
    }
}

/// A smooth profile through `points` with `steps` pieces between each two.
pub fn curve(points: &[(f32, f32)], steps: u32) -> Vec<(f32, f32)> {
    let points: Vec<Vec3> = points.iter().map(|&(r, y)| at(r, y, 0.0)).collect();
    smooth_path(&points, steps, false).iter().map(|p| (p.x.max(0.0), p.y)).collect()
}

/// The wall of a vessel that is open above: its outside, a round rim and its inside, `thickness` apart. `outside` starts
/// on the axis and runs upwards; the floor inside is `floor` above the outside's lowest point. Closed.
pub fn vessel(outside: &[(f32, f32)], thickness: f32, floor: f32) -> Vec<(f32, f32)> {
    let mut profile = outside.to_vec();
    let last = outside[outside.len() - 1];
    profile.push((last.0 - 0.5 * thickness, last.1 + 0.4 * thickness));
    let lowest = outside[0].1 + floor;
    let inside: Vec<(f32, f32)> = outside.iter().rev().map(|&(r, y)| (r - thickness, y)).collect();
    let mut radius = 0.0;
    for &(r, y) in &inside {
        if y > lowest + 1.0e-3 && r > 1.0e-3 {
            profile.push((r, y));
            radius = r;
        }
    }
    profile.push((radius * 0.9, lowest));
    profile.push((0.0, lowest));
    profile
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::{normals_agree, open_edges, volume};

    #[test]
    fn a_swept_block_is_closed_faces_outwards_and_has_its_volume() {
        let outline = Outline::new(1.0, 2.0, 0.5);
        let mesh = swept(&[(0.0, 0.0), (0.0, 1.0)], outline, 100, [true, true]);
        assert_eq!(open_edges(&mesh), 0);
        normals_agree(&mesh);
        let exact = 8.0 - (4.0 - std::f32::consts::PI) * 0.25;
        assert!((volume(&mesh) / exact - 1.0).abs() < 0.002, "{}", volume(&mesh));
        assert_eq!(open_edges(&swept(&[(0.0, 0.0), (0.0, 1.0)], outline, 100, [true, false])), 100 * 2);
    }

    #[test]
    fn a_swept_tub_is_closed_and_hollow() {
        let outline = Outline::new(1.0, 2.0, 0.5);
        let profile = [(0.0, 0.0), (0.0, 1.0), (-0.1, 1.0), (-0.1, 0.1)];
        let mesh = swept(&profile, outline, 40, [true, true]);
        assert_eq!(open_edges(&mesh), 0);
        normals_agree(&mesh);
        let inside = 1.8 * 3.8 * 0.9;
        assert!(volume(&mesh) > 0.0 && volume(&mesh) < 8.0 - 0.9 * inside);
    }

    #[test]
    fn vessels_are_closed_when_turned() {
        let outside = curve(&[(0.0, 0.0), (0.05, 0.0), (0.07, 0.05), (0.06, 0.1)], 4);
        let mesh = Mesh::lathe(&vessel(&outside, 0.004, 0.006), 16);
        assert_eq!(open_edges(&mesh), 0);
        assert!(volume(&mesh) > 0.0);
    }
}
