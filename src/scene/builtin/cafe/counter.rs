// SPDX-License-Identifier: MIT OR Apache-2.0
//! The counter with the espresso machine, the cake display and the cake dome; the shelves behind it.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, ring_path, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bottle, cup, plate};

/// Left and right end of the counter.
const ENDS: [f32; 2] = [-2.05, 0.72];
/// Back and front of the counter's body.
const SIDES: [f32; 2] = [-2.0, -1.42];
/// Height of the counter's top.
const TOP: f32 = 1.06;

/// Adds the counter and all that stands on it, and the shelves.
pub fn add(model: &mut Model, p: &Parameters) {
    body(model, p);
    espresso_machine(model, at(-1.32, TOP, -1.72), p);
    display(model, at(-0.33, TOP, -1.68));
    cake_dome(model, at(0.44, TOP, -1.66), p);
    for (k, x) in [-1.83, -1.90].into_iter().enumerate() {
        let mut stack = Mesh::default();
        for i in 0..2 - k {
            stack.append(&cup(p.cup_sides).moved(at(x, TOP + 0.05 * i as f32, -1.58 - 0.13 * k as f32)));
        }
        model.add(format!("cup-stack-{}", k + 1), "porcelain", stack);
    }
    shelves(model, p);
}

fn body(model: &mut Model, p: &Parameters) {
    let ([x0, x1], [z0, z1]) = (ENDS, SIDES);
    let carcass = Mesh::block(at(x0, 0.10, z0), at(x1, TOP - 0.05, z1));
    model.add("counter-body", "walnut", carcass.with_texture_scale(Vec2::splat(0.8)));
    model.add("counter-plinth", "iron", Mesh::block(at(x0 + 0.04, 0.0, z0 + 0.04), at(x1 - 0.04, 0.10, z1 - 0.06)));
    let mut slats = Mesh::default();
    let pitch = (x1 - x0) / p.slats as f32;
    for i in 0..p.slats {
        let x = x0 + pitch * i as f32;
        slats.append(&Mesh::block(at(x + 0.12 * pitch, 0.11, z1), at(x + 0.88 * pitch, TOP - 0.06, z1 + 0.022)));
    }
    // The grain runs upwards along a slat.
    for t in &mut slats.texcoords {
        *t = Vec2::new(t.y * 0.5, t.x * 1.5);
    }
    model.add("counter-slats", "oak", slats);
    let slab = Mesh::rounded_block(at(x0 - 0.04, TOP - 0.05, z0 - 0.03), at(x1 + 0.04, TOP, z1 + 0.09), 0.008);
    model.add("counter-top", "marble", slab.with_plan_texture(0.9));
    let rail_z = z1 + 0.13;
    let mut rail = Mesh::tube(&[at(x0 + 0.05, 0.2, rail_z), at(x1 - 0.05, 0.2, rail_z)], 0.022, 10, false);
    for i in 0..4 {
        let x = x0 + 0.2 + (x1 - x0 - 0.4) * i as f32 / 3.0;
        rail.append(&Mesh::tube(&[at(x, 0.2, rail_z), at(x, 0.2, z1)], 0.012, 8, false));
    }
    model.add("counter-rail", "gilding", rail);
}

