// SPDX-License-Identifier: MIT OR Apache-2.0
//! Base and wall cupboards with their worktops, the sink with its tap and drying rack, and the fridge.

use glam::{Vec2, Vec3};

use super::room::WORKTOP;
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, smooth_path};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::crockery::{bowl, mug, plate, wine_glass};
use crate::scene::builtin::parts::cupboards::{DOOR, Spot, bow_handle, door_frame, panelled, slab_with_hole};
use crate::scene::builtin::parts::plumbing::bridge_tap;
use crate::scene::builtin::parts::shell::{Outline, swept};

/// Depth of the base cupboards, without their doors.
pub const DEPTH: f32 = 0.58;
/// Left and right side of the stove, in a gap between the base cupboards.
pub const STOVE: [f32; 2] = [0.55, 1.17];
/// Right side of the fridge.
const FRIDGE_END: f32 = -1.62;
/// Where the run along the right wall ends.
pub const RUN_END: f32 = 0.42;
/// Middle of the sink, as seen from its window.
const SINK_HALF: [f32; 2] = [0.30, 0.19];
/// Top of the bodies, under the worktops.
const BODY_TOP: f32 = WORKTOP - 0.038;

/// What a base cupboard has in its front.
#[derive(Clone, Copy)]
enum Front {
    /// A drawer above a door, or above two.
    Doors(u32),
    /// Drawers alone.
    Drawers(u32),
}

/// Adds cupboards, sink and fridge.
pub fn add(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let front = r.back + DEPTH;
    let sink = 0.5 * (p.window.left + p.window.right);
    // Along the back wall: up to the stove, and from there into the corner.
    let corner = r.right - DEPTH;
    let runs = [
        ("back-1", FRIDGE_END + 0.005, sink - 0.42, Front::Drawers(4)),
        ("sink", sink - 0.42, sink + 0.42, Front::Doors(2)),
        ("back-2", sink + 0.42, STOVE[0] - 0.004, Front::Doors(1)),
        ("back-3", STOVE[1] + 0.004, corner - DOOR - 0.05, Front::Drawers(3)),
    ];
    for (name, x0, x1, kind) in runs {
        base_unit(model, name, Spot::new(0.0, at(x0, 0.0, front)), x1 - x0, kind, name == "sink");
    }
    // Along the right wall, in three cupboards.
    let start = front + DOOR + 0.05;
    let wide = (RUN_END - start) / 3.0;
    for (i, kind) in [Front::Doors(1), Front::Drawers(4), Front::Doors(1)].into_iter().enumerate() {
        let spot = Spot::new(-0.25, at(corner, 0.0, start + wide * i as f32));
        base_unit(model, &format!("right-{}", i + 1), spot, wide, kind, false);
    }
    // The blind corner.
    let filler = Mesh::block(at(corner - DOOR - 0.05, 0.10, front - 0.02), at(corner, BODY_TOP, front - 0.0005))
        .and(Mesh::block(at(corner + 0.0005, 0.10, front), at(corner + 0.02, BODY_TOP, start)));
    model.add("corner-filler", "blue-paint", filler);
    worktops(model, p, sink);
    basin(model, at(sink, WORKTOP, r.back + 0.31));
    drying_rack(model, at(sink - 0.56, WORKTOP, r.back + 0.30), p);
    glazed_cupboard(model, p);
    upper_cupboards(model, p);
    fridge(model, p);
}

