// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lamps.

use serde::Deserialize;

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin};
use crate::scene::builtin::model::Model;
use glam::Vec3;

/// A pendant lamp.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// Middle of the shade's lower opening.
    pub at: [f32; 3],
    /// Radius of the shade's lower opening.
    pub radius: f32,
}

/// Adds a lamp that hangs from the ceiling: a conical shade with a cord, a cap and a bulb; the light itself is in
/// `view.json`. Beside the shade's material it needs `shade-inside`, `brass`, `iron` and `bulb`.
pub fn pendant(model: &mut Model, n: usize, lamp: &Lamp, shade: &str, ceiling: f32, sides: u32) {
    let place = Vec3::from(lamp.at);
    let r = lamp.radius;
    let h = r * 0.95;
    let outside = Mesh::lathe(&[(r, 0.0), (r * 1.015, 0.010), (r * 0.28, h * 0.86), (r * 0.20, h)], sides);
    let inside =
        Mesh::lathe(&[(r * 0.18, h - 0.004), (r * 0.26, h * 0.86 - 0.004), (r * 0.99, 0.008), (r, 0.0)], sides);
    model.add(format!("lamp-{n}-shade"), shade, outside.moved(place));
    model.add(format!("lamp-{n}-inside"), "shade-inside", inside.moved(place));
    let cap = Mesh::lathe(
        &[
            (r * 0.20, h - 0.002),
            (r * 0.21, h + 0.012),
            (r * 0.14, h + 0.035),
            (r * 0.13, h + 0.06),
            (0.008, h + 0.085),
        ],
        sides.min(10),
    );
    model.add(format!("lamp-{n}-cap"), "brass", cap.moved(place));
    let cord = Mesh::tube(&[place + at(0.0, h + 0.07, 0.0), at(place.x, ceiling, place.z)], 0.006, 6, false);
    let rose = Mesh::lathe(&[(0.012, -0.03), (0.05, -0.012), (0.055, 0.0)], 10).moved(at(place.x, ceiling, place.z));
    model.add(format!("lamp-{n}-cord"), "iron", cord.and(rose));
    let (_, waist) = cos_sin(0.1);
    let b = 0.034;
    let bulb =
        [(0.0, -b), (b * waist, -b * 0.80), (b, 0.0), (b * 0.8, b * 0.75), (b * 0.42, b * 1.6), (b * 0.40, b * 2.6)];
    model.add(format!("lamp-{n}-bulb"), "bulb", Mesh::lathe(&bulb, 10).moved(place + at(0.0, 0.055, 0.0)));
}