/// Two groups with portafilters, steam wands, a gauge, a drip tray, and cups that are kept warm on top.
fn espresso_machine(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let (w, d) = (0.36, 0.20);
    let mut shell = Mesh::rounded_block(at(-w, 0.035, -d), at(w, 0.12, d), 0.014);
    shell.append(&Mesh::rounded_block(at(-w + 0.03, 0.10, -d), at(w - 0.03, 0.36, -0.02), 0.012));
    shell.append(&Mesh::rounded_block(at(-w, 0.345, -d), at(w, 0.385, d - 0.01), 0.010));
    model.add("machine-shell", "chrome", put(shell));
    let mut red = Mesh::rounded_block(at(-w, 0.255, -d + 0.005), at(w, 0.352, d - 0.015), 0.022);
    for side in [-1.0, 1.0] {
        let (a, b) = (side * w, side * (w + 0.035));
        red.append(&Mesh::rounded_block(at(a.min(b), 0.03, -d - 0.01), at(a.max(b), 0.42, d - 0.03), 0.016));
    }
    model.add("machine-panels", "red-enamel", put(red));
    let mut feet = Mesh::default();
    for (x, z) in [(-w + 0.05, -d + 0.04), (w - 0.05, -d + 0.04), (-w + 0.05, d - 0.05), (w - 0.05, d - 0.05)] {
        feet.append(&Mesh::block(at(x - 0.02, 0.0, z - 0.02), at(x + 0.02, 0.04, z + 0.02)));
    }
    let mut tray = Mesh::default();
    for i in 0..13 {
        let x = -w + 0.04 + (2.0 * w - 0.08) * i as f32 / 12.0;
        tray.append(&Mesh::block(at(x - 0.006, 0.119, 0.0), at(x + 0.006, 0.124, d - 0.02)));
    }
    model.add("machine-tray", "iron", put(tray.and(feet)));
    let mut groups = Mesh::default();
    let mut handles = Mesh::default();
    for x in [-0.17, 0.13] {
        let head =
            [(0.0, 0.215), (0.034, 0.215), (0.038, 0.222), (0.038, 0.240), (0.046, 0.243), (0.046, 0.27), (0.0, 0.27)];
        groups.append(&Mesh::lathe(&head, 14).moved(at(x, 0.0, 0.12)));
        for dx in [-0.012, 0.012] {
            let spout = [at(x, 0.212, 0.12), at(x + dx, 0.20, 0.122), at(x + dx * 1.3, 0.188, 0.122)];
            groups.append(&Mesh::tube(&spout, 0.006, 6, false));
        }
        let grip = [at(x, 0.228, 0.155), at(x, 0.225, 0.20), at(x, 0.212, 0.30)];
        handles.append(&Mesh::tapered_tube(&smooth_path(&grip, 3, false), |t| 0.009 + 0.007 * t, 8, false));
    }
    for side in [-1.0, 1.0] {
        let x = side * (w - 0.055);
        let wand = [
            at(x, 0.30, 0.17),
            at(x, 0.28, 0.215),
            at(x + side * 0.012, 0.20, 0.225),
            at(x + side * 0.02, 0.14, 0.215),
        ];
        groups.append(&Mesh::tube(&smooth_path(&wand, 3, false), 0.006, 6, false));
        handles.append(&Mesh::sphere(0.020, 8, 5).moved(at(x, 0.305, 0.20)));
    }
    model.add("machine-groups", "chrome", put(groups));
    model.add("machine-handles", "black-plastic", put(handles));
    let face = |r: f32| {
        let mut disc = Mesh::lathe(&[(r, 0.0), (0.0, 0.001)], 20).with_plan_texture(1.0);
        for t in &mut disc.texcoords {
            *t = *t * (0.5 / r) + Vec2::splat(0.5);
        }
        disc.turned_x(0.25)
    };
    model.add("machine-gauge", "gauge", put(face(0.033).moved(at(-0.02, 0.305, d - 0.013))));
    // A low rail holds the cups on top.
    let y = 0.43;
    let rail = [
        at(-w + 0.02, y, -d + 0.02),
        at(w - 0.02, y, -d + 0.02),
        at(w - 0.02, y, d - 0.03),
        at(-w + 0.02, y, d - 0.03),
    ];
    let mut bars = Mesh::default();
    for k in 0..4 {
        bars.append(&Mesh::tube(&[rail[k], rail[(k + 1) % 4]], 0.005, 6, false));
        bars.append(&Mesh::tube(&[rail[k], rail[k] - at(0.0, 0.05, 0.0)], 0.005, 6, false));
    }
    model.add("machine-rail", "chrome", put(bars));
    // Upside down; only their outsides can be seen.
    let warm = Mesh::lathe(&[(0.041, 0.0), (0.036, 0.034), (0.026, 0.054), (0.020, 0.060), (0.0, 0.060)], 8);
    let mut cups = Mesh::default();
    for (row, count) in [(0, 6), (1, 5)] {
        for i in 0..count {
            let x = 0.11 * (i as f32 - 0.5 * (count - 1) as f32);
            cups.append(&warm.clone().moved(at(x, 0.386, 0.09 - 0.12 * row as f32)));
        }
    }
    model.add("machine-cups", "porcelain", put(cups));
    model.add("machine-cup-below", "porcelain", put(cup(p.cup_sides).turned_y(0.1).moved(at(-0.17, 0.125, 0.125))));
}

