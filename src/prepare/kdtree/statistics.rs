// SPDX-License-Identifier: MIT OR Apache-2.0
//! Figures that tell a good tree from a bad one.

use super::clip::Cell;
use super::{BuildOptions, KdNode, KdTree};

/// Figures of a tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KdStatistics {
    /// Nodes in use: inner nodes and leaves.
    pub nodes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    /// Leaves without triangles.
    pub empty_leaves: usize,
    /// Depth of the deepest leaf; the root has depth 0.
    pub max_depth: usize,
    /// Triangle ids in all leaves.
    pub leaf_entries: usize,
    /// Most triangles in a leaf.
    pub max_leaf_triangles: usize,
    /// How many leaves a triangle lies in on average (triangles that lie in none are not counted).
    pub duplication: f64,
    /// Expected inner nodes that a ray through the root's box visits, if rays are spread evenly and hit nothing.
    pub expected_steps: f64,
    /// Expected leaves with triangles that such a ray visits.
    pub expected_leaves: f64,
    /// Expected triangle tests of such a ray.
    pub expected_tests: f64,
    /// `expected_steps` and `expected_tests`, weighted by the default costs of [`BuildOptions`]: the value of the
    /// surface area heuristic for the whole tree.
    pub sah_cost: f64,
    /// Bytes of nodes and leaf entries.
    pub bytes: u64,
}

impl KdTree {
    /// The cell of the root.
    pub(super) fn root_cell(&self) -> Cell {
        Cell { lo: self.bounds_min, hi: self.bounds_max }
    }

    /// Counts and rates the tree, which must be well-formed.
    pub fn statistics(&self) -> KdStatistics {
        let costs = BuildOptions::default();
        let mut s = KdStatistics {
            nodes: 0,
            leaves: 0,
            empty_leaves: 0,
            max_depth: 0,
            leaf_entries: self.leaf_triangles.len(),
            max_leaf_triangles: 0,
            duplication: 0.0,
            expected_steps: 0.0,
            expected_leaves: 0.0,
            expected_tests: 0.0,
            sah_cost: 0.0,
            bytes: (self.nodes.len() * size_of::<KdNode>() + self.leaf_triangles.len() * size_of::<u32>()) as u64,
        };
        if self.nodes.is_empty() {
            return s;
        }
        let root_area = self.root_cell().half_area();
        let mut stack = vec![(0, self.root_cell(), 0)];
        while let Some((index, cell, depth)) = stack.pop() {
            let node = self.nodes[index];
            let share = cell.half_area() / root_area;
            s.nodes += 1;
            s.max_depth = s.max_depth.max(depth);
            if node.is_leaf() {
                let count = node.payload() as usize;
                s.leaves += 1;
                s.empty_leaves += (count == 0) as usize;
                s.max_leaf_triangles = s.max_leaf_triangles.max(count);
                s.expected_tests += share * count as f64;
                s.expected_leaves += if count > 0 { share } else { 0.0 };
            } else {
                s.expected_steps += share;
                let (lower, upper) = cell.split(node.axis() as usize, node.split());
                let child = node.payload() as usize;
                stack.push((child + 1, upper, depth + 1));
                stack.push((child, lower, depth + 1));
            }
        }
        let mut ids = self.leaf_triangles.clone();
        ids.sort_unstable();
        ids.dedup();
        s.duplication = if ids.is_empty() { 0.0 } else { self.leaf_triangles.len() as f64 / ids.len() as f64 };
        s.sah_cost = costs.traversal_cost as f64 * s.expected_steps + costs.intersection_cost as f64 * s.expected_tests;
        s
    }
}
