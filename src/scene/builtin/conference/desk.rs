// SPDX-License-Identifier: MIT OR Apache-2.0
//! The long table and what lies on it.

use glam::{Vec2, Vec3};

use super::seats::along;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{cup, tumbler};
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::shell::{Outline, curve, swept, vessel};

/// Height of the table's top.
const TOP: f32 = 0.742;

/// Adds the table, and lays it.
pub fn add(model: &mut Model, p: &Parameters) {
    table(model, p);
    let mut random = Random::new(p.seed.wrapping_add(5));
    let mut n = 0;
    for side in [-1.0, 1.0] {
        for k in 0..p.seats {
            n += 1;
            let x = p.table.at[0] + side * (0.5 * p.table.size[0] - 0.20);
            let turns = 0.25 * side + random.range(-0.02, 0.02);
            let spot = Spot::new(turns, at(x, TOP, along(p, k) + random.range(-0.02, 0.02)));
            place(model, p, n, &spot, &mut random);
        }
    }
    middle(model, p);
}

fn table(model: &mut Model, p: &Parameters) {
    let [x, z] = p.table.at;
    let (half_x, half_z) = (0.5 * p.table.size[0], 0.5 * p.table.size[1]);
    let edge = [(-0.05, TOP - 0.042), (-0.010, TOP - 0.022), (0.0, TOP - 0.016), (0.0, TOP - 0.006), (-0.006, TOP)];
    let top = swept(&edge, Outline::new(half_x, half_z, 0.32), 120, [true, true]);
    model.add("table-top", "walnut", top.with_plan_texture(0.8).moved(at(x, 0.0, z)));
    let mut legs = Mesh::default();
    for k in 0..3 {
        let dz = (half_z - 0.55) * (k as f32 - 1.0);
        for side in [-1.0, 1.0] {
            for lean in [-0.12, 0.12] {
                let foot = at(x + side * (half_x - 0.34), 0.0, z + dz + lean);
                let head = at(x + side * (half_x - 0.48), TOP - 0.05, z + dz + 0.3 * lean);
                legs.append(&Mesh::tapered_tube(&[foot, head], |t| 0.014 + 0.010 * t, 16, false));
            }
        }
        let y = TOP - 0.072;
        legs.append(&Mesh::rounded_block(
            at(x - half_x + 0.30, y, z + dz - 0.05),
            at(x + half_x - 0.30, TOP - 0.0425, z + dz + 0.05),
            0.006,
        ));
    }
    model.add("table-legs", "steel", legs);
    // Lids over sockets.
    let (mut frames, mut lids) = (Mesh::default(), Mesh::default());
    for k in 0..3 {
        let place = at(x, TOP, z + (half_z - 0.9) * (k as f32 - 1.0) + 0.35);
        let lid = |half: f32, y: f32, long: f32| {
            swept(&[(0.0, -0.004), (0.0, y - 0.001), (-0.002, y)], Outline::new(half, long, 0.012), 40, [false, true])
        };
        frames.append(&lid(0.075, 0.0025, 0.16).moved(place));
        lids.append(&lid(0.062, 0.0045, 0.147).moved(place));
    }
    model.add("socket-frames", "aluminium", frames);
    model.add("socket-lids", "black-plastic", lids);
}

