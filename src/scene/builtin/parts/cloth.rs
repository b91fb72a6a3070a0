// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cloth with a thickness: towels that hang, are folded or rolled.

use glam::Vec3;

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin};

/// A sheet as [`Mesh::sheet`] makes it in the middle between two faces, `thickness` apart, with closed borders.
pub fn thick_sheet(across: u32, along: u32, thickness: f32, place: impl Fn(f32, f32) -> Vec3) -> Mesh {
    let mut front = Mesh::sheet(across, along, place);
    let mut back = front.clone();
    front.positions.iter_mut().zip(&front.normals).for_each(|(p, n)| *p += *n * (0.5 * thickness));
    for (p, n) in back.positions.iter_mut().zip(&mut back.normals) {
        *p -= *n * (0.5 * thickness);
        *n = -*n;
    }
    back.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    // Once around the border, with the inside to the left.
    let id = |i: u32, j: u32| (j * (across + 1) + i) as usize;
    let mut border: Vec<usize> = (0..across).map(|i| id(i, 0)).collect();
    border.extend((0..along).map(|j| id(across, j)));
    border.extend((0..across).map(|i| id(across - i, along)));
    border.extend((0..along).map(|j| id(0, along - j)));
    let mut edge = Mesh::default();
    for (k, &a) in border.iter().enumerate() {
        let b = border[(k + 1) % border.len()];
        let (p, q, r, s) = (front.positions[a], front.positions[b], back.positions[b], back.positions[a]);
        let n = (q - p).cross(front.normals[a]).normalize_or(Vec3::Y);
        let first = edge.positions.len() as u32;
        for (corner, i) in [(p, a), (s, a), (r, b), (q, b)] {
            edge.positions.push(corner);
            edge.normals.push(n);
            edge.texcoords.push(front.texcoords[i]);
        }
        edge.triangles.push([first, first + 1, first + 2]);
        edge.triangles.push([first, first + 2, first + 3]);
    }
    front.and(back).and(edge)
}

/// A smooth wave between -1 and 1 that returns after each whole number.
fn wave(t: f32) -> f32 {
    cos_sin(t).0
}

/// A towel over a rail along x through the origin: `wide`, hanging down by `front` and by `back`, over a rail of `radius`.
/// Its folds grow deeper downwards; `cells` across.
pub fn hung_towel(wide: f32, front: f32, back: f32, radius: f32, cells: u32, phase: f32) -> Mesh {
    let bend = std::f32::consts::PI * radius;
    let length = front + bend + back;
    let place = |u: f32, v: f32| {
        // From the lower border in front, over the rail, to the lower border behind.
        let s = v * length;
        let (y, z, hang) = if s < front {
            (s - front, radius, front - s)
        } else if s < front + bend {
            let (c, n) = cos_sin(0.5 * (s - front) / bend);
            (n * radius, c * radius, 0.0)
        } else {
            (front + bend - s, -radius, s - front - bend)
        };
        let deep = (hang * 0.13).min(0.042);
        let fold = wave(u * 2.6 + phase + 0.12 * hang) * 0.6 + wave(u * 4.3 + 0.4 + phase) * 0.4;
        let narrow = 1.0 - 0.10 * (hang / (hang + 0.5));
        // Behind the rail is a wall: there the cloth hangs flatter.
        let z = if z < 0.0 { z - deep * 0.15 * (1.0 + fold) } else { z + deep * (1.0 + fold) };
        at((u - 0.5) * wide * narrow, y + 0.1 * fold * deep, z)
    };
    let along = ((cells as f32 * length / wide) as u32).clamp(8, 400);
    thick_sheet(cells, along, 0.007, place)
}

/// A towel that is folded to a flat parcel of three layers, `wide` along x and `deep` along z, on the origin.
pub fn folded_towel(wide: f32, deep: f32, cells: u32) -> Mesh {
    // A flat spiral in the plane of y and z, which the cloth follows.
    let (gap, rows) = (0.0145, 3.0);
    let thickness = 0.0105;
    let place = move |u: f32, v: f32| {
        let row = (v * rows).floor().min(rows - 1.0);
        let t = v * rows - row;
        let turn = 0.2;
        let forth = row as i32 % 2 == 0;
        let half = 0.5 * deep - 0.5 * gap;
        let (along, lift) = if t > 1.0 - turn && row < rows - 1.0 {
            // The bend into the next layer.
            let (c, s) = cos_sin(0.25 - 0.5 * (t - (1.0 - turn)) / turn);
            (half + 0.5 * gap * c, 0.5 * gap * (1.0 - s))
        } else {
            let span = if row < rows - 1.0 { 1.0 - turn } else { 1.0 };
            (-half + 2.0 * half * t / span, 0.0)
        };
        let z = if forth { along } else { -along };
        let soft = 0.0015 * wave(u * 1.7 + row * 0.3);
        at((u - 0.5) * wide, 0.5 * thickness + 0.0016 + row * gap + lift + soft, z)
    };
    // The cloth's front is what looks up in the lowest layer.
    thick_sheet(cells.div_ceil(2), cells * 2, thickness, move |u, v| place(1.0 - u, v))
}

/// A rolled towel along x on the origin, `long`, of `turns` layers.
pub fn rolled_towel(long: f32, radius: f32, turns: f32, cells: u32) -> Mesh {
    let inner = radius * 0.12;
    let place = |u: f32, v: f32| {
        let (c, s) = cos_sin(v * turns);
        let r = inner + (radius - inner) * v;
        at((u - 0.5) * long, radius + s * r, c * r)
    };
    thick_sheet(4, cells, (radius - inner) / turns * 0.82, |u, v| place(1.0 - u, v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::{open_edges, volume};

    #[test]
    fn towels_are_closed_bodies_that_face_outwards() {
        for (name, mesh, sheet) in [
            ("hung", hung_towel(0.4, 0.6, 0.5, 0.01, 20, 0.0), 0.4 * 1.13 * 0.007),
            ("folded", folded_towel(0.3, 0.2, 24), 0.3 * 0.6 * 0.0115),
            ("rolled", rolled_towel(0.3, 0.06, 3.0, 60), 0.3 * 0.63 * 0.0145),
        ] {
            assert_eq!(open_edges(&mesh), 0, "{name} has open edges");
            let share = volume(&mesh) / sheet;
            assert!((0.6..1.4).contains(&share), "{name}: {share} of a flat sheet's volume");
        }
    }
}
