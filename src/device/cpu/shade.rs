// SPDX-License-Identifier: MIT OR Apache-2.0
//! Textures, local shading and sRGB output: `device/twin/shade.rs` lane by lane.

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined, lanes_of};
use super::vectors::{VectorArray, Vectors, fraction, pow_poly};
use crate::device::twin::SceneArgs;
use crate::device::twin::scene_args::xyz;
use crate::device::twin::shade::{srgb_word, texel_rgb};
use crate::layout::NO_TEXTURE;

/// Bilinear, repeating samples of textures `ids` at `(s, t)` in `[0, 1)`, in `lanes`.
#[inline(always)]
pub fn sample_textures<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    ids: &Array<u32>,
    at: (Floats<L>, Floats<L>),
    lanes: Mask<L>,
) -> Vectors<L> {
    l.enter(
        #[inline(always)]
        || sample_textures_inlined(l, scene, ids, at, lanes),
    )
}

#[inline(always)]
fn sample_textures_inlined<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    ids: &Array<u32>,
    (s, t): (Floats<L>, Floats<L>),
    lanes: Mask<L>,
) -> Vectors<L> {
    let (mut offsets, mut widths, mut heights) = ([0; MOST_LANES], [1; MOST_LANES], [1; MOST_LANES]);
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        let texture = &scene.textures[ids[lane] as usize];
        (offsets[lane], widths[lane], heights[lane]) = (texture.offset, texture.width, texture.height);
    }
    let one = Floats::splat(l, 1.0);
    let place = inlined(
        #[inline(always)]
        |at: Floats<L>, size: &Array<u32>| {
            let size = Words::from_array(l, size);
            let at = at * size.signed_to_floats() - Floats::splat(l, 0.5);
            let whole = at.floor();
            // Left of the first texel, which as an unsigned word is beyond them all, lies the last one.
            let (low, high) = (whole.truncated(), whole.truncated() + Words::splat(l, 1));
            let last = size - Words::splat(l, 1);
            let low = low.lt(last).select_words(low, last);
            let high = high.lt(size).select_words(high, Words::splat(l, 0));
            (low.to_array(), high.to_array(), at - whole)
        },
    );
    let ((x0, x1, wx), (y0, y1, wy)) = (place(s, &widths), place(one - t, &heights));
    let mut corners = [VectorArray::zeros(), VectorArray::zeros(), VectorArray::zeros(), VectorArray::zeros()];
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        let (upper, lower) = (offsets[lane] + y0[lane] * widths[lane], offsets[lane] + y1[lane] * widths[lane]);
        let (x0, x1) = (x0[lane], x1[lane]);
        corners[0].set(lane, &texel_rgb(scene, upper + x0).to_array());
        corners[1].set(lane, &texel_rgb(scene, upper + x1).to_array());
        corners[2].set(lane, &texel_rgb(scene, lower + x0).to_array());
        corners[3].set(lane, &texel_rgb(scene, lower + x1).to_array());
    }
    let [a, b, c, e] = [corners[0].get(l), corners[1].get(l), corners[2].get(l), corners[3].get(l)];
    let (top, bottom) = (a + (b - a) * wx, c + (e - c) * wx);
    top + (bottom - top) * wy
}

/// Surface points as local shading sees them.
pub struct ShadePoints<L: Lanes> {
    /// Lanes that are shaded.
    pub lanes: Mask<L>,
    /// Material ids.
    pub material: Words<L>,
    /// Positions.
    pub position: Vectors<L>,
    /// Unit shading normals.
    pub normal: Vectors<L>,
    /// Texture coordinates.
    pub s: Floats<L>,
    /// Likewise.
    pub t: Floats<L>,
    /// One bit for each light that does not reach the point.
    pub shadow_bits: Words<L>,
}

/// Light that surfaces send towards `view` without secondary rays, linear RGB.
#[inline(always)]
pub fn shade_local<L: Lanes>(l: L, scene: &SceneArgs, points: &ShadePoints<L>, view: Vectors<L>) -> Vectors<L> {
    let zero = Floats::splat(l, 0.0);
    let (mut diffuse, mut specular, mut emission) = (VectorArray::zeros(), VectorArray::zeros(), VectorArray::zeros());
    let (mut own, mut shininess, mut textures) = ([0.0; MOST_LANES], [0.0; MOST_LANES], [NO_TEXTURE; MOST_LANES]);
    let ids = points.material.to_array();
    let mut textured = 0;
    for lane in lanes_of(points.lanes.bits()) {
        let lane = lane % MOST_LANES;
        let m = &scene.materials[ids[lane] as usize];
        diffuse.set(lane, &m.diffuse);
        specular.set(lane, &m.specular);
        emission.set(lane, &m.emission);
        own[lane] = m.reflectance[3];
        shininess[lane] = m.diffuse[3];
        textures[lane] = m.diffuse_texture;
        textured |= u32::from(m.diffuse_texture != NO_TEXTURE) << lane;
    }
    let own = Floats::from_array(l, &own);
    let mut kd = diffuse.get(l) * own;
    let mut ks = specular.get(l);
    if scene.anchor {
        ks = ks * own;
    } else if textured != 0 {
        let lanes = Mask::from_bits(l, textured);
        let at = (fraction(l, points.s), fraction(l, points.t));
        kd = lanes.select_vectors(kd * sample_textures(l, scene, &textures, at, lanes), kd);
    }
    let shininess = Floats::from_array(l, &shininess);
    let has_highlight = ks.greatest().gt(zero);
    let mut sum = kd * Vectors::splat(l, xyz(scene.frame.ambient)) + emission.get(l);
    for (i, light) in scene.lights.iter().enumerate().take(scene.frame.light_count as usize) {
        let lit = points.lanes.without(points.shadow_bits.has(l, 1 << i));
        if !lit.any() {
            continue;
        }
        let to_light = Vectors::splat(l, xyz(light.position)) - points.position;
        let inverse_d2 = Floats::splat(l, 1.0) / to_light.dot(to_light);
        let direction = to_light * inverse_d2.sqrt();
        let n_l = points.normal.dot(direction).max2(zero);
        let mut radiance = kd * n_l;
        let shines = lit & has_highlight & n_l.gt(zero);
        if shines.any() {
            let lobe = if scene.anchor {
                (points.normal * (n_l * 2.0) - direction).dot(view)
            } else {
                points.normal.dot((direction + view).normalize(l))
            };
            let highlight = ks * pow_poly(l, lobe.min2(Floats::splat(l, 1.0)), shininess);
            radiance = shines.select_vectors(radiance + highlight, radiance);
        }
        let light = Vectors::splat(l, xyz(light.intensity)) * radiance * inverse_d2;
        sum = lit.select_vectors(sum + light, sum);
    }
    sum
}

/// Linear colours as sRGB words, in `lanes`.
#[inline(always)]
pub fn srgb_words<L: Lanes>(scene: &SceneArgs, color: Vectors<L>, lanes: Mask<L>) -> Array<u32> {
    let (r, g, b) = (color.x.to_array(), color.y.to_array(), color.z.to_array());
    let mut words = [0; MOST_LANES];
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        words[lane] = srgb_word(scene.tables, glam::Vec3::new(r[lane], g[lane], b[lane]));
    }
    words
}
