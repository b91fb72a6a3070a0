// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shower: tray, glass walls, rain head, hand shower with its hose, and a rack of bottles.

use glam::{Vec2, Vec3};

use super::vanity::dispenser;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, cos_sin, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::shell::{Outline, curve, swept};

/// Adds the shower.
pub fn add(model: &mut Model, p: &Parameters) {
    let (r, s) = (&p.room, &p.shower);
    let [w, d] = s.size;
    // The corner where the mosaic walls meet; the shower lies at -x and +z of it.
    let corner = at(r.right, 0.0, r.back);
    tray(model, corner + at(-0.5 * w, 0.0, 0.5 * d), [w, d], p);
    glass(model, corner, p);
    fittings(model, corner, p);
    rack(model, corner, p);
}

/// A low tray of ceramic with a drain.
fn tray(model: &mut Model, place: Vec3, [w, d]: [f32; 2], p: &Parameters) {
    let profile = [
        (-0.004, 0.0),
        (0.0, 0.004),
        (0.0, 0.066),
        (-0.006, 0.074),
        (-0.045, 0.075),
        (-0.054, 0.068),
        (-0.060, 0.046),
        (-0.075, 0.038),
    ];
    let outline = Outline::new(0.5 * w - 0.003, 0.5 * d - 0.003, 0.085);
    model.add(
        "shower-tray",
        "ceramic",
        swept(&profile, outline, p.ceramic_sides, [true, true]).moved(place + at(0.0, 0.0005, 0.0)),
    );
    let drain = [(0.058, 0.0387), (0.056, 0.043), (0.048, 0.044), (0.046, 0.0425), (0.0, 0.0425)];
    let mut holes = Mesh::default();
    for ring in 1..4 {
        for k in 0..ring * 6 {
            let (c, s) = cos_sin(k as f32 / (ring * 6) as f32);
            let reach = 0.013 * ring as f32;
            let hole = Mesh::lathe(&[(0.0032, 0.0431), (0.0, 0.0433)], 8);
            holes.append(&hole.moved(at(c * reach, 0.0, -s * reach)));
        }
    }
    model.add("shower-drain", "chrome", Mesh::lathe(&drain, p.small_sides * 2).moved(place));
    model.add("shower-drain-holes", "rubber", holes.moved(place));
}

/// A fixed pane at the left, and a fixed pane and a door that stands open in front, in chromed rails.
fn glass(model: &mut Model, corner: Vec3, p: &Parameters) {
    let s = &p.shower;
    let [w, d] = [s.size[0] - 0.025, s.size[1] - 0.025];
    let (y0, y1) = (0.078, s.height);
    let put = |mesh: Mesh| mesh.moved(corner);
    let side = [at(-w, y0, 0.004), at(-w, y0, d), at(-w, y1, d), at(-w, y1, 0.004)];
    model.add("shower-side", "shower-glass", put(Mesh::quad(side, Vec2::ONE)));
    let fixed = 0.42 * w;
    let front = [at(-fixed, y0, d), at(-0.004, y0, d), at(-0.004, y1, d), at(-fixed, y1, d)];
    model.add("shower-front", "shower-glass", put(Mesh::quad(front, Vec2::ONE)));
    // The door hangs on the left pane's edge and stands open into the room.
    let wide = w - fixed - 0.012;
    let hinge = at(-w + 0.006, 0.0, d + 0.012);
    let leaf =
        [at(0.0, y0 + 0.012, 0.0), at(wide, y0 + 0.012, 0.0), at(wide, y1 - 0.006, 0.0), at(0.0, y1 - 0.006, 0.0)];
    let swing = |mesh: Mesh| put(mesh.turned_y(-0.125).moved(hinge));
    model.add("shower-door", "shower-glass", swing(Mesh::quad(leaf, Vec2::ONE)));
    let t = 0.009;
    let bar = |lo: Vec3, hi: Vec3| Mesh::rounded_block(lo - Vec3::splat(t), hi + Vec3::splat(t), 0.003);
    let mut rails = bar(at(-w, y0, 0.012), at(-w, y0, d)).and(bar(at(-w, y1, 0.012), at(-w, y1, d)));
    rails.append(&bar(at(-w + 2.0 * t, y1, d), at(-0.012, y1, d)));
    rails.append(&bar(at(-fixed, y0, d), at(-0.012, y0, d)));
    rails.append(&bar(at(-w, y0 + 2.0 * t, d), at(-w, y1 - 2.0 * t, d)));
    rails.append(&bar(at(-fixed, y0 + 2.0 * t, d), at(-fixed, y1 - 2.0 * t, d)));
    model.add("shower-rails", "chrome", put(rails));
    let mut furniture = Mesh::default();
    for y in [0.45, 1.55] {
        furniture.append(&Mesh::rounded_block(at(-0.004, y - 0.04, -0.010), at(0.055, y + 0.04, 0.010), 0.004));
    }
    for z in [-1.0, 1.0] {
        let x = wide - 0.055;
        let grip = [at(x, 0.92, z * 0.0005), at(x, 0.925, z * 0.040), at(x, 1.205, z * 0.040), at(x, 1.21, z * 0.0005)];
        furniture.append(&Mesh::tube(&[grip[1] - Vec3::Y * 0.02, grip[2] + Vec3::Y * 0.02], 0.008, 12, false));
        furniture.append(&Mesh::tube(&[at(x, 0.95, z * 0.0005), at(x, 0.95, z * 0.040)], 0.006, 10, false));
        furniture.append(&Mesh::tube(&[at(x, 1.18, z * 0.0005), at(x, 1.18, z * 0.040)], 0.006, 10, false));
    }
    model.add("shower-door-furniture", "chrome", swing(furniture));
}

