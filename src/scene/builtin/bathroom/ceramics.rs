// SPDX-License-Identifier: MIT OR Apache-2.0
//! The toilet, its paper and brush, and the shelf above it.

use glam::Vec3;

use super::vanity::dispenser;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bottle, jar, jar_filling};
use crate::scene::builtin::parts::plants::potted_herb;
use crate::scene::builtin::parts::shell::{Outline, curve, swept, vessel};

/// x of the toilet's middle.
const MIDDLE: f32 = -1.59;

/// Adds toilet, paper, brush and shelf.
pub fn add(model: &mut Model, p: &Parameters) {
    let place = at(MIDDLE, 0.0, p.room.back);
    toilet(model, place, p);
    paper_and_brush(model, place, p);
    shelf(model, place, p);
}

/// Bowl, seat, lid and cistern; it looks to +z.
fn toilet(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let sides = p.ceramic_sides;
    // The bowl is as wide as 1 and longer than wide; its foot reaches to the wall.
    let outside = curve(
        &[(0.120, 0.0), (0.124, 0.02), (0.104, 0.07), (0.106, 0.15), (0.150, 0.26), (0.182, 0.34), (0.190, 0.385)],
        4,
    );
    let mut wall = vec![(0.0, 0.0)];
    wall.extend(outside);
    let bowl = Mesh::lathe(&vessel(&wall, 0.028, 0.20), sides).stretched(at(1.0, 1.0, 1.32));
    let back = swept(
        &curve(&[(-0.02, 0.0), (-0.02, 0.1), (-0.01, 0.22), (0.0, 0.37), (-0.01, 0.38)], 4),
        Outline::new(0.12, 0.12, 0.06),
        sides,
        [true, true],
    );
    model.add("toilet", "ceramic", put(bowl.moved(at(0.0, 0.0, 0.43)).and(back.moved(at(0.0, 0.0, 0.145)))));
    let ring = curve(
        &[
            (0.118, 0.394),
            (0.125, 0.389),
            (0.184, 0.389),
            (0.196, 0.397),
            (0.190, 0.409),
            (0.155, 0.413),
            (0.126, 0.405),
            (0.118, 0.394),
        ],
        2,
    );
    let ring = Mesh::lathe(&ring, sides).stretched(at(1.0, 1.0, 1.30));
    let lid = curve(&[(0.180, 0.4155), (0.194, 0.419), (0.190, 0.431), (0.120, 0.440), (0.0, 0.443)], 4);
    let lid = Mesh::lathe(&lid, sides).stretched(at(1.0, 1.0, 1.29));
    model.add("toilet-seat", "white-plastic", put(ring.and(lid).moved(at(0.0, 0.0, 0.43))));
    let tank = swept(
        &[(-0.03, 0.388), (-0.016, 0.396), (-0.004, 0.50), (0.0, 0.735)],
        Outline::new(0.20, 0.088, 0.045),
        sides,
        [true, true],
    );
    let cover = swept(
        &[(-0.006, 0.736), (0.008, 0.742), (0.008, 0.756), (-0.008, 0.768), (-0.030, 0.771)],
        Outline::new(0.20, 0.088, 0.045),
        sides,
        [true, true],
    );
    model.add("cistern", "ceramic", put(tank.and(cover).moved(at(0.0, 0.0, 0.100))));
    let button = [(0.030, 0.7705), (0.029, 0.776), (0.020, 0.778), (0.019, 0.7765), (0.0, 0.777)];
    model.add("flush-button", "chrome", put(Mesh::lathe(&button, p.small_sides * 2).moved(at(0.0, 0.0, 0.100))));
    let pipe = [
        at(-0.16, 0.10, 0.0),
        at(-0.16, 0.10, 0.05),
        at(-0.165, 0.14, 0.075),
        at(-0.17, 0.30, 0.08),
        at(-0.17, 0.40, 0.085),
    ];
    let pipe = Mesh::tube(&smooth_path(&pipe, 6, false), 0.006, 10, false).and(
        Mesh::lathe(&[(0.016, 0.0), (0.014, 0.008), (0.0, 0.009)], p.small_sides)
            .turned_x(0.25)
            .moved(at(-0.16, 0.10, 0.0005)),
    );
    model.add("supply-pipe", "chrome", put(pipe));
}

