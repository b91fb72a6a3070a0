// SPDX-License-Identifier: MIT OR Apache-2.0
//! Floor, walls with their tiles, ceiling, window, garden, door, clock and picture.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::shell::{Outline, swept};
use crate::scene::builtin::parts::walls::{face_with_hole, framed, glazed_door, window};

/// Height of the worktops, where the tiles begin.
pub const WORKTOP: f32 = 0.90;
/// Where the tiles end.
pub const TILES_END: f32 = 1.62;

/// x of the door's hinges, in the front wall.
const DOOR_RIGHT: f32 = 0.9;

/// Adds the room.
pub fn add(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let floor =
        [at(r.left, 0.0, r.front), at(r.right, 0.0, r.front), at(r.right, 0.0, r.back), at(r.left, 0.0, r.back)];
    model.add("floor", "floor", Mesh::quad(floor, Vec2::ONE).with_plan_texture(0.5 / p.floor_tile));
    let ceiling = floor.map(|c| c + Vec3::Y * r.height);
    model.add("ceiling", "ceiling", Mesh::quad([ceiling[3], ceiling[2], ceiling[1], ceiling[0]], Vec2::ONE));
    walls(model, p);
    window_and_garden(model, p);
    door(model, p);
    let rug = swept(&[(0.0, 0.0), (0.0, 0.006), (-0.006, 0.010)], Outline::new(0.62, 0.36, 0.02), 40, [false, true]);
    let place = at(0.5 * (p.window.left + p.window.right) - 0.1, 0.0005, r.back + 1.12);
    model.add("rug", "rug", rug.with_plan_texture(1.0 / 0.72).turned_y(0.01).moved(place));
    // On the right wall, beyond the shelves.
    let spot = Spot::new(-0.25, at(r.right, 1.62, 1.15));
    let mut picture = Model::new("", "");
    framed(&mut picture, "picture", ("painting", "walnut"), Vec3::ZERO, Vec2::new(0.40, 0.30), 0.04);
    for group in picture.groups {
        model.add(group.name, &group.material, spot.put(group.mesh));
    }
}

/// The four walls; the back and the right one are tiled above the worktops.
fn walls(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let wide = r.right - r.left;
    let deep = r.front - r.back;
    let tile = 0.25 / p.wall_tile;
    let hole = |y: f32| Some([w.left - r.left, w.sill - y, w.right - r.left, w.head - y]);
    let back = |y0: f32, y1: f32, scale: f32| {
        face_with_hole(at(r.left, y0, r.back), Vec3::X, Vec2::new(wide, y1 - y0), hole(y0), scale)
    };
    let right = |y0: f32, y1: f32, z1: f32, scale: f32| {
        face_with_hole(at(r.right, y0, r.back), Vec3::Z, Vec2::new(z1 - r.back, y1 - y0), None, scale)
    };
    model.add("tiles-back", "tiles", back(WORKTOP, TILES_END, tile));
    model.add("tiles-right", "tiles", right(WORKTOP, TILES_END, 0.45, tile));
    let mut plaster = face_with_hole(at(r.left, 0.0, r.back), Vec3::X, Vec2::new(wide, WORKTOP), None, 1.0);
    plaster.append(&back(TILES_END, r.height, 1.0));
    model.add("wall-back", "plaster", plaster);
    let mut plaster = right(0.0, WORKTOP, 0.45, 1.0).and(right(TILES_END, r.height, 0.45, 1.0));
    plaster.append(&face_with_hole(at(r.right, 0.0, 0.45), Vec3::Z, Vec2::new(r.front - 0.45, r.height), None, 1.0));
    model.add("wall-right", "plaster", plaster);
    let left = face_with_hole(at(r.left, 0.0, r.front), -Vec3::Z, Vec2::new(deep, r.height), None, 1.0);
    model.add("wall-left", "plaster", left);
    let front = face_with_hole(at(r.right, 0.0, r.front), -Vec3::X, Vec2::new(wide, r.height), None, 1.0);
    model.add("wall-front", "plaster", front);
    // A rounded strip ends the tiles.
    let mut strip =
        Mesh::rounded_block(at(r.left, TILES_END, r.back), at(w.left - 0.05, TILES_END + 0.02, r.back + 0.014), 0.004);
    strip.append(&Mesh::rounded_block(
        at(w.right + 0.05, TILES_END, r.back),
        at(r.right - 0.015, TILES_END + 0.02, r.back + 0.014),
        0.004,
    ));
    strip.append(&Mesh::rounded_block(
        at(r.right - 0.014, TILES_END, r.back),
        at(r.right, TILES_END + 0.02, 0.46),
        0.004,
    ));
    strip.append(&Mesh::rounded_block(at(r.right - 0.014, WORKTOP, 0.446), at(r.right, TILES_END, 0.46), 0.004));
    model.add("tile-strip", "blue-glaze", strip);
    // It ends beside the door, and reaches below the floor: no two faces lie in one plane.
    let board = |x0: f32, z0: f32, x1: f32, z1: f32| Mesh::block(at(x0, -0.001, z0), at(x1, 0.10, z1));
    let skirting = board(r.left, r.back, r.left + 0.018, r.front)
        .and(board(r.right - 0.018, 0.46, r.right, r.front))
        .and(board(r.left + 0.018, r.front - 0.018, DOOR_RIGHT - 0.992, r.front))
        .and(board(DOOR_RIGHT + 0.092, r.front - 0.018, r.right - 0.018, r.front));
    model.add("skirting", "trim", skirting);
}

