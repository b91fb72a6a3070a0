// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stove with its pots, the hood, and the rail with hanging utensils.

use glam::{Vec2, Vec3};

use super::room::WORKTOP;
use super::units::{DEPTH, STOVE};
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin, ring_path, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{jar, jar_filling};
use crate::scene::builtin::parts::shell::{Outline, curve, swept, vessel};

/// Adds stove, pots, hood, utensils and spices.
pub fn add(model: &mut Model, p: &Parameters) {
    let middle = 0.5 * (STOVE[0] + STOVE[1]);
    stove(model, at(middle, 0.0, p.room.back), p);
    pots(model, at(middle, WORKTOP + 0.040, p.room.back + 0.30), p);
    hood(model, at(middle, 0.0, p.room.back), p.room.height);
    let (x0, x1) = (p.window.right + 0.16, STOVE[0] - 0.03);
    utensils(model, x0, x1, p);
    spices(model, x0, x1, p);
}

/// A free-standing stove: oven door with a window, knobs, four burners with their grates.
fn stove(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let w = 0.5 * (STOVE[1] - STOVE[0]) - 0.002;
    let front = DEPTH + 0.03;
    model.add("stove-body", "iron", put(Mesh::block(at(-w, 0.06, 0.03), at(w, WORKTOP - 0.012, front - 0.004))));
    let plinth = Mesh::block(at(-w, 0.0, 0.06), at(w, 0.0595, front - 0.05));
    model.add("stove-plinth", "plinth", put(plinth));
    let hob = Mesh::rounded_block(at(-w, WORKTOP - 0.0115, 0.005), at(w, WORKTOP + 0.012, front + 0.02), 0.005);
    let panel = Mesh::rounded_block(at(-w, 0.775, front - 0.0035), at(w, WORKTOP - 0.0125, front + 0.024), 0.006);
    let drawer = Mesh::rounded_block(at(-w + 0.002, 0.065, front - 0.0035), at(w - 0.002, 0.215, front + 0.022), 0.006);
    model.add("stove-steel", "steel", put(hob.and(panel).and(drawer)));
    let door = swept(
        &[(-0.003, 0.0), (0.0, 0.003), (0.0, 0.022), (-0.004, 0.026)],
        Outline::new(w - 0.002, 0.271, 0.012),
        20,
        [true, true],
    );
    model.add("oven-door", "steel", put(door.turned_x(0.25).moved(at(0.0, 0.495, front - 0.0035))));
    let glass = swept(&[(0.0, 0.0), (-0.002, 0.002)], Outline::new(w - 0.075, 0.155, 0.02), 40, [false, true]);
    model.add("oven-window", "black-glass", put(glass.turned_x(0.25).moved(at(0.0, 0.465, front + 0.0232))));
    let z = front + 0.022;
    let bar = [
        at(-w + 0.05, 0.715, z),
        at(-w + 0.05, 0.718, z + 0.04),
        at(w - 0.05, 0.718, z + 0.04),
        at(w - 0.05, 0.715, z),
    ];
    let mut handle = Mesh::tube(&[bar[1] - at(0.02, 0.0, 0.0), bar[2] + at(0.02, 0.0, 0.0)], 0.010, 14, false);
    handle.append(&Mesh::tube(&bar[..2], 0.007, 10, false).and(Mesh::tube(&bar[2..], 0.007, 10, false)));
    handle.append(&Mesh::tube(&[at(-0.11, 0.165, z + 0.03), at(0.11, 0.165, z + 0.03)], 0.007, 12, false));
    for x in [-0.09, 0.09] {
        handle.append(&Mesh::tube(&[at(x, 0.165, z), at(x, 0.165, z + 0.03)], 0.005, 8, false));
    }
    model.add("oven-handle", "chrome", put(handle));
    let mut knobs = Mesh::default();
    for k in 0..5 {
        let x = -0.22 + 0.11 * k as f32;
        let turned = [(0.024, 0.0), (0.023, 0.012), (0.019, 0.016), (0.017, 0.030), (0.014, 0.033), (0.0, 0.034)];
        let grip = Mesh::rounded_block(at(-0.004, 0.010, -0.021), at(0.004, 0.037, 0.021), 0.002);
        let turn = [0.0, 0.11, 0.0, -0.08, 0.0][k];
        let knob = Mesh::lathe(&turned, 14).and(grip).turned_y(turn);
        knobs.append(&knob.turned_x(0.25).moved(at(x, 0.83, z + 0.0015)));
    }
    model.add("stove-knobs", "black-plastic", put(knobs));
    let top = WORKTOP + 0.012;
    let mut burners = Mesh::default();
    let mut grates = Mesh::default();
    for (x, z) in BURNERS {
        let centre = at(x, top, 0.30 + z);
        let ring = [(0.060, 0.0), (0.058, 0.004), (0.042, 0.006), (0.040, 0.012), (0.034, 0.016), (0.0, 0.017)];
        burners.append(&Mesh::lathe(&ring, p.small_sides).moved(centre));
        grates.append(&Mesh::tube(&ring_path(0.085, 0.085, 0.022, 20), 0.0045, 5, true).moved(centre));
        for k in 0..4 {
            let (c, s) = cos_sin(0.125 + 0.25 * k as f32);
            let arm = [at(c * 0.028, 0.022, s * 0.028), at(c * 0.11, 0.022, s * 0.11), at(c * 0.118, 0.0, s * 0.118)];
            grates.append(&Mesh::tube(&arm, 0.0045, 6, false).moved(centre));
        }
    }
    model.add("burners", "black-plastic", put(burners));
    model.add("grates", "iron", put(grates));
}

