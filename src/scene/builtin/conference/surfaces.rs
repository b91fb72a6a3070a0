// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conference room's materials and the pictures on them.

use super::Parameters;
use crate::scene::builtin::mesh::{hash, unit};
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Dark writing.
const INK: Colour = [0.10, 0.12, 0.20];

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters) {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::matte("carpet", white).with_texture("carpet.png"),
        Finish::matte("ceiling", white).with_texture("ceiling.png"),
        Finish::matte("white-wall", [0.80, 0.80, 0.78]),
        Finish::matte("warm-wall", [0.72, 0.62, 0.50]),
        Finish::matte("dark-wall", [0.05, 0.045, 0.04]),
        Finish::glossy("white-board", [0.80, 0.80, 0.79], 0.12, 60.0),
        Finish::glossy("oak", [0.86, 0.74, 0.58], 0.08, 40.0).with_texture("oak.png"),
        Finish::glossy("walnut", [0.62, 0.46, 0.34], 0.22, 110.0).with_texture("oak.png"),
        Finish::glossy("slats", [0.74, 0.74, 0.72], 0.15, 40.0),
        Finish::glossy("aluminium", [0.55, 0.56, 0.58], 0.35, 60.0),
        Finish::glossy("dark-metal", [0.055, 0.058, 0.065], 0.25, 60.0),
        Finish::matte("cord", [0.78, 0.78, 0.76]),
        finishes::chrome(),
        finishes::steel(),
        finishes::brass(),
        finishes::iron(),
        finishes::shade_inside(),
        finishes::bulb(),
        finishes::glass(),
        finishes::pane(),
        finishes::porcelain(),
        finishes::stem(),
        finishes::crust(),
        Finish::glossy("water", [0.30, 0.42, 0.48], 0.3, 200.0),
        Finish::matte("coffee", [0.05, 0.025, 0.015]),
        Finish::glossy("bottle-green", [0.03, 0.15, 0.07], 0.5, 160.0),
        Finish::matte("fabric", white).with_texture("fabric.png"),
        Finish::glossy("black-plastic", [0.022, 0.023, 0.026], 0.30, 70.0),
        Finish::glossy("red-plastic", [0.62, 0.03, 0.03], 0.35, 90.0),
        Finish::glossy("blue-plastic", [0.03, 0.10, 0.45], 0.35, 90.0),
        Finish::matte("paper", [0.86, 0.86, 0.83]),
        Finish::matte("chart-paper", white).with_texture("handout.png"),
        Finish::matte("name-card", white).with_texture("name.png"),
        Finish::glossy("screen", white, 0.10, 120.0).with_texture("screen.png"),
        Finish::glossy("laptop-screen", white, 0.15, 120.0).with_texture("laptop.png"),
        Finish::matte("flip-paper", white).with_texture("flip.png"),
        Finish::matte("clock-face", white).with_texture("clock.png"),
        Finish::glossy("leaf", white, 0.12, 40.0).with_texture("leaf.png").with_mask("leaf-mask.png"),
        Finish::matte("soil", [0.07, 0.045, 0.03]),
        Finish::matte("town", white).with_texture("town.png"),
    ];
    let (s, seed) = (p.texture, p.seed);
    model.add_picture("carpet.png", carpet(s, seed));
    model.add_picture("ceiling.png", ceiling(s / 2, seed));
    model.add_picture("oak.png", pictures::oak(s, seed));
    model.add_picture("fabric.png", fabric(s / 4, seed));
    model.add_picture("handout.png", handout(s / 4));
    model.add_picture("name.png", name(s / 4));
    model.add_picture("screen.png", screen(s * 2));
    model.add_picture("laptop.png", laptop(s / 4));
    model.add_picture("flip.png", flip(s));
    model.add_picture("clock.png", pictures::clock(s / 2));
    model.add_picture("town.png", town(s * 2, seed));
    let [leaf, mask] = pictures::leaf(s / 4);
    model.add_picture("leaf.png", leaf);
    model.add_picture("leaf-mask.png", mask);
}