/// A glazed case with two shelves of cakes.
fn display(model: &mut Model, place: Vec3) {
    let put = |mesh: Mesh| mesh.moved(place);
    let (w, d, h) = (0.40, 0.20, 0.40);
    let mut wood = Mesh::rounded_block(at(-w, 0.0, -d), at(w, 0.04, d), 0.006);
    wood.append(&Mesh::rounded_block(at(-w, h - 0.025, -d), at(w, h, d), 0.006));
    model.add("display-wood", "oak", put(wood.with_texture_scale(Vec2::splat(2.0))));
    let mut posts = Mesh::default();
    for (x, z) in [(-w, -d), (w, -d), (-w, d), (w, d)] {
        let (x, z) = (x * 0.985, z * 0.97);
        posts.append(&Mesh::block(at(x - 0.006, 0.04, z - 0.006), at(x + 0.006, h - 0.025, z + 0.006)));
    }
    model.add("display-posts", "brass", put(posts));
    let (y0, y1) = (0.04, h - 0.025);
    let (x, z) = (w * 0.985, d * 0.97);
    let front = Mesh::quad([at(-x, y0, z), at(x, y0, z), at(x, y1, z), at(-x, y1, z)], Vec2::ONE);
    let left = Mesh::quad([at(-x, y0, -z), at(-x, y0, z), at(-x, y1, z), at(-x, y1, -z)], Vec2::ONE);
    let right = Mesh::quad([at(x, y0, z), at(x, y0, -z), at(x, y1, -z), at(x, y1, z)], Vec2::ONE);
    model.add("display-panes", "pane", put(front.and(left).and(right)));
    let shelf = Mesh::block(at(-w + 0.012, 0.205, -d + 0.01), at(w - 0.012, 0.213, d - 0.04));
    model.add("display-shelf", "marble", put(shelf));
    let mut dough = Mesh::default();
    let mut glaze = Mesh::default();
    let mut cream = Mesh::default();
    let mut berries = Mesh::default();
    // Below: cupcakes. Above: a layer cake with a slice cut out, and doughnuts.
    for i in 0..4 {
        let x = -0.27 + 0.18 * i as f32;
        for z in [-0.05, 0.09] {
            let base = Mesh::lathe(&[(0.030, 0.0), (0.040, 0.045)], 10);
            dough.append(&base.moved(at(x, 0.041, z)));
            let top = Mesh::lathe(&[(0.040, 0.044), (0.046, 0.054), (0.034, 0.074), (0.014, 0.091), (0.0, 0.097)], 10);
            if (i + usize::from(z > 0.0)) % 2 == 0 { &mut glaze } else { &mut cream }
                .append(&top.moved(at(x, 0.041, z)));
            berries.append(&Mesh::sphere(0.012, 6, 4).moved(at(x, 0.144, z)));
        }
    }
    let (r, y) = (0.125, 0.214);
    let layer =
        |lo: f32, hi: f32, grow: f32| wedge(r + grow, y + lo, y + hi, 0.80, 0.80, 20).moved(at(-0.22, 0.0, -0.01));
    dough.append(&layer(0.0, 0.040, 0.0).and(layer(0.052, 0.092, 0.0)));
    cream.append(&layer(0.040, 0.052, 0.0));
    glaze.append(&layer(0.092, 0.108, 0.003));
    for i in 0..7 {
        let (c, s) = cos_sin(0.83 + 0.11 * i as f32);
        berries.append(&Mesh::sphere(0.013, 6, 4).moved(at(-0.22 + 0.1 * c, y + 0.118, -0.01 - 0.1 * s)));
    }
    for i in 0..4 {
        let (x, z) = (0.02 + 0.085 * i as f32, if i % 2 == 0 { 0.06 } else { -0.06 });
        let ring = ring_path(0.036, 0.036, 0.0, 10);
        let place = at(x, y + 0.021, z);
        dough.append(&Mesh::tube(&ring, 0.0205, 6, true).moved(place));
        let icing = Mesh::tube(&ring, 0.0185, 6, true).moved(place + at(0.0, 0.006, 0.0));
        if i % 2 == 0 { &mut glaze } else { &mut berries }.append(&icing);
    }
    model.add("display-dough", "crust", put(dough));
    model.add("display-chocolate", "chocolate", put(glaze));
    model.add("display-cream", "cream", put(cream));
    model.add("display-berries", "berry", put(berries));
}