/// The window above the sink with its sill and curtain, and what is seen through it.
fn window_and_garden(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let middle = at(0.5 * (w.left + w.right), 0.5 * (w.sill + w.head), r.back);
    let half = Vec2::new(0.5 * (w.right - w.left), 0.5 * (w.head - w.sill));
    let [frame, panes, reveal] = window(half, w.depth, w.bar, 2, 2);
    model.add("window-frame", "trim", frame.moved(middle));
    model.add("window-panes", "pane", panes.moved(middle));
    model.add("window-reveal", "trim", reveal.moved(middle));
    let mut casing =
        Mesh::rounded_block(at(w.left - 0.05, w.head, r.back), at(w.right + 0.05, w.head + 0.06, r.back + 0.02), 0.004);
    casing.append(&Mesh::rounded_block(
        at(w.left - 0.05, w.sill + 0.012, r.back),
        at(w.left, w.head, r.back + 0.02),
        0.004,
    ));
    casing.append(&Mesh::rounded_block(
        at(w.right, w.sill + 0.012, r.back),
        at(w.right + 0.05, w.head, r.back + 0.02),
        0.004,
    ));
    model.add("window-casing", "trim", casing);
    let sill = Mesh::rounded_block(
        at(w.left - 0.07, w.sill - 0.022, r.back - 0.5 * w.depth),
        at(w.right + 0.07, w.sill + 0.012, r.back + 0.09),
        0.006,
    );
    model.add("window-sill", "oak", sill);
    // A short curtain of checked cloth hangs in waves from a rod.
    let (y, z) = (w.head + 0.03, r.back + 0.055);
    let rod = Mesh::tube(&[at(w.left - 0.09, y, z), at(w.right + 0.09, y, z)], 0.008, 10, false)
        .and(Mesh::sphere(0.016, 12, 8).moved(at(w.left - 0.095, y, z)))
        .and(Mesh::sphere(0.016, 12, 8).moved(at(w.right + 0.095, y, z)));
    model.add("curtain-rod", "brass", rod);
    let wide = w.right - w.left + 0.12;
    let wave = |t: f32| {
        let f = t - t.floor();
        let g = 4.0 * f * (1.0 - f);
        if (t.floor() as i32) % 2 == 0 { g } else { -g }
    };
    let curtain = Mesh::sheet(88, 4, |u, v| {
        let swing = (0.010 + 0.012 * (1.0 - v)) * wave(u * 22.0);
        at(w.left - 0.06 + wide * u, y - 0.27 * (1.0 - v) + 0.006, z + swing)
    });
    // Both sides of the cloth are seen: its back from outside and in mirrors.
    let mut back = curtain.clone();
    back.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    back.normals.iter_mut().for_each(|n| *n = -*n);
    let curtain = curtain.and(back.moved(at(0.0, 0.0, -0.001)));
    model.add("curtain", "red-cloth", curtain.with_texture_scale(Vec2::new(14.0, 3.2)));
    let z = r.back - 5.0;
    let (x0, x1, y0, y1) = (-2.4, 4.4, 0.0, 3.4);
    model.add("garden", "garden", Mesh::quad([at(x0, y0, z), at(x1, y0, z), at(x1, y1, z), at(x0, y1, z)], Vec2::ONE));
}

/// A glazed door in the front wall: seen in the steel.
fn door(model: &mut Model, p: &Parameters) {
    let spot = Spot::new(0.5, at(DOOR_RIGHT, 0.0, p.room.front));
    let [leaf, light, casing, handle] = glazed_door(0.9, 2.05);
    model.add("door", "blue-paint", spot.put(leaf));
    model.add("door-light", "garden", spot.put(light));
    model.add("door-casing", "trim", spot.put(casing));
    model.add("door-knob", "brass", spot.put(handle));
}
