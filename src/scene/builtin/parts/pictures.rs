// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pictures that more than one scene has on its surfaces.

use crate::scene::builtin::paint::{Canvas, clouds, mix, noise, ramp, shade};

/// Planks of oak along u; four planks a repeat.
pub fn oak(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let plank = (v * 4.0).floor();
        let y = v * 4.0 - plank;
        let bend = 0.10 * noise(u * 3.0, plank * 5.0, 16, seed + 4);
        let rings = noise(u * 2.0, (v + bend * 0.25) * 64.0, 64, seed + 5);
        let grain = noise(u * 16.0, v * 128.0, 128, seed + 6);
        let tone = 0.86 + 0.26 * noise(plank * 3.0, 1.0, 16, seed + 7);
        let wood = mix([0.50, 0.33, 0.19], [0.74, 0.55, 0.35], 0.6 * rings + 0.4 * grain);
        shade(wood, tone * (0.75 + 0.25 * ramp(0.0, 0.03, y.min(1.0 - y))))
    })
}

/// White marble with grey veins.
pub fn marble(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size, |u, v| {
        let warp = clouds(u, v, 3, seed + 8);
        let fold = (clouds(u + 0.3 * warp, v + 0.2 * warp, 3, seed + 9) - 0.5).abs();
        let thin = (clouds(u - 0.2 * warp, v + 0.4 * warp, 5, seed + 10) - 0.5).abs();
        let vein = (1.0 - ramp(0.0, 0.07, fold)) * 0.55 + (1.0 - ramp(0.0, 0.03, thin)) * 0.30;
        mix(shade([0.93, 0.92, 0.90], 0.95 + 0.06 * warp), [0.52, 0.53, 0.56], vein)
    })
}

/// A leaf with veins, and the mask that cuts it out. The stalk is below.
pub fn leaf(size: u32) -> [Canvas; 2] {
    // Half the width of the leaf at height h above the stalk, both in parts of the picture.
    let half_width = |h: f32| {
        let t = h.clamp(0.0, 1.0);
        0.95 * t * (1.0 - t) * (2.2 - 1.3 * t)
    };
    let colour = Canvas::new(size, size * 2, |u, v| {
        let h = 1.0 - v;
        let x = (u - 0.5).abs();
        let f = (h - x * 0.55) * 9.0;
        let side = f - f.floor();
        let vein = (1.0 - ramp(0.010, 0.030, x)).max(0.55 * (1.0 - ramp(0.04, 0.14, side.min(1.0 - side))));
        let green = mix([0.13, 0.36, 0.14], [0.30, 0.56, 0.20], h * 0.6 + x);
        mix(green, [0.58, 0.74, 0.36], vein)
    });
    let mask = Canvas::new(size, size * 2, |u, v| {
        let h = 1.0 - v;
        let x = (u - 0.5).abs();
        // Deep slits between the side veins, as a Swiss cheese plant has.
        let f = (h - x * 0.55) * 4.5 + 0.5;
        let side = f - f.floor();
        let slit = x > 0.17 && h > 0.18 && h < 0.86 && (side - 0.5).abs() < 0.10;
        if x < half_width(h) && !slit { [1.0; 3] } else { [0.0; 3] }
    });
    [colour, mask]
}

/// A bottle's label.
pub fn label(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size, |_, v| {
        let stripe = (v - 0.5).abs();
        if stripe > 0.42 { [0.72, 0.55, 0.22] } else { [0.93, 0.89, 0.77] }
    });
    for (row, width) in [(0.33, 0.5), (0.5, 0.7), (0.66, 0.4)] {
        for u in [0.25, 0.75] {
            c.line((u - width * 0.22, row), (u + width * 0.22, row), 0.05, [0.25, 0.12, 0.10], 0.0);
        }
    }
    c
}

