// SPDX-License-Identifier: MIT OR Apache-2.0
//! The dining table, laid for as many as there are chairs up to four; chairs and lamps.

use glam::Vec3;

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bowl, fork, knife, plate, spoon, tumbler};
use crate::scene::builtin::parts::food::{apple, croissant, pear, stalk};
use crate::scene::builtin::parts::furniture::{slatted_chair, table};
use crate::scene::builtin::parts::lamps;
use crate::scene::builtin::parts::plants::tulips;
use crate::scene::builtin::parts::shell::{Outline, curve, swept, vessel};

/// Height of the table's top.
const TOP: f32 = 0.75;

/// Adds table, chairs and lamps, and lays the table.
pub fn add(model: &mut Model, p: &Parameters) {
    let half = [0.5 * p.table.size[0], 0.5 * p.table.size[1]];
    let [x, z] = p.table.at;
    let place = at(x, 0.0, z);
    let (frame, top) = table(half[0], half[1], TOP);
    model.add("table-frame", "cream-paint", frame.moved(place));
    model.add("table-top", "oak", top.moved(place));
    let (wood, seat) = slatted_chair(0.46, 0.96, p.chair_sides);
    for (i, chair) in p.chairs.iter().enumerate() {
        let put = |mesh: &Mesh| mesh.clone().turned_y(chair.turns).moved(at(chair.at[0], 0.0, chair.at[1]));
        model.add(format!("chair-{}", i + 1), "chair-wood", put(&wood));
        model.add(format!("chair-{}-seat", i + 1), "blue-paint", put(&seat));
    }
    for (i, lamp) in p.lamps.iter().enumerate() {
        lamps::pendant(model, i + 1, lamp, "red-enamel", p.room.height, p.round_sides);
    }
    let above = place + at(0.0, TOP + 0.0005, 0.0);
    // Two on each long side.
    let (dx, dz) = (half[0] * 0.5, half[1] - 0.19);
    for (i, (x, z, turns)) in [(-dx, dz, 0.0), (dx, dz, 0.0), (dx, -dz, 0.5), (-dx, -dz, 0.5)].into_iter().enumerate() {
        if i < p.chairs.len() {
            setting(model, i + 1, above + at(x, 0.0, z), turns, p);
        }
    }
    fruit_bowl(model, above + at(0.02, 0.0, 0.0), p);
    carafe(model, above + at(-0.30, 0.0, 0.02), p);
    let vase = above + at(0.36, 0.0, 0.02);
    let [pot, stems, leaves, flowers] = tulips(7, p.seed, p.round_sides);
    model.add("vase", "blue-glaze", pot.moved(vase));
    model.add("tulip-stems", "stem", stems.moved(vase));
    model.add("tulip-leaves", "herb", leaves.moved(vase));
    model.add("tulips", "apple", flowers.moved(vase));
}

/// A plate with a napkin, knife, fork and spoon, and a glass of juice.
fn setting(model: &mut Model, n: usize, place: Vec3, turns: f32, p: &Parameters) {
    let put = |mesh: Mesh| mesh.turned_y(turns).moved(place);
    let mat =
        swept(&[(0.0, 0.0), (-0.001, 0.002)], Outline::new(0.21, 0.15, 0.02), 40, [false, true]).with_plan_texture(9.0);
    model.add(format!("mat-{n}"), "red-cloth", put(mat));
    model.add(format!("plate-{n}"), "porcelain", put(plate(0.12, p.round_sides * 3 / 2).moved(at(0.0, 0.0021, 0.0))));
    let lift = at(0.0, 0.0022, 0.01);
    let cutlery = fork(-0.155).and(knife(0.150)).and(spoon(0.182));
    model.add(format!("cutlery-{n}"), "chrome", put(cutlery.moved(lift)));
    let glass = at(0.19, 0.0005, -0.13);
    let (low, high, tall, t) = (0.027, 0.034, 0.105, 0.0025);
    model.add(format!("glass-{n}"), "glass", put(tumbler(low, high, tall, t, p.small_sides).moved(glass)));
    let wall = |y: f32| low + (high - low) * y / tall - 0.5 * t;
    let drink = [(0.0, 0.005), (wall(0.005), 0.005), (wall(0.07), 0.07), (0.0, 0.07)];
    model.add(format!("juice-{n}"), "juice", put(Mesh::lathe(&drink, p.small_sides).moved(glass)));
    let above = at(0.0, 0.0122, 0.0);
    match n % 4 {
        // A bowl of soup, a croissant, a buttered roll.
        1 => {
            model.add(format!("soup-bowl-{n}"), "blue-glaze", put(bowl(0.078, 0.055, p.round_sides).moved(above)));
            model.add(
                format!("soup-{n}"),
                "paprika",
                put(Mesh::lathe(&[(0.069, 0.036), (0.0, 0.0365)], p.round_sides).moved(above)),
            );
        }
        2 => model.add(
            format!("croissant-{n}"),
            "crust",
            put(croissant().turned_y(0.1).moved(above + at(0.0, 0.004, -0.01))),
        ),
        3 => {
            model.add(
                format!("roll-{n}"),
                "crust",
                put(Mesh::sphere(0.045, 20, 12).stretched(at(1.2, 0.7, 0.95)).moved(above + at(-0.01, 0.030, 0.0))),
            );
            model.add(
                format!("butter-{n}"),
                "butter",
                put(Mesh::rounded_block(at(0.048, 0.0, -0.012), at(0.075, 0.013, 0.012), 0.002).moved(above)),
            );
        }
        _ => model.add(format!("napkin-{n}"), "blue-glaze", put(napkin().moved(above))),
    }
}

