// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a mesh is a closed body that faces outwards: for the tests of all that makes meshes.

use std::collections::HashMap;

use super::mesh::Mesh;

/// How many directed edges lack an opposite one, by position.
pub fn open_edges(mesh: &Mesh) -> usize {
    let key = |i: u32| mesh.positions[i as usize].to_array().map(|v| (v + 0.0).to_bits());
    let mut edges: HashMap<_, i32> = HashMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
            *edges.entry((a, b)).or_default() += 1;
            *edges.entry((b, a)).or_default() -= 1;
        }
    }
    edges.values().filter(|&&n| n != 0).count()
}

/// The enclosed volume: positive if the shape faces outwards.
pub fn volume(mesh: &Mesh) -> f32 {
    let p = |i: u32| mesh.positions[i as usize];
    mesh.triangles.iter().map(|t| p(t[0]).dot(p(t[1]).cross(p(t[2])))).sum::<f32>() / 6.0
}

/// Normals have length 1 and look to the side that their faces look to.
pub fn normals_agree(mesh: &Mesh) {
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let face = (b - a).cross(c - a);
        assert!(face.length() > 0.0, "a triangle without area");
        for i in t {
            let n = mesh.normals[*i as usize];
            assert!((n.length() - 1.0).abs() < 1e-4, "{n} is no unit vector");
            assert!(face.dot(n) > 0.0, "the normal {n} looks away from its face {face}");
        }
    }
}
