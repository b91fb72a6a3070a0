// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/shade.clh`: textures, local shading, sRGB output.

use glam::Vec3;

use super::scene_args::{SceneArgs, xyz};
use crate::layout::{NO_TEXTURE, SRGB_FIRST_BUCKET, SRGB_LEAST, TABLE_SRGB_GUESS, TABLE_SRGB_THRESHOLD};
use crate::math::{dot, fraction, max2, min2, normalize, pow_poly};

/// Texel `at`, linear RGB.
#[inline]
pub fn texel_rgb(scene: &SceneArgs, at: u32) -> Vec3 {
    let word = scene.texels[at as usize];
    let decode = |byte: u32| f32::from_bits(scene.tables[(byte & 255) as usize]);
    Vec3::new(decode(word), decode(word >> 8), decode(word >> 16))
}

/// The four texels around `(s, t)` in `[0, 1)` of texture `id`, upper row first, and the weights of the right and the lower ones.
#[inline]
fn texel_corners(scene: &SceneArgs, id: u32, s: f32, t: f32) -> ([Vec3; 4], (f32, f32)) {
    let texture = &scene.textures[id as usize];
    let (offset, width, height) = (texture.offset, texture.width, texture.height);
    let (x, y) = (s * width as f32 - 0.5, (1.0 - t) * height as f32 - 0.5);
    let (fx, fy) = (x.floor(), y.floor());
    let (ix, iy) = (fx as i32, fy as i32);
    let low = |i: i32, size: u32| if i < 0 { size - 1 } else { (i as u32).min(size - 1) };
    let high = |i: i32, size: u32| if ((i + 1) as u32) < size { (i + 1) as u32 } else { 0 };
    let (x0, x1, y0, y1) = (low(ix, width), high(ix, width), low(iy, height), high(iy, height));
    let texel = |x: u32, y: u32| texel_rgb(scene, offset + y * width + x);
    ([texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)], (x - fx, y - fy))
}

/// Bilinear, repeating sample of texture `id` at `(s, t)` in `[0, 1)`.
pub fn sample_texture(scene: &SceneArgs, id: u32, s: f32, t: f32) -> Vec3 {
    let ([a, b, c, e], (wx, wy)) = texel_corners(scene, id, s, t);
    let (top, bottom) = (a + (b - a) * wx, c + (e - c) * wx);
    top + (bottom - top) * wy
}

/// A surface point as local shading sees it.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)] // members as in the attribute planes of layout.rs
pub struct ShadePoint {
    pub material: u32,
    pub position: Vec3,
    pub normal: Vec3,
    pub s: f32,
    pub t: f32,
    pub shadow_bits: u32,
}

/// Light that the surface sends towards `view` without secondary rays, linear RGB.
pub fn shade_local(scene: &SceneArgs, point: &ShadePoint, view: Vec3) -> Vec3 {
    let m = &scene.materials[point.material as usize];
    let own = m.reflectance[3];
    let mut kd = xyz(m.diffuse) * own;
    let mut ks = xyz(m.specular);
    if scene.anchor {
        ks *= own;
    } else if m.diffuse_texture != NO_TEXTURE {
        kd *= sample_texture(scene, m.diffuse_texture, fraction(point.s), fraction(point.t));
    }
    let shininess = m.diffuse[3];
    let has_highlight = max2(ks.x, max2(ks.y, ks.z));
    let mut sum = kd * xyz(scene.frame.ambient) + xyz(m.emission);
    for (i, light) in scene.lights.iter().enumerate().take(scene.frame.light_count as usize) {
        if (point.shadow_bits >> i) & 1 != 0 {
            continue;
        }
        let to_light = xyz(light.position) - point.position;
        let inverse_d2 = 1.0 / dot(to_light, to_light);
        let l = to_light * inverse_d2.sqrt();
        let n_l = max2(dot(point.normal, l), 0.0);
        let mut radiance = kd * n_l;
        if has_highlight > 0.0 && n_l > 0.0 {
            let lobe = if scene.anchor {
                dot(point.normal * (2.0 * n_l) - l, view)
            } else {
                dot(point.normal, normalize(l + view))
            };
            radiance += ks * pow_poly(min2(lobe, 1.0), shininess);
        }
        sum += xyz(light.intensity) * radiance * inverse_d2;
    }
    sum
}

fn srgb_byte(tables: &[u32], linear: f32) -> u32 {
    // Written so that NaN is black, as in the kernel.
    if !(linear >= SRGB_LEAST) {
        return 0;
    }
    if linear >= 1.0 {
        return 255;
    }
    let guess = tables[(TABLE_SRGB_GUESS + (linear.to_bits() >> 16) - SRGB_FIRST_BUCKET) as usize];
    guess + u32::from(linear >= f32::from_bits(tables[(TABLE_SRGB_THRESHOLD + guess + 1) as usize]))
}

/// A linear colour as an sRGB word: red in the lowest byte, opaque.
pub fn srgb_word(tables: &[u32], linear: Vec3) -> u32 {
    srgb_byte(tables, linear.x) | srgb_byte(tables, linear.y) << 8 | srgb_byte(tables, linear.z) << 16 | 0xff00_0000
}