/// On the back wall: a rain head on its riser, a valve, a hand shower and its hose.
fn fittings(model: &mut Model, corner: Vec3, p: &Parameters) {
    let sides = p.small_sides;
    let place = corner + at(-0.5 * p.shower.size[0], 0.0, 0.0);
    let put = |mesh: Mesh| mesh.moved(place);
    let (y, z) = (2.02, 0.055);
    let riser = [
        at(0.0, 1.12, z),
        at(0.0, 1.5, z),
        at(0.0, 1.9, z),
        at(0.0, y, z),
        at(0.0, y + 0.07, z + 0.02),
        at(0.0, y + 0.10, z + 0.10),
        at(0.0, y + 0.10, z + 0.25),
        at(0.0, y + 0.10, z + 0.30),
        at(0.0, y + 0.08, z + 0.35),
        at(0.0, y + 0.03, z + 0.37),
    ];
    let mut chrome = Mesh::tube(&smooth_path(&riser, 6, false), 0.0105, 14, false);
    let head = [
        (0.0, 0.0),
        (0.104, 0.0),
        (0.112, 0.004),
        (0.112, 0.010),
        (0.060, 0.016),
        (0.024, 0.026),
        (0.020, 0.05),
        (0.0, 0.051),
    ];
    chrome.append(&Mesh::lathe(&head, p.ceramic_sides).moved(at(0.0, y, z + 0.37)));
    for y in [1.40, 1.92] {
        chrome.append(&Mesh::tube(&[at(0.0, y, 0.001), at(0.0, y, z)], 0.008, 10, false));
        chrome.append(
            &Mesh::lathe(&[(0.024, 0.0), (0.022, 0.006), (0.0, 0.007)], sides * 2)
                .turned_x(0.25)
                .moved(at(0.0, y, 0.0005)),
        );
    }
    // The valve: a bar with two grips.
    let bar = [
        (0.0, -0.13),
        (0.024, -0.13),
        (0.026, -0.125),
        (0.026, -0.085),
        (0.020, -0.080),
        (0.020, 0.080),
        (0.026, 0.085),
        (0.026, 0.125),
        (0.024, 0.13),
        (0.0, 0.13),
    ];
    chrome.append(&Mesh::lathe(&bar, sides * 2).turned_z(0.25).moved(at(0.0, 1.10, z)));
    for x in [-0.07, 0.07] {
        chrome.append(
            &Mesh::lathe(&[(0.030, 0.0), (0.028, 0.010), (0.014, 0.014), (0.013, 0.05)], sides * 2)
                .turned_x(0.25)
                .moved(at(x, 1.10, 0.0005)),
        );
    }
    // A slider on the riser holds the hand shower.
    chrome.append(
        &Mesh::lathe(&[(0.0, -0.025), (0.019, -0.025), (0.019, 0.025), (0.0, 0.025)], sides).moved(at(0.0, 1.62, z)),
    );
    let hand = [at(0.0, 1.56, z + 0.045), at(0.0, 1.66, z + 0.055), at(0.0, 1.75, z + 0.085)];
    chrome.append(&Mesh::tapered_tube(&smooth_path(&hand, 5, false), |t| 0.0115 + 0.003 * t, 14, false));
    chrome.append(&Mesh::tube(&[at(0.0, 1.62, z), at(0.0, 1.62, z + 0.05)], 0.010, 10, false));
    let rose = curve(&[(0.0, -0.012), (0.040, -0.010), (0.045, 0.0), (0.030, 0.012), (0.0, 0.018)], 3);
    chrome.append(&Mesh::lathe(&rose, sides * 2).turned_x(0.18).moved(at(0.0, 1.765, z + 0.10)));
    model.add("shower-fittings", "chrome", put(chrome));
    let mut nozzles = Mesh::default();
    for ring in 1..7 {
        for k in 0..ring * 6 {
            let (c, s) = cos_sin(k as f32 / (ring * 6) as f32);
            let reach = 0.0155 * ring as f32;
            let nozzle = Mesh::lathe(&[(0.0, -0.0045), (0.0018, -0.004), (0.0026, -0.0005)], 7);
            nozzles.append(&nozzle.moved(at(c * reach, y, z + 0.37 - s * reach)));
        }
    }
    model.add("shower-nozzles", "rubber", put(nozzles));
    // The hose is ribbed: a tube of rings.
    let path = [
        at(0.0, 1.555, z + 0.045),
        at(0.005, 1.42, z + 0.06),
        at(0.06, 1.05, z + 0.14),
        at(0.12, 0.78, z + 0.12),
        at(0.10, 0.66, z + 0.08),
        at(0.03, 0.74, z + 0.03),
        at(0.0, 0.95, z + 0.005),
        at(0.0, 1.075, z),
    ];
    let path = smooth_path(&path, 24, false);
    let last = path.len() as f32 - 1.0;
    let ribs = |t: f32| if ((t * last + 0.5) as u32).is_multiple_of(2) { 0.0078 } else { 0.0066 };
    model.add("shower-hose", "chrome", put(Mesh::tapered_tube(&path, ribs, 9, false)));
}