/// x and z of the burners, from the hob's middle.
const BURNERS: [(f32, f32); 4] = [(-0.145, 0.13), (0.145, 0.13), (-0.145, -0.13), (0.145, -0.13)];

/// A copper pan, a steel pot with its lid, a red kettle and a small copper pot, on the burners.
fn pots(model: &mut Model, place: Vec3, p: &Parameters) {
    let on = |k: usize, mesh: Mesh| mesh.moved(place + at(BURNERS[k].0, 0.0, BURNERS[k].1));
    let sides = p.round_sides;
    // Front left: a copper saucepan with a brass handle, and soup in it.
    let outside = [(0.0, 0.0), (0.088, 0.0), (0.094, 0.006), (0.096, 0.085), (0.100, 0.089)];
    model.add("saucepan", "copper", on(0, Mesh::lathe(&vessel(&outside, 0.003, 0.004), sides)));
    model.add("saucepan-soup", "turmeric", on(0, Mesh::lathe(&[(0.0925, 0.054), (0.0, 0.055)], sides)));
    let grip = [at(-0.08, 0.068, 0.055), at(-0.14, 0.085, 0.10), at(-0.24, 0.100, 0.17)];
    let grip = Mesh::tapered_tube(&smooth_path(&grip, 5, false), |t| 0.006 + 0.004 * t, 10, false);
    model.add("saucepan-handle", "brass", on(0, grip));
    // Front right: a large steel pot, its lid a little aside.
    let outside = [(0.0, 0.0), (0.104, 0.0), (0.112, 0.008), (0.112, 0.150), (0.117, 0.153)];
    model.add("pot", "chrome", on(1, Mesh::lathe(&vessel(&outside, 0.003, 0.004), sides)));
    let lid = curve(&[(0.116, 0.0), (0.114, 0.006), (0.075, 0.022), (0.0, 0.030)], 3);
    let knob = [(0.006, 0.028), (0.006, 0.040), (0.020, 0.046), (0.020, 0.056), (0.0, 0.060)];
    let lid = Mesh::lathe(&lid, sides).and(Mesh::lathe(&knob, 20));
    model.add("pot-lid", "chrome", on(1, lid.turned_z(0.012).moved(at(0.004, 0.1575, -0.006))));
    let mut ears = Mesh::default();
    for side in [-1.0, 1.0] {
        let ear = [
            at(side * 0.110, 0.105, -0.045),
            at(side * 0.150, 0.110, -0.032),
            at(side * 0.150, 0.110, 0.032),
            at(side * 0.110, 0.105, 0.045),
        ];
        ears.append(&Mesh::tube(&smooth_path(&ear, 4, false), 0.0065, 8, false));
    }
    model.add("pot-ears", "black-plastic", on(1, ears));
    // Back left: a red kettle.
    let body =
        curve(&[(0.085, 0.0), (0.105, 0.012), (0.112, 0.045), (0.090, 0.100), (0.050, 0.128), (0.040, 0.131)], 3);
    let spout = [at(0.085, 0.055, 0.0), at(0.130, 0.085, 0.0), at(0.155, 0.125, 0.0)];
    let spout = Mesh::tapered_tube(&smooth_path(&spout, 5, false), |t| 0.022 - 0.010 * t, 14, false);
    let body = Mesh::lathe(&body, sides).and(spout);
    model.add("kettle", "red-enamel", on(2, body.turned_y(0.1)));
    let lid = [(0.042, 0.130), (0.040, 0.137), (0.010, 0.142), (0.008, 0.150), (0.014, 0.158), (0.0, 0.164)];
    let hoop = [
        at(-0.080, 0.105, 0.0),
        at(-0.085, 0.19, 0.0),
        at(0.0, 0.235, 0.0),
        at(0.085, 0.19, 0.0),
        at(0.080, 0.105, 0.0),
    ];
    let hoop = Mesh::tube(&smooth_path(&hoop, 6, false), 0.0065, 10, false);
    model.add("kettle-handle", "black-plastic", on(2, Mesh::lathe(&lid, 20).and(hoop.turned_y(0.1))));
    // Back right: a small copper pot.
    let outside = [(0.0, 0.0), (0.070, 0.0), (0.076, 0.006), (0.076, 0.100), (0.080, 0.103)];
    let mut pot = Mesh::lathe(&vessel(&outside, 0.003, 0.004), sides);
    pot.append(&Mesh::lathe(&[(0.079, 0.106), (0.078, 0.110), (0.0, 0.122)], sides));
    model.add("copper-pot", "copper", on(3, pot));
    let knob = [(0.005, 0.120), (0.005, 0.132), (0.014, 0.138), (0.0, 0.148)];
    model.add("copper-pot-knob", "brass", on(3, Mesh::lathe(&knob, 16)));
}