/// A roll on its holder to the right of the toilet, and a brush in its pot.
fn paper_and_brush(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let sides = p.small_sides * 2;
    let (x, y, z) = (0.335, 0.70, 0.072);
    let holder = Mesh::tube(&[at(x - 0.085, y, 0.001), at(x - 0.085, y, z)], 0.005, 10, false)
        .and(Mesh::tube(&[at(x - 0.085, y, z), at(x + 0.07, y, z)], 0.005, 10, false))
        .and(Mesh::sphere(0.0075, 12, 8).moved(at(x - 0.085, y, z)))
        .and(Mesh::lathe(&[(0.024, 0.0), (0.022, 0.006), (0.0, 0.007)], sides).turned_x(0.25).moved(at(
            x - 0.085,
            y,
            0.0005,
        )));
    model.add("paper-holder", "chrome", put(holder));
    let roll = [(0.020, -0.048), (0.054, -0.048), (0.054, 0.048), (0.020, 0.048), (0.020, -0.048)];
    let roll = Mesh::lathe(&roll, sides).turned_z(0.25).moved(at(x, y - 0.014, z));
    let sheet = Mesh::sheet(8, 8, |u, v| {
        let (bend, deep) = (0.004 * (1.0 - v) * (1.0 - v), 0.13);
        at(x + (u - 0.5) * 0.095, y - 0.014 - deep * (1.0 - v), z + 0.0545 + bend)
    });
    model.add("paper", "paper", put(roll.and(sheet)));
    let (x, z) = (0.30, 0.15);
    let pot = curve(&[(0.045, 0.0), (0.052, 0.008), (0.050, 0.06), (0.044, 0.12)], 4);
    let mut wall = vec![(0.0, 0.0)];
    wall.extend(pot);
    model.add("brush-pot", "ceramic", put(Mesh::lathe(&vessel(&wall, 0.004, 0.008), sides).moved(at(x, 0.0005, z))));
    let stem = Mesh::tube(&[at(x, 0.02, z), at(x + 0.006, 0.34, z - 0.01)], 0.006, 10, false)
        .and(Mesh::sphere(0.014, 14, 10).moved(at(x + 0.006, 0.35, z - 0.01)));
    model.add("brush", "chrome", put(stem));
}

/// Two boards above the cistern with bottles, jars and a plant.
fn shelf(model: &mut Model, place: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(place);
    let sides = p.small_sides;
    let (w, deep) = (0.30, 0.17);
    let heights = [1.24, 1.62];
    let mut boards = Mesh::default();
    let mut brackets = Mesh::default();
    for y in heights {
        boards.append(&Mesh::rounded_block(at(-w, y - 0.024, 0.0005), at(w, y, deep), 0.005));
        for x in [-w + 0.07, w - 0.07] {
            let bend = [at(x, y - 0.13, 0.008), at(x, y - 0.05, 0.035), at(x, y - 0.030, deep - 0.03)];
            brackets.append(&Mesh::tube(&smooth_path(&bend, 5, false), 0.006, 8, false));
        }
    }
    model.add("shelf-boards", "oak", put(boards.with_texture_scale(glam::Vec2::splat(1.5))));
    model.add("shelf-brackets", "brass", put(brackets));
    let spot = |x: f32, upper: bool| place + at(x, heights[usize::from(upper)] + 0.0005, 0.085);
    // Below: three bottles with labels, a jar of bath salt, a dispenser.
    for (k, (x, kind, tall, r)) in
        [(-0.25, "soap-green", 0.20, 0.028), (-0.175, "soap-amber", 0.235, 0.030), (-0.10, "soap-blue", 0.18, 0.027)]
            .into_iter()
            .enumerate()
    {
        let n = k + 1;
        model.add(
            format!("shelf-bottle-{n}"),
            kind,
            bottle(r, tall * 0.52, r * 0.36, tall, sides * 3 / 2).moved(spot(x, false)),
        );
        let band = Mesh::lathe(&[(r + 0.0006, tall * 0.12), (r + 0.0006, tall * 0.42)], sides * 3 / 2);
        model.add(
            format!("shelf-label-{n}"),
            "label",
            band.with_texture_scale(glam::Vec2::new(2.0, 1.0)).moved(spot(x, false)),
        );
    }
    for (k, (x, kind)) in [(0.015, "soap-rose"), (0.125, "foam")].into_iter().enumerate() {
        let n = k + 1;
        let (body, lid) = jar(0.046, 0.13, sides * 3 / 2);
        model.add(format!("salt-jar-{n}"), "glass", body.moved(spot(x, false)));
        model.add(format!("salt-lid-{n}"), "chrome", lid.moved(spot(x, false)));
        model.add(
            format!("salt-{n}"),
            kind,
            jar_filling(0.046, 0.13, 0.62 - 0.14 * k as f32, sides).moved(spot(x, false)),
        );
    }
    let (body, pump) = dispenser(0.030, 0.14, sides);
    model.add("shelf-dispenser", "white-plastic", body.moved(spot(0.225, false)));
    model.add("shelf-pump", "brass", pump.turned_y(0.08).moved(spot(0.225, false)));
    // Above: two potted plants and a stack of soap.
    for (k, x) in [-0.22, 0.20].into_iter().enumerate() {
        let [pot, soil, stems, leaves] = potted_herb(0.055, 110, p.seed.wrapping_add(90 + k as u32), sides);
        let n = k + 1;
        model.add(format!("shelf-pot-{n}"), ["ceramic", "terracotta"][k], pot.moved(spot(x, true)));
        model.add(format!("shelf-soil-{n}"), "soil", soil.moved(spot(x, true)));
        model.add(format!("shelf-stems-{n}"), "stem", stems.moved(spot(x, true)));
        model.add(format!("shelf-leaves-{n}"), "herb", leaves.moved(spot(x, true)));
    }
    let mut bars = Mesh::default();
    for k in 0..3 {
        let bar = swept(
            &[(-0.008, 0.0), (0.0, 0.007), (0.0, 0.016), (-0.008, 0.023)],
            Outline::new(0.042, 0.028, 0.014),
            40,
            [true, true],
        );
        bars.append(&bar.turned_y(0.03 * k as f32 - 0.02).moved(spot(-0.02, true) + at(0.0, 0.0235 * k as f32, 0.0)));
    }
    model.add("shelf-soap", "soap-green", bars);
}
