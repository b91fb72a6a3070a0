// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which pixels the method checks against which references, and a comparison of class words with an expected mask.
#![allow(clippy::unwrap_used)]

use glam::DVec3;
use rarefy::internal::layout::{CLASS_BASE, CLASS_INTERPOLATED, CLASS_MASK, CLASS_TRACED, FAIL_ALL, PLANE_CLASS};
use rarefy::internal::method::options::{Mode, RenderOptions, Test, Tolerances};
use rarefy::internal::scene::Scene;

use crate::fixtures::{SceneBuilder, draw, options, twin_renderer, with};

/// Width of the pictures.
pub const W: u32 = 64;
/// Height of the pictures.
pub const H: u32 = 48;

/// Where a pixel's attributes come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// A base pixel.
    Base,
    /// Adaptive, between two references.
    Between([(u32, u32); 2]),
    /// Adaptive, with a reference beyond the border.
    Border,
}

/// The role of a pixel in a picture of `width` by `height` in blocks of `block`.
pub fn role((x, y): (u32, u32), (width, height): (u32, u32), block: u32) -> Role {
    if x % block == 0 && y % block == 0 {
        return Role::Base;
    }
    let mut stride = block;
    loop {
        let half = stride / 2;
        let (dx, dy) = if y % stride == 0 && x % stride == half {
            (half, 0)
        } else if x % half == 0 && y % stride == half {
            (0, half)
        } else {
            stride = half;
            continue;
        };
        let inside = x + dx < width && y + dy < height;
        return if inside { Role::Between([(x - dx, y - dy), (x + dx, y + dy)]) } else { Role::Border };
    }
}

/// A pinhole camera in doubles.
#[derive(Debug, Clone, Copy)]
pub struct Eye {
    /// Position.
    pub at: DVec3,
    /// The middle of the picture.
    pub look_at: DVec3,
    /// Vertical field of view.
    pub fov_degrees: f64,
}

/// Looks straight at the plane z = 0 from a distance of 3.
pub const FRONT: Eye = Eye { at: DVec3::new(0.0, 0.0, 3.0), look_at: DVec3::ZERO, fov_degrees: 40.0 };

impl Eye {
    /// Through the middle of a pixel, of length 1 along the line of sight.
    pub fn direction(&self, (x, y): (u32, u32)) -> DVec3 {
        let forward = (self.look_at - self.at).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let half = (self.fov_degrees.to_radians() / 2.0).tan();
        let (w, h) = (f64::from(W), f64::from(H));
        let (sx, sy) = ((2.0 * f64::from(x) + 1.0) / w - 1.0, 1.0 - (2.0 * f64::from(y) + 1.0) / h);
        forward + right * (sx * half * w / h) + up * (sy * half)
    }

    /// Where the pixel's ray meets the plane z = `z`.
    pub fn on_wall(&self, pixel: (u32, u32), z: f64) -> DVec3 {
        let d = self.direction(pixel);
        self.at + d * ((z - self.at.z) / d.z)
    }

    /// Gives a scene this camera.
    pub fn seen_from(&self, builder: SceneBuilder) -> SceneBuilder {
        builder.camera(self.at.as_vec3(), self.look_at.as_vec3(), self.fov_degrees as f32)
    }
}

/// The paper's tolerances but for the distance.
pub fn tolerances(t_pos: f32) -> Tolerances {
    Tolerances { t_pos, ..Tolerances::PAPER }
}

/// An adaptive frame with the same tolerances at all levels, without correction.
pub fn adaptive(block: u32, tolerances: Tolerances) -> RenderOptions {
    with(&options(Mode::Adaptive, W, H, block), |method| method.checks = method.checks.at_all_levels(tolerances))
}

/// The options without the test of this bit.
pub fn without(options: &RenderOptions, fail_bit: u32) -> RenderOptions {
    with(options, |method| {
        let test = Test::ALL.into_iter().find(|test| test.fail_bit() == fail_bit).expect("a test's bit");
        method.checks.tests = method.checks.tests.without(test);
    })
}

/// Draws `scene` and lists the pixels whose class and failed tests are not what `mask` says of their references.
pub fn mismatches(scene: &Scene, options: &RenderOptions, mask: &dyn Fn((u32, u32), (u32, u32)) -> u32) -> Vec<String> {
    let mut renderer = twin_renderer(scene.clone());
    draw(&mut renderer, options);
    let classes = renderer.plane(PLANE_CLASS).unwrap();
    let size = (options.width, options.height);
    let mut wrong = Vec::new();
    for (i, &word) in classes.iter().enumerate() {
        let pixel = (i as u32 % size.0, i as u32 / size.0);
        let expected = match role(pixel, size, options.method.block) {
            Role::Base => CLASS_BASE,
            Role::Border => CLASS_TRACED,
            Role::Between([a, b]) => match mask(a, b) {
                0 => CLASS_INTERPOLATED,
                mask => CLASS_TRACED | mask,
            },
        };
        // Which half of the packed list a pixel went to is no question here.
        let word = word & (CLASS_MASK | FAIL_ALL);
        if word != expected {
            wrong.push(format!("pixel {pixel:?}: {word:#x} instead of {expected:#x}"));
        }
    }
    wrong
}
