// SPDX-License-Identifier: MIT OR Apache-2.0
//! Floor, walls, ceiling, beams, window, door and the street outside.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;

/// Adds the room.
pub fn add(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let one = Vec2::ONE;
    let floor =
        [at(r.left, 0.0, r.front), at(r.right, 0.0, r.front), at(r.right, 0.0, r.back), at(r.left, 0.0, r.back)];
    model.add("floor", "floor", diagonal(Mesh::quad(floor, one), 0.5 / p.floor_tile));
    let ceiling = floor.map(|c| c + Vec3::Y * r.height);
    model.add("ceiling", "ceiling", Mesh::quad([ceiling[3], ceiling[2], ceiling[1], ceiling[0]], one));
    wall(model, "back", at(r.left, 0.0, r.back), at(r.right, 0.0, r.back), r.height, r.wainscot);
    wall(model, "right", at(r.right, 0.0, r.back), at(r.right, 0.0, r.front), r.height, r.wainscot);
    wall(model, "front", at(r.right, 0.0, r.front), at(r.left, 0.0, r.front), r.height, r.wainscot);
    window_wall(model, p);
    let mut beams = Mesh::default();
    for z in [-1.9, 0.1, 2.1] {
        beams.append(&Mesh::block(at(r.left, r.height - 0.17, z - 0.08), at(r.right, r.height - 0.001, z + 0.08)));
    }
    model.add("beams", "walnut", beams.with_texture_scale(Vec2::new(0.6, 1.2)));
    door(model, r.front);
    let (x, z) = (r.left - 6.0, 0.5 * (w.near + w.far));
    let street = Mesh::sheet(4, 2, |u, v| at(x, -1.2 + 7.5 * v, z + 4.0 - 16.0 * u));
    model.add("street", "street", street);
}

/// The same mesh with its texture laid diagonally in plan.
fn diagonal(mut mesh: Mesh, repeats_per_metre: f32) -> Mesh {
    let s = repeats_per_metre * 0.5f32.sqrt();
    for (t, p) in mesh.texcoords.iter_mut().zip(&mesh.positions) {
        *t = Vec2::new(p.x - p.z, p.x + p.z) * s;
    }
    mesh
}

/// A wall from `from` to `to`, which faces to the left of that direction as seen from above, with its panelling.
fn wall(model: &mut Model, name: &str, from: Vec3, to: Vec3, height: f32, wainscot: f32) {
    let up = Vec3::Y;
    let along = (to - from).length();
    let upper = Mesh::quad([from + up * wainscot, to + up * wainscot, to + up * height, from + up * height], Vec2::ONE);
    model.add(format!("wall-{name}"), "plaster", upper);
    let lower =
        Mesh::quad([from, to, to + up * wainscot, from + up * wainscot], Vec2::new(along / 0.5, wainscot / 0.5));
    model.add(format!("panelling-{name}"), "panelling", lower);
    let inwards = (to - from).cross(up).normalize();
    let rail = |lo: f32, hi: f32, out: f32| {
        let (a, b) = (from + up * lo, to + up * hi + inwards * out);
        Mesh::block(a.min(b), a.max(b))
    };
    let trim = rail(wainscot - 0.045, wainscot + 0.015, 0.035).and(rail(0.0, 0.11, 0.02));
    model.add(format!("rail-{name}"), "trim", trim);
}

