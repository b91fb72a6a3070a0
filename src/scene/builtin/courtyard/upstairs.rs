// SPDX-License-Identifier: MIT OR Apache-2.0
//! The upper storey of a wing: windows with shutters behind a balustrade, a cornice, and the roof's tiles.

use glam::{Vec2, Vec3};

use super::wings::{UPPER, Wing, masonry};
use super::{Parameters, at};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::cupboards::door_frame;
use crate::scene::builtin::parts::shell::curve;
use crate::scene::builtin::parts::walls::{face_with_hole, window};

/// Height of the cornice's lower border.
const CORNICE: f32 = 7.05;
/// Where the tiles begin: height, and how far in front of the wall.
const EAVE: [f32; 2] = [7.46, 0.62];
/// How far the roof rises, and how far back.
const ROOF: [f32; 2] = [1.75, 3.4];
/// Length of a roof tile that is seen.
const TILE_ROW: f32 = 0.36;

/// Adds a mesh of the wing's upper storey. Where wings meet, no two faces may lie in one plane: each has its own height.
fn put(model: &mut Model, wing: &Wing, what: &str, material: &str, mesh: Mesh) {
    wing.add(model, what, material, mesh.moved(at(0.0, 0.002 * wing.joined as f32, 0.0)));
}

/// Adds the upper storey.
pub fn add(model: &mut Model, p: &Parameters, wing: &Wing) {
    let half = 0.5 * wing.bays as f32 * p.bay;
    let band =
        |y0: f32, y1: f32, out: f32| Mesh::rounded_block(at(-half - 0.02, y0, -0.10), at(half + 0.02, y1, out), 0.02);
    let floor = UPPER + 0.24;
    let ledge = band(UPPER, UPPER + 0.10, 0.10).and(band(UPPER + 0.101, floor, 0.34));
    put(model, wing, "ledge", "stone", masonry(ledge, 0.5));
    let cornice = band(CORNICE, CORNICE + 0.12, 0.08).and(band(CORNICE + 0.121, CORNICE + 0.26, 0.18)).and(band(
        CORNICE + 0.261,
        CORNICE + 0.36,
        0.46,
    ));
    put(model, wing, "cornice", "stone", masonry(cornice, 0.5));
    let mut brackets = Mesh::default();
    let count = (2.0 * half / 0.4) as u32;
    for k in 0..count {
        let x = -half + 0.4 * (k as f32 + 0.5);
        brackets.append(&Mesh::rounded_block(
            at(x - 0.055, CORNICE + 0.14, 0.0),
            at(x + 0.055, CORNICE + 0.265, 0.40),
            0.01,
        ));
    }
    put(model, wing, "brackets", "stone", masonry(brackets, 0.5));
    windows(model, p, wing, floor);
    balustrade(model, p, wing, floor);
    roof(model, p, wing, half);
}

fn windows(model: &mut Model, p: &Parameters, wing: &Wing, floor: f32) {
    let (w, low, high) = (0.46, floor + 0.05, floor + 2.05);
    let [frame, panes, reveal] = window(Vec2::new(w, 0.5 * (high - low)), 0.24, 0.016, 2, 3);
    let (mut wall, mut frames, mut all_panes, mut reveals) =
        (Mesh::default(), Mesh::default(), Mesh::default(), Mesh::default());
    let (mut shutters, mut lintels) = (Mesh::default(), Mesh::default());
    let shutter = shutter(w - 0.01, high - low);
    for i in 0..wing.bays {
        let x = wing.column(p, i);
        let hole = Some([0.5 * p.bay - w, low - floor, 0.5 * p.bay + w, high - floor]);
        wall.append(&face_with_hole(at(x, floor, 0.0), Vec3::X, Vec2::new(p.bay, CORNICE - floor), hole, 0.35));
        let middle = at(x + 0.5 * p.bay, 0.5 * (low + high), 0.0);
        frames.append(&frame.clone().moved(middle));
        all_panes.append(&panes.clone().moved(middle));
        reveals.append(&reveal.clone().moved(middle));
        for side in [-1.0f32, 1.0] {
            let x = middle.x + if side < 0.0 { -2.0 * w + 0.005 } else { w + 0.005 };
            shutters.append(&shutter.clone().moved(at(x, low, 0.012)));
        }
        lintels.append(&Mesh::rounded_block(
            at(middle.x - w - 0.12, high - 0.004, -0.02),
            at(middle.x + w + 0.12, high + 0.16, 0.07),
            0.015,
        ));
    }
    put(model, wing, "upper-wall", "ochre", wall);
    put(model, wing, "window-frames", "cream-paint", frames);
    put(model, wing, "panes", "pane", all_panes);
    put(model, wing, "reveals", "plaster", reveals);
    put(model, wing, "shutters", "shutter", shutters);
    put(model, wing, "lintels", "stone", masonry(lintels, 0.5));
}