/// A part of a cylinder about the y axis: `sweep` turns from `from`, with flat ends.
fn wedge(radius: f32, lo: f32, hi: f32, from: f32, sweep: f32, pieces: u32) -> Mesh {
    let spot = |i: u32| {
        let (c, s) = cos_sin(from + sweep * i as f32 / pieces as f32);
        at(c * radius, 0.0, -s * radius)
    };
    let (down, up) = (Vec3::Y * lo, Vec3::Y * hi);
    let side = Mesh::sheet(pieces, 1, |u, v| {
        let (c, s) = cos_sin(from + sweep * u);
        at(c * radius, lo + (hi - lo) * v, -s * radius)
    });
    let mut mesh = side;
    let plane = |corners: [Vec3; 3], n: Vec3| Mesh {
        positions: corners.to_vec(),
        normals: vec![n; 3],
        texcoords: vec![Vec2::ZERO; 3],
        triangles: vec![[0, 1, 2]],
    };
    for i in 0..pieces {
        let (a, b) = (spot(i), spot(i + 1));
        mesh.append(&plane([up, a + up, b + up], Vec3::Y));
        mesh.append(&plane([down, b + down, a + down], -Vec3::Y));
    }
    let (a, b) = (spot(0), spot(pieces));
    mesh.append(&Mesh::quad([down, a + down, a + up, up], Vec2::ONE));
    mesh.append(&Mesh::quad([b + down, down, up, b + up], Vec2::ONE));
    mesh
}

/// A cherry cake on a stand under a glass dome with thick walls.
fn cake_dome(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let stand = [
        (0.0, 0.0),
        (0.075, 0.0),
        (0.07, 0.012),
        (0.018, 0.03),
        (0.015, 0.075),
        (0.05, 0.095),
        (0.155, 0.102),
        (0.155, 0.114),
        (0.0, 0.114),
    ];
    model.add("cake-stand", "porcelain", put(Mesh::lathe(&stand, 20)));
    let sponge = [(0.0, 0.115), (0.105, 0.115), (0.108, 0.12), (0.108, 0.175), (0.0, 0.176)];
    model.add("cake", "cream", put(Mesh::lathe(&sponge, 20)));
    let icing = [(0.1095, 0.158), (0.112, 0.176), (0.105, 0.186), (0.0, 0.188)];
    let mut coat = Mesh::lathe(&icing, 20);
    for i in 0..10 {
        let (c, s) = cos_sin(i as f32 / 10.0);
        let drop = 0.012 + 0.018 * ((i * 5) % 7) as f32 / 6.0;
        coat.append(&Mesh::sphere(0.014, 6, 4).stretched(at(0.8, 1.0 + drop * 35.0, 0.8)).moved(at(
            0.107 * c,
            0.16,
            -0.107 * s,
        )));
    }
    model.add("cake-icing", "chocolate", put(coat));
    let mut cherries = Mesh::default();
    for i in 0..7 {
        let (c, s) = cos_sin(i as f32 / 7.0);
        cherries.append(&Mesh::sphere(0.0145, 7, 4).moved(at(0.08 * c, 0.199, -0.08 * s)));
    }
    model.add("cake-cherries", "cherry", put(cherries));
    // Outside upwards, inside downwards: one closed shell, 4 mm thick.
    let (r, t, low, wall) = (0.142, 0.004, 0.1155, 0.20);
    let mut profile = vec![(r - t, low), (r, low), (r, wall)];
    let arc = 7;
    for (radius, height, order) in [(r, 0.10, 1), (r - t, 0.10 - t, -1)] {
        for k in 0..=arc {
            let k = if order > 0 { k } else { arc - k };
            let (c, s) = cos_sin(0.25 * k as f32 / arc as f32);
            let x = if k == arc { 0.0 } else { c * radius };
            if order < 0 || k > 0 {
                profile.push((x, wall + s * height));
            }
        }
    }
    profile.push((r - t, low));
    model.add("cake-dome", "glass", put(Mesh::lathe(&profile, p.glass_sides)));
    let knob = [(0.0, 0.2995), (0.008, 0.2995), (0.007, 0.312), (0.016, 0.322), (0.016, 0.334), (0.0, 0.343)];
    model.add("cake-dome-knob", "brass", put(Mesh::lathe(&knob, 14)));
}