/// A wire rack in the corner with bottles and a sponge.
fn rack(model: &mut Model, corner: Vec3, p: &Parameters) {
    let put = |mesh: Mesh| mesh.moved(corner);
    let mut wire = Mesh::default();
    let (w, d) = (0.30, 0.13);
    let middle = at(-0.22, 0.0, 0.5 * p.shower.size[1] + 0.05);
    for y in [1.06, 1.38] {
        // Along the right wall.
        let ring = |y: f32| {
            [at(-0.006, y, -0.5 * w), at(-d, y, -0.5 * w), at(-d, y, 0.5 * w), at(-0.006, y, 0.5 * w)]
                .map(|q| q + middle + at(0.22, 0.0, 0.0))
        };
        wire.append(&Mesh::tube(&smooth_path(&ring(y), 5, true), 0.0032, 8, true));
        wire.append(&Mesh::tube(&smooth_path(&ring(y + 0.05), 5, true), 0.0032, 8, true));
        for k in 0..14 {
            let z = -0.5 * w + w * (k as f32 + 0.5) / 14.0;
            let bar = [at(-d, y + 0.05, z), at(-d + 0.002, y + 0.004, z), at(-0.008, y, z), at(-0.006, y + 0.05, z)]
                .map(|q| q + middle + at(0.22, 0.0, 0.0));
            wire.append(&Mesh::tube(&bar, 0.0018, 6, false));
        }
    }
    model.add("shower-rack", "chrome", put(wire));
    let sides = p.small_sides;
    let stands = |x: f32, y: f32, z: f32| corner + middle + at(0.22 - 0.066 + x, y + 0.0045, z);
    for (k, (z, y, kind, r, tall)) in [
        (-0.10, 1.06, "soap-blue", 0.030, 0.15),
        (-0.02, 1.06, "soap-rose", 0.028, 0.17),
        (0.07, 1.06, "white-plastic", 0.033, 0.14),
        (-0.09, 1.38, "soap-green", 0.029, 0.16),
    ]
    .into_iter()
    .enumerate()
    {
        let n = k + 1;
        let (body, pump) = dispenser(r, tall, sides);
        model.add(format!("shampoo-{n}"), kind, body.moved(stands(0.0, y, z)));
        model.add(
            format!("shampoo-pump-{n}"),
            "white-plastic",
            pump.turned_y(-0.25 + 0.04 * k as f32).moved(stands(0.0, y, z)),
        );
    }
    // A sponge with a bumpy surface.
    let sponge = Mesh::sheet(40, 24, |u, v| {
        let (c, s) = cos_sin(u);
        let (h, r) = cos_sin(0.5 * (0.02 + 0.96 * v));
        let ((bump, _), (row, _)) = (cos_sin(u * 7.0), cos_sin(v * 4.0));
        let grow = 1.0 + 0.05 * bump * row * r;
        at(c * r * 0.042 * grow, -h * 0.034 * grow + 0.036, -s * r * 0.055 * grow)
    });
    model.add("sponge", "sponge", sponge.moved(stands(0.0, 1.38, 0.06)));
}
