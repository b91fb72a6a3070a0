// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fountain: a round basin, two bowls on a turned foot, water and its jets.

use glam::Vec3;

use super::wings::masonry;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::shell::curve;

/// Radius of the basin.
pub const BASIN: f32 = 1.65;
/// Heights of the water in the basin and the two bowls, and the radii of the water there.
const WATER: [(f32, f32); 3] = [(0.43, BASIN - 0.20), (1.315, 0.76), (1.935, 0.40)];

/// A bowl: its outside from `low` upwards to a rim of `radius` at `high`, and its inside; it ends on the axis above.
fn bowl(low: f32, high: f32, radius: f32, neck: f32) -> Vec<(f32, f32)> {
    let rise = high - low;
    let mut profile = curve(
        &[
            (neck, low),
            (neck + 0.25 * radius, low + 0.16 * rise),
            (0.82 * radius, low + 0.55 * rise),
            (radius, high - 0.05),
        ],
        6,
    );
    profile.extend([(radius + 0.035, high - 0.035), (radius + 0.04, high - 0.01), (radius + 0.01, high)]);
    profile.extend([
        (radius - 0.05, high),
        (radius - 0.09, high - 0.06),
        (0.6 * radius, low + 0.42 * rise),
        (0.0, low + 0.34 * rise),
    ]);
    profile
}

/// Adds the fountain.
pub fn add(model: &mut Model, p: &Parameters) {
    let place = at(p.fountain[0], 0.0, p.fountain[1]);
    let sides = p.round_sides * 2;
    let b = BASIN;
    let mut wall = vec![(b + 0.16, -0.02), (b + 0.16, 0.06), (b + 0.10, 0.08)];
    wall.extend(curve(&[(b + 0.06, 0.10), (b + 0.02, 0.20), (b + 0.03, 0.34), (b + 0.08, 0.42)], 4));
    wall.extend([
        (b + 0.13, 0.44),
        (b + 0.14, 0.50),
        (b + 0.11, 0.53),
        (b - 0.12, 0.53),
        (b - 0.15, 0.50),
        (b - 0.18, 0.10),
        (0.0, 0.10),
    ]);
    let mut stone = Mesh::lathe(&wall, sides);
    // The foot, turned as a baluster, carries the lower bowl; a thinner one the upper.
    let mut foot = vec![(0.42, 0.08), (0.42, 0.30), (0.36, 0.34)];
    foot.extend(curve(&[(0.30, 0.40), (0.18, 0.56), (0.24, 0.72), (0.26, 0.82), (0.15, 0.96), (0.14, 1.02)], 5));
    stone.append(&Mesh::lathe(&foot, sides));
    stone.append(&Mesh::lathe(&bowl(1.02, 1.36, 0.86, 0.14), sides));
    let upper =
        curve(&[(0.16, 1.12), (0.09, 1.22), (0.08, 1.34), (0.14, 1.48), (0.13, 1.56), (0.07, 1.68), (0.08, 1.75)], 5);
    stone.append(&Mesh::lathe(&upper, sides));
    stone.append(&Mesh::lathe(&bowl(1.74, 1.97, 0.46, 0.08), sides));
    let mut knob = curve(&[(0.07, 1.80), (0.05, 1.92), (0.06, 2.00)], 4);
    knob.extend(curve(&[(0.10, 2.02), (0.125, 2.10), (0.105, 2.22), (0.05, 2.32), (0.0, 2.36)], 5));
    stone.append(&Mesh::lathe(&knob, sides));
    // Shells lie around the foot.
    for k in 0..8 {
        let shell = Mesh::sphere(0.10, 16, 10).stretched(at(1.0, 0.55, 0.75)).moved(at(0.46, 0.16, 0.0));
        stone.append(&shell.turned_y(k as f32 / 8.0));
    }
    model.add("fountain", "fountain-stone", masonry(stone, 0.6).moved(place));
    for (n, (high, radius)) in WATER.into_iter().enumerate() {
        let rings = 24;
        // Rings run outwards from the middle.
        let water = Mesh::sheet(sides, rings, |u, v| {
            let (c, s) = cos_sin(u);
            let r = 0.05 + (radius - 0.05) * v;
            let (ripple, _) = cos_sin(v * radius * 9.0);
            let (cross, _) = cos_sin(u * 7.0 + v * 2.0);
            at(c * r, high + 0.0028 * (ripple + 0.6 * cross) * (1.0 - 0.6 * v), s * r)
        });
        // `u` turns clockwise as seen from above, so that the normals look up.
        model.add(format!("water-{}", n + 1), "water", upwards(water).moved(place));
    }
    jets(model, place);
}

/// The mesh, turned over if it looks down.
fn upwards(mut mesh: Mesh) -> Mesh {
    let sum: f32 = mesh.normals.iter().map(|n| n.y).sum();
    if sum < 0.0 {
        mesh.normals.iter_mut().for_each(|n| *n = -*n);
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// Thin arcs of water from bowl to bowl, and drops.
fn jets(model: &mut Model, place: Vec3) {
    let (mut arcs, mut drops) = (Mesh::default(), Mesh::default());
    for (count, from, to, phase) in [
        (12, (0.51, 1.965), (0.70, 1.31), 0.0),
        (20, (0.91, 1.355), (1.25, 0.42), 0.02),
        (6, (0.03, 2.34), (0.26, 1.93), 0.05),
    ] {
        for k in 0..count {
            let (c, s) = cos_sin(phase + k as f32 / count as f32);
            let path: Vec<Vec3> = (0..=16)
                .map(|i| {
                    let t = i as f32 / 16.0;
                    let r = from.0 + (to.0 - from.0) * t;
                    let hop = if from.0 < 0.1 { 0.62 } else { 0.10 };
                    let y = from.1 + hop * t - (from.1 + hop - to.1) * t * t;
                    at(c * r, y, -s * r)
                })
                .collect();
            arcs.append(&Mesh::tapered_tube(&path, |t| 0.011 - 0.004 * t, 8, false));
            let end = path[path.len() - 1];
            for j in 0..3 {
                let (dc, ds) = cos_sin(j as f32 / 3.0 + 0.1 * k as f32);
                let drop = Mesh::sphere(0.008, 8, 6).moved(end + at(0.035 * dc, 0.02 + 0.012 * j as f32, 0.035 * ds));
                drops.append(&drop);
            }
        }
    }
    model.add("jets", "glass", arcs.moved(place));
    model.add("drops", "glass", drops.moved(place));
}
