// SPDX-License-Identifier: MIT OR Apache-2.0
//! The washstand with two bowls, the large mirror between its lamps, and what stands on the marble.

use glam::{Vec2, Vec3};

use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cloth::rolled_towel;
use crate::scene::builtin::parts::crockery::{jar, tumbler};
use crate::scene::builtin::parts::cupboards::{DOOR, knob, panelled};
use crate::scene::builtin::parts::plumbing::lever_tap;
use crate::scene::builtin::parts::shell::{Outline, curve, swept, vessel};
use crate::scene::builtin::parts::walls::framed;

/// Left and right end of the washstand.
const ENDS: [f32; 2] = [-0.92, 0.68];
/// Its depth.
const DEPTH: f32 = 0.52;
/// Height of the marble.
const TOP: f32 = 0.80;

/// Adds washstand, mirror and lamps.
pub fn add(model: &mut Model, p: &Parameters) {
    let place = at(0.0, 0.0, p.room.back);
    stand(model, place, p);
    for (i, x) in [ENDS[0] + 0.40, ENDS[1] - 0.40].into_iter().enumerate() {
        let n = i + 1;
        let spot = place + at(x, TOP, 0.28);
        wash_bowl(model, n, spot, p);
        model.add(format!("tap-{n}"), "chrome", lever_tap(0.29, 0.15).moved(spot + at(0.0, 0.0, -0.225)));
    }
    let middle = 0.5 * (ENDS[0] + ENDS[1]);
    framed(model, "mirror", ("mirror", "walnut"), place + at(middle, 1.56, 0.002), Vec2::new(0.70, 0.44), 0.045);
    for (i, x) in [ENDS[0] - 0.10, ENDS[1] + 0.045].into_iter().enumerate() {
        wall_lamp(model, i + 1, place + at(x, 1.70, 0.0), p);
    }
    on_the_marble(model, place, p);
}

/// Body, doors and drawers, an open shelf with rolled towels, and the marble.
fn stand(model: &mut Model, place: Vec3, p: &Parameters) {
    let ([x0, x1], d) = (ENDS, DEPTH);
    let low = 0.42;
    let top = TOP - 0.03;
    let put = |mesh: Mesh| mesh.moved(place);
    let body = Mesh::block(at(x0, low, 0.014), at(x1, top, d - DOOR));
    let shelf = Mesh::rounded_block(at(x0 + 0.03, 0.14, 0.02), at(x1 - 0.03, 0.17, d - 0.03), 0.005);
    let mut wood = body.and(shelf);
    for x in [x0, x1 - 0.055] {
        for z in [0.014, d - DOOR - 0.056] {
            wood.append(&Mesh::rounded_block(at(x, 0.0, z), at(x + 0.055, low - 0.0005, z + 0.055), 0.006));
        }
    }
    model.add("stand", "walnut", put(wood));
    let mut fronts = Mesh::default();
    let mut knobs = Mesh::default();
    let each = (x1 - x0) / 4.0;
    for k in 0..4 {
        let (a, b) = (x0 + each * k as f32 + 0.003, x0 + each * (k + 1) as f32 - 0.003);
        let z = at(0.0, 0.0, d - DOOR + 0.0005);
        let split = 0.5 * (low + top);
        for (y0, y1) in if k == 0 || k == 3 { vec![(low, top)] } else { vec![(low, split), (split, top)] } {
            fronts.append(&panelled([a, b], [y0 + 0.003, y1 - 0.003], 0.045).moved(z));
            let x = match k {
                0 => b - 0.024,
                3 => a + 0.024,
                _ => 0.5 * (a + b),
            };
            knobs.append(&knob(0.013, p.small_sides).moved(at(x, 0.5 * (y0 + y1), d + 0.0005)));
        }
    }
    model.add("stand-fronts", "walnut", put(fronts));
    model.add("stand-knobs", "brass", put(knobs));
    let edge = [(-0.004, 0.0), (0.0, 0.004), (0.0, 0.024), (-0.004, 0.03)];
    let slab = swept(&edge, Outline::new(0.5 * (x1 - x0) + 0.015, 0.5 * d + 0.008, 0.012), 40, [true, true]);
    let middle = at(0.5 * (x0 + x1), top, 0.5 * d + 0.0085);
    model.add("stand-top", "marble", slab.moved(middle).with_plan_texture(0.8).moved(place));
    let mut rolls = [Mesh::default(), Mesh::default()];
    let r = 0.058;
    for (k, (x, y)) in [(0, 0), (1, 0), (2, 0), (3, 0), (0, 1), (1, 1), (2, 1)].into_iter().enumerate() {
        let spot = at(-0.60 + 2.32 * r * (x as f32 + 0.5 * y as f32), 0.178 + 2.01 * r * y as f32, 0.24);
        let roll = rolled_towel(0.36, r, 3.4, 84).turned_y(0.25).turned_z(0.0);
        rolls[k % 2].append(&roll.moved(spot));
    }
    let [white, coral] = rolls;
    model.add("rolled-towels-white", "towel-white", put(white.with_texture_scale(Vec2::new(3.0, 6.0))));
    model.add("rolled-towels-coral", "towel-coral", put(coral.with_texture_scale(Vec2::new(3.0, 6.0))));
    // A tray of spare soap beside them.
    let tray = swept(
        &[(0.0, 0.0), (0.006, 0.03), (0.0, 0.032), (-0.004, 0.006)],
        Outline::new(0.17, 0.11, 0.03),
        40,
        [true, true],
    );
    model.add("soap-tray", "wicker", put(tray.moved(at(0.33, 0.1705, 0.25))));
    let mut bars = Mesh::default();
    for (x, z, t) in
        [(-0.09, -0.03, 0.01), (0.0, -0.03, -0.02), (0.09, -0.02, 0.03), (-0.04, 0.05, 0.24), (0.06, 0.05, 0.26)]
    {
        let bar = swept(
            &[(-0.008, 0.0), (0.0, 0.008), (0.0, 0.016), (-0.010, 0.026)],
            Outline::new(0.038, 0.025, 0.014),
            40,
            [true, true],
        );
        bars.append(&bar.turned_y(t).moved(at(0.33 + x, 0.177, 0.25 + z)));
    }
    model.add("soap-bars", "soap-rose", put(bars));
}