/// What lies before a seat: paper with a pen, a glass on a mat, a name, a microphone; at some a laptop or a cup.
fn place(model: &mut Model, p: &Parameters, n: u32, spot: &Spot, random: &mut Random) {
    let above = at(0.0, 0.0005, 0.0);
    let laptop = n % 4 == 2;
    if laptop {
        notebook(model, n, spot);
    } else {
        let turn = random.range(-0.03, 0.03);
        let mut pad = Mesh::default();
        for k in 0..4 {
            let y = 0.0015 * k as f32;
            let sheet = Mesh::block(at(-0.105, y, -0.148), at(0.105, y + 0.0013, 0.148));
            pad.append(&sheet.turned_y(turn + random.range(-0.004, 0.004)));
        }
        model.add(format!("pad-{n}"), "paper", spot.put(pad.moved(above)));
        let pen = [at(-0.07, 0.0, 0.0), at(-0.055, 0.0, 0.0), at(0.0, 0.0, 0.0), at(0.07, 0.0, 0.0)];
        let pen = Mesh::tapered_tube(&pen, |t| 0.001 + 0.0036 * (6.0 * t).min(1.0), 10, false);
        let clip = Mesh::rounded_block(at(0.03, 0.004, -0.0015), at(0.072, 0.0062, 0.0015), 0.0005);
        let pen = pen.and(clip).turned_y(0.17 + random.range(-0.06, 0.06)).moved(at(0.03, 0.0115, 0.02));
        model.add(format!("pen-{n}"), if n.is_multiple_of(3) { "red-plastic" } else { "blue-plastic" }, spot.put(pen));
    }
    let glass = at(0.20, 0.0005, -0.16);
    let mat = Mesh::lathe(&[(0.046, 0.0), (0.047, 0.002), (0.044, 0.0035), (0.0, 0.0035)], p.round_sides);
    model.add(format!("mat-{n}"), "black-plastic", spot.put(mat.moved(glass)));
    let (low, high, tall, t) = (0.027, 0.034, 0.115, 0.0025);
    let stand = glass + at(0.0, 0.004, 0.0);
    model.add(format!("glass-{n}"), "glass", spot.put(tumbler(low, high, tall, t, p.small_sides).moved(stand)));
    // A folded card with a name.
    let (w, h, d) = (0.10, 0.075, 0.032);
    let face = |sign: f32| {
        let z = sign * d;
        [at(-w * sign, 0.0, z), at(w * sign, 0.0, z), at(w * sign, h, 0.0), at(-w * sign, h, 0.0)]
    };
    let card = Mesh::quad(face(1.0), Vec2::ONE).and(Mesh::quad(face(-1.0), Vec2::ONE)).moved(at(0.0, 0.001, -0.27));
    model.add(format!("card-{n}"), "name-card", spot.put(card));
    microphone(model, p, n, spot, random);
    if n % 3 == 1 {
        let saucer = Mesh::lathe(
            &[(0.0, 0.0), (0.035, 0.0), (0.072, 0.010), (0.071, 0.013), (0.034, 0.004), (0.0, 0.0035)],
            p.round_sides,
        );
        let at_left = at(-0.21, 0.0005, -0.10);
        model.add(format!("saucer-{n}"), "porcelain", spot.put(saucer.moved(at_left)));
        let drink = Mesh::lathe(&[(0.030, 0.045), (0.0, 0.045)], p.small_sides);
        let turned = cup(p.small_sides).turned_y(random.range(0.0, 1.0)).moved(at_left + at(0.0, 0.0045, 0.0));
        model.add(format!("cup-{n}"), "porcelain", spot.put(turned));
        model.add(format!("coffee-{n}"), "coffee", spot.put(drink.moved(at_left + at(0.0, 0.0045, 0.0))));
    }
}

/// A microphone on a thin bent neck.
fn microphone(model: &mut Model, p: &Parameters, n: u32, spot: &Spot, random: &mut Random) {
    let place = at(-0.13, 0.0005, -0.33);
    let foot = [(0.0, 0.0), (0.046, 0.0), (0.048, 0.006), (0.040, 0.018), (0.012, 0.022), (0.0, 0.022)];
    let mut mesh = Mesh::lathe(&foot, p.small_sides);
    let lean = random.range(0.05, 0.09);
    let neck = [
        at(0.0, 0.020, 0.0),
        at(0.0, 0.15, -0.012),
        at(0.0, 0.28, 0.01),
        at(0.005, 0.37, lean),
        at(0.01, 0.40, lean + 0.05),
    ];
    let path = smooth_path(&neck, 7, false);
    mesh.append(&Mesh::tube(&path, 0.0030, 8, false));
    let end = path[path.len() - 1];
    let along = (end - path[path.len() - 2]).normalize();
    let head = [end, end + along * 0.006, end + along * 0.04, end + along * 0.05];
    mesh.append(&Mesh::tapered_tube(&head, |t| if t > 0.1 && t < 0.9 { 0.0085 } else { 0.006 }, p.small_sides, false));
    model.add(format!("microphone-{n}"), "black-plastic", spot.put(mesh.moved(place)));
    let ring = Mesh::tube(&[end + along * 0.006, end + along * 0.010], 0.0092, p.small_sides, false);
    model.add(format!("microphone-{n}-ring"), "red-plastic", spot.put(ring.moved(place)));
}

