// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shelves on the right wall, and what stands on the worktops: jars, crockery, bread, machines, herbs.

use glam::{Vec2, Vec3};

use super::room::WORKTOP;
use super::units::RUN_END;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bottle, bowl, jar, jar_filling, mug, plate, teapot};
use crate::scene::builtin::parts::food::{banana, loaf};
use crate::scene::builtin::parts::plants::potted_herb;
use crate::scene::builtin::parts::shell::{Outline, curve, swept};

/// Heights of the shelves' upper faces.
const SHELVES: [f32; 2] = [1.42, 1.80];

/// Adds shelves and all that stands about.
pub fn add(model: &mut Model, p: &Parameters) {
    shelves(model, p);
    let right = p.room.right;
    toaster(model, at(right - 0.26, WORKTOP, -0.62), p);
    mixer(model, at(right - 0.30, WORKTOP, -1.12), p);
    knife_block(model, at(right - 0.16, WORKTOP, -0.20));
    bread_board(model, at(right - 0.36, WORKTOP, 0.10));
    bottles(model, p);
    canisters(model, p);
    let y = p.window.sill + 0.012;
    let step = (p.window.right - p.window.left) / 3.0;
    for k in 0..3 {
        let place = at(p.window.left + step * (k as f32 + 0.5), y, p.room.back + 0.015);
        let [pot, soil, stems, leaves] = potted_herb(0.052, p.herb_leaves, p.seed.wrapping_add(31 * k), p.small_sides);
        let n = k + 1;
        model.add(format!("herb-pot-{n}"), ["terracotta", "cream-enamel", "terracotta"][k as usize], pot.moved(place));
        model.add(format!("herb-soil-{n}"), "soil", soil.moved(place));
        model.add(format!("herb-stems-{n}"), "stem", stems.moved(place));
        model.add(format!("herb-leaves-{n}"), "herb", leaves.moved(place));
    }
    clock(model, at(0.5 * (p.window.left + p.window.right), 2.42, p.room.back));
}

/// Two boards with jars, bowls, plates, books, a teapot and hanging mugs.
fn shelves(model: &mut Model, p: &Parameters) {
    let right = p.room.right;
    let (z0, z1) = (p.room.back + 0.62, RUN_END - 0.02);
    let mut boards = Mesh::default();
    let mut brackets = Mesh::default();
    for y in SHELVES {
        boards.append(&Mesh::rounded_block(at(right - 0.25, y - 0.028, z0), at(right - 0.0005, y, z1), 0.005));
        for z in [z0 + 0.25, z1 - 0.25] {
            let bend = [at(right - 0.012, y - 0.18, z), at(right - 0.05, y - 0.07, z), at(right - 0.21, y - 0.033, z)];
            brackets.append(&Mesh::tube(&smooth_path(&bend, 4, false), 0.008, 8, false));
            brackets.append(&Mesh::block(
                at(right - 0.012, y - 0.21, z - 0.012),
                at(right - 0.0005, y - 0.0285, z + 0.012),
            ));
        }
    }
    for t in &mut boards.texcoords {
        *t = Vec2::new(t.y, t.x);
    }
    model.add("shelf-boards", "oak", boards);
    model.add("shelf-brackets", "iron", brackets);
    let x = right - 0.125;
    let mut random = Random::new(p.seed);
    // The upper board: glass jars.
    let fillings = ["pasta", "rice", "lentils", "coffee-beans", "dried-herbs", "turmeric"];
    let step = (z1 - z0 - 0.06) / p.jars as f32;
    for k in 0..p.jars {
        let r = (0.42 * step).min(0.062) * random.range(0.86, 1.0);
        let tall = random.range(0.13, 0.22);
        let place = at(x + random.range(-0.02, 0.02), SHELVES[1] + 0.0005, z0 + 0.03 + step * (k as f32 + 0.5));
        let (body, lid) = jar(r, tall, p.small_sides);
        let n = k + 1;
        model.add(format!("jar-{n}"), "glass", body.moved(place));
        model.add(format!("jar-{n}-lid"), if k % 2 == 0 { "walnut" } else { "steel" }, lid.moved(place));
        let filling = jar_filling(r, tall, random.range(0.45, 0.75), p.small_sides);
        model.add(format!("jar-{n}-filling"), fillings[k as usize % 6], filling.moved(place));
    }
    // The lower one, from the corner: plates, bowls, teapot, books.
    let y = SHELVES[0] + 0.0005;
    let mut plates = Mesh::default();
    for k in 0..6 {
        plates.append(&plate(0.105, p.round_sides).moved(at(x, y + 0.0125 * k as f32, z0 + 0.14)));
    }
    model.add("shelf-plates", "porcelain", plates);
    let mut bowls = Mesh::default();
    for k in 0..5 {
        bowls.append(&bowl(0.082, 0.066, p.small_sides).moved(at(x, y + 0.029 * k as f32, z0 + 0.38)));
    }
    model.add("shelf-bowls", "yellow-glaze", bowls);
    model.add("teapot", "blue-glaze", teapot(0.075, p.round_sides).turned_y(0.31).moved(at(x, y, z0 + 0.64)));
    let colours = ["book-red", "book-ochre", "book-green", "cream-paint", "book-red", "book-green"];
    let mut z = z1 - 0.30;
    for (k, colour) in colours.into_iter().enumerate() {
        let (thick, tall, deep) = (random.range(0.022, 0.042), random.range(0.19, 0.25), random.range(0.13, 0.17));
        let cover = Mesh::block(at(-deep, 0.0, 0.0), at(0.0, tall, thick));
        model.add(format!("cookbook-{}", k + 1), colour, cover.moved(at(right - 0.05, y, z)));
        z += thick + 0.0015;
    }
    // Mugs hang from hooks under the lower board.
    for k in 0..6 {
        let z = z0 + 0.30 + 0.155 * k as f32;
        let hook = [
            at(x, SHELVES[0] - 0.028, z),
            at(x, SHELVES[0] - 0.045, z),
            at(x + 0.010, SHELVES[0] - 0.057, z),
            at(x, SHELVES[0] - 0.068, z),
            at(x - 0.01, SHELVES[0] - 0.060, z),
        ];
        model.add(format!("hook-{}", k + 1), "brass", Mesh::tube(&smooth_path(&hook, 2, false), 0.0022, 6, false));
        // Hung by the handle, its mouth towards the room and a little down.
        let cup = mug(0.037, 0.085, p.small_sides).moved(at(-0.060, -0.046, 0.0)).turned_z(0.22);
        let glaze = ["porcelain", "blue-glaze", "yellow-glaze"][k % 3];
        let cup = cup.turned_y(0.25).moved(at(x, SHELVES[0] - 0.068, z));
        model.add(format!("mug-{}", k + 1), glaze, cup);
    }
}

