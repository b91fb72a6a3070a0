// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paving, the galleries' floor, and the sky.

use glam::Vec2;

use super::{Parameters, at};
use crate::Result;
use crate::monitor::Monitor;
use crate::scene::builtin::mesh::{Mesh, Random};
use crate::scene::builtin::model::Model;

/// Depth of the galleries behind the arches.
pub const GALLERY: f32 = 2.6;
/// Height of the galleries' floor above the court.
pub const STEP: f32 = 0.14;

/// A flat face that looks up.
fn flat([x0, x1]: [f32; 2], [z0, z1]: [f32; 2], y: f32) -> Mesh {
    Mesh::quad([at(x0, y, z1), at(x1, y, z1), at(x1, y, z0), at(x0, y, z0)], Vec2::ONE)
}

/// Adds the ground and the sky.
pub fn add(model: &mut Model, p: &Parameters, monitor: &Monitor) -> Result<()> {
    let (x, back, front) = (p.half_wide(), p.back(), p.front());
    let end = front + 4.0;
    model.add("sand", "sand", flat([-x, x], [back, end], -0.016).with_plan_texture(0.5));
    let [long, wide] = p.stone;
    let rows = ((end - back) / wide).ceil() as u32;
    let columns = (2.0 * x / long).ceil() as u32 + 1;
    let mut random = Random::new(p.seed.wrapping_add(3));
    // Every second row is shifted by half a stone; stones lie a little askew.
    for strip in 0..rows.div_ceil(16) {
        let mut mesh = Mesh::default();
        for row in strip * 16..rows.min(strip * 16 + 16) {
            monitor.check()?;
            let z = back + wide * row as f32;
            for column in 0..columns {
                let x0 = -x + long * (column as f32 - if row % 2 == 0 { 0.0 } else { 0.5 });
                let (a, b) = ((x0 + 0.004).max(-x), (x0 + long - 0.004).min(x));
                if b - a < 0.05 {
                    continue;
                }
                let half = at(0.5 * (b - a), 0.0, 0.5 * wide - 0.004);
                let y = random.range(-0.004, 0.003);
                let stone = Mesh::rounded_block(at(-half.x, -0.05, -half.z), at(half.x, y, half.z), 0.008);
                let shift = Vec2::new(random.range(0.0, 1.0), random.range(0.0, 1.0));
                let mut stone = stone.turned_z(random.range(-0.0010, 0.0010)).turned_y(random.range(-0.002, 0.002));
                stone.texcoords.iter_mut().for_each(|t| *t = *t * 0.8 + shift);
                mesh.append(&stone.moved(at(0.5 * (a + b), 0.0, z + 0.5 * wide)));
            }
        }
        model.add(format!("paving-{}", strip + 1), "paving", mesh);
        monitor.tell((strip * 16) as f32 / rows as f32);
    }
    // The galleries' floor lies a step higher.
    let g = GALLERY + 0.001;
    let kerb = 0.30;
    let mut floor = flat([-x - g, x + g], [back - g, back + kerb], STEP);
    floor.append(&flat([-x - g, -x + kerb], [back + kerb, front], STEP));
    floor.append(&flat([x - kerb, x + g], [back + kerb, front], STEP));
    model.add("gallery-floor", "terracotta-tiles", floor.with_plan_texture(0.55));
    let edge =
        |x0: f32, z0: f32, x1: f32, z1: f32| Mesh::rounded_block(at(x0, -0.06, z0), at(x1, STEP + 0.004, z1), 0.012);
    let e = 0.16;
    let steps = edge(-x + kerb, back + kerb, x - kerb, back + kerb + e)
        .and(edge(-x + kerb - 0.001, back + kerb + e, -x + kerb + e, front))
        .and(edge(x - kerb - e, back + kerb + e, x - kerb + 0.001, front));
    model.add("kerb", "stone", steps.with_texture_scale(Vec2::splat(0.5)));
    let (w, y0, y1, z) = (90.0, -2.0, 88.0, back - 40.0);
    let sky = Mesh::quad([at(-w, y0, z), at(w, y0, z), at(w, y1, z), at(-w, y1, z)], Vec2::new(1.5, 1.0));
    model.add("sky", "sky", sky);
    Ok(())
}
