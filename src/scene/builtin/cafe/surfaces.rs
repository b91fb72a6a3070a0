// SPDX-License-Identifier: MIT OR Apache-2.0
//! The café's materials and the pictures on them.

use super::Parameters;
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters) {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::glossy("floor", white, 0.12, 60.0).with_texture("floor.png"),
        Finish::matte("plaster", [0.80, 0.70, 0.53]),
        Finish::matte("ceiling", [0.80, 0.77, 0.70]),
        Finish::glossy("panelling", [0.62, 0.82, 0.74], 0.05, 30.0).with_texture("boards.png"),
        Finish::glossy("trim", [0.055, 0.135, 0.115], 0.08, 40.0),
        Finish::glossy("oak", [1.0, 0.95, 0.88], 0.06, 40.0).with_texture("oak.png"),
        Finish::glossy("walnut", [0.45, 0.36, 0.30], 0.08, 40.0).with_texture("oak.png"),
        Finish::glossy("bentwood", [0.16, 0.055, 0.025], 0.35, 90.0),
        Finish::glossy("cane", white, 0.02, 10.0).with_texture("cane.png"),
        Finish::glossy("marble", white, 0.25, 160.0).with_texture("marble.png"),
        finishes::iron(),
        finishes::chrome(),
        finishes::brass(),
        finishes::mirror(),
        Finish::glossy("gilding", [0.60, 0.40, 0.12], 0.5, 50.0),
        Finish::glossy("red-enamel", [0.52, 0.035, 0.025], 0.5, 180.0),
        Finish::glossy("green-enamel", [0.03, 0.16, 0.12], 0.5, 160.0),
        finishes::shade_inside(),
        finishes::bulb(),
        Finish::glossy("black-plastic", [0.02, 0.02, 0.02], 0.25, 60.0),
        finishes::porcelain(),
        Finish::glossy("coffee", [0.45, 0.25, 0.11], 0.10, 80.0),
        finishes::glass(),
        finishes::pane(),
        Finish::glossy("juice", [0.90, 0.36, 0.03], 0.1, 60.0),
        Finish::glossy("tea", [0.45, 0.035, 0.05], 0.1, 60.0),
        finishes::crust(),
        Finish::glossy("chocolate", [0.11, 0.042, 0.020], 0.25, 50.0),
        Finish::matte("cream", [0.86, 0.79, 0.66]),
        Finish::glossy("cherry", [0.55, 0.015, 0.03], 0.6, 120.0),
        Finish::matte("berry", [0.80, 0.36, 0.42]),
        Finish::matte("terracotta", [0.50, 0.20, 0.10]),
        Finish::matte("soil", [0.06, 0.04, 0.025]),
        Finish::glossy("leaf", white, 0.08, 30.0).with_texture("leaf.png").with_mask("leaf_mask.png"),
        finishes::stem(),
        Finish::matte("chalkboard", white).with_texture("menu.png"),
        Finish::matte("painting", white).with_texture("painting.png"),
        Finish::matte("clock-face", white).with_texture("clock.png"),
        Finish::matte("gauge", white).with_texture("clock.png"),
        Finish::matte("street", [0.75; 3]).with_texture("street.png"),
        Finish::matte("label", white).with_texture("label.png"),
        Finish::glossy("bottle-green", [0.03, 0.15, 0.06], 0.5, 160.0),
        Finish::glossy("bottle-amber", [0.36, 0.13, 0.02], 0.5, 160.0),
        Finish::glossy("bottle-blue", [0.04, 0.11, 0.30], 0.5, 160.0),
        Finish::glossy("bottle-clear", [0.62, 0.62, 0.56], 0.5, 160.0),
        Finish::matte("book-red", [0.45, 0.08, 0.06]),
        Finish::matte("book-blue", [0.07, 0.16, 0.32]),
        Finish::matte("book-ochre", [0.60, 0.38, 0.08]),
        Finish::matte("book-green", [0.10, 0.26, 0.12]),
        Finish::matte("paper", [0.78, 0.74, 0.64]),
        Finish::glossy("rose", [0.75, 0.10, 0.14], 0.05, 20.0),
    ];
    let s = p.texture;
    let seed = p.seed;
    model.add_picture("floor.png", floor(s, seed));
    model.add_picture("boards.png", boards(s / 2, seed));
    model.add_picture("oak.png", pictures::oak(s / 2, seed));
    model.add_picture("cane.png", cane(s / 8));
    model.add_picture("marble.png", pictures::marble(s / 2, seed));
    let [leaf, mask] = pictures::leaf(s / 4);
    model.add_picture("leaf.png", leaf);
    model.add_picture("leaf_mask.png", mask);
    model.add_picture("menu.png", menu(s, seed));
    model.add_picture("painting.png", pictures::painting(s / 2, seed));
    model.add_picture("clock.png", pictures::clock(s / 4));
    model.add_picture("street.png", street(s, seed));
    model.add_picture("label.png", pictures::label(s / 8));
}