/// A steel hood with its chimney; there is a light under it.
fn hood(model: &mut Model, place: Vec3, ceiling: f32) {
    let (low, lip, high) = (1.58, 1.63, 1.90);
    let (w, d) = (0.31, 0.50);
    let (cw, cd) = (0.14, 0.26);
    let ring =
        |half: f32, deep: f32, y: f32| [at(-half, y, deep), at(half, y, deep), at(half, y, 0.002), at(-half, y, 0.002)];
    let mut steel = Mesh::default();
    let mut band = |a: [Vec3; 4], b: [Vec3; 4]| {
        for k in 0..4 {
            let n = (k + 1) % 4;
            steel.append(&Mesh::quad([a[k], a[n], b[n], b[k]], Vec2::ONE));
        }
    };
    band(ring(w, d, low), ring(w, d, lip));
    band(ring(w, d, lip), ring(cw, cd, high));
    band(ring(cw, cd, high), ring(cw, cd, ceiling - 0.001));
    model.add("hood", "steel", steel.moved(place));
    let [a, b, c, e] = ring(w, d, low);
    let under = Mesh::quad([e, c, b, a], Vec2::ONE);
    model.add("hood-filter", "iron", under.moved(place));
    let (y, z, x) = (low + 0.025, d + 0.03, w - 0.02);
    let rail = Mesh::tube(&[at(-x, y, z), at(x, y, z)], 0.006, 10, false)
        .and(Mesh::tube(&[at(-x + 0.01, y, d - 0.001), at(-x + 0.01, y, z)], 0.004, 8, false))
        .and(Mesh::tube(&[at(x - 0.01, y, d - 0.001), at(x - 0.01, y, z)], 0.004, 8, false));
    model.add("hood-rail", "brass", rail.moved(place));
    let lamp = Mesh::lathe(&[(0.0, -0.009), (0.030, -0.009), (0.034, -0.001)], 20);
    let lamps = lamp.clone().moved(at(-0.15, low, 0.25)).and(lamp.moved(at(0.15, low, 0.25)));
    model.add("hood-lamps", "bulb", lamps.moved(place));
}

