// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wide engine: the twin's launches in packets of rays and vectors of pixels, by whatever vector instructions the
//! processor has. Equal to the twin in every bit, on every width.
//!
//! One body per algorithm, generic over `Lanes` (`lanes.rs`); a file here has the name of the twin's file that it repeats lane by
//! lane. The twin stays the truth and what work is counted by; kernels that take little of a frame run as their twins.

// Compares as the twin does, so that NaN takes the same branch. Loops over the vectors of a packet index several arrays.
#![allow(clippy::neg_cmp_op_on_partial_ord, clippy::needless_range_loop)]
// 32-bit processors have no lanes that the engine knows: the twin runs there.
#![cfg_attr(not(any(target_arch = "x86_64", target_arch = "aarch64")), allow(dead_code, unused_variables))]
#![allow(missing_docs)] // operations on lanes have the names of those on floats

pub mod dispatch;
pub mod executor;
mod lanes;
mod pack;
mod packet;
mod planes;
mod ray_tree;
mod shade;
mod similarity;
mod surface;
mod traverse;
mod triangle_test;
mod vectors;

pub use dispatch::Width;
