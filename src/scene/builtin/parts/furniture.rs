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

/// A chair of bent tubes with thin legs, a padded seat and back, and arms: tubes, pads, plastic. It looks to +z.
pub fn tube_chair(seat: f32, back: f32, sides: u32) -> [Mesh; 3] {
    let (mut tubes, mut plastic) = (Mesh::default(), Mesh::default());
    let low = seat - 0.045;
    for side in [-1.0, 1.0] {
        // One tube is front leg, rail and back; another the hind leg; a third the arm.
        let long = [
            at(side * 0.262, 0.006, 0.235),
            at(side * 0.255, 0.20, 0.226),
            at(side * 0.250, low - 0.09, 0.216),
            at(side * 0.248, low - 0.020, 0.204),
            at(side * 0.247, low, 0.165),
            at(side * 0.246, low, 0.08),
            at(side * 0.245, low, -0.09),
            at(side * 0.244, low + 0.008, -0.185),
            at(side * 0.242, low + 0.055, -0.230),
            at(side * 0.240, seat + 0.09, -0.250),
            at(side * 0.236, seat + 0.24, -0.274),
            at(side * 0.228, back - 0.02, -0.317),
        ];
        tubes.append(&Mesh::tube(&smooth_path(&long, 4, false), 0.0105, sides, false));
        let hind = [at(side * 0.246, low, -0.10), at(side * 0.250, 0.22, -0.235), at(side * 0.262, 0.006, -0.325)];
        tubes.append(&Mesh::tube(&smooth_path(&hind, 5, false), 0.0105, sides, false));
        let arm = [
            at(side * 0.250, low + 0.01, 0.13),
            at(side * 0.276, seat + 0.06, 0.165),
            at(side * 0.280, seat + 0.175, 0.14),
            at(side * 0.280, seat + 0.185, -0.04),
            at(side * 0.268, seat + 0.180, -0.20),
            at(side * 0.240, seat + 0.170, -0.258),
        ];
        tubes.append(&Mesh::tube(&smooth_path(&arm, 5, false), 0.009, sides, false));
        let y = seat + 0.186;
        let rest = Mesh::rounded_block(at(-0.024, y, -0.16), at(0.024, y + 0.022, 0.13), 0.008);
        plastic.append(&rest.moved(at(side * 0.280, 0.0, 0.0)));
        for z in [0.235, -0.325] {
            let foot = [(0.0, -0.002), (0.015, -0.002), (0.016, 0.006), (0.014, 0.024), (0.0, 0.026)];
            plastic.append(&Mesh::lathe(&foot, sides).moved(at(side * 0.262, 0.0, z)));
        }
    }
    for z in [0.12, -0.14] {
        tubes.append(&Mesh::tube(&[at(-0.245, low, z), at(0.245, low, z)], 0.009, sides, false));
    }
    let edge =
        [(-0.03, low + 0.011), (-0.004, low + 0.018), (0.0, seat - 0.012), (-0.008, seat), (-0.04, seat + 0.012)];
    let mut pads = swept(&edge, Outline::new(0.225, 0.215, 0.07), 40, [true, true]);
    // The back is bowed and narrows upwards.
    let (y0, y1) = (seat + 0.10, back);
    pads.append(&super::cloth::thick_sheet(14, 10, 0.030, move |u, v| {
        let x = 2.0 * u - 1.0;
        let round = 1.0 - 0.10 * v * v - 0.06 * (1.0 - v) * (1.0 - v);
        let y = y0 + (y1 - y0) * v;
        at(0.222 * x * round, y, -0.236 - 0.055 * v - 0.030 * (1.0 - x * x))
    }));
    [tubes, pads, plastic]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::{normals_agree, open_edges};

    #[test]
    fn a_tube_chair_s_parts_are_closed_and_bend_without_folds() {
        let [tubes, pads, plastic] = tube_chair(0.455, 0.90, 8);
        for mesh in [&tubes, &pads, &plastic] {
            assert_eq!(open_edges(mesh), 0);
            normals_agree(mesh);
        }
        assert!(tubes.positions.iter().all(|p| p.y > 0.0 && p.y < 0.92));
    }
}
