// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blackboard, mirror, pictures, clock and plant.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::plants::slit_leaved;
use crate::scene::builtin::parts::walls::framed;

/// Adds the decoration.
pub fn add(model: &mut Model, p: &Parameters) {
    let back = p.room.back;
    framed(model, "menu", ("chalkboard", "oak"), at(0.12, 1.80, back), Vec2::new(0.54, 0.52), 0.045);
    framed(model, "mirror", ("mirror", "gilding"), at(1.33, 1.66, back), Vec2::new(0.44, 0.58), 0.07);
    // Seen in the mirror.
    let name = "picture";
    let (w, h, z) = (0.5, 0.375, p.room.front);
    let canvas = [
        at(-0.45 + w, 1.7 - h, z - 0.02),
        at(-0.45 - w, 1.7 - h, z - 0.02),
        at(-0.45 - w, 1.7 + h, z - 0.02),
        at(-0.45 + w, 1.7 + h, z - 0.02),
    ];
    model.add(name, "painting", Mesh::quad(canvas, Vec2::ONE));
    let border = Mesh::block(at(-0.5 - w, 1.65 - h, z - 0.015), at(-0.4 + w, 1.75 + h, z - 0.001));
    model.add("picture-frame", "walnut", border);
    side_picture(model, p);
    clock(model, at(1.33, 2.55, back));
    plant(model, at(-2.75, 0.0, -2.05), p);
}

/// A picture on the left wall, between the window and the corner.
fn side_picture(model: &mut Model, p: &Parameters) {
    let (x, y, z) = (p.room.left, 1.75, 0.5 * (p.window.far + p.room.back) - 0.02);
    let (w, h) = (0.22, 0.165);
    let q = |dz: f32, dy: f32| at(x + 0.021, y + dy, z + dz);
    model.add("side-picture", "painting", Mesh::quad([q(w, -h), q(-w, -h), q(-w, h), q(w, h)], Vec2::ONE));
    let frame = Mesh::block(at(x + 0.001, y - h - 0.035, z - w - 0.035), at(x + 0.02, y + h + 0.035, z + w + 0.035));
    model.add("side-picture-frame", "gilding", frame);
}

/// A wall clock.
fn clock(model: &mut Model, middle: Vec3) {
    let r = 0.155;
    let mut face = Mesh::lathe(&[(r, 0.018), (0.0, 0.019)], 28).with_plan_texture(1.0);
    for t in &mut face.texcoords {
        *t = *t * (0.5 / r) + Vec2::splat(0.5);
    }
    model.add("clock", "clock-face", face.turned_x(0.25).moved(middle));
    let rim = [
        (r - 0.002, 0.001),
        (r + 0.022, 0.001),
        (r + 0.022, 0.03),
        (r + 0.010, 0.04),
        (r - 0.002, 0.03),
        (r - 0.002, 0.001),
    ];
    model.add("clock-rim", "iron", Mesh::lathe(&rim, 24).turned_x(0.25).moved(middle));
}

/// A tall plant with slit leaves in a pot.
fn plant(model: &mut Model, place: Vec3, p: &Parameters) {
    let pot =
        [(0.0, 0.0), (0.13, 0.0), (0.18, 0.30), (0.20, 0.30), (0.20, 0.35), (0.175, 0.35), (0.165, 0.31), (0.0, 0.30)];
    model.add("plant-pot", "terracotta", Mesh::lathe(&pot, 18).moved(place));
    let soil = Mesh::lathe(&[(0.166, 0.316), (0.0, 0.325)], 16);
    model.add("plant-soil", "soil", soil.moved(place));
    let (stems, leaves) = slit_leaved(p.leaves, p.seed);
    model.add("plant-stems", "stem", stems.moved(place));
    model.add("plant-leaves", "leaf", leaves.moved(place));
}