/// A wash bowl that stands on the marble, with its drain.
fn wash_bowl(model: &mut Model, n: usize, place: Vec3, p: &Parameters) {
    let outside = curve(&[(0.085, 0.0), (0.120, 0.012), (0.172, 0.060), (0.196, 0.118), (0.200, 0.132)], 5);
    let mut wall = vec![(0.0, 0.0)];
    wall.extend(outside);
    let bowl = Mesh::lathe(&vessel(&wall, 0.010, 0.014), p.ceramic_sides).stretched(at(1.16, 1.0, 0.92));
    model.add(format!("wash-bowl-{n}"), "ceramic", bowl.moved(place));
    let drain = [(0.024, 0.0142), (0.023, 0.0185), (0.014, 0.020), (0.0, 0.019)];
    model.add(format!("drain-{n}"), "chrome", Mesh::lathe(&drain, p.small_sides).moved(place));
}

/// An opal globe on a brass arm; its light is in `view.json`, before it.
fn wall_lamp(model: &mut Model, n: usize, place: Vec3, p: &Parameters) {
    let plate = [(0.045, 0.0005), (0.044, 0.008), (0.020, 0.014), (0.016, 0.03), (0.0, 0.031)];
    let arm = [at(0.0, 0.0, 0.028), at(0.0, -0.01, 0.07), at(0.0, 0.012, 0.105), at(0.0, 0.05, 0.11)];
    let holder = [(0.010, 0.035), (0.034, 0.050), (0.038, 0.062), (0.0, 0.063)];
    let brass = Mesh::lathe(&plate, p.small_sides)
        .turned_x(0.25)
        .and(Mesh::tube(&smooth_path(&arm, 5, false), 0.008, 10, false))
        .and(Mesh::lathe(&holder, p.small_sides).moved(at(0.0, 0.0, 0.11)));
    model.add(format!("wall-lamp-{n}"), "brass", brass.moved(place));
    let globe = Mesh::sphere(0.062, p.small_sides * 3 / 2, p.small_sides);
    model.add(format!("wall-globe-{n}"), "opal", globe.moved(place + at(0.0, 0.118, 0.11)));
}

