// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plates, cups, glasses, bottles and pots.

use super::at;
use super::shell::{curve, vessel};
use crate::scene::builtin::mesh::{Mesh, smooth_path};

/// A cup with a handle at +x; its foot stands on the origin. 62 mm high.
pub fn cup(sides: u32) -> Mesh {
    let profile =
        [(0.0, 0.0), (0.022, 0.0), (0.036, 0.026), (0.041, 0.060), (0.038, 0.062), (0.032, 0.026), (0.0, 0.010)];
    let handle = [
        at(0.035, 0.05, 0.0),
        at(0.055, 0.052, 0.0),
        at(0.060, 0.036, 0.0),
        at(0.048, 0.022, 0.0),
        at(0.032, 0.018, 0.0),
    ];
    Mesh::lathe(&profile, sides).and(Mesh::tube(&smooth_path(&handle, 2, false), 0.0045, 5, false))
}

/// A plate on the origin.
pub fn plate(radius: f32, sides: u32) -> Mesh {
    let r = radius;
    let profile = [(r * 0.6, 0.0), (r, 0.015), (r * 0.99, 0.018), (r * 0.66, 0.010), (0.0, 0.009)];
    Mesh::lathe(&profile, sides)
}

/// A straight glass, `low` and `high` its outer radii at foot and rim, with walls of thickness `t`; closed.
pub fn tumbler(low: f32, high: f32, tall: f32, t: f32, sides: u32) -> Mesh {
    let wall = |y: f32| low + (high - low) * y / tall;
    let profile = [
        (0.0, 0.0),
        (low - 0.002, 0.0),
        (wall(0.002), 0.002),
        (wall(tall - 0.002), tall - 0.002),
        (high - 0.5 * t, tall),
        (wall(tall - 0.002) - t, tall - 0.002),
        (wall(0.012) - t, 0.012),
        (wall(0.010) - t - 0.002, 0.010),
        (0.0, 0.010),
    ];
    Mesh::lathe(&profile, sides)
}

/// A bottle with a round shoulder; its foot stands open on the origin.
pub fn bottle(radius: f32, shoulder: f32, neck: f32, tall: f32, sides: u32) -> Mesh {
    let r = radius;
    let profile = [
        (r, 0.0),
        (r, shoulder),
        (r * 0.85, shoulder + 0.03),
        (neck, shoulder + 0.07),
        (neck, tall - 0.02),
        (neck * 1.25, tall - 0.018),
        (neck * 1.25, tall),
        (0.0, tall),
    ];
    Mesh::lathe(&profile, sides)
}

/// A mug with a handle at +x, `radius` wide and `tall`.
pub fn mug(radius: f32, tall: f32, sides: u32) -> Mesh {
    let (r, h) = (radius, tall);
    let outside = [(0.0, 0.0), (r * 0.86, 0.0), (r * 0.97, h * 0.06), (r, h * 0.2), (r, h * 0.97)];
    let grip = [
        at(r * 0.97, h * 0.80, 0.0),
        at(r * 1.45, h * 0.82, 0.0),
        at(r * 1.68, h * 0.52, 0.0),
        at(r * 1.40, h * 0.24, 0.0),
        at(r * 0.97, h * 0.20, 0.0),
    ];
    let handle = Mesh::tube(&smooth_path(&grip, 3, false), r * 0.13, 6, false);
    Mesh::lathe(&vessel(&outside, 0.004, 0.006), sides).and(handle)
}

/// A bowl on a foot ring.
pub fn bowl(radius: f32, tall: f32, sides: u32) -> Mesh {
    let (r, h) = (radius, tall);
    let mut outside = vec![(0.0, h * 0.05), (r * 0.44, h * 0.05), (r * 0.45, 0.0), (r * 0.5, 0.0), (r * 0.5, h * 0.08)];
    outside.extend(curve(&[(r * 0.56, h * 0.10), (r * 0.82, h * 0.36), (r * 0.95, h * 0.70), (r, h)], 2));
    Mesh::lathe(&vessel(&outside, r * 0.045, h * 0.14), sides)
}

/// A wine glass with a thin bowl; closed.
pub fn wine_glass(radius: f32, tall: f32, sides: u32) -> Mesh {
    let (r, h) = (radius, tall);
    let stem =
        [(0.0, 0.0), (r * 0.82, 0.0), (r * 0.82, 0.0025), (r * 0.2, 0.008), (0.0045, h * 0.10), (0.004, h * 0.38)];
    let cup = curve(&[(0.006, h * 0.42), (r * 0.62, h * 0.50), (r, h * 0.68), (r * 0.93, h * 0.86), (r * 0.82, h)], 2);
    let t = 0.0022;
    let mut profile = stem.to_vec();
    profile.extend(&cup);
    profile.push((r * 0.82 - 0.5 * t, h + 0.001));
    profile.extend(cup.iter().rev().filter(|p| p.1 > h * 0.46).map(|&(x, y)| (x - t, y + 0.4 * t)));
    profile.push((0.0, h * 0.452));
    Mesh::lathe(&profile, sides)
}

