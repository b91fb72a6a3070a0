// SPDX-License-Identifier: MIT OR Apache-2.0
//! Smooth bodies: limbs that flow into each other, described by a distance field and covered with triangles.

use glam::{Vec2, Vec3};

use super::at;
use crate::scene::builtin::mesh::Mesh;

/// A limb: a rod with round ends whose radius changes from `ra` at `a` to `rb` at `b`.
#[derive(Debug, Clone, Copy)]
pub struct Limb {
    /// Where it begins.
    pub a: Vec3,
    /// Where it ends.
    pub b: Vec3,
    /// Its radius at `a`.
    pub ra: f32,
    /// Its radius at `b`.
    pub rb: f32,
}

impl Limb {
    /// A limb from `a` to `b`.
    pub const fn new(a: Vec3, b: Vec3, ra: f32, rb: f32) -> Self {
        Limb { a, b, ra, rb }
    }

    /// About how far a point lies outside; negative inside.
    pub fn distance(&self, p: Vec3) -> f32 {
        let along = self.b - self.a;
        let t = ((p - self.a).dot(along) / along.length_squared().max(1.0e-12)).clamp(0.0, 1.0);
        (p - self.a - along * t).length() - (self.ra + (self.rb - self.ra) * t)
    }

    /// This limb, thicker by `more`.
    pub fn thicker(self, more: f32) -> Self {
        Limb { ra: self.ra + more, rb: self.rb + more, ..self }
    }
}

/// The lower of two distances, rounded off where they differ by less than `soft`.
pub fn blend(a: f32, b: f32, soft: f32) -> f32 {
    let h = (soft - (a - b).abs()).max(0.0) / soft;
    a.min(b) - h * h * soft * 0.25
}

/// The distance to limbs that flow into each other.
pub fn joined(limbs: &[Limb], soft: f32, p: Vec3) -> f32 {
    limbs.iter().fold(f32::MAX, |d, limb| blend(d, limb.distance(p), soft))
}

/// The surface on which `field` is 0, between `lo` and `hi`, in cells of `cell`; closed if the body ends before the
/// borders. Each cell that the surface crosses gets a vertex, each edge that it crosses two triangles.
pub fn surface(lo: Vec3, hi: Vec3, cell: f32, field: impl Fn(Vec3) -> f32) -> Mesh {
    let count = ((hi - lo) / cell).ceil().max(Vec3::ONE);
    let [nx, ny, nz] = count.to_array().map(|v| v as usize + 1);
    let spot = |x: usize, y: usize, z: usize| lo + at(x as f32, y as f32, z as f32) * cell;
    let node = |x: usize, y: usize, z: usize| (z * ny + y) * nx + x;
    let mut values = Vec::with_capacity(nx * ny * nz);
    for z in 0..nz {
        for y in 0..ny {
            values.extend((0..nx).map(|x| field(spot(x, y, z))));
        }
    }
    let slope = |p: Vec3| {
        let h = 0.25 * cell;
        let part = |d: Vec3| field(p + d) - field(p - d);
        at(part(Vec3::X * h), part(Vec3::Y * h), part(Vec3::Z * h)).normalize_or(Vec3::Y)
    };
    let mut mesh = Mesh::default();
    let mut vertices = vec![u32::MAX; values.len()];
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                let Some(within) = crossing(|k| values[node(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))]) else {
                    continue;
                };
                let mut p = spot(x, y, z) + within.clamp(Vec3::splat(0.12), Vec3::splat(0.88)) * cell;
                let reach = 0.2 * cell;
                p -= slope(p) * field(p).clamp(-reach, reach);
                vertices[node(x, y, z)] = mesh.positions.len() as u32;
                mesh.positions.push(p);
                mesh.normals.push(slope(p));
                mesh.texcoords.push(Vec2::ZERO);
            }
        }
    }
    let steps = [1, nx, nx * ny];
    for z in 1..nz - 1 {
        for y in 1..ny - 1 {
            for x in 1..nx - 1 {
                let here = node(x, y, z);
                for axis in 0..3 {
                    let (inside, next) = (values[here] < 0.0, values[here + steps[axis]] < 0.0);
                    if inside == next {
                        continue;
                    }
                    let (u, v) = (steps[(axis + 1) % 3], steps[(axis + 2) % 3]);
                    let mut ring = [here, here - u, here - u - v, here - v].map(|i| vertices[i]);
                    if !inside {
                        ring.swap(1, 3);
                    }
                    mesh.triangles.push([ring[0], ring[1], ring[2]]);
                    mesh.triangles.push([ring[0], ring[2], ring[3]]);
                }
            }
        }
    }
    agree(&mut mesh);
    mesh
}

