// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bath tub on its feet, water with foam and a rubber duck, the tap on the floor, and a rack across the tub.

use glam::Vec3;

use super::vanity::candle;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::plumbing::bridge_tap;
use crate::scene::builtin::parts::shell::{Outline, curve, swept};

/// Height of the water.
const WATER: f32 = 0.45;
/// Height of the tub's rim.
pub const RIM: f32 = 0.60;

/// Where the tub stands.
pub fn spot(p: &Parameters) -> Spot {
    Spot::new(p.tub.turns, at(p.tub.at[0], 0.0, p.tub.at[1]))
}

/// Adds the tub and all that belongs to it.
pub fn add(model: &mut Model, p: &Parameters) {
    let spot = spot(p);
    let half = [0.5 * p.tub.size[0], 0.5 * p.tub.size[1]];
    tub(model, spot, half, p);
    foam(model, spot, half, p);
    duck(model, spot.point(at(-0.06, WATER + 0.012, 0.30)), p);
    rack(model, spot, half, p);
}

/// The tub's outline.
fn outline([x, z]: [f32; 2]) -> Outline {
    Outline::new(x, z, x - 0.02)
}

/// A tub with a rolled rim on four feet, its waste, and a tap that stands behind its far end.
fn tub(model: &mut Model, spot: Spot, half: [f32; 2], p: &Parameters) {
    let mut profile = curve(&[(-0.22, 0.125), (-0.12, 0.145), (-0.045, 0.26), (-0.012, 0.44), (0.004, 0.565)], 4);
    profile.extend(curve(
        &[(0.022, 0.578), (0.040, 0.584), (0.048, 0.594), (0.040, 0.606), (0.016, 0.609), (-0.008, 0.597)],
        3,
    ));
    profile.extend(curve(&[(-0.016, 0.575), (-0.034, 0.44), (-0.068, 0.27), (-0.135, 0.175), (-0.24, 0.155)], 4));
    let body = swept(&profile, outline(half), p.ceramic_sides * 3 / 2, [true, true]);
    model.add("tub", "ceramic", spot.put(body));
    let mut feet = Mesh::default();
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let bend = [
            at(0.0, 0.22, 0.0),
            at(sx * 0.030, 0.15, sz * 0.030),
            at(sx * 0.030, 0.09, sz * 0.030),
            at(sx * 0.042, 0.03, sz * 0.042),
        ];
        let leg = Mesh::tapered_tube(&smooth_path(&bend, 5, false), |t| 0.030 - 0.013 * t, 14, false);
        let paw = Mesh::sphere(0.030, 16, 10).stretched(at(1.0, 0.8, 1.0)).moved(at(sx * 0.052, 0.0245, sz * 0.052));
        let mut foot = leg.and(paw);
        for k in 0..4 {
            let (c, s) = cos_sin(0.125 * (k as f32 - 1.5) * 0.7 + if sx > 0.0 { 0.125 } else { 0.375 });
            let claw = Mesh::sphere(0.0125, 10, 8).moved(at(sx * 0.052 + 0.026 * c, 0.0125, sz * (0.052 + 0.026 * s)));
            foot.append(&claw);
        }
        feet.append(&foot.moved(at(sx * (half[0] - 0.15), 0.0, sz * (half[1] - 0.24))));
    }
    model.add("tub-feet", "brass", spot.put(feet));
    // Two pipes carry the tap at the outer long side.
    let (x, z) = (half[0] + 0.10, -0.18);
    let mut pipes = Mesh::default();
    for side in [-1.0, 1.0] {
        let pipe = [at(x, 0.0, z + side * 0.085), at(x, 0.66, z + side * 0.085)];
        pipes.append(&Mesh::tube(&pipe, 0.011, 14, false));
        let rose = [(0.032, 0.0005), (0.030, 0.008), (0.012, 0.012)];
        pipes.append(&Mesh::lathe(&rose, p.small_sides * 2).moved(at(x, 0.0, z + side * 0.085)));
    }
    pipes.append(&Mesh::tube(&[at(x, 0.665, z - 0.10), at(x, 0.665, z + 0.10)], 0.013, 14, false));
    pipes.append(&bridge_tap().turned_y(-0.25).moved(at(x, 0.672, z)));
    model.add("tub-tap", "chrome", spot.put(pipes));
}

/// The water's surface, and bubbles that crowd at the far end.
fn foam(model: &mut Model, spot: Spot, half: [f32; 2], p: &Parameters) {
    let water = swept(&[(-0.036, WATER - 0.01), (-0.030, WATER)], outline(half), p.ceramic_sides, [false, true]);
    model.add("water", "water", spot.put(water));
    let mut random = Random::new(p.seed.wrapping_add(71));
    let mut bubbles = Mesh::default();
    let (x, z) = (half[0] - 0.065, half[1] - 0.065);
    for _ in 0..p.bubbles {
        // An even spread over an oval, drawn together towards -z.
        let (c, s) = cos_sin(random.range(0.0, 1.0));
        let reach = random.range(0.0, 1.0).sqrt();
        let far = random.range(0.0, 1.0);
        let spread = at(c * reach * x, 0.0, s * reach * z);
        let spread = at(spread.x, 0.0, if spread.z > 0.0 && far < 0.72 { -spread.z } else { spread.z });
        let r = random.range(0.012, 0.028) * (1.2 - 0.5 * reach);
        // Foam is heaped: small bubbles lie on larger ones.
        let lift = random.range(0.0, 1.0)
            * random.range(0.0, 0.06)
            * (1.0 - reach * reach)
            * if spread.z < 0.0 { 1.6 } else { 0.4 };
        bubbles.append(&Mesh::sphere(r, 10, 6).moved(spread + at(0.0, WATER + lift + 0.2 * r, 0.0)));
    }
    model.add("foam", "foam", spot.put(bubbles));
}