/// A rail on the tiles with a ladle, a whisk, a turner, a sieve and a spoon.
fn utensils(model: &mut Model, x0: f32, x1: f32, p: &Parameters) {
    let (y, z) = (1.40, p.room.back + 0.045);
    let mut rail = Mesh::tube(&[at(x0, y, z), at(x1, y, z)], 0.006, 12, false);
    for x in [x0 + 0.02, x1 - 0.02] {
        rail.append(&Mesh::tube(&[at(x, y, p.room.back), at(x, y, z)], 0.005, 8, false));
        rail.append(&Mesh::lathe(&[(0.016, 0.0), (0.014, 0.005), (0.0, 0.006)], 14).turned_x(0.25).moved(at(
            x,
            y,
            p.room.back,
        )));
    }
    model.add("utensil-rail", "chrome", rail);
    let step = (x1 - x0) / 5.0;
    for (k, name) in ["ladle", "whisk", "turner", "sieve", "spoon"].into_iter().enumerate() {
        let place = at(x0 + step * (k as f32 + 0.5), y - 0.012, z);
        let hook = [
            at(0.0, 0.006, -0.007),
            at(0.0, 0.019, 0.0),
            at(0.0, 0.006, 0.009),
            at(0.0, -0.012, 0.002),
            at(0.0, -0.020, 0.008),
        ];
        let mut tool = Mesh::tube(&smooth_path(&hook, 3, false), 0.0018, 6, false);
        let stem = |low: f32, r: f32| Mesh::tube(&[at(0.0, -0.012, 0.006), at(0.0, -low, 0.006)], r, 8, false);
        match name {
            "ladle" => {
                tool.append(&stem(0.24, 0.0035));
                let cup = curve(&[(0.0, 0.0), (0.022, 0.004), (0.036, 0.020), (0.040, 0.038)], 3);
                tool.append(&Mesh::lathe(&vessel(&cup, 0.0022, 0.0025), 24).moved(at(0.0, -0.275, 0.042)));
            }
            "whisk" => {
                tool.append(&stem(0.12, 0.0055));
                for j in 0..5 {
                    let loop_ = [
                        at(0.004, -0.115, 0.0),
                        at(0.018, -0.17, 0.0),
                        at(0.028, -0.235, 0.0),
                        at(0.0, -0.285, 0.0),
                        at(-0.028, -0.235, 0.0),
                        at(-0.018, -0.17, 0.0),
                        at(-0.004, -0.115, 0.0),
                    ];
                    let wire = Mesh::tube(&smooth_path(&loop_, 4, false), 0.0013, 4, false);
                    tool.append(&wire.turned_y(0.1 * j as f32).moved(at(0.0, 0.0, 0.006)));
                }
            }
            "turner" => {
                tool.append(&stem(0.20, 0.0035));
                for j in 0..5 {
                    let x = -0.032 + 0.014 * j as f32;
                    tool.append(&Mesh::block(at(x, -0.285, 0.004), at(x + 0.009, -0.205, 0.0065)));
                }
                tool.append(&Mesh::block(at(-0.032, -0.205, 0.004), at(0.033, -0.195, 0.0065)));
                tool.append(&Mesh::block(at(-0.032, -0.297, 0.004), at(0.033, -0.285, 0.0065)));
            }
            "sieve" => {
                tool.append(&stem(0.14, 0.0035));
                let rim = ring_path(0.048, 0.048, 0.0, 24);
                let mut net = Mesh::tube(&rim, 0.0028, 6, true);
                let cup = curve(&[(0.0, -0.040), (0.026, -0.033), (0.042, -0.016), (0.047, 0.0)], 3);
                net.append(&Mesh::lathe(&vessel(&cup, 0.0012, 0.0014), 24));
                tool.append(&net.turned_x(0.25).moved(at(0.0, -0.188, 0.012)));
            }
            _ => {
                tool.append(&stem(0.24, 0.0035));
                tool.append(&Mesh::sphere(1.0, 16, 8).stretched(at(0.026, 0.036, 0.007)).moved(at(0.0, -0.272, 0.008)));
            }
        }
        model.add(name, if k % 2 == 0 { "steel" } else { "chrome" }, tool.moved(place));
    }
}

/// A narrow shelf with small jars, above the rail.
fn spices(model: &mut Model, x0: f32, x1: f32, p: &Parameters) {
    let y = 1.655;
    let back = p.room.back;
    let board = Mesh::rounded_block(at(x0 - 0.01, y - 0.02, back + 0.0005), at(x1, y, back + 0.10), 0.004);
    model.add("spice-shelf", "oak", board);
    let fillings = ["paprika", "turmeric", "dried-herbs", "lentils", "coffee-beans", "rice"];
    let step = (x1 - x0) / p.spices as f32;
    let r = (0.40 * step).min(0.032);
    let tall = r * 3.1;
    for k in 0..p.spices {
        let place = at(x0 + step * (k as f32 + 0.5), y + 0.0005, back + 0.052);
        let (body, lid) = jar(r, tall, p.small_sides);
        let n = k + 1;
        model.add(format!("spice-{n}"), "glass", body.moved(place));
        model.add(format!("spice-{n}-lid"), "cork", lid.moved(place));
        let level = [0.66, 0.74, 0.52, 0.70][k as usize % 4];
        model.add(
            format!("spice-{n}-filling"),
            fillings[k as usize % 6],
            jar_filling(r, tall, level, p.small_sides).moved(place),
        );
    }
}
