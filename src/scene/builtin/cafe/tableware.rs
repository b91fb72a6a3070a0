// SPDX-License-Identifier: MIT OR Apache-2.0
//! What stands on the tables: cups, plates, a carafe, a glass of juice, a croissant, a vase.

use glam::Vec3;

use super::furniture::TABLE_HEIGHT;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{cup, plate, tumbler};
use crate::scene::builtin::parts::food::croissant;

/// Adds the tableware: the first table is laid, the others bear a cup each.
pub fn add(model: &mut Model, p: &Parameters) {
    let spot = |i: usize, dx: f32, dz: f32| {
        let table = p.tables[i.min(p.tables.len() - 1)];
        let scale = table.radius / 0.38;
        at(table.at[0] + dx * scale, TABLE_HEIGHT + 0.0002, table.at[1] + dz * scale)
    };
    carafe(model, spot(0, -0.05, -0.17), p.glass_sides);
    juice(model, spot(0, 0.17, -0.06), p.glass_sides);
    served_cup(model, "cup-1", spot(0, -0.15, 0.08), 0.42, p);
    let place = spot(0, 0.10, 0.16);
    model.add("plate", "porcelain", plate(0.105, p.cup_sides * 3 / 2).moved(place));
    model.add("croissant", "crust", croissant().turned_y(0.08).moved(place + at(0.0, 0.014, -0.01)));
    vase(model, spot(1, 0.02, -0.12), p);
    served_cup(model, "cup-2", spot(1, 0.17, 0.05), 0.1, p);
    served_cup(model, "cup-3", spot(1, -0.16, 0.06), 0.6, p);
    if p.tables.len() > 2 {
        served_cup(model, "cup-4", spot(2, -0.08, 0.13), 0.8, p);
        let cover = Mesh::block(at(-0.075, 0.0, -0.105), at(0.075, 0.004, 0.105));
        let pages = Mesh::block(at(-0.072, 0.004, -0.1), at(0.074, 0.026, 0.1));
        let lid = cover.clone().moved(at(0.0, 0.026, 0.0));
        let place = spot(2, 0.13, 0.02);
        model.add("read-book-cover", "book-red", cover.and(lid).turned_y(0.06).moved(place));
        model.add("read-book-pages", "paper", pages.turned_y(0.06).moved(place));
    }
}

/// A cup of coffee with its saucer and spoon.
fn served_cup(model: &mut Model, name: &str, place: Vec3, turns: f32, p: &Parameters) {
    let put = |mesh: Mesh| mesh.turned_y(turns).moved(place);
    let above = at(0.0, 0.0102, 0.0);
    let sides = p.cup_sides * 4 / 3;
    model.add(name, "porcelain", put(cup(sides).moved(above).and(plate(0.072, sides))));
    let surface = Mesh::lathe(&[(0.0362, 0.051), (0.0, 0.052)], sides).moved(above);
    model.add(format!("{name}-coffee"), "coffee", put(surface));
    let handle = [at(-0.03, 0.018, 0.050), at(0.02, 0.020, 0.052), at(0.075, 0.021, 0.046)];
    let spoon = Mesh::tapered_tube(&smooth_path(&handle, 2, false), |t| 0.0018 + 0.0012 * t, 5, false);
    let bowl = Mesh::sphere(0.012, 8, 4).stretched(at(1.5, 0.35, 1.0)).moved(at(-0.043, 0.0185, 0.049));
    model.add(format!("{name}-spoon"), "chrome", put(spoon.and(bowl)));
}

/// A carafe with walls of 3 mm, half full.
fn carafe(model: &mut Model, place: Vec3, sides: u32) {
    let outside = [
        (0.050, 0.0),
        (0.058, 0.006),
        (0.064, 0.030),
        (0.064, 0.070),
        (0.055, 0.115),
        (0.036, 0.155),
        (0.027, 0.190),
        (0.028, 0.220),
        (0.036, 0.250),
    ];
    let inside = |(r, y): (f32, f32)| (r - 0.003, if y < 0.01 { y + 0.006 } else { y });
    let mut profile = vec![(0.0, 0.0)];
    profile.extend(outside);
    profile.extend(outside.iter().rev().map(|&q| inside(q)));
    profile.push((0.0, 0.006));
    model.add("carafe", "glass", Mesh::lathe(&profile, sides).moved(place));
    // The drink ends in the middle of the glass: no two surfaces coincide, and no ray is lost between them.
    let gap = |(r, y): (f32, f32)| (r - 0.0015, y);
    let mut drink = vec![(0.0, 0.003), (0.050, 0.003)];
    drink.extend(outside[2..5].iter().map(|&q| gap(q)));
    drink.push((0.0, 0.115));
    model.add("carafe-drink", "tea", Mesh::lathe(&drink, sides).moved(place));
}

/// A tumbler of juice with a straw.
fn juice(model: &mut Model, place: Vec3, sides: u32) {
    let (low, high, tall) = (0.028, 0.037, 0.125);
    let wall = |y: f32| low + (high - low) * y / tall;
    let t = 0.0025;
    model.add("tumbler", "glass", tumbler(low, high, tall, t, sides).moved(place));
    let gap = 0.5 * t;
    let drink = [(0.0, 0.005), (wall(0.005) - gap, 0.005), (wall(0.092) - gap, 0.092), (0.0, 0.092)];
    model.add("juice", "juice", Mesh::lathe(&drink, sides).moved(place));
    let straw = Mesh::tube(&[at(0.012, 0.093, 0.004), at(-0.030, 0.185, -0.010)], 0.0032, 8, false);
    model.add("straw", "berry", straw.moved(place));
}

/// A small vase with three roses.
fn vase(model: &mut Model, place: Vec3, p: &Parameters) {
    let profile = [
        (0.0, 0.0),
        (0.022, 0.0),
        (0.032, 0.02),
        (0.034, 0.05),
        (0.018, 0.095),
        (0.016, 0.115),
        (0.021, 0.125),
        (0.012, 0.116),
        (0.0, 0.11),
    ];
    model.add("vase", "porcelain", Mesh::lathe(&profile, p.cup_sides).moved(place));
    let mut stems = Mesh::default();
    let mut petals = Mesh::default();
    for (i, (x, y, z)) in [(-0.05, 0.24, 0.01), (0.045, 0.255, -0.02), (0.0, 0.285, 0.03)].into_iter().enumerate() {
        let stem = [at(0.0, 0.10, 0.0), at(x * 0.35, 0.17, z * 0.35), at(x, y, z)];
        stems.append(&Mesh::tube(&smooth_path(&stem, 3, false), 0.0022, 5, false));
        for k in 0..4 {
            let (c, s) = cos_sin(0.25 * k as f32 + 0.07 * i as f32);
            let petal = Mesh::sphere(0.018, 7, 4).stretched(at(1.0, 1.15, 0.8)).moved(at(0.010 * c, 0.006, 0.010 * s));
            petals.append(&petal.moved(at(x, y, z)));
        }
    }
    model.add("vase-stems", "stem", stems.moved(place));
    model.add("vase-roses", "rose", petals.moved(place));
}