/// Four tiles, two light and two dark, as checks; repeats at the borders.
fn floor(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (tx, ty) = ((u * 2.0).floor(), (v * 2.0).floor());
        let (x, y) = (u * 2.0 - tx, v * 2.0 - ty);
        let joint = x.min(y).min(1.0 - x).min(1.0 - y);
        let dark = tx != ty;
        let veins = clouds(u, v, 6, seed);
        let fine = clouds(u, v, 24, seed + 1);
        let base = if dark {
            mix([0.16, 0.25, 0.25], [0.27, 0.36, 0.35], veins)
        } else {
            mix([0.80, 0.74, 0.63], [0.93, 0.88, 0.79], veins)
        };
        let tile = shade(base, 0.93 + 0.12 * fine);
        mix([0.52, 0.48, 0.42], tile, ramp(0.010, 0.022, joint))
    })
}

/// Upright boards with grooves; four boards a repeat.
fn boards(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let board = (u * 4.0).floor();
        let x = u * 4.0 - board;
        let groove = ramp(0.0, 0.06, x.min(1.0 - x));
        let tone = 0.92 + 0.16 * noise(board, 0.0, 4, seed + 2);
        let grain = 0.93 + 0.14 * noise(u * 64.0, v * 4.0, 64, seed + 3);
        shade([0.27, 0.42, 0.37], tone * grain * (0.45 + 0.55 * groove))
    })
}

/// Woven cane: light strips with dark gaps.
fn cane(size: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let strip = |t: f32| {
            let f = t * 4.0 - (t * 4.0).floor();
            ramp(0.0, 0.18, f.min(1.0 - f) - 0.12)
        };
        let (a, b) = (strip(u), strip(v));
        mix([0.28, 0.17, 0.08], mix([0.80, 0.63, 0.38], [0.88, 0.73, 0.48], a), a.max(b))
    })
}

const CHALK: Colour = [0.93, 0.92, 0.86];

