// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kitchen's materials and the pictures on them.

use super::Parameters;
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters) {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::glossy("floor", white, 0.15, 80.0).with_texture("floor.png"),
        Finish::glossy("tiles", white, 0.35, 160.0).with_texture("tiles.png"),
        Finish::matte("plaster", [0.84, 0.76, 0.60]),
        Finish::matte("ceiling", [0.84, 0.82, 0.77]),
        Finish::glossy("trim", [0.78, 0.76, 0.70], 0.10, 40.0),
        Finish::glossy("blue-paint", [0.075, 0.165, 0.235], 0.12, 50.0),
        Finish::glossy("cream-paint", [0.76, 0.71, 0.60], 0.10, 50.0),
        Finish::matte("plinth", [0.03, 0.035, 0.04]),
        Finish::glossy("oak", [1.0, 0.95, 0.88], 0.10, 50.0).with_texture("oak.png"),
        Finish::glossy("walnut", [0.50, 0.40, 0.33], 0.10, 50.0).with_texture("oak.png"),
        Finish::glossy("chair-wood", [0.56, 0.30, 0.12], 0.25, 70.0),
        finishes::steel(),
        finishes::chrome(),
        finishes::copper(),
        finishes::brass(),
        finishes::iron(),
        Finish::glossy("black-glass", [0.015, 0.016, 0.018], 0.55, 300.0),
        Finish::glossy("black-plastic", [0.02, 0.02, 0.02], 0.25, 60.0),
        Finish::glossy("red-enamel", [0.52, 0.035, 0.025], 0.5, 180.0),
        Finish::glossy("cream-enamel", [0.80, 0.74, 0.60], 0.4, 160.0),
        finishes::shade_inside(),
        finishes::bulb(),
        finishes::porcelain(),
        Finish::glossy("blue-glaze", [0.07, 0.17, 0.36], 0.45, 200.0),
        Finish::glossy("yellow-glaze", [0.72, 0.45, 0.08], 0.45, 200.0),
        finishes::glass(),
        finishes::pane(),
        Finish::glossy("bottle-green", [0.03, 0.13, 0.05], 0.5, 160.0),
        Finish::glossy("bottle-oil", [0.55, 0.40, 0.04], 0.5, 160.0),
        Finish::matte("label", white).with_texture("label.png"),
        Finish::matte("cork", [0.50, 0.34, 0.19]),
        Finish::matte("pasta", [0.80, 0.58, 0.24]),
        Finish::matte("rice", [0.82, 0.78, 0.68]),
        Finish::matte("lentils", [0.50, 0.18, 0.06]),
        Finish::matte("coffee-beans", [0.13, 0.06, 0.03]),
        Finish::matte("paprika", [0.58, 0.09, 0.03]),
        Finish::matte("turmeric", [0.75, 0.42, 0.03]),
        Finish::matte("dried-herbs", [0.20, 0.27, 0.09]),
        finishes::crust(),
        Finish::matte("butter", [0.88, 0.74, 0.33]),
        Finish::glossy("apple", [0.62, 0.05, 0.035], 0.30, 70.0),
        Finish::glossy("pear", [0.50, 0.55, 0.09], 0.18, 50.0),
        Finish::glossy("orange", [0.86, 0.33, 0.02], 0.20, 40.0),
        Finish::glossy("banana", [0.86, 0.62, 0.06], 0.15, 40.0),
        Finish::glossy("juice", [0.90, 0.42, 0.05], 0.1, 60.0),
        Finish::matte("stalk", [0.16, 0.09, 0.04]),
        finishes::stem(),
        Finish::glossy("herb", [0.10, 0.34, 0.06], 0.06, 30.0),
        Finish::matte("terracotta", [0.52, 0.22, 0.11]),
        Finish::matte("soil", [0.06, 0.04, 0.025]),
        Finish::matte("rug", white).with_texture("rug.png"),
        Finish::matte("red-cloth", white).with_texture("cloth.png"),
        Finish::matte("book-red", [0.45, 0.08, 0.06]),
        Finish::matte("book-green", [0.12, 0.30, 0.16]),
        Finish::matte("book-ochre", [0.66, 0.42, 0.10]),
        Finish::matte("paper", [0.80, 0.77, 0.68]),
        Finish::matte("clock-face", white).with_texture("clock.png"),
        Finish::matte("painting", white).with_texture("painting.png"),
        Finish::matte("garden", [0.62; 3]).with_texture("garden.png"),
    ];
    let (s, seed) = (p.texture, p.seed);
    model.add_picture("floor.png", floor(s, seed));
    model.add_picture("tiles.png", tiles(s, seed));
    model.add_picture("oak.png", pictures::oak(s / 2, seed));
    model.add_picture("label.png", pictures::label(s / 8));
    model.add_picture("rug.png", rug(s / 4, seed));
    model.add_picture("cloth.png", cloth(s / 8));
    model.add_picture("clock.png", pictures::clock(s / 4));
    model.add_picture("painting.png", pictures::painting(s / 2, seed));
    model.add_picture("garden.png", pictures::garden(s, seed));
}

