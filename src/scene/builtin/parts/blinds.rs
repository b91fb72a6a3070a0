// SPDX-License-Identifier: MIT OR Apache-2.0
//! Venetian blinds.

use super::at;
use crate::scene::builtin::mesh::{Mesh, cos_sin};

/// Depth of a slat.
pub const SLAT: f32 = 0.045;

/// A blind that hangs in the plane z = 0, its head rail's top in the middle of the origin: slats, rails, cords. It is
/// `wide` and hangs down by `drop`; `tilt` in whole turns lowers the slats' edges at +z.
pub fn venetian(wide: f32, drop: f32, slats: u32, cells: u32, tilt: f32) -> [Mesh; 3] {
    let half = 0.5 * wide;
    let (c, s) = cos_sin(tilt);
    let (top, low) = (-0.055, -drop + 0.03);
    let mut leaves = Mesh::default();
    for k in 0..slats {
        let y = top - (top - low) * (k as f32 + 0.5) / slats as f32;
        // A slat is bent across, and sags a little between its cords.
        let place = move |lift: f32| {
            move |u: f32, v: f32| {
                let across = v - 0.5;
                let crown = 0.0045 * (1.0 - 4.0 * across * across) + lift;
                let thirds = u * 3.0 - (u * 3.0).floor();
                let sag = 0.0012 * 4.0 * thirds * (1.0 - thirds);
                let d = -across * SLAT;
                at((2.0 * u - 1.0) * half, y + crown * c - d * s - sag, d * c + crown * s)
            }
        };
        let above = place(0.0005);
        let below = place(-0.0005);
        leaves.append(&Mesh::sheet(cells, 3, above));
        leaves.append(&Mesh::sheet(cells, 3, move |u, v| below(1.0 - u, v)));
    }
    let mut rails = Mesh::rounded_block(at(-half, -0.045, -0.026), at(half, 0.0, 0.026), 0.004);
    rails.append(&Mesh::rounded_block(at(-half, -drop, -0.024), at(half, -drop + 0.018, 0.024), 0.004));
    let mut cords = Mesh::default();
    for x in [-0.8 * half, -0.27 * half, 0.27 * half, 0.8 * half] {
        for z in [-0.026, 0.026] {
            cords.append(&Mesh::tube(&[at(x, -0.04, z), at(x, -drop + 0.012, z)], 0.0011, 4, false));
        }
    }
    // The rod that turns the slats.
    let rod = [at(0.9 * half, -0.03, 0.040), at(0.9 * half, -0.65 * drop, 0.044)];
    cords.append(&Mesh::tube(&rod, 0.004, 6, false));
    [leaves, rails, cords]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::solid::normals_agree;

    #[test]
    fn slats_look_up_and_down_and_lie_between_the_rails() {
        let [slats, rails, cords] = venetian(1.0, 1.5, 10, 6, 0.06);
        normals_agree(&slats);
        assert_eq!(slats.triangles.len(), 10 * 2 * 6 * 3 * 2);
        assert!(slats.positions.iter().all(|p| p.y < -0.045 && p.y > -1.5 + 0.018 && p.z.abs() <= SLAT));
        let low = rails.positions.iter().map(|p| p.y).fold(0.0, f32::min);
        assert!((low + 1.5).abs() < 1e-6 && cords.positions.iter().all(|p| p.y > low));
        // The front edges are the lower ones.
        let mean = |front: bool| {
            let of: Vec<f32> = slats.positions.iter().filter(|p| (p.z > 0.01) == front).map(|p| p.y).collect();
            of.iter().sum::<f32>() / of.len() as f32
        };
        assert!(mean(true) < mean(false));
    }
}
