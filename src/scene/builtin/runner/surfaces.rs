// SPDX-License-Identifier: MIT OR Apache-2.0
//! The finish line's materials and the pictures on them.

use super::Parameters;
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Colours of the shirts.
const SHIRTS: [Colour; 3] = [[0.86, 0.12, 0.10], [0.10, 0.32, 0.80], [0.96, 0.74, 0.06]];

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters) {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::matte("track", white).with_texture("track.png"),
        Finish::matte("grass", white).with_texture("grass.png"),
        Finish::matte("sky", white).with_texture("sky.png"),
        Finish::glossy("white-paint", [0.86, 0.86, 0.84], 0.15, 60.0),
        Finish::glossy("blue-paint", [0.03, 0.12, 0.34], 0.15, 60.0),
        Finish::glossy("orange-plastic", [0.90, 0.25, 0.03], 0.25, 60.0),
        Finish::glossy("black-plastic", [0.02, 0.02, 0.025], 0.40, 120.0),
        Finish::matte("banner", white).with_texture("banner.png"),
        Finish::glossy("clock-face", white, 0.20, 120.0).with_texture("clock.png"),
        Finish::matte("stripes", white).with_texture("stripes.png"),
        Finish::matte("podium", white).with_texture("podium.png"),
        Finish::glossy("oak", [1.0, 0.90, 0.78], 0.10, 50.0).with_texture("oak.png"),
        Finish::glossy("ball", [0.82, 0.36, 0.10], 0.20, 40.0),
        Finish::matte("ribbon", [0.90, 0.06, 0.10]),
        Finish::glossy("water", [0.10, 0.42, 0.62], 0.5, 200.0),
        Finish::mirror("gold", [0.14, 0.09, 0.02], [0.86, 0.62, 0.22]),
        Finish::mirror("lenses", [0.02, 0.03, 0.05], [0.55, 0.62, 0.72]),
        finishes::chrome(),
        finishes::iron(),
        finishes::glass(),
    ];
    let skins = [[0.46, 0.24, 0.14], [0.68, 0.42, 0.29], [0.20, 0.10, 0.06]];
    let shorts = [[0.04, 0.05, 0.10], [0.80, 0.80, 0.80], [0.02, 0.20, 0.10]];
    let shoes = [[0.85, 0.85, 0.82], [0.90, 0.32, 0.04], [0.06, 0.45, 0.62]];
    let hairs = [[0.03, 0.02, 0.015], [0.30, 0.15, 0.05], [0.015, 0.012, 0.012]];
    for k in 0..3 {
        let n = k + 1;
        model.materials.push(Finish::glossy(&format!("skin-{n}"), skins[k], 0.10, 25.0));
        model.materials.push(Finish::matte(&format!("shirt-{n}"), white).with_texture(&format!("shirt-{n}.png")));
        model.materials.push(Finish::matte(&format!("shorts-{n}"), shorts[k]));
        model.materials.push(Finish::glossy(&format!("shoes-{n}"), shoes[k], 0.15, 40.0));
        model.materials.push(Finish::glossy(&format!("hair-{n}"), hairs[k], 0.10, 20.0));
        model.add_picture(&format!("shirt-{n}.png"), shirt(p.texture / 2, SHIRTS[k], ["7", "12", "25"][k]));
    }
    let (s, seed) = (p.texture, p.seed);
    model.add_picture("track.png", track(s, seed));
    model.add_picture("grass.png", grass(s / 2, seed));
    model.add_picture("sky.png", sky(s * 2, seed));
    model.add_picture("banner.png", banner(s));
    model.add_picture("clock.png", clock(s / 2));
    model.add_picture(
        "stripes.png",
        Canvas::new(s / 4, s / 8, |u, _| {
            if ((u * 8.0) as u32).is_multiple_of(2) { [0.95, 0.95, 0.93] } else { [0.85, 0.10, 0.08] }
        }),
    );
    model.add_picture("podium.png", podium(s));
    model.add_picture("oak.png", pictures::oak(s / 2, seed));
}

