// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a view to what a frame is drawn from.

use glam::Vec3;

use crate::device::frame_memory::FrameInputs;
use crate::layout::FrameParams;
use crate::math::{cross, normalize};
use crate::prepare::{PreparedScene, Shading, flatten_lights};
use crate::scene::View;

/// Largest width or height in pixels.
pub const MAX_SIDE: u32 = 16384;
/// Largest width or height in samples: addresses hold 16 bits for each, and the last one is [`crate::layout::NO_PIXEL`].
pub const MAX_SAMPLE_SIDE: u32 = 65535;

/// What a frame, in one window, of `width` by `height` samples in base blocks of `block` (1, 2 or 4) is drawn from.
pub fn frame_inputs(
    view: &View,
    scene: &PreparedScene,
    width: u32,
    height: u32,
    block: u32,
    depth_limit: u32,
) -> FrameInputs {
    let camera = &view.camera;
    // In doubles: systems' tangents differ in their last bit, which the rounding to f32 takes away.
    let half = (f64::from(camera.fov_y_degrees).to_radians() * 0.5).tan() as f32;
    let forward = normalize(camera.look_at - camera.eye);
    let right = normalize(cross(forward, camera.up));
    let up = cross(right, forward) * half;
    let right = right * (half * width as f32 / height as f32);
    let float4 = |v: Vec3| [v.x, v.y, v.z, 0.0];
    let corner = |c: [f32; 3]| [c[0], c[1], c[2], 0.0];
    let anchor = scene.shading == Shading::Anchor;
    let phase_width = width.div_ceil(block);
    let phase_height = height.div_ceil(block);
    let lights = flatten_lights(&view.lights);
    let params = FrameParams {
        eye: float4(camera.eye),
        forward: float4(forward),
        right: float4(right),
        up: float4(up),
        ambient: float4(if anchor { Vec3::splat(0.1) } else { view.ambient }),
        background: float4(if anchor { Vec3::ZERO } else { view.background }),
        bounds_min: corner(scene.tree.bounds_min),
        bounds_max: corner(scene.tree.bounds_max),
        width,
        height,
        block,
        phase_width,
        phase_height,
        plane_pitch: block * block * phase_width * phase_height,
        light_count: lights.len() as u32,
        depth_limit: if anchor { 2 } else { depth_limit },
        epsilon: scene.epsilon,
        window_begin: 0,
        window_end: height,
        interior_begin: 0,
        interior_end: height,
        pad: [0; 3],
    };
    FrameInputs { params, lights }
}
