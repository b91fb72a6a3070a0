// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kd-tree over a scene's triangles, in the very bytes that kernels read.
//!
//! A node is 8 bytes, two words. Second word: bits 0-1 hold the split axis (0 x, 1 y, 2 z) or [`LEAF`]; bits 2-31 hold
//! the index of the lower child (the upper child follows it) or, in a leaf, the number of triangles. First word: the
//! split position as a float, or, in a leaf, the index of its first entry in [`KdTree::leaf_triangles`].

mod build;
mod clip;
mod sah;
mod statistics;
mod validate;

pub use build::{BuildOptions, MAX_BYTES_PER_TRIANGLE};
pub(crate) use clip::cell_epsilon;
pub use statistics::KdStatistics;

pub use crate::layout::LEAF;

/// Deepest tree the builder makes; traversal stacks have this many entries. Reaches kernels as a build option.
pub const MAX_DEPTH: usize = crate::layout::MAX_DEPTH as usize;

/// A node, as in `kernels/common/kdtree.clh`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct KdNode {
    /// Split position (float bits), or index of the first leaf entry.
    pub split_or_first: u32,
    /// Axis or [`LEAF`] in bits 0-1; lower child's index or triangle count above.
    pub axis_and_payload: u32,
}

const _: () = assert!(size_of::<KdNode>() == 8);

impl KdNode {
    /// A leaf with `count` triangles, the first at index `first` of [`KdTree::leaf_triangles`].
    pub fn leaf(first: u32, count: u32) -> Self {
        debug_assert!(count < 1 << 30);
        KdNode { split_or_first: first, axis_and_payload: count << 2 | LEAF }
    }

    /// An inner node: the plane at `split` on `axis`, the lower child at index `child`, the upper one behind it.
    pub fn inner(axis: u32, split: f32, child: u32) -> Self {
        debug_assert!(axis < 3 && child < 1 << 30);
        KdNode { split_or_first: split.to_bits(), axis_and_payload: child << 2 | axis }
    }

    /// Whether this is a leaf.
    #[inline]
    pub fn is_leaf(self) -> bool {
        self.axis() == LEAF
    }

    /// The split axis (0 x, 1 y, 2 z), or [`LEAF`].
    #[inline]
    pub fn axis(self) -> u32 {
        self.axis_and_payload & 3
    }

    /// An inner node's split position, in scene units.
    #[inline]
    pub fn split(self) -> f32 {
        f32::from_bits(self.split_or_first)
    }

    /// An inner node's lower child (the upper one follows), or a leaf's number of triangles.
    #[inline]
    pub fn payload(self) -> u32 {
        self.axis_and_payload >> 2
    }
}

/// A kd-tree over triangles.
#[derive(Debug, Clone, Default)]
pub struct KdTree {
    /// Nodes; the root is node 0, children are adjacent pairs. Index 1 is unused so that pairs are 16-byte aligned.
    pub nodes: Vec<KdNode>,
    /// Triangle ids of all leaves, leaf by leaf, ascending within a leaf.
    pub leaf_triangles: Vec<u32>,
    /// Lower corner of the box around all triangles, widened so that every triangle lies strictly inside.
    pub bounds_min: [f32; 3],
    /// Upper corner of that box.
    pub bounds_max: [f32; 3],
}