/// A chromed toaster with two slices in it.
fn toaster(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.turned_y(-0.24).moved(place);
    let side = curve(&[(-0.012, 0.02), (0.0, 0.032), (0.002, 0.13), (-0.010, 0.172), (-0.035, 0.186)], 3);
    let shell = swept(&side, Outline::new(0.145, 0.088, 0.045), p.round_sides.max(40), [true, true]);
    model.add("toaster", "chrome", put(shell));
    let base = swept(&[(0.0, 0.0), (0.0, 0.022), (-0.02, 0.024)], Outline::new(0.138, 0.080, 0.04), 40, [true, true]);
    let mut black = base;
    black.append(&Mesh::rounded_block(at(0.146, 0.10, -0.016), at(0.172, 0.118, 0.016), 0.004));
    for z in [-0.030, 0.030] {
        black.append(&Mesh::block(at(-0.105, 0.180, z - 0.014), at(0.105, 0.1868, z + 0.014)));
    }
    model.add("toaster-black", "black-plastic", put(black));
    let slice = |z: f32, turn: f32| {
        let crust = swept(
            &[(-0.003, -0.009), (0.0, -0.006), (0.0, 0.006), (-0.003, 0.009)],
            Outline::new(0.056, 0.05, 0.02),
            40,
            [true, true],
        );
        crust.turned_x(0.25).turned_z(turn).moved(at(0.0, 0.192, z))
    };
    model.add("toast", "crust", put(slice(-0.030, 0.004).and(slice(0.030, -0.006))));
}

