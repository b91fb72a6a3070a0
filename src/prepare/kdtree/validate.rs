// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a tree is what traversal relies on: for tests, after every build.
//!
//! Nothing of the builder is used but its epsilon: whether a triangle meets a cell is found by separating axes
//! (Akenine-Moller, "Fast 3D triangle-box overlap testing", 2001), not by clipping.

use glam::{DVec3, Vec3};

use super::build::scene_cell;
use super::clip::Cell;
use super::{KdTree, MAX_DEPTH};

impl KdTree {
    /// Panics with a message unless this is a correct tree over these triangles.
    ///
    /// Checked: each node slot is used exactly once (index 1 by none), children lie behind their parent in even-odd
    /// pairs, split planes lie strictly within their cells, no leaf is deeper than [`MAX_DEPTH`], each leaf entry
    /// belongs to exactly one leaf, ids ascend within a leaf, every triangle that meets a leaf's cell is in that leaf,
    /// no triangle is in a leaf that it does not come near, and the bounds contain all triangles strictly.
    ///
    /// The time grows with leaf entries times depth: a second or so per 100,000 triangles.
    ///
    /// # Panics
    ///
    /// If anything is wrong, or if the triangles themselves are invalid.
    pub fn assert_well_formed(&self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        let epsilon = match scene_cell(positions, triangles) {
            Ok((_, epsilon)) => epsilon as f64,
            Err(e) => panic!("the triangles are invalid: {e}"),
        };
        assert!(self.nodes.len() >= 2, "there are {} nodes, fewer than the root and the unused one", self.nodes.len());
        assert!(self.nodes.len().is_multiple_of(2), "there are {} nodes, an odd number", self.nodes.len());
        for (i, triangle) in triangles.iter().enumerate() {
            for &corner in triangle {
                let p = positions[corner as usize];
                let within = Vec3::from(self.bounds_min).cmplt(p) & p.cmplt(Vec3::from(self.bounds_max));
                assert!(within.all(), "triangle {i}: corner {p} is not strictly within the bounds");
            }
        }
        let mut check = Check {
            tree: self,
            corners: triangles.iter().map(|t| t.map(|corner| positions[corner as usize].as_dvec3())).collect(),
            epsilon,
            used: vec![false; self.nodes.len()],
            covered: vec![false; self.leaf_triangles.len()],
        };
        check.used[1] = true;
        let all = (0..triangles.len() as u32).collect();
        check.node(0, self.root_cell(), 0, all);
        if let Some(i) = check.used.iter().position(|&used| !used) {
            panic!("node {i} cannot be reached");
        }
        if let Some(i) = check.covered.iter().position(|&covered| !covered) {
            panic!("leaf entry {i} belongs to no leaf");
        }
    }
}

struct Check<'a> {
    tree: &'a KdTree,
    corners: Vec<[DVec3; 3]>,
    epsilon: f64,
    used: Vec<bool>,
    covered: Vec<bool>,
}

impl Check<'_> {
    /// Checks the subtree below node `index`; `near` are the triangles that may come near its cell.
    fn node(&mut self, index: usize, cell: Cell, depth: usize, near: Vec<u32>) {
        assert!(!self.used[index], "node {index} is reached twice");
        self.used[index] = true;
        assert!(depth <= MAX_DEPTH, "node {index} has depth {depth}, more than {MAX_DEPTH}");
        // What belongs here for certain lies in the cell or within half an epsilon; what may be here, within a few.
        let near: Vec<u32> = near.into_iter().filter(|&id| self.meets(id, &cell, 8.0 * self.epsilon)).collect();
        let node = self.tree.nodes[index];
        if node.is_leaf() {
            self.leaf(index, &cell, &near);
            return;
        }
        let (axis, split, child) = (node.axis() as usize, node.split(), node.payload() as usize);
        assert!(
            split > cell.lo[axis] && split < cell.hi[axis],
            "node {index}: the plane at {split} on axis {axis} is not strictly between {} and {}",
            cell.lo[axis],
            cell.hi[axis]
        );
        assert!(
            child % 2 == 0 && child > index,
            "node {index}: the children at {child} are not an even pair behind it"
        );
        assert!(child + 1 < self.tree.nodes.len(), "node {index}: the children at {child} are out of range");
        let (lower, upper) = cell.split(axis, split);
        self.node(child, lower, depth + 1, near.clone());
        self.node(child + 1, upper, depth + 1, near);
    }

    fn leaf(&mut self, index: usize, cell: &Cell, near: &[u32]) {
        let node = self.tree.nodes[index];
        let (first, count) = (node.split_or_first as usize, node.payload() as usize);
        let end = first.saturating_add(count);
        assert!(end <= self.tree.leaf_triangles.len(), "leaf {index}: entries {first} to {end} are out of range");
        for (i, covered) in self.covered[first..end].iter_mut().enumerate() {
            assert!(!*covered, "leaf {index}: entry {} belongs to another leaf too", first + i);
            *covered = true;
        }
        let ids = &self.tree.leaf_triangles[first..end];
        assert!(ids.is_sorted_by(|a, b| a < b), "leaf {index}: ids do not ascend");
        for id in ids {
            assert!(near.binary_search(id).is_ok(), "leaf {index}: triangle {id} does not come near the cell {cell:?}");
        }
        for &id in near {
            if self.meets(id, cell, 0.5 * self.epsilon) {
                assert!(ids.binary_search(&id).is_ok(), "leaf {index}: triangle {id} meets the cell but is not in it");
            }
        }
    }

    /// Whether triangle `id` meets `cell` widened by `margin`.
    fn meets(&self, id: u32, cell: &Cell, margin: f64) -> bool {
        let lo = DVec3::from(cell.lo.map(f64::from)) - margin;
        let hi = DVec3::from(cell.hi.map(f64::from)) + margin;
        triangle_meets_box(&self.corners[id as usize], lo, hi)
    }
}

/// Whether a triangle and a box have a point in common: no axis separates them.
fn triangle_meets_box(triangle: &[DVec3; 3], lo: DVec3, hi: DVec3) -> bool {
    let [a, b, c] = *triangle;
    if a.min(b).min(c).cmpgt(hi).any() || a.max(b).max(c).cmplt(lo).any() {
        return false;
    }
    let (centre, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    let corners = [a - centre, b - centre, c - centre];
    let separates = |axis: DVec3| {
        let [p, q, r] = corners.map(|corner| corner.dot(axis));
        let reach = half.dot(axis.abs());
        p.min(q).min(r) > reach || p.max(q).max(r) < -reach
    };
    let edges = [b - a, c - b, a - c];
    if separates(edges[0].cross(edges[1])) {
        return false;
    }
    !edges.iter().any(|edge| DVec3::AXES.iter().any(|axis| separates(axis.cross(*edge))))
}
