// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bathroom's materials and the pictures on them.

use super::Parameters;
use crate::scene::Surface;
use crate::scene::builtin::mesh::{hash, unit};
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters) {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::glossy("floor", white, 0.20, 100.0).with_texture("hexagons.png"),
        Finish::glossy("tiles", white, 0.40, 200.0).with_texture("tiles.png"),
        Finish::glossy("mosaic", white, 0.40, 200.0).with_texture("mosaic.png"),
        Finish::glossy("teal-glaze", [0.04, 0.22, 0.24], 0.45, 200.0),
        Finish::matte("paint", [0.60, 0.70, 0.66]),
        Finish::matte("ceiling", [0.86, 0.86, 0.84]),
        Finish::glossy("trim", [0.80, 0.79, 0.75], 0.10, 40.0),
        Finish::glossy("ceramic", [0.88, 0.88, 0.86], 0.50, 260.0),
        Finish::glossy("oak", [1.0, 0.93, 0.84], 0.10, 50.0).with_texture("oak.png"),
        Finish::glossy("walnut", [0.52, 0.40, 0.32], 0.10, 50.0).with_texture("oak.png"),
        Finish::glossy("marble", white, 0.30, 180.0).with_texture("marble.png"),
        finishes::chrome(),
        finishes::brass(),
        finishes::mirror(),
        finishes::iron(),
        finishes::glass(),
        finishes::pane(),
        Finish { index_of_refraction: 1.45, ..Finish::glass("shower-glass", Surface::ThinGlass, [0.90, 0.97, 0.95]) },
        Finish::matte("opal", [1.0, 0.96, 0.88]),
        Finish::matte("rubber", [0.30, 0.31, 0.32]),
        Finish::glossy("water", [0.33, 0.58, 0.60], 0.6, 300.0),
        Finish::glossy("foam", [0.92, 0.94, 0.95], 0.15, 30.0),
        Finish::glossy("duck", [0.92, 0.68, 0.03], 0.35, 90.0),
        Finish::glossy("beak", [0.85, 0.25, 0.02], 0.30, 80.0),
        Finish::glossy("eyes", [0.01, 0.01, 0.01], 0.6, 200.0),
        Finish::matte("towel-white", [0.92, 0.90, 0.86]).with_texture("terry.png"),
        Finish::matte("towel-coral", [0.86, 0.32, 0.22]).with_texture("terry.png"),
        Finish::matte("towel-teal", [0.10, 0.40, 0.42]).with_texture("terry.png"),
        Finish::matte("mat", [0.80, 0.76, 0.68]),
        Finish::matte("wicker", [0.56, 0.36, 0.17]),
        Finish::glossy("soap-green", [0.28, 0.55, 0.30], 0.4, 140.0),
        Finish::glossy("soap-amber", [0.55, 0.24, 0.04], 0.4, 140.0),
        Finish::glossy("soap-blue", [0.10, 0.28, 0.52], 0.4, 140.0),
        Finish::glossy("soap-rose", [0.80, 0.42, 0.44], 0.4, 140.0),
        Finish::glossy("white-plastic", [0.82, 0.82, 0.80], 0.3, 90.0),
        Finish::matte("label", white).with_texture("label.png"),
        Finish::matte("sponge", [0.88, 0.66, 0.26]),
        Finish::matte("candle", [0.90, 0.84, 0.70]),
        Finish::matte("flame", [1.0, 0.80, 0.35]),
        Finish::matte("paper", [0.88, 0.87, 0.84]),
        Finish::matte("terracotta", [0.52, 0.22, 0.11]),
        Finish::matte("soil", [0.06, 0.04, 0.025]),
        finishes::stem(),
        Finish::glossy("leaf", white, 0.08, 30.0).with_texture("leaf.png").with_mask("leaf_mask.png"),
        Finish::glossy("herb", [0.10, 0.34, 0.06], 0.06, 30.0),
        Finish::matte("painting", white).with_texture("painting.png"),
        Finish::matte("garden", [0.62; 3]).with_texture("garden.png"),
    ];
    let (s, seed) = (p.texture, p.seed);
    model.add_picture("hexagons.png", hexagons(s, seed));
    model.add_picture("tiles.png", tiles(s / 2, seed));
    model.add_picture("mosaic.png", mosaic(s / 2, seed));
    model.add_picture("oak.png", pictures::oak(s / 2, seed));
    model.add_picture("marble.png", pictures::marble(s / 2, seed));
    model.add_picture("terry.png", terry(s / 4, seed));
    model.add_picture("label.png", pictures::label(s / 8));
    let [leaf, mask] = pictures::leaf(s / 4);
    model.add_picture("leaf.png", leaf);
    model.add_picture("leaf_mask.png", mask);
    model.add_picture("painting.png", pictures::painting(s / 2, seed));
    model.add_picture("garden.png", pictures::garden(s, seed));
}