/// Soap dispensers, tooth brushes in a glass, scent bottles, cotton in a jar, a candle.
fn on_the_marble(model: &mut Model, place: Vec3, p: &Parameters) {
    let spot = |x: f32, z: f32| place + at(x, TOP + 0.0005, z);
    let sides = p.small_sides;
    for (k, (x, z, kind)) in [(-0.155, 0.30, "soap-green"), (0.06, 0.16, "soap-amber")].into_iter().enumerate() {
        let n = k + 1;
        let (body, pump) = dispenser(0.032, 0.135, sides);
        model.add(format!("dispenser-{n}"), kind, body.moved(spot(x, z)));
        model.add(format!("pump-{n}"), "chrome", pump.turned_y(0.2 - 0.12 * k as f32).moved(spot(x, z)));
    }
    let glass = spot(-0.06, 0.20);
    model.add("tooth-glass", "glass", tumbler(0.030, 0.036, 0.10, 0.0028, sides * 3 / 2).moved(glass));
    for (k, kind) in ["soap-blue", "soap-rose"].into_iter().enumerate() {
        let side = if k == 0 { -1.0 } else { 1.0 };
        let handle = [at(-side * 0.014, 0.0125, 0.0), at(side * 0.008, 0.09, 0.0), at(side * 0.030, 0.185, 0.0)];
        let handle = Mesh::tapered_tube(&smooth_path(&handle, 6, false), |t| 0.0042 - 0.001 * t, 10, false);
        model.add(format!("tooth-brush-{}", k + 1), kind, handle.moved(glass));
        let bristles =
            Mesh::rounded_block(at(-0.005, -0.013, 0.0), at(0.005, 0.013, 0.014), 0.002).turned_z(-side * 0.035);
        model.add(
            format!("bristles-{}", k + 1),
            "white-plastic",
            bristles.moved(glass + at(side * 0.0275, 0.172, 0.003)),
        );
    }
    // Scent bottles of thick glass, half full.
    for (k, (x, z, half, tall, kind)) in [
        (-0.86, 0.15, 0.030, 0.075, "soap-amber"),
        (-0.80, 0.24, 0.024, 0.095, "soap-rose"),
        (0.625, 0.30, 0.028, 0.080, "soap-blue"),
    ]
    .into_iter()
    .enumerate()
    {
        let n = k + 1;
        let at_bottle = spot(x, z);
        let outline = Outline::new(half, half * 0.7, half * 0.5);
        let shape = [(-0.004, 0.0), (0.0, 0.004), (0.0, tall - 0.008), (-half * 0.42, tall)];
        model.add(format!("scent-{n}"), "glass", swept(&shape, outline, 40, [true, true]).moved(at_bottle));
        let inside = [(-0.007, 0.008), (-0.005, 0.011), (-0.005, tall * 0.55)];
        model.add(format!("scent-{n}-filling"), kind, swept(&inside, outline, 40, [true, true]).moved(at_bottle));
        let cap = [
            (0.010, tall + 0.0005),
            (0.011, tall + 0.006),
            (0.011, tall + 0.026),
            (0.008, tall + 0.030),
            (0.0, tall + 0.030),
        ];
        model.add(format!("scent-{n}-cap"), "brass", Mesh::lathe(&cap, sides).moved(at_bottle));
    }
    let (body, lid) = jar(0.045, 0.115, sides * 3 / 2);
    let place = spot(-0.85, 0.36);
    model.add("cotton-jar", "glass", body.moved(place));
    model.add("cotton-lid", "chrome", lid.moved(place));
    let mut random = Random::new(p.seed.wrapping_add(3));
    let mut balls = Mesh::default();
    for k in 0..14 {
        let (c, s) = cos_sin(0.381_966 * k as f32);
        let reach = if k % 3 == 0 { 0.008 } else { 0.024 };
        let ball = Mesh::sphere(random.range(0.0125, 0.015), 12, 8);
        balls.append(&ball.moved(at(c * reach, 0.021 + 0.0045 * k as f32, -s * reach)));
    }
    model.add("cotton", "foam", balls.moved(place));
    candle(model, 1, spot(0.60, 0.17), p);
}

/// A bottle with a pump: body and pump.
pub fn dispenser(radius: f32, tall: f32, sides: u32) -> (Mesh, Mesh) {
    let (r, h) = (radius, tall);
    let body = curve(
        &[(r * 0.95, 0.0), (r, h * 0.06), (r, h * 0.68), (r * 0.82, h * 0.86), (r * 0.42, h * 0.96), (r * 0.40, h)],
        3,
    );
    let spout =
        [at(0.0, h + 0.052, 0.0), at(0.0, h + 0.056, 0.014), at(0.0, h + 0.054, 0.034), at(0.0, h + 0.044, 0.045)];
    let pump = Mesh::lathe(
        &[
            (r * 0.44, h - 0.002),
            (r * 0.44, h + 0.014),
            (r * 0.16, h + 0.018),
            (r * 0.15, h + 0.044),
            (r * 0.34, h + 0.046),
            (r * 0.34, h + 0.060),
            (0.0, h + 0.062),
        ],
        sides,
    )
    .and(Mesh::tube(&smooth_path(&spout, 4, false), 0.0042, 8, false));
    (Mesh::lathe(&body, sides * 3 / 2), pump)
}

/// A candle in a glass, burning.
pub fn candle(model: &mut Model, n: usize, place: Vec3, p: &Parameters) {
    let sides = p.small_sides * 3 / 2;
    model.add(format!("candle-glass-{n}"), "glass", tumbler(0.032, 0.034, 0.075, 0.003, sides).moved(place));
    let wax = [(0.0, 0.006), (0.0295, 0.006), (0.0305, 0.044), (0.024, 0.043), (0.0, 0.041)];
    model.add(format!("candle-{n}"), "candle", Mesh::lathe(&wax, sides).moved(place));
    let flame = [(0.0, 0.052), (0.0045, 0.057), (0.0052, 0.063), (0.0025, 0.073), (0.0, 0.081)];
    model.add(format!("flame-{n}"), "flame", Mesh::lathe(&curve(&flame, 2), 10).moved(place));
    model.add(
        format!("wick-{n}"),
        "iron",
        Mesh::tube(&[at(0.0, 0.040, 0.0), at(0.001, 0.0525, 0.0)], 0.0009, 5, false).moved(place),
    );
}
