// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hurdles, the arch over the line, the podium with its cup, a bench with bottles, cones and a ball.

use glam::{Vec2, Vec3};

use super::ground::{LINE, half_track};
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin, ring_path, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::shell::{curve, vessel};

/// Adds all that stands beside and on the track.
pub fn add(model: &mut Model, p: &Parameters) {
    hurdles(model, p);
    arch(model, p);
    ribbon(model);
    podium(model, p);
    bench(model, p);
    small_things(model, p);
}

/// Hurdles: two bent rods carry a striped board.
fn hurdles(model: &mut Model, p: &Parameters) {
    for (n, &[x, z]) in p.hurdles.iter().enumerate() {
        let place = at(x, 0.0, z);
        let half = 0.44 * p.lane;
        let mut rods = Mesh::default();
        for side in [-1.0, 1.0] {
            let path = [
                at(side * half, 0.02, 0.62),
                at(side * half, 0.02, 0.12),
                at(side * half, 0.07, 0.015),
                at(side * half, 0.30, 0.0),
                at(side * half, 0.90, 0.0),
            ];
            rods.append(&Mesh::tube(&smooth_path(&path, 6, false), 0.017, p.rod_sides, false));
        }
        rods.append(&Mesh::tube(&[at(-half, 0.30, 0.0), at(half, 0.30, 0.0)], 0.012, p.rod_sides, false));
        rods.append(&Mesh::tube(&[at(-half, 0.021, 0.60), at(half, 0.021, 0.60)], 0.012, p.rod_sides, false));
        model.add(format!("hurdle-{}-rods", n + 1), "chrome", rods.moved(place));
        let (w, y0, y1) = (half + 0.04, 0.83, 0.91);
        let board = Mesh::rounded_block(at(-w, y0, -0.016), at(w, y1, 0.018), 0.005);
        model.add(format!("hurdle-{}-back", n + 1), "white-paint", board.moved(place));
        let face = |z: f32| {
            [
                at(-w + 0.006, y0 + 0.006, z),
                at(w - 0.006, y0 + 0.006, z),
                at(w - 0.006, y1 - 0.006, z),
                at(-w + 0.006, y1 - 0.006, z),
            ]
        };
        let front = Mesh::quad(face(0.0195), Vec2::ONE);
        model.add(format!("hurdle-{}-board", n + 1), "stripes", front.moved(place));
    }
}

/// The arch over the line with its banner and the clock on it.
fn arch(model: &mut Model, p: &Parameters) {
    let (x, z) = (half_track(p) + 0.36, LINE - 3.4);
    let mut posts = Mesh::default();
    for side in [-1.0, 1.0] {
        for d in [-0.14, 0.14] {
            posts.append(&Mesh::tube(
                &[at(side * x, -0.03, z + d), at(side * x, 3.16, z + d)],
                0.035,
                p.rod_sides,
                false,
            ));
        }
        for k in 0..8 {
            let y = 0.15 + 0.38 * k as f32;
            let (a, b) = if k % 2 == 0 { (-0.14, 0.14) } else { (0.14, -0.14) };
            posts.append(&Mesh::tube(
                &[at(side * x, y, z + a), at(side * x, y + 0.38, z + b)],
                0.014,
                p.rod_sides,
                false,
            ));
        }
        posts.append(&Mesh::rounded_block(
            at(side * x - 0.22, -0.05, z - 0.3),
            at(side * x + 0.22, 0.05, z + 0.3),
            0.01,
        ));
    }
    model.add("arch-posts", "chrome", posts);
    let beam = Mesh::rounded_block(at(-x - 0.06, 2.56, z - 0.13), at(x + 0.06, 3.20, z + 0.13), 0.02);
    model.add("arch-beam", "blue-paint", beam);
    let face = |x: f32, y0: f32, y1: f32, z: f32| [at(-x, y0, z), at(x, y0, z), at(x, y1, z), at(-x, y1, z)];
    model.add("banner", "banner", Mesh::quad(face(x, 2.59, 3.17, z + 0.132), Vec2::ONE));
    let case = Mesh::rounded_block(at(-0.62, 3.19, z - 0.10), at(0.62, 3.64, z + 0.12), 0.02);
    model.add("clock-case", "black-plastic", case);
    model.add("clock", "clock-face", Mesh::quad(face(0.58, 3.232, 3.61, z + 0.122), Vec2::ONE));
}

