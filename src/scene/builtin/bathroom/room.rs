// SPDX-License-Identifier: MIT OR Apache-2.0
//! Floor, tiled walls, ceiling with its lamp, window, garden, door.

use glam::{Vec2, Vec3};

use super::surfaces::HEXAGONS;
use super::{Parameters, at};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::Spot;
use crate::scene::builtin::parts::plants::potted_herb;
use crate::scene::builtin::parts::walls::{face_with_hole, framed, glazed_door, window};

/// x of the door's hinges, in the front wall.
const DOOR_RIGHT: f32 = 0.75;

/// Adds the room.
pub fn add(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let floor =
        [at(r.left, 0.0, r.front), at(r.right, 0.0, r.front), at(r.right, 0.0, r.back), at(r.left, 0.0, r.back)];
    let scale = Vec2::new(1.0 / HEXAGONS[0], 1.0 / HEXAGONS[1]) / p.floor_tile;
    model.add("floor", "floor", Mesh::quad(floor, Vec2::ONE).with_plan_texture(1.0).with_texture_scale(scale));
    let ceiling = floor.map(|c| c + Vec3::Y * r.height);
    model.add("ceiling", "ceiling", Mesh::quad([ceiling[3], ceiling[2], ceiling[1], ceiling[0]], Vec2::ONE));
    walls(model, p);
    window_and_garden(model, p);
    let spot = Spot::new(0.5, at(DOOR_RIGHT, 0.0, r.front));
    let [leaf, light, casing, handle] = glazed_door(0.85, 2.03);
    model.add("door", "trim", spot.put(leaf));
    model.add("door-light", "garden", spot.put(light));
    model.add("door-casing", "oak", spot.put(casing));
    model.add("door-knob", "chrome", spot.put(handle));
    // Seen in the mirror.
    let spot = Spot::new(0.5, at(1.45, 1.65, r.front));
    let mut picture = Model::new("", "");
    framed(&mut picture, "picture", ("painting", "walnut"), Vec3::ZERO, Vec2::new(0.36, 0.27), 0.04);
    for group in picture.groups {
        model.add(group.name, &group.material, spot.put(group.mesh));
    }
    // A globe under the ceiling; its light is in `view.json`.
    let place = at(0.0, r.height, 0.7);
    let globe = Mesh::sphere(0.13, p.small_sides * 2, p.small_sides).stretched(at(1.0, 0.8, 1.0));
    model.add("ceiling-globe", "opal", globe.moved(place - at(0.0, 0.145, 0.0)));
    let rose = Mesh::lathe(&[(0.06, -0.055), (0.075, -0.05), (0.08, -0.015), (0.085, -0.0005)], p.small_sides * 2);
    model.add("ceiling-rose", "chrome", rose.moved(place));
}

