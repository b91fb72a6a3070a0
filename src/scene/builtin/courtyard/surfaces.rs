// SPDX-License-Identifier: MIT OR Apache-2.0
//! The courtyard's materials and the pictures on them.

use super::Parameters;
use crate::Result;
use crate::monitor::Monitor;
use crate::scene::builtin::mesh::{hash, unit};
use crate::scene::builtin::model::{Finish, Model};
use crate::scene::builtin::paint::{Canvas, Colour, clouds, mix, noise, ramp, shade};
use crate::scene::builtin::parts::{finishes, pictures};

/// Adds all materials and pictures.
pub fn add(model: &mut Model, p: &Parameters, monitor: &Monitor) -> Result<()> {
    let white = [1.0; 3];
    model.materials = vec![
        Finish::matte("sand", white).with_texture("sand.png"),
        Finish::glossy("paving", white, 0.05, 30.0).with_texture("paving.png"),
        Finish::glossy("terracotta-tiles", white, 0.10, 50.0).with_texture("floor.png"),
        Finish::matte("stone", white).with_texture("stone.png"),
        Finish::glossy("fountain-stone", [0.86, 0.86, 0.84], 0.12, 50.0).with_texture("stone.png"),
        Finish::matte("plaster", white).with_texture("plaster.png"),
        Finish::matte("ochre", white).with_texture("ochre.png"),
        Finish::matte("roof-tile", white).with_texture("tile.png"),
        Finish::matte("sky", white).with_texture("sky.png"),
        Finish::glossy("dark-green", [0.03, 0.10, 0.06], 0.15, 50.0),
        Finish::glossy("shutter", [0.10, 0.24, 0.22], 0.10, 40.0),
        Finish::glossy("cream-paint", [0.76, 0.72, 0.62], 0.10, 50.0),
        Finish::matte("dark-wood", [0.45, 0.36, 0.30]).with_texture("oak.png"),
        Finish::glossy("oak", [1.0, 0.92, 0.80], 0.10, 50.0).with_texture("oak.png"),
        Finish::matte("bark", white).with_texture("bark.png"),
        Finish::glossy("leaf", white, 0.10, 40.0).with_texture("leaf.png").with_mask("leaf-mask.png"),
        Finish::glossy("ivy", white, 0.08, 40.0).with_texture("ivy.png").with_mask("ivy-mask.png"),
        Finish::glossy("box-leaf", [0.62, 0.78, 0.50], 0.08, 40.0).with_texture("leaf.png").with_mask("leaf-mask.png"),
        Finish::matte("hedge-core", [0.018, 0.035, 0.012]),
        Finish::glossy("herb", [0.13, 0.34, 0.07], 0.06, 30.0),
        Finish::glossy("orange", [0.90, 0.34, 0.02], 0.20, 40.0),
        Finish::matte("red-petal", [0.72, 0.05, 0.05]),
        Finish::matte("white-petal", [0.86, 0.82, 0.80]),
        Finish::matte("terracotta", [0.56, 0.24, 0.12]),
        Finish::matte("soil", [0.07, 0.045, 0.03]),
        Finish::mirror("water", [0.05, 0.11, 0.12], [0.50, 0.56, 0.58]),
        finishes::glass(),
        finishes::pane(),
        finishes::brass(),
        finishes::iron(),
        finishes::shade_inside(),
        finishes::bulb(),
        finishes::porcelain(),
        finishes::stem(),
        finishes::crust(),
    ];
    let (s, seed) = (p.texture, p.seed);
    let rough = |light: Colour, dark: Colour, cells: u32, seed: u32| {
        Canvas::new(s, s, move |u, v| {
            let grain = noise(u * 96.0, v * 96.0, 96, seed);
            mix(dark, light, 0.75 * clouds(u, v, cells, seed + 1) + 0.25 * grain)
        })
    };
    let mut done = 0.0;
    let mut put = |name: &str, canvas: Canvas| {
        model.add_picture(name, canvas);
        done += 1.0;
        monitor.tell(done / 14.0);
        monitor.check()
    };
    put("sand.png", rough([0.52, 0.46, 0.38], [0.30, 0.26, 0.21], 12, seed))?;
    put("paving.png", rough([0.80, 0.74, 0.66], [0.46, 0.42, 0.39], 3, seed + 2))?;
    put("floor.png", floor(s, seed))?;
    put("stone.png", rough([0.88, 0.84, 0.75], [0.62, 0.57, 0.49], 4, seed + 4))?;
    put("plaster.png", rough([0.92, 0.89, 0.82], [0.80, 0.75, 0.66], 3, seed + 6))?;
    put("ochre.png", rough([0.90, 0.70, 0.43], [0.76, 0.53, 0.29], 3, seed + 8))?;
    put("tile.png", rough([0.84, 0.46, 0.29], [0.50, 0.22, 0.14], 6, seed + 10))?;
    put("sky.png", sky(s * 2, seed))?;
    put("oak.png", pictures::oak(s / 2, seed))?;
    put("bark.png", bark(s / 4, seed))?;
    for (name, [colour, mask]) in [("leaf", leaf(s / 8)), ("ivy", ivy(s / 8))] {
        put(&format!("{name}.png"), colour)?;
        put(&format!("{name}-mask.png"), mask)?;
    }
    Ok(())
}