/// A napkin that is folded to a fan, and stands.
fn napkin() -> Mesh {
    let sheet = Mesh::sheet(24, 4, |u, v| {
        let (c, s) = cos_sin(0.06 + 0.38 * u);
        let f = u * 6.0 - (u * 6.0).floor();
        let fold = (f - 0.5).abs() * 0.018;
        let r = 0.012 + 0.075 * v;
        at(c * r, 0.002 + s * r * 1.15, fold * (0.3 + v) - 0.004)
    });
    let mut back = sheet.clone();
    back.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    back.normals.iter_mut().for_each(|n| *n = -*n);
    sheet.and(back.moved(at(0.0, 0.0, 0.001)))
}

/// A wide bowl heaped with fruit.
fn fruit_bowl(model: &mut Model, place: Vec3, p: &Parameters) {
    let outside = curve(&[(0.055, 0.0), (0.060, 0.008), (0.110, 0.030), (0.158, 0.075)], 4);
    let mut wall = vec![(0.0, 0.0)];
    wall.extend(outside);
    model.add(
        "fruit-bowl",
        "yellow-glaze",
        Mesh::lathe(&vessel(&wall, 0.005, 0.008), p.round_sides * 4 / 3).moved(place),
    );
    let mut random = Random::new(p.seed.wrapping_add(9));
    let mut kinds = [Mesh::default(), Mesh::default(), Mesh::default()];
    let mut stalks = Mesh::default();
    for k in 0..p.fruit {
        // Rings of six, each a layer higher and further in, as fruit lies in a bowl.
        let (layer, i) = (k / 6, k % 6);
        let reach = [0.092, 0.055, 0.020][(layer as usize).min(2)];
        let (c, s) = cos_sin((i as f32 + 0.5 * (layer % 2) as f32) / 6.0 + random.range(-0.015, 0.015));
        let spot = place + at(c * reach, 0.022 + 0.048 * layer as f32, -s * reach);
        let turn = random.range(0.0, 1.0);
        let tilt = random.range(-0.06, 0.06);
        let put = |mesh: Mesh| mesh.turned_z(tilt).turned_y(turn).moved(spot);
        match k % 3 {
            0 => {
                kinds[0].append(&put(apple(p.small_sides)));
                stalks.append(&put(stalk(0.062)));
            }
            1 => kinds[1].append(&put(Mesh::sphere(0.038, p.small_sides, p.small_sides / 2 + 2)
                .stretched(at(1.0, 0.94, 1.0))
                .moved(at(0.0, 0.037, 0.0)))),
            _ => kinds[2].append(&put(pear(p.small_sides).turned_x(0.2).moved(at(0.0, 0.036, -0.03)))),
        }
    }
    for (mesh, (name, material)) in
        kinds.into_iter().zip([("apples", "apple"), ("oranges", "orange"), ("pears", "pear")])
    {
        if !mesh.triangles.is_empty() {
            model.add(name, material, mesh);
        }
    }
    if !stalks.triangles.is_empty() {
        model.add("apple-stalks", "stalk", stalks);
    }
}

/// A glass jug of juice with a handle.
fn carafe(model: &mut Model, place: Vec3, p: &Parameters) {
    let outside = [
        (0.0, 0.0),
        (0.052, 0.0),
        (0.058, 0.006),
        (0.060, 0.05),
        (0.058, 0.12),
        (0.048, 0.165),
        (0.045, 0.195),
        (0.054, 0.225),
    ];
    let sides = p.round_sides;
    model.add("jug", "glass", Mesh::lathe(&vessel(&outside, 0.003, 0.007), sides).moved(place));
    let inside = [(0.0, 0.0035), (0.0505, 0.0035), (0.0565, 0.010), (0.0585, 0.05), (0.0565, 0.12), (0.0, 0.12)];
    model.add("jug-juice", "juice", Mesh::lathe(&inside, sides).moved(place));
    let grip = [
        at(0.049, 0.19, 0.0),
        at(0.085, 0.19, 0.0),
        at(0.100, 0.14, 0.0),
        at(0.085, 0.07, 0.0),
        at(0.0605, 0.055, 0.0),
    ];
    let grip = Mesh::tube(&smooth_path(&grip, 5, false), 0.006, 10, false).turned_y(-0.12);
    model.add("jug-handle", "glass", grip.moved(place));
}