/// A cupboard between floor and worktop, `w` wide; its front's lower left corner is the spot's origin.
fn base_unit(model: &mut Model, name: &str, spot: Spot, w: f32, kind: Front, open_above: bool) {
    // A sink hangs in its cupboard, whose body therefore ends below.
    let top = if open_above { 0.66 } else { BODY_TOP };
    model.add(
        format!("unit-{name}"),
        "blue-paint",
        spot.put(Mesh::block(at(0.0005, 0.10, -DEPTH + 0.01), at(w - 0.0005, top, -0.001))),
    );
    model.add(
        format!("plinth-{name}"),
        "plinth",
        spot.put(Mesh::block(at(0.0005, 0.0, -DEPTH + 0.02), at(w - 0.0005, 0.0995, -0.05))),
    );
    let gap = 0.0025;
    let (low, high) = (0.105, BODY_TOP - 0.006);
    let mut fronts = Mesh::default();
    let mut handles = Mesh::default();
    let mut drawer = |y0: f32, y1: f32, frame: f32| {
        fronts.append(&panelled([gap, w - gap], [y0 + gap, y1 - gap], frame));
        handles.append(&bow_handle(0.13_f32.min(0.5 * w), 0.0055).moved(at(0.5 * w, 0.5 * (y0 + y1), DOOR)));
    };
    match kind {
        Front::Drawers(count) => {
            // The upper drawers are the lower ones' better half.
            let small = (high - low) * 0.19;
            let mut y = high;
            for k in 0..count {
                let tall = if k + 1 == count {
                    y - low
                } else if k + 2 < count {
                    small
                } else {
                    (y - low) * 0.46
                };
                drawer(y - tall, y, if tall > 0.2 { 0.05 } else { 0.03 });
                y -= tall;
            }
        }
        Front::Doors(count) => {
            let split = high - 0.145;
            drawer(split, high, 0.03);
            let each = w / count as f32;
            for k in 0..count {
                let (x0, x1) = (each * k as f32 + gap, each * (k + 1) as f32 - gap);
                fronts.append(&panelled([x0, x1], [low + gap, split - gap], 0.058));
                let x = if k % 2 == 0 { x1 - 0.030 } else { x0 + 0.030 };
                let handle = bow_handle(0.13, 0.0055).turned_z(0.25);
                handles.append(&handle.moved(at(x, split - 0.12, DOOR)));
            }
        }
    }
    model.add(format!("fronts-{name}"), "blue-paint", spot.put(fronts));
    model.add(format!("handles-{name}"), "chrome", spot.put(handles));
}

/// The worktops: left of the stove with the sink's hole, right of it, and along the right wall.
fn worktops(model: &mut Model, p: &Parameters, sink: f32) {
    let r = &p.room;
    let (back, front) = (r.back, r.back + DEPTH + 0.045);
    let (low, high) = (BODY_TOP, WORKTOP);
    let z = r.back + 0.31;
    let hole =
        [sink - SINK_HALF[0] + 0.01, z - SINK_HALF[1] + 0.01, sink + SINK_HALF[0] - 0.01, z + SINK_HALF[1] - 0.01];
    let slab = [FRIDGE_END + 0.003, back, STOVE[0] - 0.003, front];
    model.add("worktop-left", "oak", slab_with_hole(slab, hole, low, high));
    let corner = r.right - DEPTH - 0.045;
    let mut right = Mesh::rounded_block(at(STOVE[1] + 0.003, low, back), at(r.right, high, front), 0.004);
    right = right.with_plan_texture(1.0);
    let mut run = Mesh::rounded_block(at(corner, low, front + 0.0004), at(r.right, high, RUN_END + 0.02), 0.004);
    // The grain runs along the worktop.
    for (t, q) in run.texcoords.iter_mut().zip(&run.positions) {
        *t = Vec2::new(q.z, q.x + 0.37);
    }
    model.add("worktop-right", "oak", right);
    model.add("worktop-run", "oak", run);
}

/// A steel sink let into the worktop, and its tap.
fn basin(model: &mut Model, place: Vec3) {
    let profile = [
        (0.020, 0.0005),
        (0.018, 0.0042),
        (0.010, 0.0055),
        (-0.006, 0.0050),
        (-0.013, 0.0),
        (-0.016, -0.012),
        (-0.018, -0.13),
        (-0.022, -0.155),
        (-0.034, -0.170),
        (-0.050, -0.175),
    ];
    let outline = Outline::new(SINK_HALF[0], SINK_HALF[1], 0.062);
    model.add("sink", "steel", swept(&profile, outline, 60, [false, true]).moved(place));
    let drain = [(0.045, -0.1748), (0.044, -0.172), (0.030, -0.171), (0.026, -0.1735), (0.0, -0.1735)];
    model.add("sink-drain", "chrome", Mesh::lathe(&drain, 24).moved(place));
    model.add("tap", "chrome", bridge_tap().moved(place + at(0.0, 0.0, -0.235)));
}

