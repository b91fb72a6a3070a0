// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables, bentwood chairs and pendant lamps.

use glam::Vec3;

use super::{Chair, Parameters, at};
use crate::scene::builtin::mesh::{Mesh, ring_path, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::lamps;

/// Height of a table's top.
pub const TABLE_HEIGHT: f32 = 0.74;

/// Adds tables, chairs and lamps.
pub fn add(model: &mut Model, p: &Parameters) {
    for (i, table) in p.tables.iter().enumerate() {
        let [x, z] = table.at;
        let place = at(x, 0.0, z);
        let n = i + 1;
        model.add(format!("table-{n}-top"), "marble", table_top(table.radius, p.table_sides).moved(place));
        let r = table.radius + 0.003;
        let (lo, hi) = (TABLE_HEIGHT - 0.028, TABLE_HEIGHT - 0.008);
        let band = Mesh::lathe(&[(r, lo), (r, hi), (r - 0.004, hi)], p.table_sides);
        model.add(format!("table-{n}-band"), "gilding", band.moved(place));
        let foot = table_foot(table.radius).turned_y(0.07 + 0.11 * i as f32);
        model.add(format!("table-{n}-foot"), "iron", foot.moved(place));
    }
    let frame = chair_frame(&p.chair);
    let seat = chair_seat(&p.chair);
    for (i, chair) in p.chairs.iter().enumerate() {
        let [x, z] = chair.at;
        let put = |mesh: &Mesh| mesh.clone().turned_y(chair.turns).moved(at(x, 0.0, z));
        model.add(format!("chair-{}-frame", i + 1), "bentwood", put(&frame));
        model.add(format!("chair-{}-seat", i + 1), "cane", put(&seat));
    }
    for (i, lamp) in p.lamps.iter().enumerate() {
        lamps::pendant(model, i + 1, lamp, "green-enamel", p.room.height, p.lamp_sides);
    }
}

/// A round slab with softened borders.
fn table_top(radius: f32, sides: u32) -> Mesh {
    let (lo, hi) = (TABLE_HEIGHT - 0.035, TABLE_HEIGHT);
    let profile =
        [(0.0, lo), (radius - 0.01, lo), (radius, lo + 0.008), (radius, hi - 0.007), (radius - 0.007, hi), (0.0, hi)];
    Mesh::lathe(&profile, sides).with_plan_texture(1.3)
}

/// A turned column on three curved feet.
fn table_foot(radius: f32) -> Mesh {
    let under = TABLE_HEIGHT - 0.035;
    let profile = [
        (0.0, 0.09),
        (0.03, 0.10),
        (0.04, 0.14),
        (0.026, 0.20),
        (0.021, 0.34),
        (0.024, 0.56),
        (0.034, 0.60),
        (0.024, 0.64),
        (0.05, under - 0.02),
        (0.14, under - 0.008),
        (0.14, under),
    ];
    let mut foot = Mesh::lathe(&profile, 10);
    let reach = radius * 0.82;
    let bend = [at(0.0, 0.17, 0.0), at(reach * 0.35, 0.155, 0.0), at(reach * 0.75, 0.06, 0.0), at(reach, 0.018, 0.0)];
    let path = smooth_path(&bend, 2, false);
    for k in 0..3 {
        let leg = Mesh::tapered_tube(&path, |t| 0.020 - 0.006 * t, 6, false);
        let pad = Mesh::lathe(&[(0.026, 0.0), (0.026, 0.012), (0.0, 0.021)], 7);
        foot.append(&leg.and(pad.moved(at(reach, 0.0, 0.0))).turned_y(k as f32 / 3.0));
    }
    foot
}

/// Legs, hoops, ring and seat rim of a bentwood chair. The seat's middle stands over the origin, its back at -z.
fn chair_frame(c: &Chair) -> Mesh {
    let (s, h) = (c.seat_height, c.back_height);
    let r = c.tube_radius;
    let w = c.seat_radius;
    let rise = h - s;
    let mut frame = Mesh::default();
    // Rear legs and back are one bent piece.
    let half = [
        at(0.80 * w, 0.0, -1.22 * w),
        at(0.76 * w, 0.45 * s, -w),
        at(0.74 * w, s, -0.86 * w),
        at(0.80 * w, s + 0.40 * rise, -1.02 * w),
        at(0.78 * w, s + 0.74 * rise, -1.20 * w),
        at(0.46 * w, s + 0.96 * rise, -1.32 * w),
    ];
    frame.append(&Mesh::tube(&smooth_path(&mirrored(&half, at(0.0, h, -1.34 * w)), c.steps, false), r, c.sides, false));
    let inner = [
        at(0.44 * w, s, -0.86 * w),
        at(0.47 * w, s + 0.35 * rise, -0.99 * w),
        at(0.40 * w, s + 0.66 * rise, -1.14 * w),
    ];
    let top = at(0.0, s + 0.80 * rise, -1.22 * w);
    frame.append(&Mesh::tube(&smooth_path(&mirrored(&inner, top), c.steps, false), r * 0.78, c.sides, false));
    for side in [-1.0, 1.0] {
        let leg = [
            at(side * 0.70 * w, s, 0.62 * w),
            at(side * 0.76 * w, 0.5 * s, 0.74 * w),
            at(side * 0.90 * w, 0.0, 0.98 * w),
        ];
        let path = smooth_path(&leg, c.steps.div_ceil(2), false);
        frame.append(&Mesh::tapered_tube(&path, |t| r * (1.05 - 0.3 * t), c.sides, false));
    }
    frame.append(&Mesh::tube(&ring_path(0.77 * w, 0.80 * w, 0.46 * s, c.seat_sides), r * 0.65, c.sides.min(5), true));
    let rim = [(w * 0.98, s - 0.030), (w, s - 0.015), (w * 0.96, s + 0.004), (w * 0.80, s - 0.006)];
    frame.append(&Mesh::lathe(&rim, c.seat_sides));
    frame
}

/// The right half of a path, its top, and the left half.
fn mirrored(half: &[Vec3], top: Vec3) -> Vec<Vec3> {
    let left = half.iter().rev().map(|p| at(-p.x, p.y, p.z));
    half.iter().copied().chain([top]).chain(left).collect()
}

/// The woven seat.
fn chair_seat(c: &Chair) -> Mesh {
    let (s, w) = (c.seat_height, c.seat_radius);
    let profile = [(w * 0.82, s - 0.026), (w * 0.83, s - 0.006), (0.0, s - 0.011)];
    Mesh::lathe(&profile, c.seat_sides).with_plan_texture(12.0)
}
