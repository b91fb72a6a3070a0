// SPDX-License-Identifier: MIT OR Apache-2.0
//! What grows: orange trees, ivy, hedges around the fountain, and pots of flowers.

use glam::{Vec2, Vec3};

use super::fountain::BASIN;
use super::wings::{UPPER, masonry, wings};
use super::{Parameters, at};
use crate::Result;
use crate::monitor::Monitor;
use crate::scene::builtin::mesh::{Mesh, Random, cos_sin};
use crate::scene::builtin::model::Model;
use crate::scene::builtin::parts::foliage::{Tree, climber, hedge, tree};
use crate::scene::builtin::parts::plants::potted_herb;

/// Adds all that grows.
pub fn add(model: &mut Model, p: &Parameters, monitor: &Monitor) -> Result<()> {
    let steps = p.trees.len() + 2;
    for n in 0..p.trees.len() {
        orange_tree(model, p, n, monitor)?;
        monitor.tell((n + 1) as f32 / steps as f32);
    }
    ivy(model, p, monitor)?;
    monitor.tell((steps - 1) as f32 / steps as f32);
    hedges(model, p, monitor)?;
    pots(model, p);
    monitor.tell(1.0);
    Ok(())
}

/// A tree in a square bed with a stone border.
fn orange_tree(model: &mut Model, p: &Parameters, n: usize, monitor: &Monitor) -> Result<()> {
    let t = &p.trees[n];
    let seed = p.seed.wrapping_mul(31).wrapping_add(n as u32);
    let what = Tree { trunk: t.trunk, reach: t.reach, leaves: p.tree_leaves, leaf: p.leaf, seed };
    let (wood, leaves, ends) = tree(&what, monitor)?;
    let place = at(t.at[0], 0.0, t.at[1]);
    let n = n + 1;
    model.add(
        format!("tree-{n}-wood"),
        "bark",
        wood.with_texture_scale(Vec2::new(2.0, 3.0)).moved(place + Vec3::Y * 0.14),
    );
    model.add(format!("tree-{n}-leaves"), "leaf", leaves.moved(place + Vec3::Y * 0.14));
    let mut random = Random::new(seed.wrapping_add(7));
    let mut fruit = Mesh::default();
    for k in 0..p.oranges as usize {
        // Ripe fruit hangs on the outside of the crown.
        let end = ends[(k * 37 + 11) % ends.len()];
        let out = (end - at(0.0, t.trunk + 0.4 * t.reach, 0.0)).normalize_or(Vec3::X);
        let ball = Mesh::sphere(random.range(0.042, 0.052), p.small_sides, p.small_sides / 2);
        fruit.append(&ball.moved(end + out * random.range(0.02, 0.12) - Vec3::Y * 0.05));
    }
    model.add(format!("tree-{n}-oranges"), "orange", fruit.moved(place + Vec3::Y * 0.14));
    let (h, w) = (0.62, 0.12);
    let side = |x0: f32, z0: f32, x1: f32, z1: f32| Mesh::rounded_block(at(x0, -0.08, z0), at(x1, 0.20, z1), 0.015);
    let border = side(-h, -h, h, -h + w)
        .and(side(-h, h - w, h, h))
        .and(side(-h, -h + w + 0.001, -h + w, h - w - 0.001))
        .and(side(h - w, -h + w + 0.001, h, h - w - 0.001));
    model.add(format!("tree-{n}-bed"), "stone", masonry(border, 0.5).moved(place));
    let q = h - 0.5 * w;
    let soil = Mesh::sheet(10, 10, |u, v| {
        at((2.0 * u - 1.0) * q, 0.10 + 0.25 * u * (1.0 - u) * v * (1.0 - v), (1.0 - 2.0 * v) * q)
    });
    model.add(format!("tree-{n}-soil"), "soil", soil.moved(place));
    Ok(())
}

