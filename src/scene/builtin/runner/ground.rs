// SPDX-License-Identifier: MIT OR Apache-2.0
//! The track, the lawn beside it, the sky behind it, and the line.

use glam::Vec2;

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin};
use crate::scene::builtin::model::Model;

/// Lanes from the middle of the track to its border, half a lane included.
const LANES: f32 = 2.5;
/// z of the line.
pub const LINE: f32 = 0.9;

/// A flat face that looks up, between two corners.
fn flat([x0, x1]: [f32; 2], [z0, z1]: [f32; 2], y: f32) -> Mesh {
    Mesh::quad([at(x0, y, z1), at(x1, y, z1), at(x1, y, z0), at(x0, y, z0)], Vec2::ONE)
}

/// Half the width of the track.
pub fn half_track(p: &Parameters) -> f32 {
    LANES * p.lane + 0.06
}

/// Adds the ground and the sky.
pub fn add(model: &mut Model, p: &Parameters) {
    let half = half_track(p);
    let (back, front) = (-22.0, 12.0);
    let mut track = flat([-half, half], [back, front], 0.0);
    for (t, q) in track.texcoords.iter_mut().zip(&track.positions) {
        *t = Vec2::new((q.x + 0.5 * p.lane) / p.lane, -q.z / p.lane);
    }
    model.add("track", "track", track);
    let lawn = flat([-24.0, -half], [back, front], -0.02).and(flat([half, 24.0], [back, front], -0.02));
    model.add("lawn", "grass", lawn.with_plan_texture(0.4));
    let mut kerb = Mesh::default();
    for side in [-1.0, 1.0] {
        let x = side * (half + 0.05);
        kerb.append(&Mesh::rounded_block(at(x - 0.045, -0.05, back), at(x + 0.045, 0.05, front), 0.012));
    }
    model.add("kerb", "white-paint", kerb);
    let mut line = Mesh::rounded_block(at(-half, -0.003, LINE - 0.06), at(half, 0.003, LINE + 0.06), 0.001);
    line.append(&Mesh::rounded_block(at(-half, -0.003, LINE - 0.62), at(half, 0.003, LINE - 0.59), 0.001));
    model.add("line", "white-paint", line);
    // Half a cylinder around the place, seen from inside.
    let radius = 21.0;
    let sky = Mesh::sheet(48, 1, |u, v| {
        let (c, s) = cos_sin(0.5 - 0.5 * u);
        at(c * radius, -0.5 + 14.0 * v, 2.0 - s * radius)
    });
    model.add("sky", "sky", sky.with_texture_scale(Vec2::new(2.0, 1.0)));
}