/// Red granules with a white line at the left border: one lane a repeat.
fn track(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let grain = noise(u * 160.0, v * 160.0, 160, seed);
        let worn = clouds(u, v, 4, seed + 1);
        let ground = shade([0.70, 0.25, 0.18], 0.80 + 0.18 * grain + 0.16 * worn);
        let line = 0.5 - (u - 0.5).abs();
        mix([0.93, 0.92, 0.90], ground, ramp(0.018, 0.022, line))
    })
}

/// Mown grass.
fn grass(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let blades = noise(u * 128.0, v * 48.0, 16, seed + 5);
        let patch = clouds(u, v, 5, seed + 6);
        let stripe = if v < 0.5 { 0.92 } else { 1.06 };
        shade(mix([0.18, 0.40, 0.10], [0.34, 0.56, 0.16], patch), (0.75 + 0.40 * blades) * stripe)
    })
}

/// Sky with clouds above trees and a stand.
fn sky(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size / 2, |u, v| {
        let cloud = clouds(u, v * 1.6, 4, seed + 9);
        let blue = mix([0.36, 0.60, 0.92], [0.78, 0.88, 0.97], ramp(0.0, 0.85, v));
        let sky = mix(blue, [0.98, 0.98, 0.98], ramp(0.46, 0.66, cloud));
        let crown = 0.70 + 0.10 * clouds(u, 0.3, 12, seed + 10) - 0.05 * clouds(u, 0.7, 40, seed + 11);
        let leaf = clouds(u * 2.0, v * 2.0, 24, seed + 12);
        let trees =
            shade(mix([0.10, 0.26, 0.09], [0.30, 0.50, 0.18], ramp(0.30, 0.70, leaf)), 0.7 + 0.5 * ramp(1.0, 0.70, v));
        mix(sky, trees, ramp(0.0, 0.008, v - crown))
    })
}

/// A shirt's cloth with a number on a white field.
fn shirt(size: u32, cloth: Colour, number: &str) -> Canvas {
    let mut canvas = Canvas::new(size, size, |u, v| {
        let weave = noise(u * 64.0, v * 64.0, 64, 3);
        let field = (u - 0.5).abs() < 0.155 && (v - 0.50).abs() < 0.125;
        let side = (u - 0.5).abs() > 0.24;
        if field {
            [0.95, 0.95, 0.94]
        } else if side {
            shade(cloth, 0.55)
        } else {
            shade(cloth, 0.92 + 0.08 * weave)
        }
    });
    let tall = 0.17;
    let wide = Canvas::measure(number, tall);
    canvas.text(number, (0.5 - 0.5 * wide + 0.014, 0.585), tall, 0.030, [0.04, 0.04, 0.06], 0.0);
    canvas
}

/// The word that every runner wants to read.
fn banner(size: u32) -> Canvas {
    let mut canvas = Canvas::new(size, size / 8, |u, v| {
        let edge = v.min(1.0 - v) < 0.10;
        if (u - 0.5).abs() > 0.36 {
            let check = ((u * 50.0) as u32 + (v * 6.25) as u32).is_multiple_of(2);
            return if check { [0.95; 3] } else { [0.04; 3] };
        }
        if edge { [0.95, 0.95, 0.93] } else { [0.08, 0.20, 0.52] }
    });
    let tall = 0.072;
    let wide = Canvas::measure("FINISH", tall);
    canvas.text("FINISH", (0.5 - 0.5 * wide, 0.099), tall, 0.013, [0.97, 0.97, 0.95], 0.0);
    canvas
}

/// A clock that shows the seconds.
fn clock(size: u32) -> Canvas {
    let mut canvas = Canvas::new(size, size / 3, |_, _| [0.03, 0.03, 0.035]);
    let wide = Canvas::measure("12.48", 0.22);
    canvas.text("12.48", (0.5 - 0.5 * wide, 0.275), 0.22, 0.034, [1.0, 0.72, 0.08], 0.0);
    canvas
}

/// The three numbers of a podium side by side: second, first, third.
fn podium(size: u32) -> Canvas {
    let mut canvas = Canvas::new(size, size / 3, |_, v| if v < 0.04 { [0.85, 0.68, 0.25] } else { [0.93, 0.93, 0.92] });
    for (k, digit) in ["2", "1", "3"].iter().enumerate() {
        canvas.text(digit, (0.12 + k as f32 / 3.0, 0.25), 0.16, 0.026, [0.08, 0.20, 0.52], 0.0);
    }
    canvas
}