/// Rows and columns of six-sided tiles in a repeat of the floor's picture.
pub const HEXAGONS: [f32; 2] = [4.0, 4.0 * ROW];

/// Distance of two rows of six-sided tiles of width 1, the square root of 3/4.
const ROW: f32 = 0.866_025_4;

/// Four columns and four rows of six-sided tiles, white with dark ones in a pattern; repeats at the borders.
fn hexagons(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (x, y) = (u * HEXAGONS[0], v * HEXAGONS[1]);
        // The nearest middle: of the even rows, or of the odd ones, which are shifted by half a tile.
        let mut best = (f32::MAX, 0.0, 0.0, 0);
        for shift in [0.0, 0.5] {
            let column = (x - shift).round() + shift;
            let row = ((y / ROW - 2.0 * shift) * 0.5).round() * 2.0 + 2.0 * shift;
            let (dx, dy) = (x - column, y - row * ROW);
            let d = dx * dx + dy * dy;
            if d < best.0 {
                let id = (column.floor() as i32).rem_euclid(4) + 4 * (row as i32).rem_euclid(4);
                best = (d, dx.abs(), dy.abs(), id);
            }
        }
        let (_, dx, dy, id) = best;
        let joint = 0.5 - dx.max(0.5 * dx + ROW * dy);
        let tone = 0.93 + 0.07 * unit(hash(id as u32 + seed));
        let cloud = 0.95 + 0.08 * clouds(u, v, 8, seed + 1);
        let dark = matches!(id, 0 | 10);
        let tile: Colour = if dark { [0.10, 0.25, 0.27] } else { [0.90, 0.89, 0.85] };
        mix([0.56, 0.56, 0.54], shade(tile, tone * cloud), ramp(0.025, 0.055, joint))
    })
}

/// Two columns and four rows of white tiles, twice as long as high, each row shifted by half a tile; repeats at the borders.
fn tiles(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let row = (v * 4.0).floor();
        let x = u * 2.0 + 0.5 * (row - 2.0 * (row * 0.5).floor());
        let column = x.floor();
        let (fx, fy) = (x - column, v * 4.0 - row);
        let joint = (2.0 * fx.min(1.0 - fx)).min(fy.min(1.0 - fy));
        let id = (column as i32).rem_euclid(2) as u32 + 2 * row as u32;
        let tone = 0.95 + 0.05 * unit(hash(id + seed + 40));
        let edge = 0.90 + 0.10 * ramp(0.04, 0.14, joint);
        mix([0.66, 0.66, 0.63], shade([0.92, 0.93, 0.91], tone * edge), ramp(0.02, 0.045, joint))
    })
}

/// Eight by eight small tiles in blues and greens; repeats at the borders.
fn mosaic(size: u32, seed: u32) -> Canvas {
    let palette: [Colour; 5] =
        [[0.10, 0.38, 0.42], [0.20, 0.52, 0.54], [0.36, 0.66, 0.64], [0.58, 0.78, 0.74], [0.14, 0.44, 0.55]];
    Canvas::new(size, size, |u, v| {
        let (tx, ty) = ((u * 8.0).floor(), (v * 8.0).floor());
        let (fx, fy) = (u * 8.0 - tx, v * 8.0 - ty);
        let joint = fx.min(1.0 - fx).min(fy.min(1.0 - fy));
        let bits = hash(tx as u32 + 8 * ty as u32 + seed.wrapping_mul(31));
        let tile = shade(palette[bits as usize % 5], 0.88 + 0.2 * unit(hash(bits)));
        mix([0.80, 0.82, 0.80], tile, ramp(0.03, 0.08, joint))
    })
}

/// Loops of terry cloth, light on dark.
fn terry(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let loops = noise(u * 48.0, v * 48.0, 48, seed + 2);
        let nap = clouds(u, v, 6, seed + 3);
        shade([1.0; 3], 0.74 + 0.20 * loops + 0.10 * nap)
    })
}