/// Square carpet tiles in blue and grey; four by four a repeat.
fn carpet(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (x, y) = (u * 4.0, v * 4.0);
        let tile = hash(x as u32 * 7 + y as u32 * 13 + seed);
        let loops =
            if tile & 1 == 0 { noise(x * 32.0, y * 8.0, 128, seed) } else { noise(x * 8.0, y * 32.0, 128, seed) };
        let base = mix([0.24, 0.29, 0.37], [0.36, 0.40, 0.46], unit(hash(tile)));
        let fine = noise(u * 256.0, v * 256.0, 256, seed + 3);
        shade(base, 0.72 + 0.30 * loops + 0.16 * fine)
    })
}

/// Two by two panels with small holes between thin rails.
fn ceiling(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (x, y) = (u * 2.0 - (u * 2.0).floor(), v * 2.0 - (v * 2.0).floor());
        let rail = x.min(1.0 - x).min(y).min(1.0 - y);
        let fleck = noise(u * 128.0, v * 128.0, 128, seed + 4);
        let panel = shade([0.90, 0.90, 0.88], if fleck > 0.80 { 0.80 } else { 1.0 });
        mix([0.97, 0.97, 0.96], mix([0.55, 0.55, 0.55], panel, ramp(0.022, 0.028, rail)), ramp(0.016, 0.018, rail))
    })
}

/// Woven cloth.
fn fabric(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let weave = noise(u * 64.0, v * 16.0, 64, seed + 5) + noise(u * 16.0, v * 64.0, 64, seed + 6);
        shade([0.16, 0.30, 0.50], 0.62 + 0.38 * weave)
    })
}

/// Text of grey lines.
fn written(canvas: &mut Canvas, [x0, x1]: [f32; 2], from: f32, step: f32, rows: u32, width: f32) {
    for k in 0..rows {
        let y = from + step * k as f32;
        let end = x0 + (x1 - x0) * (0.62 + 0.38 * unit(hash(k + 7)));
        canvas.line((x0, y), (end, y), width, [0.42, 0.44, 0.48], 0.0);
    }
}

fn handout(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size * 3 / 2, |_, _| [0.94, 0.94, 0.92]);
    written(&mut c, [0.12, 0.88], 0.20, 0.09, 6, 0.03);
    written(&mut c, [0.12, 0.88], 0.95, 0.09, 5, 0.03);
    c
}

fn name(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size / 2, |_, v| if v > 0.86 { [0.10, 0.30, 0.55] } else { [0.95, 0.95, 0.93] });
    c.text("GUEST", (0.17, 0.33), 0.17, 0.03, INK, 0.0);
    c
}

/// A slide with bars, a line and a title.
fn screen(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size * 9 / 16, |u, v| {
        let ground = mix([0.93, 0.95, 0.98], [0.82, 0.87, 0.94], v);
        let y = v * 9.0 / 16.0;
        if y < 0.105 {
            return mix([0.06, 0.20, 0.42], [0.10, 0.34, 0.60], u);
        }
        // Bars, in pairs.
        for k in 0..6 {
            for (pair, colour) in [(0, [0.12, 0.42, 0.72]), (1, [0.96, 0.58, 0.12])] {
                let x = 0.09 + 0.090 * k as f32 + 0.034 * pair as f32;
                let tall = 0.07 + 0.042 * k as f32 - 0.030 * pair as f32 + 0.05 * unit(hash(k * 2 + pair + 3));
                if u > x && u < x + 0.030 && y < 0.50 && y > 0.50 - tall {
                    return colour;
                }
            }
        }
        // A ring in three parts.
        let (dx, dy) = (u - 0.80, y - 0.27);
        let r = (dx * dx + dy * dy).sqrt();
        if r > 0.055 && r < 0.105 {
            return if dy < 0.35 * dx {
                [0.12, 0.42, 0.72]
            } else if dx < 0.0 {
                [0.96, 0.58, 0.12]
            } else {
                [0.20, 0.62, 0.36]
            };
        }
        ground
    });
    c.text("RESULTS 2016", (0.045, 0.076), 0.050, 0.0085, [0.97, 0.97, 0.97], 0.0);
    c.lines(&[(0.06, 0.14), (0.06, 0.50), (0.64, 0.50)], 0.004, INK, 0.0);
    let line = [(0.105, 0.40), (0.195, 0.36), (0.285, 0.37), (0.375, 0.28), (0.465, 0.22), (0.60, 0.15)];
    c.lines(&line, 0.006, [0.80, 0.12, 0.16], 0.0);
    written(&mut c, [0.70, 0.92], 0.42, 0.030, 3, 0.008);
    c
}