/// Walls with white tiles below and paint above; mosaic up to the ceiling in the shower.
fn walls(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let (tiles, high) = (r.tiles, r.height);
    let wide = r.right - p.shower.size[0] - r.left;
    let deep = r.front - r.back;
    // Two tiles a repeat along, and four rows of half their length.
    let white = 0.5 / p.wall_tile;
    let mosaic = 0.125 / p.mosaic_tile;
    let face = |origin: Vec3, right: Vec3, long: f32, y0: f32, y1: f32, scale: f32| {
        face_with_hole(origin + Vec3::Y * y0, right, Vec2::new(long, y1 - y0), None, scale)
    };
    let corner = at(r.right, 0.0, r.back);
    let sides = [
        ("back", at(r.left, 0.0, r.back), Vec3::X, wide),
        ("left", at(r.left, 0.0, r.front), -Vec3::Z, deep),
        ("front", at(r.right, 0.0, r.front), -Vec3::X, r.right - r.left),
    ];
    for (name, origin, right, long) in sides {
        model.add(format!("tiles-{name}"), "tiles", face(origin, right, long, 0.0, tiles, white));
        model.add(format!("wall-{name}"), "paint", face(origin, right, long, tiles, high, 1.0));
    }
    let start = corner + Vec3::Z * p.shower.size[1];
    let long = deep - p.shower.size[1];
    model.add("tiles-right", "tiles", face(start, Vec3::Z, long, 0.0, tiles, white));
    let hole = [w.far - start.z, w.sill - tiles, w.near - start.z, w.head - tiles];
    let upper = face_with_hole(start + Vec3::Y * tiles, Vec3::Z, Vec2::new(long, high - tiles), Some(hole), 1.0);
    model.add("wall-right", "paint", upper);
    let shower = face(corner - Vec3::X * p.shower.size[0], Vec3::X, p.shower.size[0], 0.0, high, mosaic).and(face(
        corner,
        Vec3::Z,
        p.shower.size[1],
        0.0,
        high,
        mosaic,
    ));
    model.add("shower-mosaic", "mosaic", shower);
    // A glazed border ends the tiles.
    let t = 0.012;
    let (y0, y1) = (tiles - 0.001, tiles + 0.035);
    let border =
        Mesh::rounded_block(at(r.left + t, y0, r.back), at(r.right - p.shower.size[0] - 0.03, y1, r.back + t), 0.003)
            .and(Mesh::rounded_block(at(r.left, y0, r.back), at(r.left + t, y1, r.front - t), 0.003))
            .and(Mesh::rounded_block(at(r.right - t, y0, start.z + 0.03), at(r.right, y1, r.front - t), 0.003))
            .and(Mesh::rounded_block(at(r.left, y0, r.front - t), at(DOOR_RIGHT - 0.945, y1, r.front), 0.003))
            .and(Mesh::rounded_block(at(DOOR_RIGHT + 0.095, y0, r.front - t), at(r.right, y1, r.front), 0.003));
    model.add("tile-border", "teal-glaze", border);
}

/// The window with its sill, pots on it, and what is seen through it.
fn window_and_garden(model: &mut Model, p: &Parameters) {
    let (r, w) = (&p.room, &p.window);
    let half = Vec2::new(0.5 * (w.near - w.far), 0.5 * (w.head - w.sill));
    let spot = Spot::new(-0.25, at(r.right, 0.5 * (w.sill + w.head), 0.5 * (w.near + w.far)));
    let [frame, panes, reveal] = window(half, w.depth, w.bar, 2, 1);
    model.add("window-frame", "trim", spot.put(frame));
    model.add("window-panes", "pane", spot.put(panes));
    model.add("window-reveal", "trim", spot.put(reveal));
    let (x, y) = (half.x, half.y);
    let casing = Mesh::rounded_block(at(-x - 0.06, y, 0.0), at(x + 0.06, y + 0.06, 0.02), 0.004)
        .and(Mesh::rounded_block(at(-x - 0.06, -y + 0.012, 0.0), at(-x, y, 0.02), 0.004))
        .and(Mesh::rounded_block(at(x, -y + 0.012, 0.0), at(x + 0.06, y, 0.02), 0.004));
    model.add("window-casing", "trim", spot.put(casing));
    let sill = Mesh::rounded_block(at(-x - 0.08, -y - 0.024, -0.5 * w.depth), at(x + 0.08, -y + 0.012, 0.10), 0.006);
    model.add("window-sill", "marble", spot.put(sill));
    for (k, z) in [(0, 0.55 * x), (1, 0.18 * x)] {
        let place = at(r.right - 0.03, w.sill + 0.0125, 0.5 * (w.near + w.far) - z);
        let [pot, soil, stems, leaves] = potted_herb(0.055, 90, p.seed.wrapping_add(17 * k), p.small_sides);
        let n = k + 1;
        model.add(format!("herb-pot-{n}"), "ceramic", pot.moved(place));
        model.add(format!("herb-soil-{n}"), "soil", soil.moved(place));
        model.add(format!("herb-stems-{n}"), "stem", stems.moved(place));
        model.add(format!("herb-leaves-{n}"), "herb", leaves.moved(place));
    }
    let x = r.right + 4.5;
    let z = 0.5 * (w.near + w.far) - 2.5;
    let garden = [at(x, -0.2, z - 4.5), at(x, -0.2, z + 4.5), at(x, 4.3, z + 4.5), at(x, 4.3, z - 4.5)];
    model.add("garden", "garden", Mesh::quad(garden, Vec2::ONE));
}