/// Two wall shelves with bottles, jars, cups, plates and books, and a low cabinet under them.
fn shelves(model: &mut Model, p: &Parameters) {
    let back = p.room.back;
    let (x0, x1) = (-2.55, -0.62);
    let heights = [1.50, 1.93];
    let mut boards = Mesh::default();
    let mut brackets = Mesh::default();
    for y in heights {
        boards.append(&Mesh::rounded_block(at(x0, y - 0.03, back), at(x1, y, back + 0.24), 0.005));
        for x in [x0 + 0.3, x1 - 0.3] {
            let bend = [at(x, y - 0.16, back + 0.012), at(x, y - 0.06, back + 0.05), at(x, y - 0.032, back + 0.18)];
            brackets.append(&Mesh::tube(&smooth_path(&bend, 2, false), 0.009, 5, false));
            brackets.append(&Mesh::block(at(x - 0.012, y - 0.2, back), at(x + 0.012, y - 0.03, back + 0.012)));
        }
    }
    model.add("shelf-boards", "walnut", boards);
    model.add("shelf-brackets", "iron", brackets);
    let cabinet = Mesh::block(at(x0, 0.0, back), at(x1 + 0.3, 0.88, back + 0.42));
    model.add("cabinet", "walnut", cabinet);
    let top = Mesh::rounded_block(at(x0 - 0.02, 0.88, back), at(x1 + 0.32, 0.915, back + 0.44), 0.006);
    model.add("cabinet-top", "oak", top);
    let mut random = Random::new(p.seed);
    let glass = ["bottle-green", "bottle-amber", "bottle-clear", "bottle-blue"];
    let step = (x1 - x0 - 0.16) / p.bottles as f32;
    for i in 0..p.bottles {
        let x = x0 + 0.08 + step * (i as f32 + 0.5);
        let tall = random.range(0.24, 0.34);
        let r = random.range(0.034, 0.044).min(0.42 * step);
        let place = at(x, heights[1], back + 0.12 + random.range(-0.02, 0.03));
        let kind = glass[(random.range(0.0, 4.0) as usize).min(3)];
        let (shoulder, neck) = (tall * random.range(0.52, 0.62), r * 0.34);
        model.add(format!("bottle-{}", i + 1), kind, bottle(r, shoulder, neck, tall, p.bottle_sides).moved(place));
        let band = Mesh::lathe(&[(r + 0.001, shoulder * 0.28), (r + 0.001, shoulder * 0.82)], p.bottle_sides);
        model.add(format!("label-{}", i + 1), "label", band.with_texture_scale(Vec2::new(2.0, 1.0)).moved(place));
    }
    // The lower shelf: books on the right, jars and a stack of plates on the left.
    let colours = ["book-red", "book-blue", "book-ochre", "book-green", "paper"];
    let mut x = x1 - 0.06;
    for i in 0..p.books {
        let (thick, tall, deep) = (random.range(0.022, 0.045), random.range(0.19, 0.27), random.range(0.13, 0.17));
        x -= thick + 0.002;
        if x < x0 + 1.0 {
            break;
        }
        let book = Mesh::block(at(0.0, 0.0, 0.0), at(thick, tall, deep)).moved(at(x, heights[0], back + 0.04));
        model.add(format!("book-{}", i + 1), colours[(i as usize * 3 + i as usize / 5) % 5], book);
    }
    let jar = [(0.058, 0.0), (0.062, 0.012), (0.062, 0.12), (0.050, 0.145), (0.0, 0.146)];
    let lid = [(0.052, 0.1465), (0.054, 0.165), (0.02, 0.172), (0.018, 0.185), (0.0, 0.190)];
    for (i, (x, kind)) in [(-2.40, "cream"), (-2.24, "chocolate"), (-2.08, "terracotta")].into_iter().enumerate() {
        let place = at(x, heights[0], back + 0.13);
        model.add(format!("jar-{}", i + 1), kind, Mesh::lathe(&jar, 12).moved(place));
        model.add(format!("jar-{}-lid", i + 1), "oak", Mesh::lathe(&lid, 12).moved(place));
    }
    let mut plates = Mesh::default();
    for i in 0..4 {
        plates.append(&plate(0.095, p.cup_sides).moved(at(-1.84, heights[0] + 0.012 * i as f32, back + 0.13)));
    }
    for i in 0..3 {
        let place = at(-1.64 + 0.125 * i as f32, heights[0], back + 0.12);
        plates.append(&cup(p.cup_sides).turned_y(0.07 * i as f32 - 0.1).moved(place));
    }
    model.add("shelf-crockery", "porcelain", plates);
}