/// The left wall around its window, the window's frame, panes and sill.
fn window_wall(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let x = r.left;
    let piece = |z0: f32, z1: f32, y0: f32, y1: f32| {
        let size = Vec2::new((z0 - z1) / 0.5, (y1 - y0) / 0.5);
        Mesh::quad([at(x, y0, z0), at(x, y0, z1), at(x, y1, z1), at(x, y1, z0)], size)
    };
    let lower = r.wainscot.min(w.sill);
    model.add("panelling-left", "panelling", piece(r.front, r.back, 0.0, lower));
    let mut wall = piece(r.front, w.near, lower, r.height);
    wall.append(&piece(w.far, r.back, lower, r.height));
    wall.append(&piece(w.near, w.far, w.head, r.height));
    model.add("wall-left", "plaster", wall);
    let trim = Mesh::block(at(x, 0.0, r.back), at(x + 0.02, 0.11, r.front));
    model.add("rail-left", "trim", trim);
    // The opening's four sides.
    let out = x - w.depth;
    let (n, f, s, h) = (w.near, w.far, w.sill, w.head);
    let reveal = Mesh::quad([at(x, s, n), at(x, s, f), at(out, s, f), at(out, s, n)], Vec2::ONE)
        .and(Mesh::quad([at(x, h, f), at(x, h, n), at(out, h, n), at(out, h, f)], Vec2::ONE))
        .and(Mesh::quad([at(x, s, f), at(x, h, f), at(out, h, f), at(out, s, f)], Vec2::ONE))
        .and(Mesh::quad([at(x, h, n), at(x, s, n), at(out, s, n), at(out, h, n)], Vec2::ONE));
    model.add("window-reveal", "ceiling", reveal);
    let middle = x - 0.6 * w.depth;
    let bar = |y0: f32, y1: f32, z0: f32, z1: f32, half: f32| {
        Mesh::rounded_block(at(middle - half, y0, z1), at(middle + half, y1, z0), half * 0.3)
    };
    let b = w.bar;
    let mut frame = bar(s, s + 3.0 * b, n, f, 1.5 * b);
    frame.append(&bar(h - 3.0 * b, h, n, f, 1.5 * b));
    frame.append(&bar(s, h, n, n - 3.0 * b, 1.5 * b));
    frame.append(&bar(s, h, f + 3.0 * b, f, 1.5 * b));
    for k in 1..3 {
        let z = n + (f - n) * k as f32 / 3.0;
        frame.append(&bar(s, h, z + b, z - b, b));
    }
    let y = s + (h - s) * 0.68;
    frame.append(&bar(y - b, y + b, n, f, b));
    model.add("window-frame", "trim", frame);
    model.add(
        "window-panes",
        "pane",
        Mesh::quad([at(middle, s, n), at(middle, s, f), at(middle, h, f), at(middle, h, n)], Vec2::ONE),
    );
    let sill = Mesh::rounded_block(at(x - 0.02, s - 0.035, f - 0.06), at(x + 0.10, s + 0.012, n + 0.06), 0.01);
    model.add("window-sill", "oak", sill);
    // A frame around the opening, on the wall.
    let mut casing = Mesh::block(at(x, h, f - 0.08), at(x + 0.025, h + 0.08, n + 0.08));
    casing.append(&Mesh::block(at(x, s, n), at(x + 0.025, h, n + 0.08)));
    casing.append(&Mesh::block(at(x, s, f - 0.08), at(x + 0.025, h, f)));
    model.add("window-casing", "trim", casing);
}

/// The door in the front wall: seen in the mirror.
fn door(model: &mut Model, front: f32) {
    let (x0, x1, y) = (0.35, 1.35, 2.15);
    let z = front;
    let mut frame = Mesh::block(at(x0 - 0.1, 0.0, z - 0.05), at(x0, y + 0.1, z - 0.001));
    frame.append(&Mesh::block(at(x1, 0.0, z - 0.05), at(x1 + 0.1, y + 0.1, z - 0.001)));
    frame.append(&Mesh::block(at(x0, y, z - 0.05), at(x1, y + 0.1, z - 0.001)));
    model.add("door-frame", "trim", frame);
    let mut leaf = Mesh::block(at(x0, 0.0, z - 0.04), at(x1, 0.75, z - 0.002));
    leaf.append(&Mesh::block(at(x0, 0.75, z - 0.04), at(x0 + 0.13, y, z - 0.002)));
    leaf.append(&Mesh::block(at(x1 - 0.13, 0.75, z - 0.04), at(x1, y, z - 0.002)));
    leaf.append(&Mesh::block(at(x0 + 0.13, y - 0.14, z - 0.04), at(x1 - 0.13, y, z - 0.002)));
    leaf.append(&Mesh::block(at(x0 + 0.13, 1.36, z - 0.03), at(x1 - 0.13, 1.40, z - 0.002)));
    model.add("door", "oak", leaf);
    let light = [
        at(x1 - 0.13, 0.75, z - 0.004),
        at(x0 + 0.13, 0.75, z - 0.004),
        at(x0 + 0.13, y - 0.14, z - 0.004),
        at(x1 - 0.13, y - 0.14, z - 0.004),
    ];
    model.add("door-light", "street", Mesh::quad(light, Vec2::new(0.2, 0.6)));
    let knob = Mesh::sphere(0.03, 10, 6).moved(at(x0 + 0.07, 1.0, z - 0.08));
    model.add("door-knob", "brass", knob);
}
