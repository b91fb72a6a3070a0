// SPDX-License-Identifier: MIT OR Apache-2.0
//! Doors, drawers, handles and worktops of fitted cupboards.

use glam::{Vec2, Vec3};

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin, smooth_path};

/// Thickness of a door.
pub const DOOR: f32 = 0.022;

/// Where something stands that is made with its front towards +z: turned about the y axis, then moved.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// How far it is turned, in whole turns.
    pub turns: f32,
    /// Where its origin comes to lie.
    pub origin: Vec3,
}

impl Spot {
    /// A place of its own.
    pub const fn new(turns: f32, origin: Vec3) -> Self {
        Spot { turns, origin }
    }

    /// The mesh in its place.
    pub fn put(&self, mesh: Mesh) -> Mesh {
        let mesh = if self.turns == 0.0 { mesh } else { mesh.turned_y(self.turns) };
        mesh.moved(self.origin)
    }

    /// The place of a point of it.
    pub fn point(&self, point: Vec3) -> Vec3 {
        let (c, s) = cos_sin(self.turns);
        at(c * point.x + s * point.z, point.y, c * point.z - s * point.x) + self.origin
    }
}

/// A door or a drawer's front: a frame `frame` wide around a sunk panel, its back at z = 0.
pub fn panelled([x0, x1]: [f32; 2], [y0, y1]: [f32; 2], frame: f32) -> Mesh {
    let mut mesh = door_frame([x0, x1], [y0, y1], frame);
    mesh.append(&Mesh::block(at(x0 + frame, y0 + frame, 0.002), at(x1 - frame, y1 - frame, 0.011)));
    mesh
}

/// The frame of a door, without what is in it.
pub fn door_frame([x0, x1]: [f32; 2], [y0, y1]: [f32; 2], frame: f32) -> Mesh {
    let piece = |x0: f32, y0: f32, x1: f32, y1: f32| Mesh::rounded_block(at(x0, y0, 0.0), at(x1, y1, DOOR), 0.003);
    piece(x0, y0, x0 + frame, y1)
        .and(piece(x1 - frame, y0, x1, y1))
        .and(piece(x0 + frame, y0, x1 - frame, y0 + frame))
        .and(piece(x0 + frame, y1 - frame, x1 - frame, y1))
}

/// A bent bar handle, `long` from end to end, lying along x about the origin; its feet stand on z = 0.
pub fn bow_handle(long: f32, radius: f32) -> Mesh {
    let h = 0.5 * long;
    let bend = [at(-h, 0.0, 0.0), at(-h, 0.0, 0.022), at(-h * 0.72, 0.0, 0.033), at(0.0, 0.0, 0.036)];
    let right = bend.iter().rev().skip(1).map(|p| at(-p.x, p.y, p.z));
    let path: Vec<Vec3> = bend.iter().copied().chain(right).collect();
    let bar = Mesh::tube(&smooth_path(&path, 2, false), radius, 8, false);
    let foot = Mesh::lathe(&[(radius * 1.9, 0.0), (radius * 1.7, 0.004), (0.0, 0.005)], 10).turned_x(0.25);
    bar.and(foot.clone().moved(at(-h, 0.0, 0.0))).and(foot.moved(at(h, 0.0, 0.0)))
}

/// A round knob on z = 0.
pub fn knob(radius: f32, sides: u32) -> Mesh {
    let r = radius;
    let profile =
        [(r * 0.8, 0.0), (r * 0.5, r * 0.3), (r * 0.45, r * 0.7), (r, r * 1.2), (r * 0.85, r * 1.75), (0.0, r * 1.95)];
    Mesh::lathe(&profile, sides).turned_x(0.25)
}

/// A slab with a rectangular hole: `[x0, z0, x1, z1]` of each, from `low` to `high`. Texture coordinates are metres.
pub fn slab_with_hole(slab: [f32; 4], hole: [f32; 4], low: f32, high: f32) -> Mesh {
    let corners = |[x0, z0, x1, z1]: [f32; 4], y: f32| [at(x0, y, z1), at(x1, y, z1), at(x1, y, z0), at(x0, y, z0)];
    let (outer, inner) = (corners(slab, high), corners(hole, high));
    let down = Vec3::Y * (low - high);
    let mut mesh = Mesh::default();
    for k in 0..4 {
        let next = (k + 1) % 4;
        let (a, b, c, d) = (outer[k], outer[next], inner[next], inner[k]);
        mesh.append(&Mesh::quad([a, b, c, d], Vec2::ONE).with_plan_texture(1.0));
        mesh.append(&Mesh::quad([d + down, c + down, b + down, a + down], Vec2::ONE).with_plan_texture(1.0));
        let long = (b - a).length();
        mesh.append(&Mesh::quad([a + down, b + down, b, a], Vec2::new(long, high - low)));
        mesh.append(&Mesh::quad([c + down, d + down, d, c], Vec2::new((c - d).length(), high - low)));
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slab_with_a_hole_has_the_volume_that_is_left() {
        let mesh = slab_with_hole([0.0, 0.0, 3.0, 2.0], [1.0, 0.5, 2.0, 1.5], 0.0, 0.5);
        let p = |i: u32| mesh.positions[i as usize];
        let volume: f32 = mesh.triangles.iter().map(|t| p(t[0]).dot(p(t[1]).cross(p(t[2])))).sum::<f32>() / 6.0;
        assert!((volume - 2.5).abs() < 1e-4, "{volume}");
    }

    #[test]
    fn what_is_put_on_a_right_wall_looks_to_the_left() {
        let spot = Spot::new(-0.25, at(2.0, 0.0, 1.0));
        let mesh = spot
            .put(Mesh::quad([at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0)], Vec2::ONE));
        assert!((mesh.normals[0] + Vec3::X).length() < 1e-5, "{}", mesh.normals[0]);
        assert!((mesh.positions[1] - at(2.0, 0.0, 2.0)).length() < 1e-5, "{}", mesh.positions[1]);
        assert!((spot.point(Vec3::X) - mesh.positions[1]).length() < 1e-5);
    }
}
