// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a scene to what kernels read: the kd-tree and flat arrays.

pub mod kdtree;
pub mod scene_buffers;