/// Two by two cream octagons with small blue squares between them; repeats at the borders.
fn floor(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (tx, ty) = ((u * 2.0).floor(), (v * 2.0).floor());
        let (x, y) = ((u * 2.0 - tx - 0.5).abs(), (v * 2.0 - ty - 0.5).abs());
        let veins = clouds(u, v, 6, seed);
        let fine = clouds(u, v, 32, seed + 1);
        // The distance to the corner where four tiles meet, along the diagonal.
        let corner = 1.0 - x - y;
        let tone = 0.92 + 0.12 * noise(tx + 2.0 * ty, 0.0, 4, seed + 2);
        let cream = mix([0.80, 0.70, 0.56], [0.91, 0.84, 0.71], veins);
        let blue = mix([0.10, 0.19, 0.28], [0.17, 0.28, 0.38], veins);
        let (tile, joint) = if corner < 0.19 {
            (blue, 0.19 - corner)
        } else {
            (shade(cream, tone), (corner - 0.19).min(0.5 - x.max(y)))
        };
        mix([0.50, 0.46, 0.40], shade(tile, 0.93 + 0.12 * fine), ramp(0.008, 0.020, joint))
    })
}

/// Four by four wall tiles: white ones, and blue and white ones with a flower; repeats at the borders.
fn tiles(size: u32, seed: u32) -> Canvas {
    let white: Colour = [0.93, 0.93, 0.90];
    let blue: Colour = [0.13, 0.27, 0.55];
    let ochre: Colour = [0.85, 0.62, 0.20];
    Canvas::new(size, size, |u, v| {
        let (tx, ty) = ((u * 4.0).floor(), (v * 4.0).floor());
        let (x, y) = (u * 4.0 - tx - 0.5, v * 4.0 - ty - 0.5);
        let (ax, ay) = (x.abs(), y.abs());
        let joint = 0.5 - ax.max(ay);
        let tone = 0.955 + 0.045 * noise(tx + 4.0 * ty, 0.5, 16, seed + 3);
        let mut c = white;
        if (tx as i32 + ty as i32) % 2 == 0 {
            let r = (x * x + y * y).sqrt();
            // Four petals along the diagonals: two discs that overlap make each.
            let (p, q) = (ax - 0.02, ay - 0.02);
            let petal = (p - 0.27) * (p - 0.27) + q * q < 0.075 && p * p + (q - 0.27) * (q - 0.27) < 0.075;
            let ring = (r - 0.40).abs() < 0.016;
            let bud = ax.min(ay) < 0.035 && r > 0.22 && r < 0.36;
            let corner = (0.5 - ax) + (0.5 - ay);
            if petal || bud {
                c = blue;
            }
            if ring || corner < 0.17 {
                c = mix(blue, white, 0.25);
            }
            if r < 0.075 {
                c = ochre;
            }
        }
        let edge = 0.90 + 0.10 * ramp(0.02, 0.06, joint);
        mix([0.66, 0.65, 0.61], shade(c, tone * edge), ramp(0.010, 0.020, joint))
    })
}

/// Woven stripes across v.
fn rug(size: u32, seed: u32) -> Canvas {
    let stripes: [Colour; 8] = [
        [0.72, 0.16, 0.12],
        [0.90, 0.84, 0.72],
        [0.16, 0.28, 0.42],
        [0.90, 0.84, 0.72],
        [0.84, 0.58, 0.18],
        [0.90, 0.84, 0.72],
        [0.16, 0.28, 0.42],
        [0.90, 0.84, 0.72],
    ];
    Canvas::new(size, size, |u, v| {
        let weave = noise(u * 64.0, v * 64.0, 64, seed + 12);
        shade(stripes[((v * 8.0) as usize).min(7)], 0.82 + 0.22 * weave)
    })
}

/// Red and white checks, woven.
fn cloth(size: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let band = |t: f32| {
            let f = t * 2.0 - (t * 2.0).floor();
            if f < 0.5 { 1.0 } else { 0.0 }
        };
        let red = 0.5 * band(u) + 0.5 * band(v);
        mix([0.92, 0.88, 0.82], [0.66, 0.09, 0.08], red)
    })
}
