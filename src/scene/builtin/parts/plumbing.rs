// SPDX-License-Identifier: MIT OR Apache-2.0
//! Taps.

use glam::Vec3;

use super::at;
use crate::scene::builtin::mesh::{Mesh, smooth_path};

/// A tap with a bent neck between two valves with cross handles; the neck's foot is the origin, water falls at +z.
pub fn bridge_tap() -> Mesh {
    let foot =
        [(0.034, 0.0), (0.034, 0.006), (0.024, 0.014), (0.019, 0.05), (0.018, 0.085), (0.012, 0.098), (0.0, 0.10)];
    let neck = [
        at(0.0, 0.08, 0.0),
        at(0.0, 0.20, 0.0),
        at(0.0, 0.285, 0.015),
        at(0.0, 0.325, 0.075),
        at(0.0, 0.300, 0.145),
        at(0.0, 0.235, 0.165),
    ];
    let mut tap = Mesh::lathe(&foot, 24).and(Mesh::tube(&smooth_path(&neck, 5, false), 0.0115, 12, false));
    let mouth = [(0.0115, -0.002), (0.0145, 0.0), (0.0145, 0.022), (0.0116, 0.024)];
    tap.append(&Mesh::lathe(&mouth, 16).moved(at(0.0, 0.215, 0.165)));
    for side in [-1.0, 1.0] {
        let x = side * 0.085;
        let valve =
            [(0.024, 0.0), (0.024, 0.005), (0.015, 0.012), (0.013, 0.045), (0.017, 0.05), (0.017, 0.06), (0.0, 0.064)];
        tap.append(&Mesh::lathe(&valve, 18).moved(at(x, 0.0, 0.0)));
        for k in 0..4 {
            let lever = Mesh::tapered_tube(&[Vec3::ZERO, at(0.036, 0.004, 0.0)], |t| 0.0048 + 0.002 * t, 8, false);
            tap.append(&lever.turned_y(0.25 * k as f32 + 0.07 * side).moved(at(x, 0.055, 0.0)));
        }
    }
    tap
}

/// A slender tap with one lever, for a wash bowl: `tall`, water falls at `reach` along +z.
pub fn lever_tap(tall: f32, reach: f32) -> Mesh {
    let foot = [(0.028, 0.0), (0.028, 0.005), (0.020, 0.010), (0.018, 0.05), (0.017, tall * 0.55)];
    let neck = [
        at(0.0, tall * 0.5, 0.0),
        at(0.0, tall * 0.80, 0.0),
        at(0.0, tall * 0.97, reach * 0.18),
        at(0.0, tall, reach * 0.55),
        at(0.0, tall * 0.93, reach * 0.92),
        at(0.0, tall * 0.83, reach),
    ];
    let lever = [at(0.016, tall * 0.42, 0.0), at(0.035, tall * 0.43, 0.0), at(0.085, tall * 0.50, 0.004)];
    Mesh::lathe(&foot, 28)
        .and(Mesh::tube(&smooth_path(&neck, 8, false), 0.0135, 18, false))
        .and(Mesh::sphere(0.021, 18, 10).stretched(at(1.1, 0.8, 0.9)).moved(at(0.010, tall * 0.42, 0.0)))
        .and(Mesh::tapered_tube(&smooth_path(&lever, 4, false), |t| 0.0055 + 0.002 * t, 10, false))
}
