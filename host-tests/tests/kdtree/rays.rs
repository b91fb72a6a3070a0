// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rays through the tree, in the plainest way, against brute force: the tree alone must make them agree.

use glam::Vec3;
use rarefy::internal::prepare::kdtree::{BuildOptions, KdNode, KdTree};

use crate::build;
use crate::meshes::{Mesh, Random, awkward_meshes};

/// Moeller and Trumbore's test in floats: the ray parameter of a hit.
fn hit(o: Vec3, d: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let s = o - a;
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(p) / det, d.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t.is_finite()).then_some(t)
}

fn corners(mesh: &Mesh, id: u32) -> [Vec3; 3] {
    mesh.1[id as usize].map(|corner| mesh.0[corner as usize])
}

/// The least (t, id) over all triangles.
fn closest_of_all(mesh: &Mesh, o: Vec3, d: Vec3) -> Option<(f32, u32)> {
    let hits = (0..mesh.1.len() as u32).filter_map(|id| hit(o, d, corners(mesh, id)).map(|t| (t, id)));
    hits.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

/// The least (t, id) over all triangles of leaves whose cells the ray meets, by slabs in 64 bits, without any order.
fn closest_in_tree(tree: &KdTree, mesh: &Mesh, o: Vec3, d: Vec3) -> Option<(f32, u32)> {
    let mut best: Option<(f32, u32)> = None;
    let mut stack = vec![(0usize, tree.bounds_min, tree.bounds_max)];
    while let Some((index, lo, hi)) = stack.pop() {
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for a in 0..3 {
            let (o, d, lo, hi) = (o[a] as f64, d[a] as f64, lo[a] as f64, hi[a] as f64);
            if d == 0.0 {
                if o < lo || o > hi {
                    far = -1.0;
                }
            } else {
                let (t0, t1) = ((lo - o) / d, (hi - o) / d);
                (near, far) = (near.max(t0.min(t1)), far.min(t0.max(t1)));
            }
        }
        // Roundings of 64 bits only: the tree itself must allow for those of the 32-bit test.
        if near > far * (1.0 + 1e-12) {
            continue;
        }
        let node = tree.nodes[index];
        if node.is_leaf() {
            let first = node.split_or_first as usize;
            for &id in &tree.leaf_triangles[first..first + node.payload() as usize] {
                if let Some(t) = hit(o, d, corners(mesh, id))
                    && best.is_none_or(|best| (t, id) < best)
                {
                    best = Some((t, id));
                }
            }
        } else {
            let (axis, child) = (node.axis() as usize, node.payload() as usize);
            let (mut middle_hi, mut middle_lo) = (hi, lo);
            middle_hi[axis] = node.split();
            middle_lo[axis] = node.split();
            stack.push((child, lo, middle_hi));
            stack.push((child + 1, middle_lo, hi));
        }
    }
    best
}

/// Shoots rays, many of them parallel to axes and through corners. Returns how many there were, how many should hit, and
/// those for which `tree` and brute force disagree.
fn shoot(tree: &KdTree, mesh: &Mesh, random: &mut Random) -> (usize, usize, Vec<String>) {
    let (lo, hi) = (Vec3::from(tree.bounds_min), Vec3::from(tree.bounds_max));
    let (mut hits, mut disagreements) = (0, Vec::new());
    for i in 0..400 {
        let corner = mesh.0[(random.unit() * mesh.0.len() as f32) as usize];
        let o = match i % 4 {
            // On a corner's coordinates in two axes: rays in the planes that split cells.
            0 => Vec3::new(corner.x, corner.y, lo.z - 0.5 * (hi - lo).max_element()),
            1 => corner,
            _ => lo + (hi - lo) * random.point(1.0),
        };
        let target = corners(mesh, (random.unit() * mesh.1.len() as f32) as u32);
        let (u, v) = (random.unit(), random.unit());
        let inside = target[0] + (target[1] - target[0]) * u * (1.0 - v) + (target[2] - target[0]) * v;
        let d = match i % 4 {
            0 => Vec3::Z,
            1 => [Vec3::X, Vec3::NEG_Y, Vec3::new(1.0, 1.0, 0.0), Vec3::Z][i / 4 % 4],
            _ => (inside - o).normalize_or(Vec3::X),
        };
        let expected = closest_of_all(mesh, o, d);
        let found = closest_in_tree(tree, mesh, o, d);
        hits += expected.is_some() as usize;
        if found != expected {
            disagreements.push(format!("ray {i} from {o} to {d}: {found:?}, not {expected:?}"));
        }
    }
    (400, hits, disagreements)
}

#[test]
fn rays_hit_the_same_triangle_in_the_tree_as_among_all() {
    let mut random = Random(99);
    let (mut rays, mut hits) = (0, 0);
    for (name, mesh) in awkward_meshes().into_iter().filter(|(_, mesh)| !mesh.1.is_empty()) {
        let mut tree = build(&mesh, &BuildOptions::default());
        let (shot, expected, disagreements) = shoot(&tree, &mesh, &mut random);
        assert!(disagreements.is_empty(), "{name}: {disagreements:#?}");
        rays += shot;
        hits += expected;
        // With the first triangle of every leaf left out, some rays must disagree.
        for node in &mut tree.nodes {
            if node.is_leaf() && node.payload() > 0 {
                *node = KdNode::leaf(node.split_or_first + 1, node.payload() - 1);
            }
        }
        if name == "sphere" || name == "random, small" {
            assert!(!shoot(&tree, &mesh, &mut random).2.is_empty(), "{name}: lost triangles were not noticed");
        }
    }
    assert!(hits > rays / 3, "only {hits} of {rays} rays hit");
}
