// SPDX-License-Identifier: MIT OR Apache-2.0
//! Towels, the laundry basket, the bath mat, the stool, and the tall plant.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, ring_path, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cloth::{folded_towel, hung_towel};
use crate::scene::builtin::parts::plants::slit_leaved;
use crate::scene::builtin::parts::shell::{Outline, swept};

/// Adds all cloth and wicker, the stool and the plant.
pub fn add(model: &mut Model, p: &Parameters) {
    towel_rail(model, at(-1.13, 0.0, p.room.back), p);
    draped_towel(model, p);
    basket(model, at(-1.14, 0.0, p.room.back + 0.36), p);
    mat(model, at(-0.02, 0.0005, 0.35), p);
    stool(model, at(0.02, 0.0, -0.48), p);
    plant(model, at(p.room.right - 0.30, 0.0, p.room.back + p.shower.size[1] + 0.30), p);
}

/// Two towels on two rails, one above the other.
fn towel_rail(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let sides = p.small_sides * 2;
    let mut chrome = Mesh::default();
    for (y, z) in [(1.50, 0.09), (1.12, 0.09)] {
        chrome.append(&Mesh::tube(&[at(-0.19, y, z), at(0.19, y, z)], 0.009, 14, false));
        for x in [-0.175, 0.175] {
            chrome.append(&Mesh::tube(&[at(x, y, 0.001), at(x, y, z)], 0.007, 12, false));
            let wall = if y > 1.2 { 0.0005 } else { 0.0 };
            let rose = Mesh::lathe(&[(0.022, 0.0), (0.020, 0.006), (0.0, 0.007)], sides).turned_x(0.25);
            chrome.append(&rose.moved(at(x, y, wall + 0.0005)));
        }
    }
    model.add("towel-rail", "chrome", put(chrome));
    let scale = Vec2::new(4.0, 9.0);
    let upper = hung_towel(0.30, 0.30, 0.26, 0.0135, p.towel_cells, 0.1);
    model.add("towel-upper", "towel-coral", put(upper.with_texture_scale(scale).moved(at(0.0, 1.50, 0.09))));
    let lower = hung_towel(0.32, 0.46, 0.40, 0.0135, p.towel_cells, 0.45);
    model.add("towel-lower", "towel-teal", put(lower.with_texture_scale(scale).moved(at(0.0, 1.12, 0.09))));
}

/// A white towel over the near end of the tub's inner long side.
fn draped_towel(model: &mut Model, p: &Parameters) {
    let spot = super::bath::spot(p);
    // Over the rim, which is thicker than a rail; the longer part hangs outside.
    let towel = hung_towel(0.42, 0.44, 0.22, 0.046, p.towel_cells, 0.3);
    let towel = towel.with_texture_scale(Vec2::new(5.0, 8.0)).turned_y(-0.25);
    let place = at(-0.5 * p.tub.size[0] - 0.016, super::bath::RIM - 0.026, 0.18);
    model.add("towel-on-tub", "towel-coral", spot.put(towel.moved(place)));
}

/// A round laundry basket of wicker, with cloth looking out.
fn basket(model: &mut Model, place: Vec3, p: &Parameters) {
    let (low, high, tall) = (0.15, 0.185, 0.46);
    let rows = 24;
    // An even number: the weave closes after one round.
    let stakes = p.stakes & !1;
    let mut wicker = Mesh::default();
    let radius = |y: f32| low + (high - low) * (y / tall);
    for k in 0..stakes {
        let (c, s) = cos_sin(k as f32 / stakes as f32);
        let path = [at(c * low, 0.012, -s * low), at(c * high, tall, -s * high)];
        wicker.append(&Mesh::tube(&path, 0.0036, 5, false));
    }
    // Each weaver passes before and behind the stakes in turn, and the next row the other way around.
    for row in 0..rows {
        let y = 0.012 + (tall - 0.02) * row as f32 / (rows - 1) as f32;
        let side = if row % 2 == 0 { 1.0 } else { -1.0 };
        let pieces = stakes * 3;
        let path: Vec<Vec3> = (0..pieces)
            .map(|i| {
                let t = i as f32 / pieces as f32;
                let (c, s) = cos_sin(t);
                let (swing, _) = cos_sin(0.5 * t * stakes as f32);
                let r = radius(y) + 0.0058 * side * swing;
                at(c * r, y, -s * r)
            })
            .collect();
        wicker.append(&Mesh::tube(&path, 0.0062, 5, true));
    }
    for (y, grow) in [(tall + 0.002, 0.0), (0.010, 0.004)] {
        wicker.append(&Mesh::tube(&ring_path(radius(y) + grow, radius(y) + grow, y, 72), 0.011, 10, true));
    }
    wicker.append(&Mesh::lathe(&[(0.0, 0.006), (low, 0.006), (low, 0.010), (0.0, 0.010)], 40));
    for side in [-1.0, 1.0] {
        let grip = [
            at(side * high, tall - 0.03, -0.06),
            at(side * (high + 0.03), tall + 0.03, -0.04),
            at(side * (high + 0.03), tall + 0.03, 0.04),
            at(side * high, tall - 0.03, 0.06),
        ];
        wicker.append(&Mesh::tube(&smooth_path(&grip, 6, false), 0.007, 8, false));
    }
    model.add("basket", "wicker", wicker.moved(place));
    // Crumpled cloth fills it to the brim.
    let cells = p.towel_cells;
    let heap = Mesh::sheet(cells * 2, cells * 2, |u, v| {
        let (x, z) = (2.0 * u - 1.0, 1.0 - 2.0 * v);
        let (x, z) = (x * (1.0 - 0.5 * z * z).sqrt(), z * (1.0 - 0.5 * x * x).sqrt());
        let (a, _) = cos_sin(u * 3.1 + v * 1.7);
        let (b, _) = cos_sin(v * 4.3 - u * 1.3 + 0.2);
        let lift = 0.05 * (1.0 - x * x - z * z) + 0.018 * a + 0.014 * b;
        at(x * 0.172, tall - 0.02 + lift, z * 0.172)
    });
    model.add("laundry", "towel-white", heap.with_texture_scale(Vec2::new(5.0, 5.0)).moved(place));
}