/// A rubber duck that looks to -x.
fn duck(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.turned_y(0.1).moved(place);
    let sides = p.small_sides * 3 / 2;
    let s = 1.35;
    let mut body =
        Mesh::sphere(0.040 * s, sides, sides * 2 / 3).stretched(at(1.25, 0.82, 1.0)).moved(at(0.0, 0.020 * s, 0.0));
    body.append(&Mesh::sphere(0.027 * s, sides, sides * 2 / 3).moved(at(-0.028 * s, 0.066 * s, 0.0)));
    let tail = [at(0.030 * s, 0.030 * s, 0.0), at(0.050 * s, 0.042 * s, 0.0), at(0.060 * s, 0.060 * s, 0.0)];
    body.append(&Mesh::tapered_tube(&smooth_path(&tail, 5, false), |t| s * (0.020 - 0.018 * t), 16, false));
    for side in [-1.0, 1.0] {
        let wing = Mesh::sphere(0.024 * s, 18, 12).stretched(at(1.2, 0.7, 0.35)).turned_z(-0.05);
        body.append(&wing.moved(at(0.008 * s, 0.026 * s, side * 0.037 * s)));
    }
    model.add("duck", "duck", put(body));
    let upper = Mesh::sphere(0.012 * s, 16, 10).stretched(at(1.15, 0.40, 1.0)).moved(at(-0.056 * s, 0.064 * s, 0.0));
    let lower = Mesh::sphere(0.010 * s, 16, 10).stretched(at(1.0, 0.32, 0.9)).moved(at(-0.053 * s, 0.058 * s, 0.0));
    model.add("duck-beak", "beak", put(upper.and(lower)));
    let mut eyes = Mesh::default();
    for side in [-1.0, 1.0] {
        eyes.append(&Mesh::sphere(0.0044 * s, 12, 8).moved(at(-0.046 * s, 0.075 * s, side * 0.0165 * s)));
    }
    model.add("duck-eyes", "eyes", put(eyes));
}

/// A wooden rack across the tub with a candle, soap and a brush.
fn rack(model: &mut Model, spot: Spot, half: [f32; 2], p: &Parameters) {
    let (z, low) = (-0.42, RIM + 0.0095);
    let reach = half[0] + 0.07;
    let mut wood = Mesh::default();
    for side in [-1.0, 1.0] {
        let rail = Mesh::rounded_block(
            at(-reach, low, z + side * 0.085 - 0.011),
            at(reach, low + 0.022, z + side * 0.085 + 0.011),
            0.004,
        );
        wood.append(&rail);
    }
    for k in 0..11 {
        let x = -reach + 0.07 + (2.0 * reach - 0.14) * k as f32 / 10.0;
        wood.append(&Mesh::rounded_block(
            at(x - 0.014, low + 0.0225, z - 0.105),
            at(x + 0.014, low + 0.0325, z + 0.105),
            0.003,
        ));
    }
    model.add("tub-rack", "oak", spot.put(wood));
    let top = low + 0.033;
    candle(model, 2, spot.point(at(-0.24, top, z)), p);
    let bar = swept(
        &[(-0.008, 0.0), (0.0, 0.008), (0.0, 0.016), (-0.010, 0.026)],
        Outline::new(0.040, 0.026, 0.014),
        40,
        [true, true],
    );
    model.add("bath-soap", "soap-rose", spot.put(bar.turned_y(0.06).moved(at(-0.03, top, z + 0.02))));
    let back = swept(
        &[(-0.006, 0.0), (0.0, 0.006), (0.0, 0.012), (-0.008, 0.018)],
        Outline::new(0.060, 0.030, 0.025),
        40,
        [true, true],
    );
    let handle = [at(0.055, 0.010, 0.0), at(0.12, 0.014, 0.0), at(0.24, 0.020, 0.0)];
    let handle = Mesh::tapered_tube(&smooth_path(&handle, 5, false), |t| 0.010 - 0.002 * t, 12, false);
    let brush = back.moved(at(0.0, 0.014, 0.0)).and(handle.moved(at(0.0, 0.014, 0.0)));
    let mut bristles = Mesh::default();
    for i in 0..13 {
        for j in 0..6 {
            let foot = at(-0.048 + 0.008 * i as f32, 0.0, -0.020 + 0.008 * j as f32);
            bristles.append(&Mesh::tapered_tube(&[foot + Vec3::Y * 0.015, foot], |t| 0.0024 + 0.0008 * t, 5, false));
        }
    }
    let turn = |mesh: Mesh| spot.put(mesh.turned_y(-0.04).moved(at(0.16, top + 0.0005, z)));
    model.add("bath-brush", "oak", turn(brush));
    model.add("bath-brush-bristles", "candle", turn(bristles));
}