/// A wire rack with plates on edge, cups beside them.
fn drying_rack(model: &mut Model, place: Vec3, p: &Parameters) {
    let (w, d) = (0.17, 0.14);
    let mut wire = Mesh::default();
    let ring = |y: f32, grow: f32| {
        smooth_path(&[at(-w - grow, y, -d), at(w + grow, y, -d), at(w + grow, y, d), at(-w - grow, y, d)], 6, true)
    };
    wire.append(&Mesh::tube(&ring(0.02, 0.0), 0.003, 6, true));
    wire.append(&Mesh::tube(&ring(0.09, 0.005), 0.003, 6, true));
    let bars = p.rack_plates + 1;
    for k in 0..bars {
        let x = -w + 2.0 * w * (k as f32 + 0.5) / bars as f32;
        let hoop = [at(x, 0.09, -d - 0.02), at(x, 0.02, -d + 0.01), at(x, 0.018, d - 0.01), at(x, 0.09, d + 0.02)];
        wire.append(&Mesh::tube(&smooth_path(&hoop, 4, false), 0.0022, 6, false));
    }
    for (x, z) in [(-w, -d), (w, -d), (w, d), (-w, d)] {
        wire.append(&Mesh::sphere(0.007, 8, 6).moved(at(x * 0.96, 0.007, z * 0.96)));
        wire.append(&Mesh::tube(&[at(x * 0.96, 0.01, z * 0.96), at(x * 0.99, 0.09, z * 0.99)], 0.0026, 6, false));
    }
    model.add("rack", "chrome", wire.moved(place));
    for k in 0..p.rack_plates {
        let x = -w + 2.0 * w * (k as f32 + 1.0) / bars as f32;
        let leaning = plate(0.105, p.round_sides).turned_z(-0.23).moved(at(x - 0.012, 0.128, 0.0));
        let glaze = if k % 3 == 1 { "blue-glaze" } else { "porcelain" };
        model.add(format!("rack-plate-{}", k + 1), glaze, leaning.moved(place));
    }
}

/// The wall cupboard with glass doors, right of the hood, and the crockery in it.
fn glazed_cupboard(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let (x0, x1, y0, y1) = (STOVE[1] + 0.13, r.right - 0.36, 1.46, 2.22);
    let (back, front) = (r.back, r.back + 0.33);
    let t = 0.018;
    let board = |x0: f32, y0: f32, x1: f32, y1: f32, z1: f32| Mesh::block(at(x0, y0, back + 0.016), at(x1, y1, z1));
    let mut body = board(x0, y0, x0 + t, y1, front).and(board(x1 - t, y0, x1, y1, front));
    body.append(&board(x0 + t, y0, x1 - t, y0 + t, front).and(board(x0 + t, y1 - t, x1 - t, y1, front)));
    body.append(&Mesh::block(at(x0, y0, back + 0.001), at(x1, y1, back + 0.0155)));
    let middle = 0.5 * (y0 + y1);
    body.append(&board(x0 + t, middle - 0.009, x1 - t, middle + 0.009, front - 0.03));
    body.append(&Mesh::rounded_block(at(x0 - 0.02, y1, back), at(x1 + 0.001, y1 + 0.045, front + 0.045), 0.008));
    model.add("glazed-cupboard", "cream-paint", body);
    let half = 0.5 * (x1 - x0);
    let mut doors = Mesh::default();
    let mut panes = Mesh::default();
    let mut handles = Mesh::default();
    for k in 0..2 {
        let (a, b) = (x0 + half * k as f32 + 0.002, x0 + half * (k + 1) as f32 - 0.002);
        let mut leaf = door_frame([a, b], [y0, y1 - 0.002], 0.05);
        leaf.append(&Mesh::block(at(a + 0.05, middle + 0.04, 0.004), at(b - 0.05, middle + 0.055, 0.018)));
        doors.append(&leaf);
        let z = 0.011;
        panes.append(&Mesh::quad(
            [
                at(a + 0.05, y0 + 0.05, z),
                at(b - 0.05, y0 + 0.05, z),
                at(b - 0.05, y1 - 0.052, z),
                at(a + 0.05, y1 - 0.052, z),
            ],
            Vec2::ONE,
        ));
        let x = if k == 0 { b - 0.025 } else { a + 0.025 };
        handles.append(&bow_handle(0.11, 0.005).turned_z(0.25).moved(at(x, y0 + 0.14, DOOR)));
    }
    let lift = at(0.0, 0.0, front + 0.001);
    model.add("glazed-doors", "cream-paint", doors.moved(lift));
    model.add("glazed-panes", "pane", panes.moved(lift));
    model.add("glazed-handles", "chrome", handles.moved(lift));
    let z = back + 0.17;
    let spot = |x: f32, upper: bool| at(x, if upper { middle + 0.0095 } else { y0 + t + 0.0005 }, z);
    let mut plates = Mesh::default();
    for k in 0..6 {
        plates.append(&plate(0.115, p.round_sides).moved(spot(x0 + 0.15, false) + at(0.0, 0.0125 * k as f32, 0.0)));
    }
    model.add("glazed-plates", "porcelain", plates);
    let mut bowls = Mesh::default();
    for k in 0..4 {
        bowls.append(&bowl(0.075, 0.06, p.small_sides).moved(spot(x0 + 0.40, false) + at(0.0, 0.028 * k as f32, 0.0)));
    }
    model.add("glazed-bowls", "blue-glaze", bowls);
    let step = (x1 - x0 - 0.12) / 6.0;
    for k in 0..6 {
        let place = spot(x0 + 0.06 + step * (k as f32 + 0.5), true);
        if k < 3 {
            model.add(format!("wine-glass-{}", k + 1), "glass", wine_glass(0.036, 0.19, p.small_sides).moved(place));
        } else {
            let cup = mug(0.036, 0.085, p.small_sides).turned_y(0.05 - 0.12 * (k - 3) as f32);
            model.add(
                format!("cupboard-mug-{}", k - 2),
                ["yellow-glaze", "porcelain", "blue-glaze"][k - 3],
                cup.moved(place),
            );
        }
    }
}

