// SPDX-License-Identifier: MIT OR Apache-2.0
//! Chairs and tables.

use glam::Vec3;
use serde::Deserialize;

use super::at;
use super::shell::{Outline, swept};
use crate::scene::builtin::mesh::{Mesh, smooth_path};

/// Where a chair stands.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChairPlace {
    /// x and z of its seat's middle.
    pub at: [f32; 2],
    /// How far it is turned about the y axis; at 0 who sits on it looks to +z.
    pub turns: f32,
}

/// A chair with four turned legs and a back of curved slats: its wood, and its seat. It looks to +z.
pub fn slatted_chair(seat: f32, back: f32, sides: u32) -> (Mesh, Mesh) {
    let mut wood = Mesh::default();
    let (w, d) = (0.195, 0.19);
    for side in [-1.0, 1.0] {
        let post = [
            at(side * (w - 0.015), 0.0, -d - 0.05),
            at(side * (w - 0.02), seat * 0.55, -d - 0.005),
            at(side * (w - 0.02), seat, -d),
            at(side * (w - 0.01), seat + 0.5 * (back - seat), -d - 0.03),
            at(side * (w + 0.005), back, -d - 0.10),
        ];
        wood.append(&Mesh::tapered_tube(&smooth_path(&post, 4, false), |t| 0.018 - 0.005 * t, sides, false));
        let tip = Mesh::sphere(0.0165, sides, 6).moved(at(side * (w + 0.005), back + 0.006, -d - 0.101));
        wood.append(&tip);
        // Turned legs: a thick middle between two rings.
        let bulge = [0.013, 0.016, 0.019, 0.021, 0.0185, 0.022, 0.0185, 0.020, 0.0165];
        let leg: Vec<Vec3> = (0..bulge.len())
            .map(|i| {
                let t = i as f32 / (bulge.len() - 1) as f32;
                at(side * (w + 0.012 - 0.022 * t), t * (seat - 0.02), d + 0.015 - 0.025 * t)
            })
            .collect();
        let thick = |t: f32| bulge[((t * (bulge.len() - 1) as f32 + 0.5) as usize).min(bulge.len() - 1)];
        wood.append(&Mesh::tapered_tube(&leg, thick, sides, false));
        for y in [0.14, 0.25] {
            let rail = [at(side * (w + 0.004), y, d), at(side * (w - 0.017), y + 0.005, -d - 0.03)];
            wood.append(&Mesh::tube(&rail, 0.0085, sides, false));
        }
    }
    for (y, z) in [(0.20, d + 0.004), (0.30, d - 0.001), (0.22, -d - 0.03)] {
        wood.append(&Mesh::tube(&[at(-w, y, z), at(w, y, z)], 0.0085, sides, false));
    }
    for k in 0..3 {
        let t = 0.34 + 0.27 * k as f32;
        let y = seat + t * (back - seat);
        let z = -d - 0.012 - 0.09 * t * t;
        let (tall, grow) = (0.052, 0.018);
        // Bowed backwards, with a crown.
        let slat = |side: f32| {
            move |u: f32, v: f32| {
                let x = 2.0 * u - 1.0;
                let bow = 0.028 * (1.0 - x * x);
                let crown = grow * (1.0 - x * x) * v;
                at(x * (w - 0.012), y + tall * v + crown, z - bow + side * 0.006 - 0.01 * v)
            }
        };
        wood.append(&Mesh::sheet(8, 2, slat(1.0)));
        wood.append(&Mesh::sheet(8, 2, move |u, v| slat(-1.0)(1.0 - u, v)));
        let edge: Vec<Vec3> = (0..=8).map(|i| slat(0.0)(i as f32 / 8.0, 1.0)).collect();
        wood.append(&Mesh::tube(&edge, 0.0066, 5, false));
        let edge: Vec<Vec3> = (0..=8).map(|i| slat(0.0)(i as f32 / 8.0, 0.0)).collect();
        wood.append(&Mesh::tube(&edge, 0.0066, 5, false));
    }
    let edge = [
        (-0.012, seat - 0.024),
        (0.0, seat - 0.014),
        (0.0, seat - 0.002),
        (-0.008, seat + 0.006),
        (-0.05, seat + 0.003),
    ];
    let board = swept(&edge, Outline::new(0.215, 0.205, 0.07), 20, [true, true]).with_plan_texture(1.6);
    (wood, board)
}

/// A table on four tapered legs, about the origin: its legs and aprons, and its top.
pub fn table(half_x: f32, half_z: f32, height: f32) -> (Mesh, Mesh) {
    let (x, z) = (half_x - 0.07, half_z - 0.07);
    let low = height - 0.036;
    let mut frame = Mesh::default();
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let profile = [
            (-0.014, 0.0),
            (-0.012, 0.03),
            (-0.002, height * 0.62),
            (0.004, height * 0.66),
            (0.0, height * 0.70),
            (0.002, height * 0.72),
            (0.002, low),
        ];
        let leg = swept(&profile, Outline::new(0.032, 0.032, 0.016), 20, [true, false]);
        frame.append(&leg.moved(at(sx * x, 0.0, sz * z)));
    }
    for s in [-1.0, 1.0] {
        let along = at(x - 0.03, 0.0, s * z);
        frame.append(&Mesh::block(
            at(-along.x, low - 0.10, along.z - 0.011),
            at(along.x, low - 0.0005, along.z + 0.011),
        ));
        let across = at(s * x, 0.0, z - 0.03);
        frame.append(&Mesh::block(
            at(across.x - 0.011, low - 0.10, -across.z),
            at(across.x + 0.011, low - 0.0005, across.z),
        ));
    }
    let edge = [(-0.008, low), (0.0, low + 0.009), (0.0, height - 0.010), (-0.003, height - 0.003), (-0.010, height)];
    let top = swept(&edge, Outline::new(half_x, half_z, 0.03), 40, [true, true]).with_plan_texture(1.0);
    (frame, top)
}
