// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tools that make triangle meshes: blocks, turned profiles, tubes, spheres and bent sheets.
//!
//! Everything is computed with `+ - * /` and square roots alone, so that every platform makes the same bits.
//! Closed shapes face outwards: the corners of a triangle run counter-clockwise when seen from outside.

use glam::{Vec2, Vec3};

/// Triangles with shading normals and texture coordinates at their vertices.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions in metres.
    pub positions: Vec<Vec3>,
    /// One unit normal for each vertex.
    pub normals: Vec<Vec3>,
    /// One texture coordinate for each vertex; `y` runs upwards.
    pub texcoords: Vec<Vec2>,
    /// Three vertex indices for each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Cosine and sine of an angle given in whole turns; the error is below 1e-6.
pub fn cos_sin(turns: f32) -> (f32, f32) {
    // The nearest quarter turn is taken off, what is left lies within an eighth of a turn.
    let quarters = (turns * 4.0).round();
    let x = (turns - quarters * 0.25) * std::f32::consts::TAU;
    let x2 = x * x;
    let cos = 1.0 - x2 * (0.5 - x2 * (1.0 / 24.0 - x2 * (1.0 / 720.0 - x2 * (1.0 / 40320.0))));
    let sin = x * (1.0 - x2 * (1.0 / 6.0 - x2 * (1.0 / 120.0 - x2 * (1.0 / 5040.0))));
    match (quarters as i32).rem_euclid(4) {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    }
}