/// Square tiles of fired clay; four by four a repeat.
fn floor(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let (x, y) = (u * 4.0, v * 4.0);
        let edge = |t: f32| (t - t.floor()).min(1.0 - (t - t.floor()));
        let tint = unit(hash(x as u32 * 17 + y as u32 * 5 + seed));
        let clay = shade(mix([0.66, 0.34, 0.22], [0.78, 0.48, 0.32], tint), 0.85 + 0.2 * clouds(u, v, 8, seed + 1));
        mix([0.42, 0.36, 0.30], clay, ramp(0.015, 0.03, edge(x).min(edge(y))))
    })
}

/// A light sky with clouds.
fn sky(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size / 2, |u, v| {
        let blue = mix([0.30, 0.56, 0.90], [0.80, 0.89, 0.97], ramp(0.0, 1.0, v));
        mix(blue, [0.98, 0.98, 0.98], 0.9 * ramp(0.50, 0.72, clouds(u, v * 1.4, 5, seed + 14)))
    })
}

/// Bark with upright cracks.
fn bark(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let crack = noise(u * 24.0, v * 4.0, 24, seed + 15);
        mix([0.22, 0.16, 0.11], [0.50, 0.42, 0.33], crack * 0.7 + 0.3 * clouds(u, v, 8, seed + 16))
    })
}

/// An oval leaf with a middle vein, and the mask that cuts it out; the stalk is below.
fn leaf(size: u32) -> [Canvas; 2] {
    let half_width = |h: f32| {
        let t = ((h - 0.06) / 0.94).clamp(0.0, 1.0);
        2.05 * t * (1.0 - t) * (1.25 - 0.5 * t)
    };
    let colour = Canvas::new(size, size, |u, v| {
        let (h, x) = (1.0 - v, (u - 0.5).abs());
        let f = (h - x * 0.6) * 8.0;
        let side = (f - f.floor() - 0.5).abs();
        let vein = (1.0 - ramp(0.015, 0.04, x)).max(0.35 * ramp(0.42, 0.5, side));
        mix(mix([0.10, 0.30, 0.08], [0.28, 0.52, 0.14], h * 0.5 + x), [0.55, 0.70, 0.34], vein)
    });
    let mask = Canvas::new(size, size, |u, v| {
        let (h, x) = (1.0 - v, (u - 0.5).abs());
        if x < half_width(h) * 0.5 || (x < 0.02 && h < 0.1) { [1.0; 3] } else { [0.0; 3] }
    });
    [colour, mask]
}

/// A leaf of five lobes, and its mask.
fn ivy(size: u32) -> [Canvas; 2] {
    // Lobes are long ellipses from the stalk's end.
    let inside = |u: f32, v: f32| {
        let (x, y) = ((u - 0.5).abs(), 0.84 - v);
        let lobe = |dx: f32, dy: f32, long: f32, wide: f32| {
            let along = x * dx + y * dy;
            let across = x * dy - y * dx;
            let t = (along - 0.42 * long) / (0.58 * long);
            let w = across / wide;
            t * t + w * w < 1.0
        };
        lobe(0.0, 1.0, 0.82, 0.20)
            || lobe(0.80, 0.60, 0.60, 0.155)
            || lobe(0.97, -0.24, 0.42, 0.14)
            || (x < 0.02 && y < 0.0)
    };
    let colour = Canvas::new(size, size, |u, v| {
        let (x, y) = ((u - 0.5).abs(), 0.84 - v);
        let vein = (1.0 - ramp(0.012, 0.03, x)).max(1.0 - ramp(0.012, 0.03, (0.8 * y - 0.6 * x).abs()));
        mix(mix([0.07, 0.22, 0.07], [0.20, 0.40, 0.12], y + 0.4 * x), [0.46, 0.60, 0.34], 0.7 * vein)
    });
    let mask = Canvas::new(size, size, |u, v| if inside(u, v) { [1.0; 3] } else { [0.0; 3] });
    [colour, mask]
}