/// A stand mixer of red enamel with its steel bowl.
fn mixer(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.turned_y(-0.29).moved(place);
    let foot = swept(
        &[(-0.008, 0.0), (0.0, 0.008), (0.0, 0.026), (-0.012, 0.036)],
        Outline::new(0.10, 0.17, 0.08),
        40,
        [true, true],
    );
    let mut red = foot;
    let column = curve(&[(0.0, 0.03), (-0.006, 0.10), (-0.008, 0.22), (0.004, 0.27)], 3);
    red.append(&swept(&column, Outline::new(0.055, 0.05, 0.035), 40, [false, true]).moved(at(0.0, 0.0, -0.10)));
    // The head: a blunt body of revolution along z.
    let head = curve(
        &[(0.0, -0.17), (0.045, -0.165), (0.068, -0.12), (0.072, 0.0), (0.062, 0.12), (0.048, 0.165), (0.0, 0.172)],
        3,
    );
    let head = Mesh::lathe(&head, p.round_sides).turned_x(0.25).stretched(at(0.92, 1.0, 1.0));
    red.append(&head.moved(at(0.0, 0.315, 0.0)));
    model.add("mixer", "red-enamel", put(red));
    let mut bright =
        Mesh::lathe(&[(0.0725, -0.012), (0.0745, -0.006), (0.0745, 0.006), (0.0725, 0.012)], p.round_sides)
            .turned_x(0.25)
            .stretched(at(0.92, 1.0, 1.0))
            .moved(at(0.0, 0.315, 0.02));
    bright.append(&Mesh::lathe(&[(0.030, 0.225), (0.032, 0.255)], 20).moved(at(0.0, 0.0, 0.085)));
    bright.append(
        &Mesh::lathe(&[(0.018, 0.0), (0.018, 0.014), (0.0, 0.016)], 16).turned_z(-0.25).moved(at(0.062, 0.315, -0.06)),
    );
    let outside = curve(&[(0.055, 0.038), (0.085, 0.06), (0.104, 0.115), (0.108, 0.165)], 3);
    let mut wall = vec![(0.0, 0.0375)];
    wall.extend(outside);
    let wall = crate::scene::builtin::parts::shell::vessel(&wall, 0.0025, 0.004);
    bright.append(&Mesh::lathe(&wall, p.round_sides).moved(at(0.0, 0.0, 0.085)));
    for k in 0..3 {
        let wire = [
            at(0.003, 0.23, 0.0),
            at(0.035, 0.17, 0.0),
            at(0.03, 0.10, 0.0),
            at(0.0, 0.075, 0.0),
            at(-0.03, 0.10, 0.0),
            at(-0.035, 0.17, 0.0),
            at(-0.003, 0.23, 0.0),
        ];
        bright.append(
            &Mesh::tube(&smooth_path(&wire, 4, false), 0.0016, 5, false)
                .turned_y(k as f32 / 6.0)
                .moved(at(0.0, 0.0, 0.085)),
        );
    }
    model.add("mixer-bowl", "chrome", put(bright));
}

/// A slanted wooden block with five knives.
fn knife_block(model: &mut Model, place: Vec3) {
    let put = |mesh: Mesh| mesh.turned_x(0.045).turned_y(-0.27).moved(place + at(0.0, 0.012, 0.0));
    model.add(
        "knife-block",
        "walnut",
        put(Mesh::rounded_block(at(-0.055, 0.018, -0.07), at(0.055, 0.225, 0.07), 0.006)),
    );
    let mut grips = Mesh::default();
    let mut collars = Mesh::default();
    for (x, z, long) in
        [(-0.03, 0.045, 0.09), (0.0, 0.045, 0.10), (0.03, 0.045, 0.085), (-0.018, 0.0, 0.115), (0.022, 0.0, 0.11)]
    {
        collars.append(&Mesh::rounded_block(at(x - 0.007, 0.226, z - 0.012), at(x + 0.007, 0.240, z + 0.012), 0.003));
        let grip = [
            (-0.002, 0.0),
            (0.0, 0.004),
            (0.001, long * 0.4),
            (-0.001, long * 0.7),
            (0.002, long * 0.95),
            (-0.001, long),
        ];
        let grip = swept(&grip, Outline::new(0.008, 0.013, 0.006), 20, [true, true]);
        grips.append(&grip.moved(at(x, 0.240, z)));
    }
    model.add("knife-grips", "black-plastic", put(grips));
    model.add("knife-collars", "steel", put(collars));
}

/// A loaf on a board, two slices, and a board that leans on the wall behind.
fn bread_board(model: &mut Model, place: Vec3) {
    let put = |mesh: Mesh| mesh.turned_y(0.28).moved(place);
    let board = swept(
        &[(-0.003, 0.0), (0.0, 0.003), (0.0, 0.017), (-0.003, 0.02)],
        Outline::new(0.20, 0.13, 0.03),
        40,
        [true, true],
    );
    model.add("bread-board", "walnut", put(board.with_plan_texture(1.5)));
    let mut bread = loaf().moved(at(-0.03, 0.0205, 0.0));
    for (x, turn) in [(0.155, 0.235), (0.175, 0.243)] {
        let slice = swept(
            &[(-0.003, -0.006), (0.0, -0.003), (0.0, 0.003), (-0.003, 0.006)],
            Outline::new(0.036, 0.048, 0.025),
            40,
            [true, true],
        );
        bread.append(&slice.turned_z(turn).moved(at(x - 0.03, 0.056, 0.0)));
    }
    model.add("bread", "crust", put(bread));
    let leaning = swept(
        &[(-0.003, 0.0), (0.0, 0.003), (0.0, 0.015), (-0.003, 0.018)],
        Outline::new(0.15, 0.20, 0.06),
        60,
        [true, true],
    )
    .with_plan_texture(1.5);
    let spot = place + at(0.36 - 0.085, 0.205, -0.02);
    model.add("leaning-board", "oak", leaning.turned_x(0.25).turned_y(-0.25).turned_z(-0.022).moved(spot));
    let mut fruit = Mesh::default();
    for k in 0..3 {
        fruit.append(&banana().turned_y(0.03 * k as f32).moved(at(0.0, 0.020 * k as f32, 0.012 * k as f32)));
    }
    model.add("bananas", "banana", fruit.turned_y(0.1).moved(place + at(-0.08, 0.0, 0.19)));
}