/// A clock's face at ten past ten.
pub fn clock(size: u32) -> Canvas {
    let mut c = Canvas::new(size, size, |_, _| [0.94, 0.92, 0.86]);
    let ink = [0.08, 0.07, 0.07];
    let spot = |turns: f32, r: f32| {
        let (x, y) = crate::scene::builtin::mesh::cos_sin(0.25 - turns);
        (0.5 + x * r, 0.5 - y * r)
    };
    for hour in 0..12 {
        let t = hour as f32 / 12.0;
        let long = hour % 3 == 0;
        c.line(spot(t, if long { 0.34 } else { 0.38 }), spot(t, 0.43), if long { 0.035 } else { 0.02 }, ink, 0.0);
    }
    c.line((0.5, 0.5), spot(10.17 / 12.0, 0.23), 0.045, ink, 0.0);
    c.line(spot(10.0 / 60.0, -0.06), spot(10.0 / 60.0, 0.36), 0.03, ink, 0.0);
    c.line(spot(0.55, -0.05), spot(0.55, 0.36), 0.012, [0.7, 0.1, 0.08], 0.0);
    c
}

/// A landscape: a low sun over hills and water.
pub fn painting(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size * 3 / 4, |u, v| {
        let stroke = clouds(u, v, 12, seed + 13) - 0.5;
        let mut c = mix([0.26, 0.45, 0.62], [0.97, 0.76, 0.48], ramp(0.0, 0.55, v + 0.10 * stroke));
        let (dx, dy) = ((u - 0.66) * 4.0 / 3.0, v - 0.36);
        let sun = (dx * dx + dy * dy).sqrt();
        c = mix([1.0, 0.93, 0.68], c, ramp(0.085, 0.11, sun + 0.02 * stroke));
        let far = 0.50 - 0.10 * noise(u * 4.0, 0.5, 4, seed + 14);
        let near = 0.66 - 0.16 * noise(u * 3.0 + 0.7, 1.5, 3, seed + 15);
        if v > far {
            c = mix([0.40, 0.44, 0.58], [0.52, 0.50, 0.56], stroke + 0.5);
        }
        if v > near {
            c = mix([0.18, 0.32, 0.20], [0.42, 0.50, 0.20], stroke + 0.6 - (v - near));
        }
        if v > 0.80 {
            let glitter = noise(u * 14.0, v * 60.0, 60, seed + 16);
            c = mix(
                [0.16, 0.30, 0.42],
                [0.95, 0.74, 0.50],
                ramp(0.55, 0.8, glitter) * (1.0 - ramp(0.05, 0.35, (u - 0.66).abs())),
            );
        }
        shade(c, 0.94 + 0.2 * stroke)
    })
}

/// A garden under a light sky: lawn, a fence, trees and a path.
pub fn garden(size: u32, seed: u32) -> Canvas {
    Canvas::new(size, size / 2, |u, v| {
        let h = 1.0 - v;
        let cloud = ramp(0.50, 0.75, clouds(u, v, 5, seed + 4));
        let mut c = mix(mix([0.74, 0.85, 0.95], [0.46, 0.68, 0.92], h), [0.97, 0.97, 0.96], 0.8 * cloud);
        let hill = 0.42 + 0.10 * noise(u * 3.0, 0.3, 3, seed + 5);
        if h < hill {
            c = mix([0.36, 0.52, 0.34], [0.52, 0.66, 0.46], clouds(u, v, 8, seed + 6));
        }
        // Round tree tops on dark trunks.
        for k in 0..5 {
            let k = k as f32;
            let (x, y, r) =
                (0.08 + 0.21 * k, 0.50 + 0.10 * noise(k, 2.0, 8, seed + 7), 0.13 + 0.03 * noise(k, 5.0, 8, seed + 8));
            let (dx, dy) = ((u - x) * 2.0, h - y);
            let leafy = clouds(u * 2.0, v, 16, seed + 9);
            if dx.abs() < 0.018 && h > 0.2 && h < y {
                c = [0.26, 0.18, 0.11];
            }
            if (dx * dx + dy * dy).sqrt() < r * (0.80 + 0.45 * leafy) {
                c = shade(mix([0.14, 0.32, 0.10], [0.45, 0.62, 0.22], leafy + dy), 0.95);
            }
        }
        if h < 0.26 {
            let blade = noise(u * 160.0, h * 60.0, 160, seed + 10);
            c = mix([0.24, 0.44, 0.13], [0.50, 0.66, 0.26], blade * (0.5 + h));
        }
        // A white fence.
        let post = u * 28.0 - (u * 28.0).floor();
        if (h > 0.14 && h < 0.33 && (post - 0.5).abs() < 0.22) || (h > 0.18 && h < 0.205) || (h > 0.27 && h < 0.295) {
            c = [0.93, 0.92, 0.88];
        }
        c
    })
}