/// Cupboards that are closed: above the fridge, and between it and the window.
fn upper_cupboards(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let right = p.window.left - 0.12;
    let boxes = [
        ("over-fridge", r.left + 0.01, FRIDGE_END, 1.96, 2.30, 0.55),
        ("left", FRIDGE_END + 0.01, right, 1.46, 2.30, 0.33),
    ];
    for (name, x0, x1, y0, y1, deep) in boxes {
        let front = r.back + deep;
        model.add(format!("upper-{name}"), "cream-paint", Mesh::block(at(x0, y0, r.back + 0.001), at(x1, y1, front)));
        let cornice = Mesh::rounded_block(at(x0 - 0.005, y1, r.back), at(x1 + 0.004, y1 + 0.045, front + 0.045), 0.008);
        model.add(format!("upper-{name}-cornice"), "cream-paint", cornice);
        let count = if x1 - x0 > 0.6 { 2 } else { 1 };
        let each = (x1 - x0) / count as f32;
        let mut doors = Mesh::default();
        let mut handles = Mesh::default();
        for k in 0..count {
            let (a, b) = (x0 + each * k as f32 + 0.002, x0 + each * (k + 1) as f32 - 0.002);
            doors.append(&panelled([a, b], [y0 + 0.002, y1 - 0.002], 0.055));
            let x = if k % 2 == 0 { b - 0.028 } else { a + 0.028 };
            handles.append(&bow_handle(0.11, 0.005).turned_z(0.25).moved(at(x, y0 + 0.11, DOOR)));
        }
        let lift = at(0.0, 0.0, front + 0.001);
        model.add(format!("upper-{name}-doors"), "cream-paint", doors.moved(lift));
        model.add(format!("upper-{name}-handles"), "chrome", handles.moved(lift));
    }
}

/// A tall fridge with two doors of steel, and notes on it.
fn fridge(model: &mut Model, p: &Parameters) {
    let r = &p.room;
    let (x0, x1) = (r.left + 0.03, FRIDGE_END - 0.01);
    let (front, top) = (r.back + 0.60, 1.90);
    model.add(
        "fridge-body",
        "black-plastic",
        Mesh::rounded_block(at(x0 + 0.01, 0.02, r.back + 0.03), at(x1 - 0.01, top, front), 0.01),
    );
    let split = 1.22;
    let door = |y0: f32, y1: f32| Mesh::rounded_block(at(x0, y0, front + 0.004), at(x1, y1, front + 0.064), 0.012);
    model.add("fridge-doors", "steel", door(0.05, split - 0.004).and(door(split + 0.004, top)));
    let mut handles = Mesh::default();
    for (y0, y1) in [(0.62, split - 0.06), (split + 0.06, 1.68)] {
        let (x, z) = (x1 - 0.06, front + 0.064);
        handles.append(&Mesh::tube(&[at(x, y0, z + 0.045), at(x, y1, z + 0.045)], 0.010, 12, false));
        for y in [y0 + 0.03, y1 - 0.03] {
            handles.append(&Mesh::tube(&[at(x, y, z - 0.002), at(x, y, z + 0.045)], 0.007, 8, false));
        }
    }
    model.add("fridge-handles", "chrome", handles);
    let mut random = Random::new(p.seed.wrapping_add(5));
    let mut notes = Mesh::default();
    let mut magnets = Mesh::default();
    for (x, y) in [(0.16, 1.52), (0.33, 1.60), (0.27, 1.40)] {
        let (w, h) = (random.range(0.045, 0.065), random.range(0.05, 0.075));
        let note = Mesh::block(at(-w, -h, 0.0), at(w, h, 0.0012)).turned_z(random.range(-0.02, 0.02));
        let place = at(x0 + x, y, front + 0.0645);
        notes.append(&note.moved(place));
        let magnet = Mesh::lathe(&[(0.011, 0.0), (0.011, 0.004), (0.0, 0.006)], 12).turned_x(0.25);
        magnets.append(&magnet.moved(place + at(0.0, h - 0.012, 0.0012)));
    }
    model.add("fridge-notes", "paper", notes);
    model.add("fridge-magnets", "red-enamel", magnets);
}
