// SPDX-License-Identifier: MIT OR Apache-2.0
//! What stands along the walls: the screen, the sideboard with coffee, a flip chart, a clock, plants.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bottle, cup, plate, teapot};
use crate::scene::builtin::parts::cupboards::{bow_handle, panelled};
use crate::scene::builtin::parts::food::croissant;
use crate::scene::builtin::parts::plants::slit_leaved;
use crate::scene::builtin::parts::walls::framed;

/// Adds what stands along the walls.
pub fn add(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let back = r.back + 0.034;
    framed(model, "screen", ("screen", "black-plastic"), at(-0.45, 1.72, back), Vec2::new(1.28, 0.72), 0.03);
    sideboard(model, p);
    flip_chart(model, p);
    clock(model, p, at(2.45, 2.32, back));
    plant(model, p, 1, at(r.left + 0.62, 0.0, r.back + 0.55));
    plant(model, p, 2, at(r.right - 0.62, 0.0, r.back + 0.20 + 0.75 + 0.70 * p.guests as f32));
}

/// A sideboard below the screen with coffee, cups and croissants.
fn sideboard(model: &mut Model, p: &Parameters) {
    let (x0, x1, back) = (-1.75, 0.85, p.room.back + 0.04);
    let (front, top) = (back + 0.46, 0.80);
    let body = Mesh::block(at(x0, 0.12, back), at(x1, top - 0.03, front));
    model.add("sideboard", "white-board", body);
    let board = Mesh::rounded_block(at(x0 - 0.02, top - 0.03, back - 0.004), at(x1 + 0.02, top, front + 0.03), 0.005);
    model.add("sideboard-top", "walnut", board.with_texture_scale(Vec2::splat(0.8)));
    let (mut doors, mut handles, mut feet) = (Mesh::default(), Mesh::default(), Mesh::default());
    let each = (x1 - x0) / 4.0;
    for k in 0..4 {
        let a = x0 + each * k as f32;
        let door = panelled([a + 0.004, a + each - 0.004], [0.124, top - 0.036], 0.06);
        doors.append(&door.moved(at(0.0, 0.0, front)));
        let side = if k % 2 == 0 { a + each - 0.035 } else { a + 0.035 };
        handles.append(&bow_handle(0.16, 0.005).turned_z(0.25).moved(at(side, 0.52, front + 0.022)));
        for z in [back + 0.05, front - 0.05] {
            feet.append(&Mesh::tapered_tube(
                &[at(a + 0.06, -0.002, z), at(a + 0.06, 0.121, z)],
                |t| 0.012 + 0.006 * t,
                12,
                false,
            ));
        }
    }
    model.add("sideboard-doors", "white-board", doors);
    model.add("sideboard-handles", "chrome", handles);
    model.add("sideboard-feet", "steel", feet);
    let on = |x: f32, z: f32| at(x, top + 0.0005, back + z);
    for (n, x) in [-1.35, -1.05].iter().enumerate() {
        let pot = teapot(0.085, p.round_sides).stretched(at(1.0, 1.35, 1.0)).turned_y(0.04 - 0.1 * n as f32);
        model.add(format!("coffee-pot-{}", n + 1), "chrome", pot.moved(on(*x, 0.22)));
    }
    let mut cups = Mesh::default();
    for k in 0..10 {
        let (column, row) = ((k % 5) as f32, (k / 5) as f32);
        cups.append(
            &cup(p.small_sides).turned_y(0.1 * column + 0.05).moved(on(-0.72 + 0.11 * column, 0.14 + 0.13 * row)),
        );
    }
    model.add("cups", "porcelain", cups);
    let dish = on(0.20, 0.22);
    model.add("dish", "porcelain", plate(0.19, p.round_sides).moved(dish));
    let mut food = Mesh::default();
    for k in 0..6 {
        let (c, s) = cos_sin(k as f32 / 6.0);
        let up = if k == 5 { 0.045 } else { 0.012 };
        let out = if k == 5 { 0.0 } else { 0.095 };
        food.append(&croissant().turned_y(0.17 * k as f32).moved(dish + at(c * out, up, -s * out)));
    }
    model.add("croissants", "crust", food);
    let mut bottles = Mesh::default();
    for k in 0..4 {
        bottles.append(&bottle(0.036, 0.14, 0.014, 0.27, p.small_sides).moved(on(0.52 + 0.085 * k as f32, 0.16)));
    }
    model.add("bottles", "bottle-green", bottles);
}