/// Ivy above the arches of the left wing, and on its upper wall.
fn ivy(model: &mut Model, p: &Parameters, monitor: &Monitor) -> Result<()> {
    let [_, left, right] = wings(p);
    let half = 0.5 * left.bays as f32 * p.bay;
    let upper = p.ivy_leaves * 6 / 10;
    let mesh = climber(Vec2::new(-0.2 * half, UPPER + 0.4), Vec2::new(half - 0.1, 7.0), upper, 0.115, p.seed, monitor)?;
    left.add(model, "ivy-upper", "ivy", mesh);
    // On the spandrels, where it hangs down.
    let low = Vec2::new(-0.1 * half, 3.42);
    let mesh = climber(low, Vec2::new(half - 0.1, UPPER + 0.3), p.ivy_leaves / 5, 0.115, p.seed + 5, monitor)?;
    left.add(model, "ivy-lower", "ivy", mesh.moved(at(0.0, 0.0, 0.04)));
    let (x0, x1) = (-half + 0.1, -0.35 * half);
    let mesh = climber(Vec2::new(x0, UPPER + 0.4), Vec2::new(x1, 6.9), p.ivy_leaves / 5, 0.115, p.seed + 9, monitor)?;
    right.add(model, "ivy", "ivy", mesh);
    Ok(())
}

/// Four arcs of clipped box around the fountain.
fn hedges(model: &mut Model, p: &Parameters, monitor: &Monitor) -> Result<()> {
    let place = at(p.fountain[0], 0.0, p.fountain[1]);
    for n in 0..4 {
        let path: Vec<Vec3> = (0..=18)
            .map(|k| {
                let (c, s) = cos_sin(0.25 * n as f32 + 0.04 + 0.17 * k as f32 / 18.0);
                place + at(c, 0.0, -s) * (BASIN + 0.72)
            })
            .collect();
        let [core, leaves] = hedge(&path, 0.34, 0.40, p.hedge_leaves / 4, p.seed.wrapping_add(n), monitor)?;
        model.add(format!("hedge-{}-core", n + 1), "hedge-core", core);
        model.add(format!("hedge-{}", n + 1), "box-leaf", leaves);
    }
    Ok(())
}

/// Pots of red and white flowers before the columns of the wings at both sides, and of the back.
fn pots(model: &mut Model, p: &Parameters) {
    let all = wings(p);
    for n in 0..p.pots {
        let wing = &all[[1, 2, 0][n as usize % 3]];
        let i = 1 + n / 3 % (wing.bays - 1).max(1);
        let place = wing.spot.point(at(wing.column(p, i), 0.14, 0.42));
        let radius = if n % 2 == 0 { 0.17 } else { 0.15 };
        let [pot, soil, stems, leaves] = potted_herb(radius, p.pot_leaves, p.seed.wrapping_add(n), p.round_sides);
        let name = |what: &str| format!("pot-{}-{what}", n + 1);
        model.add(name("clay"), "terracotta", pot.moved(place - Vec3::Y * 0.001));
        model.add(name("soil"), "soil", soil.moved(place));
        model.add(name("stems"), "stem", stems.moved(place));
        model.add(name("leaves"), "herb", leaves.moved(place));
        let mut random = Random::new(p.seed.wrapping_add(90 + n));
        let mut flowers = Mesh::default();
        for k in 0..26 {
            let (c, s) = cos_sin(0.381_966 * k as f32);
            let r = radius * 1.5 * ((k as f32 + 0.5) / 26.0).sqrt();
            let centre = at(c * r, radius * random.range(2.9, 4.1) - 0.4 * r, -s * r);
            for j in 0..5 {
                let (pc, ps) = cos_sin(0.2 * j as f32 + 0.05 * k as f32);
                let petal = Mesh::sphere(0.016, 6, 4).stretched(at(1.0, 0.45, 1.0));
                flowers.append(&petal.moved(centre + at(0.017 * pc, 0.0, 0.017 * ps)));
            }
        }
        model.add(name("flowers"), if n % 3 == 2 { "white-petal" } else { "red-petal" }, flowers.moved(place));
    }
}
