// SPDX-License-Identifier: MIT OR Apache-2.0
//! Triangles with the same three corners: which of them a ray finds.
//!
//! The rule: of two that face opposite sides each is found from its front; of two that face the same side the one with
//! the lower id. The first is a flag, by which rays pass a triangle from behind. The second is that of the closest hit,
//! least (t, id), and holds since t comes out the same: all triangles start with their least corner.

use glam::Vec3;
use rayon::prelude::*;

use crate::Result;
use crate::memory;
use crate::monitor::Monitor;
use crate::scene::check::has_area;
use crate::scene::{Scene, Surface};

/// How many corners to rotate a triangle by so that its least corner comes first.
pub(super) fn least_corner([a, b, c]: [Vec3; 3]) -> usize {
    let less = |p: Vec3, q: Vec3| p.to_array() < q.to_array();
    match (less(b, a), less(c, a), less(c, b)) {
        (false, false, _) => 0,
        (true, _, false) => 1,
        _ => 2,
    }
}

/// The triangles that lie on one that faces the other side, in order. Bodies of glass have none: rays that leave them
/// come from behind.
pub(super) fn one_sided(scene: &Scene, monitor: &Monitor) -> Result<Vec<u32>> {
    let corners = |id: u32| {
        let mut corners = scene.triangles()[id as usize].map(|v| scene.positions()[v as usize] + Vec3::ZERO);
        let first = least_corner(corners);
        corners.rotate_left(first);
        corners
    };
    let is_glass = |id: u32| {
        let object = scene.triangle_objects()[id as usize];
        scene.materials()[scene.objects()[object as usize].material as usize].surface == Surface::Glass
    };
    let mut keys: Vec<(u64, u32)> = memory::with_room("the triangles", scene.triangles().len())?;
    keys.extend((0..scene.triangles().len() as u32).map(|id| (hash(corners(id)), id)));
    monitor.check()?;
    keys.par_sort_unstable();
    monitor.check()?;
    let mut found = Vec::new();
    for same in keys.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
        // By the corners themselves: the front first, then the back.
        let mut same: Vec<_> = same.iter().map(|&(_, id)| (sides(corners(id)), id)).collect();
        same.sort_unstable_by(|a, b| bits(&a.0.0).cmp(&bits(&b.0.0)).then(a.1.cmp(&b.1)));
        for same in same.chunk_by(|a, b| a.0.0 == b.0.0) {
            let both = same.iter().any(|s| s.0.1) && same.iter().any(|s| !s.0.1);
            let any_glass = same.iter().any(|&(_, id)| is_glass(id));
            if both && !any_glass && has_area(same[0].0.0) {
                found.extend(same.iter().map(|&(_, id)| id));
            }
        }
    }
    found.sort_unstable();
    Ok(found)
}

/// The corners in an order that both sides have, and which side it is.
fn sides([a, b, c]: [Vec3; 3]) -> ([Vec3; 3], bool) {
    if c.to_array() < b.to_array() { ([a, c, b], true) } else { ([a, b, c], false) }
}

fn bits(corners: &[Vec3; 3]) -> [[u32; 3]; 3] {
    corners.map(|c| c.to_array().map(f32::to_bits))
}

/// A hash of three corners that is the same for both sides.
fn hash(corners: [Vec3; 3]) -> u64 {
    bits(&sides(corners).0).into_iter().flatten().fold(0x9e37_79b9_7f4a_7c15, |h: u64, word| {
        let h = (h ^ u64::from(word)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        h ^ (h >> 29)
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::{Material, Object, SceneParts};

    #[test]
    fn the_least_corner_comes_first() {
        let all = [Vec3::new(-1.0, 2.0, 0.0), Vec3::new(-1.0, 2.0, 1.0), Vec3::new(0.0, -5.0, 0.0)];
        for order in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let mut corners = order.map(|i| all[i]);
            let first = least_corner(corners);
            corners.rotate_left(first);
            assert_eq!(corners[0], all[0], "{order:?}");
        }
    }

    #[test]
    fn only_triangles_that_face_both_sides_are_one_sided() {
        let (a, b, c, d) = (Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z);
        let mut parts = SceneParts { positions: vec![a, b, c, d, Vec3::new(-0.0, 0.0, 0.0)], ..SceneParts::default() };
        // 0 and 1 are two sides, from other corners; 2 and 3 the same twice; 4 and 5 two sides, one of glass.
        parts.triangles = vec![[0, 1, 2], [2, 1, 4], [0, 1, 3], [1, 3, 0], [1, 2, 3], [2, 1, 3], [0, 2, 3]];
        let count = parts.triangles.len();
        parts.corner_normals = vec![[0; 3]; count];
        parts.corner_texcoords = vec![[glam::Vec2::ZERO; 3]; count];
        parts.triangle_objects = vec![0, 0, 0, 0, 0, 1, 0];
        let glass = Material { surface: Surface::Glass, ..Material::default() };
        parts.materials = vec![Material::default(), glass];
        parts.objects = (0..2).map(|material| Object { name: "o".into(), material }).collect();
        let found = |parts: &SceneParts| one_sided(&Scene::new(parts.clone()).unwrap(), &Monitor::default()).unwrap();
        assert_eq!(found(&parts), [0, 1]);
        parts.triangle_objects = vec![0; count];
        assert_eq!(found(&parts), [0, 1, 4, 5]);
    }
}
