// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a scene's own size suggests where its view says nothing: extent, camera and light.

use glam::Vec3;

use crate::scene::{Camera, Light};

/// Boxes around a scene's vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extents {
    /// Corners of the box around all vertices that triangles use.
    pub all: (Vec3, Vec3),
    /// Corners of the box from the 1st to the 99th percentile of the vertices along each axis.
    pub most: (Vec3, Vec3),
}

impl Extents {
    /// The boxes around the vertices that `triangles` use; each vertex counts once.
    pub(crate) fn of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut used = vec![false; positions.len()];
        for v in triangles.iter().flatten() {
            used[*v as usize] = true;
        }
        let mut extents = Extents { all: (Vec3::ZERO, Vec3::ZERO), most: (Vec3::ZERO, Vec3::ZERO) };
        let mut values: Vec<f32> = Vec::new();
        for axis in 0..3 {
            values.clear();
            values.extend(positions.iter().zip(&used).filter(|(_, used)| **used).map(|(p, _)| p[axis]));
            if values.is_empty() {
                continue;
            }
            let last = values.len() - 1;
            // Rounded outwards: with fewer than 100 vertices this is the whole range.
            let low = last / 100;
            let mut at = |i: usize| *values.select_nth_unstable_by(i, f32::total_cmp).1;
            extents.most.0[axis] = at(low);
            extents.most.1[axis] = at(last - low);
            extents.all.0[axis] = at(0);
            extents.all.1[axis] = at(last);
        }
        extents
    }

    /// Longest side of the percentile box, or of the whole box where that is flat.
    pub(crate) fn extent(&self) -> f32 {
        let side = |(low, high): (Vec3, Vec3)| (high - low).max_element();
        if side(self.most) > 0.0 { side(self.most) } else { side(self.all).max(f32::MIN_POSITIVE) }
    }

    /// Middle and radius of the sphere around the percentile box.
    fn sphere(&self) -> (Vec3, f32) {
        let (low, high) = self.most;
        (low + (high - low) * 0.5, ((high - low).length() * 0.5).max(self.extent() * 0.5))
    }
}

/// A camera that sees the whole percentile box from the front, a little from above and from the right.
pub(super) fn fitted_camera(extents: &Extents) -> Camera {
    let (middle, radius) = extents.sphere();
    let fov_y_degrees = 45.0;
    // 1 / sin(22.5 degrees): the sphere around the box just fits.
    let distance = radius * 2.613_126;
    let direction = Vec3::new(0.4, 0.3, 1.0).normalize();
    let mut camera = Camera { eye: middle + direction * distance, look_at: middle, up: Vec3::Y, fov_y_degrees };
    if camera.eye == camera.look_at {
        // A speck far from the origin: any direction will do.
        camera.look_at = camera.eye - direction * camera.eye.abs().max_element().max(1.0);
    }
    camera
}

/// A light above and beside the camera; bright enough that a white surface in the middle facing it is white.
pub(super) fn fitted_light(extents: &Extents, camera: &Camera) -> Light {
    let (middle, radius) = extents.sphere();
    let position = camera.eye + Vec3::new(-0.6, 0.8, 0.0) * radius;
    let distance2 = (position - middle).length_squared().clamp(f32::MIN_POSITIVE, 1.0e30);
    Light { position, intensity: Vec3::splat(distance2) }
}