impl Mesh {
    /// Adds a vertex and returns its index.
    fn vertex(&mut self, position: Vec3, normal: Vec3, texcoord: Vec2) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.texcoords.push(texcoord);
        (self.positions.len() - 1) as u32
    }

    /// Adds another mesh's triangles to this one.
    pub fn append(&mut self, other: &Mesh) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.texcoords.extend_from_slice(&other.texcoords);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + first)));
    }

    /// This mesh with another one added.
    pub fn and(mut self, other: Mesh) -> Mesh {
        self.append(&other);
        self
    }

    /// Puts vertices in the order in which triangles first use them, as readers of OBJ files do, and drops the rest.
    pub(super) fn sort_vertices(&mut self) {
        let mut place = vec![u32::MAX; self.positions.len()];
        let mut sorted = Mesh::default();
        for t in &mut self.triangles {
            for i in t {
                let old = *i as usize;
                if place[old] == u32::MAX {
                    place[old] = sorted.vertex(self.positions[old], self.normals[old], self.texcoords[old]);
                }
                *i = place[old];
            }
        }
        sorted.triangles = std::mem::take(&mut self.triangles);
        *self = sorted;
    }

    /// This mesh moved by `offset`.
    pub fn moved(mut self, offset: Vec3) -> Mesh {
        self.positions.iter_mut().for_each(|p| *p += offset);
        self
    }

    /// This mesh turned about the y axis through the origin; positive angles turn +z towards +x.
    pub fn turned_y(self, turns: f32) -> Mesh {
        let (c, s) = cos_sin(turns);
        self.in_frame([Vec3::new(c, 0.0, -s), Vec3::Y, Vec3::new(s, 0.0, c)])
    }

    /// This mesh turned about the x axis through the origin; positive angles turn +y towards +z.
    pub fn turned_x(self, turns: f32) -> Mesh {
        let (c, s) = cos_sin(turns);
        self.in_frame([Vec3::X, Vec3::new(0.0, c, s), Vec3::new(0.0, -s, c)])
    }

    /// This mesh turned about the z axis through the origin; positive angles turn +x towards +y.
    pub fn turned_z(self, turns: f32) -> Mesh {
        let (c, s) = cos_sin(turns);
        self.in_frame([Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0), Vec3::Z])
    }

    /// This mesh with its axes laid along three orthonormal, right-handed vectors.
    fn in_frame(mut self, axes: [Vec3; 3]) -> Mesh {
        let turn = |v: Vec3| axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
        self.positions.iter_mut().for_each(|p| *p = turn(*p));
        self.normals.iter_mut().for_each(|n| *n = turn(*n));
        self
    }

    /// This mesh stretched along the axes by positive factors.
    pub fn stretched(mut self, factors: Vec3) -> Mesh {
        self.positions.iter_mut().for_each(|p| *p *= factors);
        self.normals.iter_mut().for_each(|n| *n = (*n / factors).normalize());
        self
    }

    /// This mesh with its texture coordinates multiplied by `factors`.
    pub fn with_texture_scale(mut self, factors: Vec2) -> Mesh {
        self.texcoords.iter_mut().for_each(|t| *t *= factors);
        self
    }

    /// This mesh with texture coordinates taken from x and z, `repeats_per_metre` apart: for table tops and floors.
    pub fn with_plan_texture(mut self, repeats_per_metre: f32) -> Mesh {
        for (t, p) in self.texcoords.iter_mut().zip(&self.positions) {
            *t = Vec2::new(p.x, -p.z) * repeats_per_metre;
        }
        self
    }

    /// A flat four-cornered face; corners counter-clockwise as seen from its front, texture `(0,0)` at the first
    /// corner and `repeats` at the third.
    pub fn quad(corners: [Vec3; 4], repeats: Vec2) -> Mesh {
        let [a, b, c, d] = corners;
        let n = (b - a).cross(d - a).normalize();
        let mut mesh = Mesh::default();
        let (u, v) = (repeats.x, repeats.y);
        for (p, t) in [(a, (0.0, 0.0)), (b, (u, 0.0)), (c, (u, v)), (d, (0.0, v))] {
            mesh.vertex(p, n, t.into());
        }
        mesh.triangles = vec![[0, 1, 2], [0, 2, 3]];
        mesh
    }

    /// A block with flat faces between two corners. Texture coordinates are metres along each face.
    pub fn block(lo: Vec3, hi: Vec3) -> Mesh {
        let mut mesh = Mesh::default();
        for (corners, size) in block_faces(lo, hi) {
            mesh.append(&Mesh::quad(corners, size));
        }
        mesh
    }

    /// A block whose edges are cut off by `bevel` and shaded as if round; all its vertices are shared in place, so
    /// it is closed.
    pub fn rounded_block(lo: Vec3, hi: Vec3, bevel: f32) -> Mesh {
        let mut mesh = Mesh::default();
        // Vertex (axis, corner): the corner of the block, pulled in along the two axes other than `axis`.
        let corner = |index: usize, axis: usize| {
            let mut p = Vec3::ZERO;
            for k in 0..3 {
                let high = index >> k & 1 == 1;
                let inset = if k == axis { 0.0 } else { bevel };
                p[k] = if high { hi[k] - inset } else { lo[k] + inset };
            }
            p
        };
        for axis in 0..3 {
            for index in 0..8 {
                let mut n = Vec3::ZERO;
                n[axis] = if index >> axis & 1 == 1 { 1.0 } else { -1.0 };
                let p = corner(index, axis);
                let t = match axis {
                    0 => Vec2::new(p.z, p.y),
                    1 => Vec2::new(p.x, p.z),
                    _ => Vec2::new(p.x, p.y),
                };
                mesh.vertex(p, n, t);
            }
        }
        let id = |index: usize, axis: usize| (axis * 8 + index) as u32;
        let face = |mesh: &mut Mesh, ids: &[u32]| {
            // The outward side is known from the normals of the corners themselves.
            let at = |i: usize| mesh.positions[ids[i] as usize];
            let n = (at(1) - at(0)).cross(at(2) - at(0));
            let outwards: Vec3 = ids.iter().map(|&i| mesh.normals[i as usize]).sum();
            let flip = n.dot(outwards) < 0.0;
            for k in 2..ids.len() {
                let (b, c) = if flip { (ids[k], ids[k - 1]) } else { (ids[k - 1], ids[k]) };
                mesh.triangles.push([ids[0], b, c]);
            }
        };
        for axis in 0..3 {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            for side in [0, 1 << axis] {
                face(&mut mesh, &[id(side, axis), id(side | u, axis), id(side | u | v, axis), id(side | v, axis)]);
            }
            // The four edges along this axis join the faces of the other two axes.
            let (ua, va) = ((axis + 1) % 3, (axis + 2) % 3);
            for rest in [0, u, v, u | v] {
                let end = rest | 1 << axis;
                face(&mut mesh, &[id(rest, ua), id(end, ua), id(end, va), id(rest, va)]);
            }
        }
        for index in 0..8 {
            face(&mut mesh, &[id(index, 0), id(index, 1), id(index, 2)]);
        }
        mesh
    }

    /// A profile of (radius, height) points turned about the y axis.
    ///
    /// The profile runs upwards along the outside for a shape that faces outwards. Corners of the profile sharper than
    /// 40 degrees stay sharp. A profile that starts and ends on the axis, or ends where it starts, gives a closed shape.
    pub fn lathe(profile: &[(f32, f32)], sides: u32) -> Mesh {
        let points: Vec<Vec2> = profile.iter().map(|&p| p.into()).collect();
        let normal = |k: usize| {
            let d = points[k + 1] - points[k];
            Vec2::new(d.y, -d.x).normalize()
        };
        let segments = points.len() - 1;
        let closed = points[0] == points[segments];
        let blend = |k: usize, other: Option<usize>| match other {
            // cos 40 degrees
            Some(o) if normal(k).dot(normal(o)) > 0.766 => (normal(k) + normal(o)).normalize(),
            _ => normal(k),
        };
        let directions: Vec<(f32, f32)> = (0..=sides).map(|i| cos_sin((i % sides) as f32 / sides as f32)).collect();
        let length: f32 = (0..segments).map(|k| (points[k + 1] - points[k]).length()).sum();
        let mut mesh = Mesh::default();
        let mut along = 0.0;
        for k in 0..segments {
            let before = if k > 0 { Some(k - 1) } else { closed.then_some(segments - 1) };
            let after = if k + 1 < segments { Some(k + 1) } else { closed.then_some(0) };
            let (n0, n1) = (blend(k, before), blend(k, after));
            let (p0, p1) = (points[k], points[k + 1]);
            let v0 = along / length;
            along += (p1 - p0).length();
            let v1 = along / length;
            let first = mesh.positions.len() as u32;
            for (i, &(c, s)) in directions.iter().enumerate() {
                let u = i as f32 / sides as f32;
                for (p, n, v) in [(p0, n0, v0), (p1, n1, v1)] {
                    mesh.vertex(Vec3::new(c * p.x, p.y, -s * p.x), Vec3::new(c * n.x, n.y, -s * n.x), Vec2::new(u, v));
                }
            }
            for i in 0..sides {
                let a = first + i * 2;
                if p0.x > 0.0 {
                    mesh.triangles.push([a, a + 2, a + 1]);
                }
                if p1.x > 0.0 {
                    mesh.triangles.push([a + 1, a + 2, a + 3]);
                }
            }
        }
        mesh
    }

    /// A sphere about the origin; closed.
    pub fn sphere(radius: f32, sides: u32, rings: u32) -> Mesh {
        let profile: Vec<(f32, f32)> = (0..=rings)
            .map(|i| {
                let (c, s) = cos_sin(0.5 * i as f32 / rings as f32);
                let r = if i == 0 || i == rings { 0.0 } else { s * radius };
                (r, -c * radius)
            })
            .collect();
        let mut mesh = Mesh::lathe(&profile, sides);
        for (n, p) in mesh.normals.iter_mut().zip(&mesh.positions) {
            *n = p.normalize();
        }
        mesh
    }

    /// A round tube of `sides` sides along a path; the ends are capped unless the path is closed.
    pub fn tube(path: &[Vec3], radius: f32, sides: u32, closed: bool) -> Mesh {
        Mesh::tapered_tube(path, |_| radius, sides, closed)
    }

    /// A tube whose radius depends on how far along it is, from 0 to 1.
    pub fn tapered_tube(path: &[Vec3], radius: impl Fn(f32) -> f32, sides: u32, closed: bool) -> Mesh {
        let n = path.len();
        let tangent = |i: usize| {
            let (a, b) = if closed {
                (path[(i + n - 1) % n], path[(i + 1) % n])
            } else {
                (path[i.saturating_sub(1)], path[(i + 1).min(n - 1)])
            };
            (b - a).normalize()
        };
        // The frame is carried along the path, so that the tube does not twist.
        let mut t = tangent(0);
        let seed = if t.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
        let mut side = t.cross(seed).normalize();
        let rows = if closed { n + 1 } else { n };
        let mut mesh = Mesh::default();
        let mut first_side = side;
        for row in 0..rows {
            let i = row % n;
            t = tangent(i);
            side = (side - t * t.dot(side)).normalize();
            if row == 0 {
                first_side = side;
            } else if row == n {
                side = first_side;
            }
            let up = t.cross(side);
            let along = row as f32 / (rows - 1) as f32;
            let r = radius(along);
            for k in 0..=sides {
                let (c, s) = cos_sin((k % sides) as f32 / sides as f32);
                let d = side * c + up * s;
                mesh.vertex(path[i] + d * r, d, Vec2::new(k as f32 / sides as f32, along));
            }
        }
        let stride = sides + 1;
        for row in 0..rows as u32 - 1 {
            for k in 0..sides {
                let a = row * stride + k;
                mesh.triangles.push([a, a + 1, a + stride]);
                mesh.triangles.push([a + 1, a + stride + 1, a + stride]);
            }
        }
        if !closed {
            for (row, n, flip) in [(0u32, -tangent(0), true), (rows as u32 - 1, t, false)] {
                let ring: Vec<u32> = (0..sides)
                    .map(|k| {
                        let p = mesh.positions[(row * stride + k) as usize];
                        mesh.vertex(p, n, Vec2::ZERO)
                    })
                    .collect();
                for k in 1..ring.len() - 1 {
                    let (b, c) = if flip { (ring[k + 1], ring[k]) } else { (ring[k], ring[k + 1]) };
                    mesh.triangles.push([ring[0], b, c]);
                }
            }
        }
        mesh
    }

    /// A sheet of `across` by `along` cells; `at` gives the position for parameters in `[0, 1]`. Smooth normals, which
    /// look along `d/du x d/dv`. Texture coordinates are the parameters.
    pub fn sheet(across: u32, along: u32, at: impl Fn(f32, f32) -> Vec3) -> Mesh {
        let mut mesh = Mesh::default();
        let step = 1.0 / 256.0;
        for j in 0..=along {
            for i in 0..=across {
                let (u, v) = (i as f32 / across as f32, j as f32 / along as f32);
                let (u0, u1) = ((u - step).max(0.0), (u + step).min(1.0));
                let (v0, v1) = ((v - step).max(0.0), (v + step).min(1.0));
                let n = (at(u1, v) - at(u0, v)).cross(at(u, v1) - at(u, v0));
                mesh.vertex(at(u, v), n.normalize_or(Vec3::Y), Vec2::new(u, v));
            }
        }
        for j in 0..along {
            for i in 0..across {
                let a = j * (across + 1) + i;
                mesh.triangles.push([a, a + 1, a + across + 2]);
                mesh.triangles.push([a, a + across + 2, a + across + 1]);
            }
        }
        mesh
    }
}