/// A shutter with slats, its lower left corner on the origin.
fn shutter(wide: f32, high: f32) -> Mesh {
    let mut mesh = door_frame([0.0, wide], [0.0, high], 0.06);
    let count = 30;
    for k in 0..count {
        let y = 0.07 + (high - 0.14) * (k as f32 + 0.5) / count as f32;
        let slat = Mesh::block(at(0.06, -0.004, -0.026), at(wide - 0.06, 0.004, 0.026)).turned_x(0.09);
        mesh.append(&slat.moved(at(0.0, y, 0.011)));
    }
    mesh
}

/// Turned balusters between small piers, below a rail.
fn balustrade(model: &mut Model, p: &Parameters, wing: &Wing, floor: f32) {
    let z = 0.22;
    let mut profile = vec![(0.0, 0.0), (0.050, 0.0), (0.050, 0.05)];
    profile.extend(curve(
        &[
            (0.040, 0.06),
            (0.024, 0.085),
            (0.030, 0.12),
            (0.054, 0.20),
            (0.048, 0.27),
            (0.026, 0.38),
            (0.022, 0.45),
            (0.036, 0.47),
        ],
        3,
    ));
    profile.extend([(0.048, 0.48), (0.048, 0.53), (0.0, 0.53)]);
    let baluster = Mesh::lathe(&profile, p.small_sides);
    let (mut balusters, mut rest) = (Mesh::default(), Mesh::default());
    for i in 0..wing.bays {
        let x = wing.column(p, i);
        for k in 0..p.balusters {
            let t = (k as f32 + 0.5) / p.balusters as f32;
            balusters.append(&baluster.clone().moved(at(x + 0.16 + (p.bay - 0.32) * t, floor - 0.002, z)));
        }
    }
    for i in 0..=wing.bays {
        let x = wing.column(p, i);
        rest.append(&Mesh::rounded_block(
            at(x - 0.13, floor - 0.01, z - 0.10),
            at(x + 0.13, floor + 0.56, z + 0.10),
            0.012,
        ));
    }
    let half = 0.5 * wing.bays as f32 * p.bay;
    rest.append(&Mesh::rounded_block(
        at(-half - 0.1, floor + 0.524, z - 0.115),
        at(half + 0.1, floor + 0.62, z + 0.115),
        0.02,
    ));
    put(model, wing, "balusters", "stone", masonry(balusters, 0.5));
    put(model, wing, "rail", "stone", masonry(rest, 0.5));
}

/// Half-round tiles in rows, each row lying on the one below it.
fn roof(model: &mut Model, p: &Parameters, wing: &Wing, half: f32) {
    let [rise, back] = ROOF;
    let slope = (rise * rise + back * back).sqrt();
    let (up, into) = (rise / slope, back / slope);
    let rows = (slope / TILE_ROW) as u32;
    // Where wings meet, their roofs reach into each other.
    let more = ROOF[1];
    let ends = match wing.joined {
        0 => [-half - more, half + more],
        1 => [-half, half + more],
        _ => [-half - more, half],
    };
    let mut random = Random::new(p.seed.wrapping_add(wing.joined as u32));
    let columns = ((ends[1] - ends[0]) / p.roof_tile) as u32;
    let step = (ends[1] - ends[0]) / columns as f32;
    let spot =
        |x: f32, along: f32, lift: f32| at(x, EAVE[0] + along * up + lift * into, EAVE[1] - along * into + lift * up);
    let mut tiles = Mesh::default();
    for column in 0..columns {
        for row in 0..rows {
            let from = TILE_ROW * row as f32;
            let long = TILE_ROW + 0.07;
            let jitter = random.range(-0.008, 0.008);
            let tint = Vec2::new(random.range(0.0, 1.0), random.range(0.0, 1.0));
            for (cover, shift) in [(true, 0.0), (false, 0.5)] {
                let x = ends[0] + step * (column as f32 + 0.5 + shift) + jitter;
                let mut tile = Mesh::sheet(6, 2, |u, v| {
                    // Narrower above, where the next row's tile covers it.
                    let r = 0.36 * step * (1.0 - 0.16 * v);
                    let (c, s) = cos_sin(0.5 - 0.5 * u);
                    let lift = if cover { s * r + 0.030 } else { 0.055 - s * r * 0.7 };
                    spot(x + c * r, from + long * v, lift - 0.022 * v)
                });
                tile.texcoords.iter_mut().for_each(|t| *t = *t * 0.12 + tint);
                tiles.append(&tile);
            }
        }
    }
    put(model, wing, "tiles", "roof-tile", tiles);
    let deck = [
        spot(ends[0], 0.0, -0.03),
        spot(ends[1], 0.0, -0.03),
        spot(ends[1], slope, -0.03),
        spot(ends[0], slope, -0.03),
    ];
    put(model, wing, "deck", "dark-wood", Mesh::quad(deck, Vec2::new(4.0, 1.0)));
}