/// Where a field has an edge, its slope may look away from a face that spans it: such a face becomes flat.
fn agree(mesh: &mut Mesh) {
    for k in 0..mesh.triangles.len() {
        let corners = mesh.triangles[k].map(|i| i as usize);
        let [a, b, c] = corners.map(|i| mesh.positions[i]);
        let face = (b - a).cross(c - a);
        if corners.iter().all(|&i| face.dot(mesh.normals[i]) > 0.0) {
            continue;
        }
        let first = mesh.positions.len() as u32;
        for i in corners {
            mesh.positions.push(mesh.positions[i]);
            mesh.normals.push(face.normalize_or(Vec3::Y));
            mesh.texcoords.push(mesh.texcoords[i]);
        }
        mesh.triangles[k] = [first, first + 1, first + 2];
    }
}

/// The middle of the points where a surface crosses the edges of a unit cell, from the values at its corners; none
/// if it does not cross any.
fn crossing(value: impl Fn(usize) -> f32) -> Option<Vec3> {
    let (mut sum, mut found) = (Vec3::ZERO, 0.0);
    for low in 0..8 {
        for axis in 0..3 {
            let high = low | 1 << axis;
            if high == low {
                continue;
            }
            let (a, b) = (value(low), value(high));
            if (a < 0.0) != (b < 0.0) {
                let mut p = at((low & 1) as f32, (low >> 1 & 1) as f32, (low >> 2) as f32);
                p[axis] = a / (a - b);
                sum += p;
                found += 1.0;
            }
        }
    }
    (found > 0.0).then(|| sum / found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::{normals_agree, open_edges, volume};

    #[test]
    fn a_round_field_becomes_a_closed_ball_of_its_volume() {
        let ball = Limb::new(Vec3::ZERO, Vec3::ZERO, 0.5, 0.5);
        let mesh = surface(Vec3::splat(-0.7), Vec3::splat(0.7), 0.05, |p| ball.distance(p));
        assert_eq!(open_edges(&mesh), 0);
        let exact = 4.0 / 3.0 * std::f32::consts::PI * 0.125;
        assert!((volume(&mesh) / exact - 1.0).abs() < 0.02, "{}", volume(&mesh) / exact);
        assert!(mesh.positions.iter().zip(&mesh.normals).all(|(p, n)| p.normalize().dot(*n) > 0.999));
    }

    #[test]
    fn normals_look_to_the_side_of_their_faces_at_edges_too() {
        // A thin plate that is cut off: its cells are as thick as it is.
        let rod = Limb::new(Vec3::ZERO, Vec3::X, 0.3, 0.2);
        let cut = |p: Vec3| rod.distance(p).max(p.y - 0.04).max(-0.02 - p.y).max(p.x + 0.7 * p.z - 0.6);
        let mesh = surface(Vec3::splat(-0.6), Vec3::splat(1.4), 0.05, cut);
        assert_eq!(open_edges(&mesh), 0);
        normals_agree(&mesh);
    }

    #[test]
    fn limbs_flow_into_each_other() {
        let rod = Limb::new(Vec3::ZERO, Vec3::X, 0.2, 0.1);
        assert!((rod.distance(at(0.5, 0.4, 0.0)) - 0.25).abs() < 1.0e-6);
        assert!((rod.thicker(0.1).distance(at(0.0, 0.4, 0.0)) - 0.1).abs() < 1.0e-6);
        let both = [rod, Limb::new(Vec3::ZERO, Vec3::Y, 0.2, 0.1)];
        let p = at(0.2, 0.2, 0.0);
        assert!(joined(&both, 0.1, p) < rod.distance(p) - 0.02);
        assert_eq!(joined(&both, 0.1, at(2.0, 0.0, 0.0)), rod.distance(at(2.0, 0.0, 0.0)));
    }
}