/// The six faces of a block with their sizes in metres.
fn block_faces(lo: Vec3, hi: Vec3) -> [([Vec3; 4], Vec2); 6] {
    let p = |x: u8, y: u8, z: u8| {
        Vec3::new(if x == 1 { hi.x } else { lo.x }, if y == 1 { hi.y } else { lo.y }, if z == 1 { hi.z } else { lo.z })
    };
    let s = hi - lo;
    [
        ([p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)], Vec2::new(s.x, s.y)),
        ([p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0)], Vec2::new(s.x, s.y)),
        ([p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)], Vec2::new(s.z, s.y)),
        ([p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)], Vec2::new(s.z, s.y)),
        ([p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)], Vec2::new(s.x, s.z)),
        ([p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)], Vec2::new(s.x, s.z)),
    ]
}

/// A smooth path through `points` with `steps` pieces between each two (a Catmull-Rom spline).
pub fn smooth_path(points: &[Vec3], steps: u32, closed: bool) -> Vec<Vec3> {
    let n = points.len();
    let at = |i: usize, d: isize| {
        let k = i as isize + d;
        if closed { points[k.rem_euclid(n as isize) as usize] } else { points[k.clamp(0, n as isize - 1) as usize] }
    };
    let pieces = if closed { n } else { n - 1 };
    let mut path = Vec::new();
    for i in 0..pieces {
        let (a, b, c, d) = (at(i, -1), at(i, 0), at(i, 1), at(i, 2));
        for s in 0..steps {
            let t = s as f32 / steps as f32;
            let linear = (c - a) * t;
            let square = (a * 2.0 - b * 5.0 + c * 4.0 - d) * (t * t);
            let cubic = ((b - c) * 3.0 + d - a) * (t * t * t);
            path.push((b * 2.0 + linear + square + cubic) * 0.5);
        }
    }
    if !closed {
        path.push(points[n - 1]);
    }
    path
}