/// A flip chart on three thin legs.
fn flip_chart(model: &mut Model, p: &Parameters) {
    let place = at(2.35, 0.0, p.room.back + 0.75);
    let put = |mesh: Mesh| mesh.turned_y(-0.045).moved(place);
    let mut legs = Mesh::default();
    for (x, z) in [(-0.36, 0.16), (0.36, 0.16), (0.0, -0.48)] {
        let head = at(0.25 * x, 1.86, -0.02);
        legs.append(&Mesh::tube(&[at(x, 0.01, z), head], 0.011, p.chair_sides, false));
        legs.append(&Mesh::sphere(0.017, p.chair_sides, 6).moved(at(x, 0.017, z)));
    }
    let tray = Mesh::rounded_block(at(-0.36, 0.86, 0.062), at(0.36, 0.875, 0.13), 0.004);
    let clamp = Mesh::rounded_block(at(-0.35, 1.80, 0.022), at(0.35, 1.85, 0.052), 0.008);
    model.add("easel", "aluminium", put(legs.and(tray).and(clamp)));
    // The board leans back; a few sheets hang over it.
    let lean = |y: f32| 0.075 - 0.055 * (y - 0.86);
    let point = |x: f32, y: f32, z: f32| at(x, y, lean(y) + z);
    let face =
        |x: f32, y0: f32, y1: f32, z: f32| [point(-x, y0, z), point(x, y0, z), point(x, y1, z), point(-x, y1, z)];
    let board = Mesh::quad(face(0.35, 0.88, 1.82, 0.0), Vec2::ONE);
    let back = Mesh::quad(
        [point(0.35, 0.88, -0.006), point(-0.35, 0.88, -0.006), point(-0.35, 1.82, -0.006), point(0.35, 1.82, -0.006)],
        Vec2::ONE,
    );
    model.add("flip-board", "white-board", put(board.and(back)));
    let paper = Mesh::sheet(10, 14, |u, v| {
        let (x, y) = (0.66 * (u - 0.5), 0.93 + 0.86 * v);
        // The lower border curls up a little.
        let curl = (1.0 - v) * (1.0 - v) * (1.0 - v) * (0.02 + 0.03 * u);
        point(x, y, 0.004 + curl)
    });
    model.add("flip-paper", "flip-paper", put(paper));
    let mut pens = Mesh::default();
    for k in 0..4 {
        let x = -0.22 + 0.13 * k as f32;
        pens.append(&Mesh::tube(&[at(x, 0.885, 0.10), at(x + 0.10, 0.885, 0.102)], 0.008, 10, false));
    }
    model.add("flip-pens", "red-plastic", put(pens));
}

fn clock(model: &mut Model, p: &Parameters, place: Vec3) {
    let rim = [(0.155, 0.0), (0.168, 0.006), (0.170, 0.030), (0.160, 0.036), (0.152, 0.020)];
    let rim = Mesh::lathe(&rim, p.round_sides).turned_x(0.25);
    model.add("clock-rim", "aluminium", rim.moved(place));
    let mut face = Mesh::lathe(&[(0.154, 0.016), (0.0, 0.016)], p.round_sides).turned_x(0.25);
    for (t, q) in face.texcoords.iter_mut().zip(&face.positions) {
        *t = Vec2::new(0.5 + q.x / 0.308, 0.5 + q.y / 0.308);
    }
    model.add("clock-face", "clock-face", face.moved(place));
}

/// A tall plant in a white pot.
fn plant(model: &mut Model, p: &Parameters, n: u32, place: Vec3) {
    let pot = [
        (0.0, -0.002),
        (0.15, -0.002),
        (0.19, 0.02),
        (0.20, 0.34),
        (0.195, 0.36),
        (0.18, 0.35),
        (0.175, 0.31),
        (0.0, 0.30),
    ];
    model.add(format!("plant-{n}-pot"), "porcelain", Mesh::lathe(&pot, p.round_sides).moved(place));
    let soil = Mesh::lathe(&[(0.176, 0.316), (0.0, 0.325)], p.round_sides);
    model.add(format!("plant-{n}-soil"), "soil", soil.moved(place));
    let (stems, leaves) = slit_leaved(p.leaves, p.seed.wrapping_add(n));
    model.add(format!("plant-{n}-stems"), "stem", stems.moved(place));
    model.add(format!("plant-{n}-leaves"), "leaf", leaves.moved(place));
    let stake = smooth_path(&[place + at(0.02, 0.30, 0.0), place + at(0.0, 1.35, 0.02)], 1, false);
    model.add(format!("plant-{n}-stake"), "soil", Mesh::tube(&stake, 0.012, 8, false));
}
