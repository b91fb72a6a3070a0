// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plants.

use super::at;
use super::shell::{curve, vessel};
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin, smooth_path};

/// Stems and leaves of a tall plant that grows out of a pot of 31 cm; a leaf's picture has its stalk below.
pub fn slit_leaved(count: u32, seed: u32) -> (Mesh, Mesh) {
    let mut random = Random::new(seed.wrapping_add(77));
    let mut stems = Mesh::default();
    let mut leaves = Mesh::default();
    for i in 0..count {
        let t = (i as f32 + 0.5) / count as f32;
        // The golden angle spreads the leaves evenly around.
        let (c, s) = cos_sin(0.381_966 * i as f32 + random.range(-0.03, 0.03));
        let reach = (0.14 + 0.30 * (1.0 - t) + 0.10 * t) * random.range(0.8, 1.15);
        let high = 0.45 + 1.05 * t + random.range(-0.05, 0.05);
        let tip = at(c * reach, high, -s * reach);
        let stem =
            [at(c * 0.03, 0.31, -s * 0.03), at(c * reach * 0.35, 0.31 + (high - 0.31) * 0.7, -s * reach * 0.35), tip];
        stems.append(&Mesh::tube(&smooth_path(&stem, 2, false), 0.0045, 3, false));
        let (long, wide) = (random.range(0.24, 0.34), random.range(0.19, 0.25));
        let (rise, droop) = (random.range(0.02, 0.30) * (0.3 + t), random.range(0.25, 0.6));
        let roll = random.range(-0.35, 0.35);
        let outwards = at(c, 0.0, -s);
        let across = at(s, roll, c).normalize();
        let leaf = Mesh::sheet(2, 4, |u, v| {
            let side = (u - 0.5) * wide;
            let fold = (u - 0.5).abs() * 0.25 * wide;
            let along = v * long;
            tip + across * side + outwards * along + at(0.0, rise * v - droop * long * v * v + fold, 0.0)
        });
        leaves.append(&leaf);
    }
    (stems, leaves)
}

/// A leaf seen from both sides, from the origin along +x: `long`, `wide`, bent down by `droop`.
fn leaf(long: f32, wide: f32, droop: f32, cells: u32) -> Mesh {
    let blade = |u: f32, v: f32| {
        let half = wide * v * (1.0 - v) * (2.2 - 0.8 * v);
        let side = 2.0 * u - 1.0;
        at(long * v, 0.25 * half * side * side - droop * v * v, -half * side)
    };
    let front = Mesh::sheet(2, cells, |u, v| blade(u, 0.02 + 0.96 * v));
    let back = Mesh::sheet(2, cells, |u, v| blade(1.0 - u, 0.02 + 0.96 * v) - at(0.0, 0.0004, 0.0));
    front.and(back)
}

/// A pot of `radius` with a bush of herbs: pot, soil, stems, leaves.
pub fn potted_herb(radius: f32, leaves: u32, seed: u32, sides: u32) -> [Mesh; 4] {
    let r = radius;
    let pot = [
        (0.0, 0.0),
        (r * 0.70, 0.0),
        (r * 0.92, r * 1.35),
        (r, r * 1.35),
        (r * 1.02, r * 1.68),
        (r * 0.90, r * 1.68),
        (r * 0.86, r * 1.45),
        (0.0, r * 1.44),
    ];
    let soil = Mesh::lathe(&[(r * 0.87, r * 1.50), (0.0, r * 1.56)], sides);
    let mut random = Random::new(seed.wrapping_add(311));
    let (mut stems, mut foliage) = (Mesh::default(), Mesh::default());
    let shoots = leaves.div_ceil(9);
    for k in 0..shoots {
        let (c, s) = cos_sin(0.381_966 * k as f32);
        let lean = r * 1.5 * ((k as f32 + 0.5) / shoots as f32).sqrt();
        let high = r * random.range(3.0, 4.4) - lean * 0.5;
        let foot = at(c * lean * 0.35, r * 1.5, -s * lean * 0.35);
        let tip = at(c * lean, high, -s * lean);
        let path = smooth_path(&[foot, (foot + tip) * 0.5 + at(0.0, r * 0.25, 0.0), tip], 3, false);
        stems.append(&Mesh::tube(&path, 0.0014, 3, false));
        for j in 0..9.min(leaves - 9 * k) {
            let t = 0.30 + 0.70 * j as f32 / 8.0;
            let spot = path[((t * 6.0 + 0.5) as usize).min(path.len() - 1)];
            let blade = leaf(r * random.range(0.55, 0.85), r * random.range(0.22, 0.34), r * 0.12, 2);
            let lift = random.range(-0.02, 0.12);
            let around = 0.381_966 * (j + 3 * k) as f32 + random.range(-0.05, 0.05);
            foliage.append(&blade.turned_z(lift).turned_y(around).moved(spot));
        }
    }
    [Mesh::lathe(&pot, sides), soil, stems, foliage]
}

/// A vase with tulips: vase, stems, leaves, flowers.
pub fn tulips(count: u32, seed: u32, sides: u32) -> [Mesh; 4] {
    let outside =
        curve(&[(0.030, 0.0), (0.042, 0.012), (0.050, 0.05), (0.036, 0.11), (0.034, 0.14), (0.044, 0.165)], 3);
    let mut wall = vec![(0.0, 0.0)];
    wall.extend(outside);
    let vase = Mesh::lathe(&vessel(&wall, 0.004, 0.008), sides);
    let mut random = Random::new(seed.wrapping_add(57));
    let (mut stems, mut leaves, mut flowers) = (Mesh::default(), Mesh::default(), Mesh::default());
    for k in 0..count {
        let (c, s) = cos_sin(0.381_966 * k as f32 + 0.05);
        let reach = 0.13 * ((k as f32 + 0.3) / count as f32).sqrt();
        let high = random.range(0.30, 0.38) - 0.35 * reach;
        let tip = at(c * reach, high, -s * reach);
        let stem = [
            at(-c * 0.015, 0.02, s * 0.015),
            at(c * 0.014, 0.16, -s * 0.014),
            at(c * reach * 0.6, 0.8 * high, -s * reach * 0.6),
            tip,
        ];
        stems.append(&Mesh::tube(&smooth_path(&stem, 3, false), 0.0030, 6, false));
        // Six petals in two rings, each a bent leaf that stands upright.
        for j in 0..6 {
            let petal = Mesh::sheet(3, 5, |u, v| {
                let side = 2.0 * u - 1.0;
                let half = 0.021 * (0.35 + 2.6 * v * (1.0 - v)).min(1.0) * (1.0 - v * v * v).max(0.05);
                let out = 0.004 + 0.021 * (4.0 * v * (1.0 - 0.62 * v)).min(1.55) * 0.6;
                at(out - 0.008 * side * side, 0.055 * v, -half * side)
            });
            let mut inner = petal.clone();
            inner.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            inner.normals.iter_mut().for_each(|n| *n = -*n);
            let both = petal.and(inner.stretched(at(0.96, 1.0, 1.0)));
            let scale = if j % 2 == 0 { 1.0 } else { 0.86 };
            flowers.append(&both.stretched(at(scale, 1.0, scale)).turned_y(j as f32 / 6.0 + 0.1 * k as f32).moved(tip));
        }
        if k % 2 == 0 {
            let blade = leaf(0.20, 0.024, 0.09, 8).turned_z(0.16).turned_y(0.381_966 * k as f32 + 0.2);
            leaves.append(&blade.moved(at(c * 0.02, 0.14, -s * 0.02)));
        }
    }
    [vase, stems, leaves, flowers]
}