/// Points on an ellipse about the y axis at `height`, counter-clockwise from +x when seen from above.
pub fn ring_path(radius_x: f32, radius_z: f32, height: f32, pieces: u32) -> Vec<Vec3> {
    (0..pieces)
        .map(|i| {
            let (c, s) = cos_sin(i as f32 / pieces as f32);
            Vec3::new(c * radius_x, height, -s * radius_z)
        })
        .collect()
}

/// A small repeatable generator of pseudo-random numbers (PCG-like, 32 bits).
#[derive(Debug, Clone)]
pub struct Random {
    state: u32,
}

impl Random {
    /// A generator with its own sequence for each seed.
    pub fn new(seed: u32) -> Self {
        Random { state: hash(seed) }
    }

    /// The next number in `[lo, hi)`.
    pub fn range(&mut self, lo: f32, hi: f32) -> f32 {
        self.state = self.state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        lo + (hi - lo) * unit(hash(self.state))
    }
}

/// Mixes the bits of a word.
pub fn hash(x: u32) -> u32 {
    let x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
    let x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

/// The upper 24 bits of a word as a number in `[0, 1)`.
pub fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::{normals_agree, open_edges, volume};

    #[test]
    fn cosines_and_sines_are_close_to_the_standard_library() {
        for i in -2000..2000 {
            let turns = i as f32 / 700.0;
            let exact = turns as f64 * std::f64::consts::TAU;
            let (c, s) = cos_sin(turns);
            assert!((c as f64 - exact.cos()).abs() < 2e-6 && (s as f64 - exact.sin()).abs() < 2e-6, "{turns}");
        }
        assert_eq!(cos_sin(0.25), (-0.0, 1.0));
    }

    #[test]
    fn solid_shapes_are_closed_and_face_outwards() {
        let (lo, hi) = (Vec3::new(-1.0, -2.0, -3.0), Vec3::new(1.0, 2.0, 3.0));
        let bent = smooth_path(&[Vec3::ZERO, Vec3::Y, Vec3::new(1.0, 2.0, 0.0), Vec3::new(2.0, 2.0, 1.0)], 5, false);
        for (name, mesh) in [
            ("block", Mesh::block(lo, hi)),
            ("rounded block", Mesh::rounded_block(lo, hi, 0.1)),
            ("sphere", Mesh::sphere(2.0, 12, 8)),
            ("cylinder", Mesh::lathe(&[(0.0, 0.0), (1.0, 0.0), (1.0, 2.0), (0.0, 2.0)], 9)),
            ("ring", Mesh::lathe(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 0.0)], 9)),
            ("tube", Mesh::tube(&bent, 0.1, 7, false)),
            ("hoop", Mesh::tube(&ring_path(1.0, 1.5, 0.5, 20), 0.1, 7, true)),
            ("turned", Mesh::block(lo, hi).turned_x(0.1).turned_y(0.2).turned_z(0.3)),
            ("stretched", Mesh::sphere(1.0, 12, 8).stretched(Vec3::new(1.0, 2.0, 3.0))),
        ] {
            assert_eq!(open_edges(&mesh), 0, "{name} has open edges");
            assert!(volume(&mesh) > 0.0, "{name} faces inwards");
            normals_agree(&mesh);
        }
    }

    #[test]
    fn a_missing_triangle_is_found() {
        let mut mesh = Mesh::sphere(1.0, 12, 8);
        mesh.triangles.pop();
        assert_eq!(open_edges(&mesh), 6);
    }

    #[test]
    fn a_sphere_s_volume_approaches_the_true_one() {
        let exact = 4.0 / 3.0 * std::f32::consts::PI;
        assert!((volume(&Mesh::sphere(1.0, 64, 32)) / exact - 1.0).abs() < 0.01);
    }

    #[test]
    fn random_numbers_stay_in_range_and_differ_by_seed() {
        let (mut a, mut b) = (Random::new(1), Random::new(2));
        let mut sum = 0.0;
        for _ in 0..1000 {
            let (x, y) = (a.range(-1.0, 1.0), b.range(-1.0, 1.0));
            assert!((-1.0..1.0).contains(&x) && x != y);
            sum += x;
        }
        assert!(sum.abs() < 100.0);
    }
}
