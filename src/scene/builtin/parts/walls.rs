// SPDX-License-Identifier: MIT OR Apache-2.0
//! Walls with openings, windows and what hangs on walls.

use glam::{Vec2, Vec3};

use super::at;
use super::cupboards::{door_frame, knob};
use crate::scene::builtin::mesh::Mesh;
use crate::scene::builtin::model::Model;

/// A flat thing in a frame on the back wall: its materials, middle, half size and the frame's width.
pub fn framed(model: &mut Model, name: &str, materials: (&str, &str), middle: Vec3, half: Vec2, width: f32) {
    let (w, h) = (half.x, half.y);
    let p = |x: f32, y: f32| middle + at(x, y, 0.012);
    model.add(name, materials.0, Mesh::quad([p(-w, -h), p(w, -h), p(w, h), p(-w, h)], Vec2::ONE));
    let bar = |x0: f32, y0: f32, x1: f32, y1: f32| {
        Mesh::rounded_block(middle + at(x0, y0, 0.001), middle + at(x1, y1, 0.035), width * 0.2)
    };
    let mut frame = bar(-w - width, -h - width, w + width, -h);
    frame.append(&bar(-w - width, h, w + width, h + width));
    frame.append(&bar(-w - width, -h, -w, h));
    frame.append(&bar(w, -h, w + width, h));
    model.add(format!("{name}-frame"), materials.1, frame);
}

/// A wall's upright face with a rectangular hole: `origin` is the lower left corner as seen from the front, `right` its
/// direction. `size` and `hole` (`[x0, y0, x1, y1]`) are metres from there; texture coordinates are metres times `scale`.
pub fn face_with_hole(origin: Vec3, right: Vec3, size: Vec2, hole: Option<[f32; 4]>, scale: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut piece = |x0: f32, y0: f32, x1: f32, y1: f32| {
        if x1 - x0 < 1.0e-4 || y1 - y0 < 1.0e-4 {
            return;
        }
        let spot = |x: f32, y: f32| origin + right * x + Vec3::Y * y;
        let mut quad = Mesh::quad([spot(x0, y0), spot(x1, y0), spot(x1, y1), spot(x0, y1)], Vec2::ONE);
        for (t, (x, y)) in quad.texcoords.iter_mut().zip([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) {
            *t = Vec2::new(x, y) * scale;
        }
        mesh.append(&quad);
    };
    let (w, h) = (size.x, size.y);
    match hole {
        None => piece(0.0, 0.0, w, h),
        Some([x0, y0, x1, y1]) => {
            let (x0, x1) = (x0.clamp(0.0, w), x1.clamp(0.0, w));
            let (y0, y1) = (y0.clamp(0.0, h), y1.clamp(0.0, h));
            piece(0.0, 0.0, x0, h);
            piece(x1, 0.0, w, h);
            piece(x0, 0.0, x1, y0);
            piece(x0, y1, x1, h);
        }
    }
    mesh
}

/// A window about the origin in a wall that faces +z: frame, panes and the opening's four sides, in this order. The wall
/// reaches `depth` behind z = 0; `columns` and `rows` of panes.
pub fn window(half: Vec2, depth: f32, bar: f32, columns: u32, rows: u32) -> [Mesh; 3] {
    let (w, h) = (half.x, half.y);
    let z = -0.6 * depth;
    let piece = |x0: f32, y0: f32, x1: f32, y1: f32, half: f32| {
        Mesh::rounded_block(at(x0, y0, z - half), at(x1, y1, z + half), half * 0.3)
    };
    let (b, thick) = (bar, 3.0 * bar);
    let mut frame = piece(-w, -h, -w + thick, h, 1.5 * b)
        .and(piece(w - thick, -h, w, h, 1.5 * b))
        .and(piece(-w + thick, -h, w - thick, -h + thick, 1.45 * b))
        .and(piece(-w + thick, h - thick, w - thick, h, 1.45 * b));
    for k in 1..columns {
        let x = -w + 2.0 * w * k as f32 / columns as f32;
        frame.append(&piece(x - b, -h + thick, x + b, h - thick, b));
    }
    for k in 1..rows {
        let y = -h + 2.0 * h * k as f32 / rows as f32;
        frame.append(&piece(-w + thick, y - b, w - thick, y + b, 0.9 * b));
    }
    let panes = Mesh::quad([at(-w, -h, z), at(w, -h, z), at(w, h, z), at(-w, h, z)], Vec2::ONE);
    let corner = |x: f32, y: f32, z: f32| at(x * w, y * h, z);
    let side = |a: (f32, f32), b: (f32, f32)| {
        Mesh::quad(
            [corner(a.0, a.1, 0.0), corner(b.0, b.1, 0.0), corner(b.0, b.1, -depth), corner(a.0, a.1, -depth)],
            Vec2::ONE,
        )
    };
    let (ll, lr, ur, ul) = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0));
    let reveal = side(ll, lr).and(side(lr, ur)).and(side(ur, ul)).and(side(ul, ll));
    [frame, panes, reveal]
}

/// A door with a pane in its upper half, `w` wide and `h` high, its lower left corner at the origin: leaf, what is seen
/// through its pane, casing, knob.
pub fn glazed_door(w: f32, h: f32) -> [Mesh; 4] {
    let mut leaf = door_frame([0.0, w], [0.0, h], 0.12);
    leaf.append(&Mesh::block(at(0.12, 0.12, 0.002), at(w - 0.12, 0.95, 0.014)));
    leaf.append(&Mesh::rounded_block(at(0.12, 0.95, 0.0), at(w - 0.12, 1.05, 0.021), 0.003));
    let z = 0.008;
    let light = [at(0.12, 1.05, z), at(w - 0.12, 1.05, z), at(w - 0.12, h - 0.12, z), at(0.12, h - 0.12, z)];
    let casing = Mesh::block(at(-0.09, 0.0, 0.0), at(-0.001, h + 0.09, 0.03))
        .and(Mesh::block(at(w + 0.001, 0.0, 0.0), at(w + 0.09, h + 0.09, 0.03)))
        .and(Mesh::block(at(-0.001, h + 0.001, 0.0), at(w + 0.001, h + 0.09, 0.03)));
    let handle = knob(0.03, 14).moved(at(w - 0.06, 1.0, 0.022));
    [leaf, Mesh::quad(light, Vec2::new(0.3, 1.0)), casing, handle]
}