/// A mat of bobbles.
fn mat(model: &mut Model, place: Vec3, p: &Parameters) {
    let [across, along] = p.mat;
    let (w, d) = (0.27, 0.40);
    let base = swept(&[(0.0, 0.0), (0.0, 0.008), (-0.006, 0.012)], Outline::new(w, d, 0.03), 40, [false, true]);
    let mut mat = base;
    let mut random = Random::new(p.seed.wrapping_add(23));
    let r = (w / across as f32).min(d / along as f32);
    let bobble = Mesh::lathe(&[(r * 0.98, 0.0), (r * 0.92, r * 0.55), (r * 0.58, r * 1.0), (0.0, r * 1.2)], 7);
    for j in 0..along {
        for i in 0..across {
            let x = -w + 2.0 * w * (i as f32 + 0.5) / across as f32;
            let z = -d + 2.0 * d * (j as f32 + 0.5) / along as f32;
            let shift = at(random.range(-0.12, 0.12) * r, random.range(-0.25, 0.1) * r, random.range(-0.12, 0.12) * r);
            mat.append(&bobble.clone().turned_y(random.range(0.0, 0.125)).moved(at(x, 0.010, z) + shift));
        }
    }
    model.add("bath-mat", "mat", mat.turned_y(0.012).moved(place));
}

/// A three-legged stool with folded towels and a book.
fn stool(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let tall = 0.44;
    let seat = [
        (0.0, tall - 0.03),
        (0.160, tall - 0.03),
        (0.168, tall - 0.024),
        (0.168, tall - 0.006),
        (0.162, tall),
        (0.0, tall),
    ];
    let mut wood = Mesh::lathe(&seat, p.ceramic_sides).with_plan_texture(1.8);
    for k in 0..3 {
        let leg = [at(0.105, tall - 0.03, 0.0), at(0.165, 0.0, 0.0)];
        let leg = Mesh::tapered_tube(&smooth_path(&leg, 6, false), |t| 0.0185 - 0.006 * t, 14, false);
        let rung = Mesh::tube(&[at(0.141, 0.17, 0.0), at(-0.0705, 0.17, 0.122)], 0.008, 10, false);
        wood.append(&leg.and(rung).turned_y(k as f32 / 3.0 + 0.05));
    }
    model.add("stool", "oak", put(wood));
    for (k, (kind, wide, deep, turns)) in
        [("towel-teal", 0.25, 0.185, 0.03), ("towel-white", 0.245, 0.18, 0.015), ("towel-coral", 0.235, 0.175, 0.045)]
            .into_iter()
            .enumerate()
    {
        let towel = folded_towel(wide, deep, p.towel_cells).with_texture_scale(Vec2::new(3.0, 8.0));
        model.add(
            format!("folded-towel-{}", k + 1),
            kind,
            put(towel.turned_y(turns).moved(at(0.0, tall + 0.0005 + 0.0425 * k as f32, 0.0))),
        );
    }
}

/// A tall plant in a glazed pot.
fn plant(model: &mut Model, place: Vec3, p: &Parameters) {
    let pot = [
        (0.0, 0.0),
        (0.12, 0.0),
        (0.165, 0.10),
        (0.185, 0.28),
        (0.195, 0.30),
        (0.195, 0.35),
        (0.175, 0.35),
        (0.165, 0.31),
        (0.0, 0.30),
    ];
    model.add("plant-pot", "teal-glaze", Mesh::lathe(&pot, p.ceramic_sides).moved(place));
    let soil = Mesh::lathe(&[(0.166, 0.316), (0.0, 0.325)], 32);
    model.add("plant-soil", "soil", soil.moved(place));
    let (stems, leaves) = slit_leaved(p.leaves, p.seed);
    model.add("plant-stems", "stem", stems.moved(place));
    model.add("plant-leaves", "leaf", leaves.moved(place));
}
