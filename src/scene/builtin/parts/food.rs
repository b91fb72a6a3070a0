// SPDX-License-Identifier: MIT OR Apache-2.0
//! Things to eat.

use glam::Vec3;

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin};

/// A croissant: a bent, ridged spindle.
pub fn croissant() -> Mesh {
    let rows = 21;
    let path: Vec<Vec3> = (0..=rows)
        .map(|i| {
            let (c, s) = cos_sin(-0.06 + 0.62 * i as f32 / rows as f32);
            at(c * 0.058, 0.0, 0.012 - s * 0.046)
        })
        .collect();
    // Seven ridges, thickest in the middle.
    let radius = |t: f32| {
        let spindle = 4.0 * t * (1.0 - t);
        let f = t * 7.0 - (t * 7.0).floor();
        0.005 + 0.024 * spindle * (0.72 + 1.1 * f * (1.0 - f))
    };
    Mesh::tapered_tube(&path, radius, 10, false).stretched(at(1.0, 0.85, 1.0)).moved(at(0.0, 0.018, 0.0))
}

/// An apple of 8 cm on the origin, without its stalk.
pub fn apple(sides: u32) -> Mesh {
    let half = [
        (0.0, 0.010),
        (0.010, 0.003),
        (0.022, 0.002),
        (0.034, 0.020),
        (0.040, 0.045),
        (0.033, 0.067),
        (0.018, 0.074),
        (0.007, 0.068),
        (0.0, 0.063),
    ];
    Mesh::lathe(&super::shell::curve(&half, 2), sides)
}

/// A pear of 11 cm on the origin, with its stalk.
pub fn pear(sides: u32) -> Mesh {
    let half =
        [(0.0, 0.0), (0.022, 0.004), (0.036, 0.032), (0.026, 0.068), (0.015, 0.092), (0.008, 0.102), (0.0, 0.104)];
    Mesh::lathe(&super::shell::curve(&half, 2), sides).and(stalk(0.101))
}

/// The stalk of a fruit, from height `low` upwards.
pub fn stalk(low: f32) -> Mesh {
    Mesh::tapered_tube(
        &[at(0.0, low, 0.0), at(0.002, low + 0.01, 0.0), at(0.006, low + 0.02, 0.002)],
        |t| 0.0014 + 0.0008 * t,
        5,
        false,
    )
}

/// A banana of 18 cm that lies on the origin, bent in the horizontal plane.
pub fn banana() -> Mesh {
    let path: Vec<Vec3> = (0..=14)
        .map(|i| {
            let (c, s) = cos_sin(0.02 + 0.30 * i as f32 / 14.0);
            at(0.095 * (c - 0.5), 0.0, -0.095 * s + 0.06)
        })
        .collect();
    // Blunt at the tip, thin at the stalk.
    let radius =
        |t: f32| 0.018 * (1.0 - (2.0 * t - 0.9) * (2.0 * t - 0.9) * (2.0 * t - 0.9) * (2.0 * t - 0.9)).max(0.22);
    Mesh::tapered_tube(&path, radius, 6, false).moved(at(0.0, 0.016, 0.0))
}

/// A loaf of bread along x, 30 cm long, with cuts across its top.
pub fn loaf() -> Mesh {
    let path: Vec<Vec3> = (0..=30).map(|i| at(0.30 * (i as f32 / 30.0 - 0.5), 0.0, 0.0)).collect();
    let radius = |t: f32| {
        let end = (4.0 * t * (1.0 - t)).sqrt().max(0.12);
        let f = t * 5.0 - (t * 5.0).floor();
        let cut = if (f - 0.5).abs() < 0.12 && t > 0.12 && t < 0.88 { 0.88 } else { 1.0 };
        0.055 * end.min(1.0) * cut
    };
    Mesh::tapered_tube(&path, radius, 16, false).stretched(at(1.0, 0.78, 1.0)).moved(at(0.0, 0.042, 0.0))
}