/// The ribbon that the winner has torn: it flies to both sides from the breast.
fn ribbon(model: &mut Model) {
    let mut mesh = Mesh::default();
    for side in [-1.0, 1.0] {
        let band = |u: f32, v: f32| {
            let (c, _) = cos_sin(u * 1.3);
            let z = LINE - 0.17 - 0.55 * u - 0.05 * c * u;
            at(side * (0.02 + 0.95 * u), 1.07 + 0.16 * u * c - 0.04 * u + 0.05 * v, z)
        };
        mesh.append(&Mesh::sheet(40, 1, band));
        mesh.append(&Mesh::sheet(40, 1, |u, v| band(u, 1.0 - v) - Vec3::Z * 0.001));
    }
    model.add("ribbon", "ribbon", mesh);
}

/// Three steps with numbers, and the cup on the highest.
fn podium(model: &mut Model, p: &Parameters) {
    let spot = Spot::new(0.05, at(-4.3, -0.03, -6.0));
    let mut steps = Mesh::default();
    let mut fronts = Mesh::default();
    for (k, (x, tall)) in [(-0.7, 0.42), (0.0, 0.66), (0.7, 0.28)].iter().enumerate() {
        let (x0, x1) = (x - 0.348, x + 0.348);
        steps.append(&Mesh::rounded_block(at(x0, 0.0, -0.35), at(x1, *tall, 0.35), 0.012));
        let z = 0.3515;
        let (a, b, y0, y1) = (x0 + 0.02, x1 - 0.02, 0.02, tall - 0.02);
        let mut front = Mesh::quad([at(a, y0, z), at(b, y0, z), at(b, y1, z), at(a, y1, z)], Vec2::ONE);
        // The digit keeps its shape: only as much of the picture as the step is high.
        let part = ((y1 - y0) / (b - a)).min(1.0);
        for t in &mut front.texcoords {
            *t = Vec2::new((k as f32 + t.x) / 3.0, 1.0 - part * (1.0 - t.y));
        }
        fronts.append(&front);
    }
    model.add("podium", "white-paint", spot.put(steps));
    model.add("podium-fronts", "podium", spot.put(fronts));
    let cup = cup(p.round_sides);
    model.add("cup", "gold", spot.put(cup.moved(at(0.0, 0.661, 0.0))));
}

/// A cup with two handles on a foot, half a metre high.
fn cup(sides: u32) -> Mesh {
    let mut outside = vec![(0.0, 0.0), (0.12, 0.0), (0.12, 0.03)];
    outside.extend(curve(
        &[
            (0.10, 0.05),
            (0.045, 0.09),
            (0.026, 0.16),
            (0.045, 0.22),
            (0.115, 0.30),
            (0.145, 0.40),
            (0.150, 0.50),
            (0.165, 0.56),
        ],
        5,
    ));
    let mut mesh = Mesh::lathe(&vessel(&outside, 0.008, 0.26), sides);
    for side in [-1.0, 1.0] {
        let grip = [
            at(side * 0.148, 0.49, 0.0),
            at(side * 0.23, 0.52, 0.0),
            at(side * 0.25, 0.42, 0.0),
            at(side * 0.18, 0.32, 0.0),
            at(side * 0.118, 0.31, 0.0),
        ];
        mesh.append(&Mesh::tube(&smooth_path(&grip, 8, false), 0.012, 12, false));
    }
    mesh
}