/// Oil, vinegar and wine beside the stove.
fn bottles(model: &mut Model, p: &Parameters) {
    let (x, z) = (super::units::STOVE[1], p.room.back);
    for (k, (dx, dz, kind, tall)) in
        [(0.10, 0.16, "bottle-oil", 0.30), (0.19, 0.12, "bottle-green", 0.33), (0.20, 0.23, "bottle-oil", 0.22)]
            .into_iter()
            .enumerate()
    {
        let place = at(x + dx, WORKTOP + 0.0005, z + dz);
        let n = k + 1;
        model.add(format!("bottle-{n}"), kind, bottle(0.034, tall * 0.55, 0.012, tall, p.small_sides).moved(place));
        model.add(
            format!("cork-{n}"),
            "cork",
            Mesh::lathe(&[(0.010, tall), (0.011, tall + 0.018), (0.0, tall + 0.019)], 12).moved(place),
        );
        let band = Mesh::lathe(&[(0.0346, tall * 0.16), (0.0346, tall * 0.46)], p.small_sides);
        model.add(format!("label-{n}"), "label", band.with_texture_scale(Vec2::new(2.0, 1.0)).moved(place));
    }
}

/// Three enamelled canisters in the corner, and a crock with wooden spoons.
fn canisters(model: &mut Model, p: &Parameters) {
    let (x, z) = (p.room.right - 0.62, p.room.back + 0.17);
    for k in 0..3 {
        let s = 1.0 - 0.14 * k as f32;
        let (r, h) = (0.075 * s, 0.19 * s);
        let place = at(x + 0.185 * k as f32 * 0.93, WORKTOP + 0.0005, z);
        let n = k + 1;
        let body = [(0.0, 0.0), (r * 0.97, 0.0), (r, 0.006), (r, h - 0.01), (r * 0.96, h)];
        model.add(format!("canister-{n}"), "cream-enamel", Mesh::lathe(&body, p.round_sides).moved(place));
        let lid = [
            (r * 1.02, h - 0.008),
            (r * 1.02, h + 0.012),
            (r * 0.9, h + 0.02),
            (r * 0.16, h + 0.026),
            (r * 0.14, h + 0.038),
            (r * 0.26, h + 0.048),
            (0.0, h + 0.056),
        ];
        model.add(format!("canister-{n}-lid"), "red-enamel", Mesh::lathe(&lid, p.round_sides).moved(place));
    }
    let place = at(super::units::STOVE[0] - 0.13, WORKTOP + 0.0005, p.room.back + 0.14);
    let outside = [(0.0, 0.0), (0.052, 0.0), (0.056, 0.006), (0.058, 0.13), (0.063, 0.142)];
    let crock = Mesh::lathe(&crate::scene::builtin::parts::shell::vessel(&outside, 0.006, 0.008), p.round_sides);
    model.add("crock", "blue-glaze", crock.moved(place));
    let mut spoons = Mesh::default();
    for k in 0..5 {
        let (c, s) = cos_sin(0.21 * k as f32 + 0.05);
        let (low, high) = (at(-c * 0.03, 0.012, s * 0.03), at(c * 0.072, 0.24 + 0.018 * (k % 3) as f32, -s * 0.072));
        spoons.append(&Mesh::tube(&[low, high], 0.005, 8, false));
        let head = Mesh::sphere(1.0, 10, 6).stretched(at(0.022, 0.034, 0.008)).turned_y(0.1 * k as f32);
        spoons.append(&head.moved(high + (high - low).normalize() * 0.02));
    }
    model.add("wooden-spoons", "oak", spoons.moved(place));
}

/// A round wall clock above the window.
fn clock(model: &mut Model, middle: Vec3) {
    let r = 0.13;
    let mut face = Mesh::lathe(&[(r, 0.018), (0.0, 0.019)], 40).with_plan_texture(1.0);
    for t in &mut face.texcoords {
        *t = *t * (0.5 / r) + Vec2::splat(0.5);
    }
    model.add("clock", "clock-face", face.turned_x(0.25).moved(middle));
    let rim = [
        (r - 0.002, 0.001),
        (r + 0.020, 0.001),
        (r + 0.022, 0.022),
        (r + 0.012, 0.036),
        (r - 0.002, 0.028),
        (r - 0.002, 0.001),
    ];
    model.add("clock-rim", "red-enamel", Mesh::lathe(&rim, 48).turned_x(0.25).moved(middle));
}