/// The menu on the blackboard.
fn menu(size: u32, seed: u32) -> Canvas {
    let mut c = Canvas::new(size, size, |u, v| {
        let wiped = clouds(u * 0.5, v, 4, seed + 12);
        mix([0.085, 0.10, 0.095], [0.20, 0.215, 0.205], wiped * wiped)
    });
    let (yellow, pink, blue) = ([0.95, 0.80, 0.42], [0.93, 0.60, 0.55], [0.62, 0.82, 0.88]);
    let heading = "CAFE";
    let h = 0.17;
    c.text(heading, (0.5 - 0.5 * Canvas::measure(heading, h) + 0.012, 0.23), h, 0.020, yellow, 0.35);
    // The accent on the E.
    c.line((0.697, 0.035), (0.735, 0.012), 0.016, yellow, 0.35);
    // A wavy line below the heading.
    let wave: Vec<(f32, f32)> = (0..=32)
        .map(|i| {
            let t = i as f32 / 32.0;
            let saw = t * 6.0 - (t * 6.0).floor();
            (0.14 + 0.72 * t, 0.285 + 0.06 * saw * (1.0 - saw))
        })
        .collect();
    c.lines(&wave, 0.008, pink, 0.4);
    let items =
        [("ESPRESSO", "2.20"), ("CAPPUCCINO", "3.10"), ("TEA", "2.50"), ("CAKE", "3.80"), ("CROISSANT", "2.00")];
    for (i, (what, price)) in items.into_iter().enumerate() {
        let y = 0.40 + 0.089 * i as f32;
        let h = 0.060;
        let end = c.text(what, (0.09, y), h, 0.0105, CHALK, 0.35);
        let start = 0.915 - Canvas::measure(price, h);
        let mut x = end + 0.03;
        while x < start - 0.03 {
            c.line((x, y), (x, y), 0.008, CHALK, 0.3);
            x += 0.028;
        }
        c.text(price, (start, y), h, 0.0105, yellow, 0.35);
    }
    // A steaming cup and a cake below.
    let cup = [(0.20, 0.86), (0.22, 0.935), (0.25, 0.955), (0.33, 0.955), (0.36, 0.935), (0.38, 0.86), (0.20, 0.86)];
    c.lines(&cup, 0.010, blue, 0.3);
    c.lines(&[(0.375, 0.875), (0.42, 0.875), (0.425, 0.91), (0.36, 0.93)], 0.009, blue, 0.3);
    c.lines(&[(0.15, 0.975), (0.44, 0.975)], 0.010, blue, 0.3);
    for x in [0.25, 0.29, 0.33] {
        c.lines(&[(x, 0.845), (x + 0.012, 0.832), (x - 0.006, 0.818), (x + 0.008, 0.803)], 0.007, CHALK, 0.4);
    }
    c.lines(&[(0.60, 0.955), (0.60, 0.89), (0.80, 0.86), (0.84, 0.89), (0.84, 0.955), (0.60, 0.955)], 0.010, pink, 0.3);
    c.lines(&[(0.60, 0.89), (0.84, 0.89)], 0.009, pink, 0.3);
    c.lines(&[(0.61, 0.922), (0.83, 0.922)], 0.007, CHALK, 0.4);
    c.line((0.75, 0.848), (0.75, 0.846), 0.026, pink, 0.2);
    c
}

/// House fronts across the street under a light sky.
fn street(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size / 2, |u, v| {
        let h = 1.0 - v;
        let houses = 5.0;
        let house = (u * houses).floor();
        let x = u * houses - house;
        let tall = 0.72 + 0.22 * noise(house, 0.0, 5, seed + 17);
        let roof = tall + 0.05 * (1.0 - (x - 0.5).abs() * 2.0);
        if h > roof {
            return mix([0.86, 0.91, 0.96], [0.66, 0.80, 0.94], ramp(0.6, 1.0, h));
        }
        if h > tall - 0.03 {
            return mix([0.55, 0.27, 0.20], [0.66, 0.36, 0.27], noise(u * 90.0, h * 60.0, 128, seed + 18));
        }
        let palette: [Colour; 5] =
            [[0.85, 0.72, 0.54], [0.73, 0.53, 0.44], [0.86, 0.82, 0.74], [0.66, 0.71, 0.66], [0.88, 0.70, 0.60]];
        let wall = shade(palette[house as usize % 5], 0.94 + 0.1 * clouds(u, v, 16, seed + 19));
        if h < 0.07 {
            return [0.55, 0.54, 0.53];
        }
        let (column, row) = (x * 3.0 - (x * 3.0).floor(), h * 5.0 - (h * 5.0).floor());
        let (dx, dy) = ((column - 0.5).abs(), (row - 0.55).abs());
        if dx < 0.24 && dy < 0.30 && h > 0.2 {
            if dx < 0.025 || (row - 0.62).abs() < 0.02 || dx > 0.20 || dy > 0.27 {
                return [0.93, 0.91, 0.86];
            }
            return mix([0.30, 0.38, 0.45], [0.60, 0.70, 0.78], row);
        }
        // Shops: awnings above dark doors.
        if h < 0.2 && (x - 0.5).abs() < 0.42 {
            if h > 0.155 {
                let stripe = (x * 16.0).floor() as i32 % 2 == 0;
                return if stripe { [0.90, 0.87, 0.80] } else { [0.62, 0.22, 0.18] };
            }
            return mix([0.22, 0.24, 0.26], [0.40, 0.44, 0.46], x);
        }
        wall
    })
}