/// A bench with wooden planks on bent rods, and two bottles on it.
fn bench(model: &mut Model, p: &Parameters) {
    let spot = Spot::new(-0.10, at(4.0, -0.03, -8.4));
    let mut planks = Mesh::default();
    for k in 0..4 {
        let z = -0.20 + 0.105 * k as f32;
        planks.append(&Mesh::rounded_block(at(-0.85, 0.44, z), at(0.85, 0.475, z + 0.09), 0.006));
    }
    for k in 0..3 {
        let y = 0.58 + 0.11 * k as f32;
        let z = -0.245 - 0.025 * k as f32;
        planks.append(&Mesh::rounded_block(at(-0.85, y, z - 0.03), at(0.85, y + 0.09, z), 0.006));
    }
    model.add("bench-planks", "oak", spot.put(planks.with_texture_scale(Vec2::splat(0.8))));
    let mut rods = Mesh::default();
    for x in [-0.68, 0.68] {
        let back = [at(x, 0.0, -0.30), at(x, 0.22, -0.24), at(x, 0.43, -0.235), at(x, 0.60, -0.29), at(x, 0.90, -0.36)];
        rods.append(&Mesh::tube(&smooth_path(&back, 6, false), 0.02, p.rod_sides, false));
        let front = [at(x, 0.0, 0.24), at(x, 0.25, 0.19), at(x, 0.40, 0.15), at(x, 0.425, 0.05), at(x, 0.425, -0.235)];
        rods.append(&Mesh::tube(&smooth_path(&front, 6, false), 0.02, p.rod_sides, false));
    }
    model.add("bench-rods", "iron", spot.put(rods));
    for (n, x) in [-0.42, -0.28].iter().enumerate() {
        let outside =
            [(0.0, 0.0), (0.036, 0.0), (0.038, 0.01), (0.038, 0.15), (0.030, 0.18), (0.015, 0.20), (0.015, 0.225)];
        let place = at(*x, 0.4755, -0.02 + 0.03 * n as f32);
        let bottle = Mesh::lathe(&vessel(&outside, 0.003, 0.004), p.round_sides);
        model.add(format!("bottle-{}", n + 1), "glass", spot.put(bottle.moved(place)));
        let water = [(0.0, 0.005), (0.0335, 0.005), (0.0345, 0.012), (0.0345, 0.11), (0.0, 0.112)];
        model.add(
            format!("bottle-{}-water", n + 1),
            "water",
            spot.put(Mesh::lathe(&water, p.round_sides).moved(place)),
        );
        let cap = [(0.0, 0.226), (0.018, 0.226), (0.018, 0.25), (0.008, 0.256), (0.007, 0.27), (0.0, 0.27)];
        model.add(
            format!("bottle-{}-cap", n + 1),
            "orange-plastic",
            spot.put(Mesh::lathe(&cap, p.round_sides).moved(place)),
        );
    }
}

/// Cones at the track's border and a ball on the lawn.
fn small_things(model: &mut Model, p: &Parameters) {
    let x = half_track(p) + 0.42;
    let (mut cones, mut bands) = (Mesh::default(), Mesh::default());
    for (cx, cz) in [(-x, 1.1), (-x, -0.8), (x, 1.2), (-x, -4.4), (x, -5.0), (x, -12.0)] {
        let place = at(cx, -0.03, cz);
        let foot = Mesh::rounded_block(at(-0.16, 0.0, -0.16), at(0.16, 0.025, 0.16), 0.008);
        let cone =
            [(0.12, 0.025), (0.105, 0.05), (0.072, 0.18), (0.0471, 0.28), (0.026, 0.36), (0.018, 0.38), (0.0, 0.385)];
        cones.append(&foot.and(Mesh::lathe(&cone, p.round_sides / 2)).moved(place));
        let band = [(0.0775, 0.17), (0.0505, 0.275)];
        bands.append(&Mesh::lathe(&band, p.round_sides / 2).moved(place));
    }
    model.add("cones", "orange-plastic", cones);
    model.add("cone-bands", "white-paint", bands);
    let centre = at(-3.55, 0.105, -3.2);
    let ball = Mesh::sphere(0.125, p.round_sides, p.round_sides / 2).moved(centre);
    model.add("ball", "ball", ball);
    let mut seams = Mesh::tube(&ring_path(0.1245, 0.1245, 0.0, 48), 0.003, 5, true);
    seams.append(&Mesh::tube(&ring_path(0.1245, 0.1245, 0.0, 48), 0.003, 5, true).turned_x(0.25));
    seams.append(&Mesh::tube(&ring_path(0.1245, 0.1245, 0.0, 48), 0.003, 5, true).turned_z(0.25));
    model.add("ball-seams", "black-plastic", seams.turned_y(0.1).turned_x(0.06).moved(centre));
}
