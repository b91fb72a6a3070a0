// SPDX-License-Identifier: MIT OR Apache-2.0
//! Structs that host and kernels share: the mirror of `kernels/types.h`, which is the truth. Sizes are asserted here, sizes
//! and offsets by a probe kernel in the tests and in `rarefy selftest`.

use bytemuck::{Pod, Zeroable};

/// `FrameParams` of `kernels/types.h`: what stays the same for a whole frame or one window of it.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct FrameParams {
    pub eye: [f32; 4],
    pub forward: [f32; 4],
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub ambient: [f32; 4],
    pub background: [f32; 4],
    pub bounds_min: [f32; 4],
    pub bounds_max: [f32; 4],
    pub width: u32,
    pub height: u32,
    pub block: u32,
    pub phase_width: u32,
    pub phase_height: u32,
    pub plane_pitch: u32,
    pub light_count: u32,
    pub depth_limit: u32,
    pub epsilon: f32,
    pub window_begin: u32,
    pub window_end: u32,
    pub interior_begin: u32,
    pub interior_end: u32,
    pub pad: [u32; 3],
}
const _: () = assert!(size_of::<FrameParams>() == 192);

/// `StepParams` of `kernels/types.h`: what one launch works on.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct StepParams {
    pub origin_x: u32,
    pub origin_y: u32,
    pub step_x: u32,
    pub step_y: u32,
    pub grid_width: u32,
    pub grid_height: u32,
    pub reference_dx: u32,
    pub reference_dy: u32,
    pub item_count: u32,
    pub list_offset: u32,
    pub source_offset: u32,
    pub sums_offset: u32,
    pub t_pos: f32,
    pub t_norm: f32,
    pub t_conv: f32,
    pub t_tex: f32,
    pub t_gcol: f32,
    pub tests: u32,
    pub flags: u32,
    pub scan_group: u32,
    pub lenient_tests: u32,
    pub t_visible: u32,
    pub list_end: u32,
    pub pixel_class: u32,
}
const _: () = assert!(size_of::<StepParams>() == 96);

/// `Light` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Light {
    pub position: [f32; 4],
    pub intensity: [f32; 4],
}
const _: () = assert!(size_of::<Light>() == 32);

/// `Material` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Material {
    pub diffuse: [f32; 4],
    pub specular: [f32; 4],
    pub reflectance: [f32; 4],
    pub transmission: [f32; 4],
    pub surface: u32,
    pub diffuse_texture: u32,
    pub cutout_texture: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Material>() == 80);

/// `Texture` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct Texture {
    pub offset: u32,
    pub width: u32,
    pub height: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<Texture>() == 16);

/// A triangle as traversal reads it: a corner and two edges; `corner[3]` holds `TRIANGLE_*` bits.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// First corner; the fourth float's bits are flags.
    pub corner: [f32; 4],
    /// Second corner minus the first; the fourth float is unused.
    pub edge1: [f32; 4],
    /// Third corner minus the first; the fourth float is unused.
    pub edge2: [f32; 4],
}
const _: () = assert!(size_of::<Triangle>() == 48);

/// `TriangleShading` of `kernels/types.h`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[allow(missing_docs)] // documented member by member in kernels/types.h
pub struct TriangleShading {
    pub normals: [u32; 3],
    pub object: u32,
    /// `s` and `t` of the three corners in turn.
    pub texcoords: [f32; 6],
    pub material: u32,
    pub pad0: u32,
}
const _: () = assert!(size_of::<TriangleShading>() == 48);

/// What the probe kernel must report: sizes and offsets in bytes, in its order.
pub fn expected_probe() -> Vec<u32> {
    use std::mem::offset_of;
    let bytes: [usize; 25] = [
        size_of::<FrameParams>(),
        offset_of!(FrameParams, up),
        offset_of!(FrameParams, bounds_max),
        offset_of!(FrameParams, width),
        offset_of!(FrameParams, plane_pitch),
        offset_of!(FrameParams, epsilon),
        offset_of!(FrameParams, interior_end),
        size_of::<StepParams>(),
        offset_of!(StepParams, reference_dx),
        offset_of!(StepParams, item_count),
        offset_of!(StepParams, t_pos),
        offset_of!(StepParams, tests),
        offset_of!(StepParams, scan_group),
        size_of::<Light>(),
        offset_of!(Light, intensity),
        size_of::<Material>(),
        offset_of!(Material, transmission),
        offset_of!(Material, surface),
        offset_of!(Material, cutout_texture),
        size_of::<Texture>(),
        offset_of!(Texture, height),
        size_of::<TriangleShading>(),
        offset_of!(TriangleShading, object),
        offset_of!(TriangleShading, texcoords) + 5 * size_of::<f32>(),
        offset_of!(TriangleShading, material),
    ];
    bytes.iter().map(|&b| b as u32).collect()
}