/// A laptop, open.
fn notebook(model: &mut Model, n: u32, spot: &Spot) {
    let base = Mesh::rounded_block(at(-0.160, 0.003, -0.11), at(0.160, 0.017, 0.115), 0.004);
    let turn = |mesh: Mesh| spot.put(mesh.turned_x(-0.055).moved(at(0.0, 0.020, -0.112)));
    let lid = Mesh::rounded_block(at(-0.160, 0.0, -0.007), at(0.160, 0.215, 0.0), 0.003);
    model.add(format!("laptop-{n}"), "aluminium", spot.put(base));
    model.add(format!("laptop-{n}-lid"), "aluminium", turn(lid));
    let face = |x: f32, y0: f32, y1: f32, z: f32| [at(-x, y0, z), at(x, y0, z), at(x, y1, z), at(-x, y1, z)];
    model.add(
        format!("laptop-{n}-screen"),
        "laptop-screen",
        turn(Mesh::quad(face(0.150, 0.012, 0.204, 0.0007), Vec2::ONE)),
    );
    let mut keys = Mesh::default();
    for row in 0..5 {
        for column in 0..13 {
            let (x, z) = (-0.143 + 0.0222 * column as f32, -0.095 + 0.022 * row as f32);
            keys.append(&Mesh::rounded_block(at(x, 0.0165, z), at(x + 0.019, 0.0188, z + 0.019), 0.0008));
        }
    }
    model.add(format!("laptop-{n}-keys"), "black-plastic", spot.put(keys));
}

/// Carafes with water, a telephone and papers along the middle of the table.
fn middle(model: &mut Model, p: &Parameters) {
    let [x, z] = p.table.at;
    let half = 0.5 * p.table.size[1];
    let outside = {
        let mut list = vec![(0.0, 0.0), (0.058, 0.0)];
        list.extend(curve(
            &[(0.062, 0.006), (0.064, 0.06), (0.058, 0.13), (0.036, 0.19), (0.032, 0.23), (0.042, 0.265)],
            3,
        ));
        list
    };
    for k in 0..3 {
        let place = at(x + 0.06, TOP + 0.0005, z + (half - 0.75) * (k as f32 - 1.0) - 0.12);
        let n = k + 1;
        model.add(
            format!("carafe-{n}"),
            "glass",
            Mesh::lathe(&vessel(&outside, 0.003, 0.007), p.round_sides).moved(place),
        );
        let water: Vec<(f32, f32)> =
            [(0.0, 0.0078), (0.0555, 0.0078), (0.0595, 0.02), (0.0603, 0.06), (0.0545, 0.125), (0.0, 0.125)].into();
        model.add(format!("carafe-{n}-water"), "water", Mesh::lathe(&water, p.round_sides).moved(place));
    }
    // The telephone stands on three legs.
    let place = at(x, TOP + 0.0005, z + 0.02);
    let dome = [(0.0, 0.004), (0.085, 0.004), (0.092, 0.016), (0.080, 0.040), (0.055, 0.052), (0.0, 0.056)];
    let mut phone = Mesh::lathe(&dome, p.round_sides);
    let mut keys = Mesh::default();
    for k in 0..3 {
        let arm = [(-0.004, 0.0), (0.0, 0.008), (-0.002, 0.020), (-0.012, 0.026)];
        let arm = swept(&arm, Outline::new(0.034, 0.085, 0.030), 40, [true, true]).moved(at(0.0, 0.0, 0.105));
        phone.append(&arm.turned_y(k as f32 / 3.0));
    }
    for k in 0..12 {
        let (column, row) = ((k % 3) as f32 - 1.0, (k / 3) as f32 - 1.5);
        let y = 0.055;
        let key = Mesh::rounded_block(at(-0.007, 0.0, -0.005), at(0.007, 0.004, 0.005), 0.001);
        keys.append(&key.moved(at(0.018 * column, y, 0.014 * row)));
    }
    model.add("telephone", "black-plastic", phone.moved(place));
    model.add("telephone-keys", "aluminium", keys.moved(place));
    let mut random = Random::new(p.seed.wrapping_add(19));
    let mut sheets = Mesh::default();
    for k in 0..9 {
        let y = TOP + 0.0006 + 0.0008 * k as f32;
        let spread = at(x - 0.12 + random.range(-0.05, 0.05), y, z + half * 0.45 + random.range(-0.06, 0.06));
        let sheet = Mesh::block(Vec3::ZERO - at(0.105, 0.0, 0.148), at(0.105, 0.0006, 0.148));
        sheets.append(&sheet.turned_y(random.range(-0.08, 0.08)).moved(spread));
    }
    model.add("handouts", "chart-paper", sheets.with_texture_scale(Vec2::new(4.6, 3.3)));
}