/// A jar, open below its lid: the body's mesh and the lid's. The body's wall is closed, for glass.
pub fn jar(radius: f32, tall: f32, sides: u32) -> (Mesh, Mesh) {
    let (r, h) = (radius, tall);
    let outside = [
        (0.0, 0.0),
        (r * 0.92, 0.0),
        (r, h * 0.04),
        (r, h * 0.78),
        (r * 0.95, h * 0.84),
        (r * 0.80, h * 0.89),
        (r * 0.78, h * 0.94),
    ];
    let body = Mesh::lathe(&vessel(&outside, 0.003, 0.005), sides);
    let (s, y) = (r * 0.84, h * 0.945);
    let lid = [(0.0, y), (s, y), (s * 1.03, y + 0.004), (s * 1.03, y + 0.018), (s * 0.96, y + 0.022), (0.0, y + 0.023)];
    (body, Mesh::lathe(&lid, sides))
}

/// What fills a jar of [`jar`] to `level` of its height, within its walls.
pub fn jar_filling(radius: f32, tall: f32, level: f32, sides: u32) -> Mesh {
    let r = radius - 0.0045;
    let y = tall * level;
    Mesh::lathe(
        &[(0.0, 0.0065), (r * 0.93, 0.0065), (r, tall * 0.05), (r, y - 0.004), (r * 0.8, y + 0.002), (0.0, y)],
        sides,
    )
}

/// A pot with a round belly, a spout at +x, a handle at -x and its lid.
pub fn teapot(radius: f32, sides: u32) -> Mesh {
    let r = radius;
    let body = curve(
        &[
            (r * 0.5, 0.0),
            (r * 0.62, r * 0.06),
            (r * 0.97, r * 0.5),
            (r * 0.92, r * 1.0),
            (r * 0.58, r * 1.36),
            (r * 0.5, r * 1.4),
        ],
        3,
    );
    let lid = [
        (r * 0.54, r * 1.40),
        (r * 0.53, r * 1.44),
        (r * 0.30, r * 1.53),
        (r * 0.08, r * 1.56),
        (r * 0.07, r * 1.60),
        (r * 0.13, r * 1.68),
        (r * 0.10, r * 1.76),
        (0.0, r * 1.79),
    ];
    let spout = [
        at(r * 0.80, r * 0.50, 0.0),
        at(r * 1.25, r * 0.66, 0.0),
        at(r * 1.40, r * 1.02, 0.0),
        at(r * 1.66, r * 1.30, 0.0),
    ];
    let handle = [
        at(-r * 0.72, r * 1.16, 0.0),
        at(-r * 1.22, r * 1.28, 0.0),
        at(-r * 1.58, r * 0.94, 0.0),
        at(-r * 1.36, r * 0.48, 0.0),
        at(-r * 0.90, r * 0.36, 0.0),
    ];
    Mesh::lathe(&body, sides)
        .and(Mesh::lathe(&lid, sides))
        .and(Mesh::tapered_tube(&smooth_path(&spout, 4, false), |t| r * (0.22 - 0.12 * t), 10, false))
        .and(Mesh::tube(&smooth_path(&handle, 4, false), r * 0.085, 8, false))
}

/// Fork, knife and spoon of 20 cm along z, tips at -z, side by side at `x`; all lie on y = 0.
pub fn fork(x: f32) -> Mesh {
    let stem = [at(x, 0.004, 0.10), at(x, 0.005, 0.03), at(x, 0.003, -0.02), at(x, 0.004, -0.045)];
    let mut mesh = Mesh::tapered_tube(&smooth_path(&stem, 3, false), |t| 0.0045 - 0.0022 * t, 6, false)
        .stretched(at(1.0, 0.8, 1.0));
    for k in 0..4 {
        let d = 0.0058 * (k as f32 - 1.5);
        let tine = [at(x + d * 0.5, 0.0035, -0.042), at(x + d, 0.003, -0.055), at(x + d, 0.006, -0.10)];
        mesh.append(&Mesh::tapered_tube(&smooth_path(&tine, 2, false), |t| 0.0018 - 0.0008 * t, 5, false));
    }
    mesh
}

/// A knife; see [`fork`].
pub fn knife(x: f32) -> Mesh {
    let grip = [at(x, 0.005, 0.10), at(x, 0.005, 0.0)];
    let grip = Mesh::tapered_tube(&smooth_path(&grip, 3, false), |t| 0.0062 - 0.0018 * t, 8, false);
    let blade = Mesh::sphere(1.0, 14, 6).stretched(at(0.009, 0.0016, 0.058)).moved(at(x, 0.0045, -0.052));
    grip.and(blade)
}

/// A spoon; see [`fork`].
pub fn spoon(x: f32) -> Mesh {
    let stem = [at(x, 0.004, 0.10), at(x, 0.006, 0.03), at(x, 0.003, -0.04), at(x, 0.004, -0.06)];
    let stem = Mesh::tapered_tube(&smooth_path(&stem, 3, false), |t| 0.0045 - 0.002 * t, 6, false);
    stem.and(Mesh::sphere(1.0, 12, 6).stretched(at(0.018, 0.004, 0.027)).moved(at(x, 0.005, -0.078)))
}
