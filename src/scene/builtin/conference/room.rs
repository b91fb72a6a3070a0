// SPDX-License-Identifier: MIT OR Apache-2.0
//! Floor, walls, ceiling, windows with blinds, the town outside, and the battens on the back wall.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::blinds::venetian;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::walls::{face_with_hole, window};

/// Adds the room.
pub fn add(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let floor =
        [at(r.left, 0.0, r.front), at(r.right, 0.0, r.front), at(r.right, 0.0, r.back), at(r.left, 0.0, r.back)];
    model.add("floor", "carpet", Mesh::quad(floor, Vec2::ONE).with_plan_texture(0.5));
    let ceiling = floor.map(|c| c + Vec3::Y * r.height);
    let panels = Mesh::quad([ceiling[3], ceiling[2], ceiling[1], ceiling[0]], Vec2::ONE);
    model.add("ceiling", "ceiling", panels.with_plan_texture(1.0 / 1.2));
    walls(model, p);
    windows(model, p);
    battens(model, p);
    downlights(model, p);
}

fn walls(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.windows);
    let (wide, deep) = (r.right - r.left, r.front - r.back);
    let each = deep / w.count as f32;
    let side = 0.5 * (each - w.wide);
    let mut left = Mesh::default();
    for k in 0..w.count {
        let origin = at(r.left, 0.0, r.front - each * k as f32);
        let hole = Some([side, w.sill, side + w.wide, w.head]);
        left.append(&face_with_hole(origin, -Vec3::Z, Vec2::new(each, r.height), hole, 1.0));
    }
    model.add("wall-left", "white-wall", left);
    let back = face_with_hole(at(r.left, 0.0, r.back), Vec3::X, Vec2::new(wide, r.height), None, 1.0);
    model.add("wall-back", "dark-wall", back);
    let right = face_with_hole(at(r.right, 0.0, r.back), Vec3::Z, Vec2::new(deep, r.height), None, 1.0);
    model.add("wall-right", "warm-wall", right);
    let front = face_with_hole(at(r.right, 0.0, r.front), -Vec3::X, Vec2::new(wide, r.height), None, 1.0);
    model.add("wall-front", "white-wall", front);
    let board = |x0: f32, z0: f32, x1: f32, z1: f32| Mesh::block(at(x0, -0.001, z0), at(x1, 0.08, z1));
    let skirting = board(r.left, r.back + 0.05, r.left + 0.015, r.front).and(board(
        r.right - 0.015,
        r.back + 0.05,
        r.right,
        r.front,
    ));
    model.add("skirting", "dark-metal", skirting);
}

/// The windows, each with its blind and a sill, and what is seen through them.
fn windows(model: &mut Model, p: &Parameters) {
    let (r, w, b) = (&p.room, &p.windows, &p.blinds);
    let each = (r.front - r.back) / w.count as f32;
    let half = Vec2::new(0.5 * w.wide, 0.5 * (w.head - w.sill));
    let [frame, panes, reveal] = window(half, w.depth, w.bar, 2, 1);
    for k in 0..w.count {
        let n = k + 1;
        let z = r.front - each * (k as f32 + 0.5);
        let spot = Spot::new(0.25, at(r.left, 0.5 * (w.sill + w.head), z));
        model.add(format!("window-{n}-frame"), "dark-metal", spot.put(frame.clone()));
        model.add(format!("window-{n}-pane"), "pane", spot.put(panes.clone()));
        model.add(format!("window-{n}-reveal"), "white-wall", spot.put(reveal.clone()));
        // Every third blind is drawn up by a part: its slats lie close together.
        let drop = (w.head - w.sill + 0.06) * if k % 3 == 1 { 0.72 } else { 1.0 };
        let [slats, rails, cords] = venetian(w.wide + 0.10, drop, b.slats, b.cells, b.tilt);
        let spot = Spot::new(0.25, at(r.left + 0.045, w.head + 0.07, z));
        model.add(format!("blind-{n}-slats"), "slats", spot.put(slats));
        model.add(format!("blind-{n}-rails"), "aluminium", spot.put(rails));
        model.add(format!("blind-{n}-cords"), "cord", spot.put(cords));
    }
    // A long case below the windows, with the heating behind slits.
    let (x0, x1) = (r.left + 0.001, r.left + 0.17);
    let top = Mesh::rounded_block(at(x0, w.sill - 0.10, r.back + 0.06), at(x1 + 0.02, w.sill - 0.07, r.front), 0.006);
    model.add("sill", "white-board", top);
    let mut case = Mesh::block(at(x0, 0.09, r.back + 0.06), at(x1 - 0.01, w.sill - 0.16, r.front - 0.001));
    let count = ((r.front - r.back) / 0.05) as u32;
    for k in 0..count {
        let z = r.back + 0.08 + 0.05 * k as f32;
        case.append(&Mesh::block(at(x1 - 0.03, w.sill - 0.161, z), at(x1, w.sill - 0.099, z + 0.012)));
    }
    model.add("heating", "white-board", case);
    let x = r.left - 9.0;
    let (z0, z1, y0, y1) = (r.back - 21.0, r.front + 6.0, -3.5, 9.5);
    let town = [at(x, y0, z1), at(x, y0, z0), at(x, y1, z0), at(x, y1, z1)];
    model.add("town", "town", Mesh::quad(town, Vec2::new(1.5, 1.0)));
}

/// Upright wooden battens on the back wall.
fn battens(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let step = (r.right - r.left) / p.battens as f32;
    let mut wood = Mesh::default();
    for k in 0..p.battens {
        let x = r.left + step * (k as f32 + 0.5);
        let half = 0.36 * step;
        wood.append(&Mesh::rounded_block(
            at(x - half, 0.02, r.back - 0.002),
            at(x + half, r.height - 0.02, r.back + 0.032),
            0.004,
        ));
    }
    model.add("battens", "oak", wood.with_texture_scale(Vec2::new(2.0, 0.5)));
}

/// Round lights in the ceiling.
fn downlights(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let (mut rings, mut discs) = (Mesh::default(), Mesh::default());
    for x in [0.72, -0.72] {
        for k in 0..5 {
            let z = r.back + (r.front - r.back) * (k as f32 + 0.5) / 5.0;
            let place = at(if x > 0.0 { r.right - 1.1 } else { r.left + 1.1 }, r.height, z);
            let ring = [(0.075, -0.004), (0.083, -0.012), (0.100, -0.010), (0.102, 0.001)];
            rings.append(&Mesh::lathe(&ring, p.round_sides).moved(place));
            discs.append(&Mesh::lathe(&[(0.0, -0.005), (0.076, -0.005)], p.round_sides).moved(place));
        }
    }
    model.add("downlight-rings", "aluminium", rings);
    model.add("downlights", "bulb", discs);
}