fn laptop(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size * 5 / 8, |u, v| {
        let y = v * 0.625;
        if y < 0.07 {
            [0.16, 0.30, 0.55]
        } else if u < 0.2 {
            [0.80, 0.84, 0.90]
        } else {
            [0.95, 0.96, 0.97]
        }
    });
    written(&mut c, [0.28, 0.92], 0.16, 0.075, 6, 0.02);
    c
}

/// A sheet with a drawn plan: three boxes, arrows, and a word.
fn flip(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size * 13 / 10, |_, _| [0.95, 0.95, 0.93]);
    let blue = [0.08, 0.20, 0.62];
    let red = [0.80, 0.10, 0.10];
    c.text("PLAN", (0.26, 0.24), 0.15, 0.022, blue, 0.05);
    c.line((0.22, 0.29), (0.80, 0.275), 0.016, red, 0.05);
    for (k, colour) in [blue, [0.05, 0.45, 0.15], red].into_iter().enumerate() {
        let y = 0.42 + 0.27 * k as f32;
        let (a, b) = (0.20 + 0.05 * k as f32, 0.62 + 0.05 * k as f32);
        c.lines(&[(a, y), (b, y + 0.005), (b, y + 0.13), (a + 0.004, y + 0.125), (a, y)], 0.014, colour, 0.05);
        c.text(["1", "2", "3"][k], (a + 0.17, y + 0.105), 0.08, 0.014, colour, 0.05);
        if k < 2 {
            c.lines(&[(b - 0.10, y + 0.14), (b - 0.08, y + 0.26)], 0.012, INK, 0.05);
            c.lines(&[(b - 0.12, y + 0.225), (b - 0.08, y + 0.26), (b - 0.055, y + 0.22)], 0.012, INK, 0.05);
        }
    }
    c
}

/// Towers with rows of windows under a light sky.
fn town(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size / 2, |u, v| {
        let h = 1.0 - v;
        let cloud = ramp(0.52, 0.75, clouds(u, v, 4, seed + 21));
        let mut c = mix(mix([0.86, 0.92, 0.97], [0.46, 0.68, 0.93], h), [0.98; 3], cloud);
        // Two rows of towers: the far one is pale.
        for (row, count, base, tall, pale) in [(0u32, 26u32, 0.30, 0.38, 0.55), (1, 17, 0.16, 0.44, 0.0)] {
            let x = u * count as f32;
            let k = x as u32;
            let bits = hash(k * 31 + row * 977 + seed);
            let high = base + tall * unit(bits);
            let across = x - k as f32;
            if h < high && across > 0.04 && across < 0.96 {
                let wall = mix([0.52, 0.50, 0.48], [0.72, 0.56, 0.42], unit(hash(bits)));
                let (wx, wy) = (across * 7.0, h * 60.0);
                let pane = (wx - wx.floor() - 0.5).abs() < 0.30 && (wy - wy.floor() - 0.5).abs() < 0.30;
                let lit = unit(hash(wx as u32 + (wy as u32) * 57 + bits));
                let window = mix([0.20, 0.28, 0.38], [0.55, 0.68, 0.80], lit);
                c = mix(if pane { window } else { shade(wall, 0.75 + 0.3 * across) }, [0.78, 0.84, 0.90], pale);
            }
        }
        c
    })
}
