// SPDX-License-Identifier: MIT OR Apache-2.0
//! The buffers of a frame, read and written by vectors of pixels: `device/twin/planes.rs` lane by lane.

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined, lanes_of};
use super::vectors::{Vectors, fraction, pack_normal, unpack_normal, whole_repeats};
use crate::device::twin::Words as Buffer;
use crate::device::twin::planes::look_different;
use crate::layout::*;

/// What is kept of pixels' first hits (paper section 3).
#[derive(Clone, Copy)]
#[allow(missing_docs)] // documented in kernels/common/attributes.clh
pub struct WideAttributes<L: Lanes> {
    pub position: Vectors<L>,
    pub normal: Vectors<L>,
    pub s: Floats<L>,
    pub t: Floats<L>,
    pub gcol: Vectors<L>,
    pub object: Words<L>,
    pub shadow_bits: Words<L>,
    pub behind: Words<L>,
}

/// Words of a buffer at the indices `at`, of which those of unused lanes must lie in the buffer as well: 0 does.
#[inline(always)]
pub fn gather<L: Lanes>(l: L, buffer: &Buffer, first: u32, at: &Array<u32>) -> Words<L> {
    let mut words = [0; MOST_LANES];
    for lane in 0..L::COUNT {
        words[lane] = buffer.get(first + at[lane]);
    }
    Words::from_array(l, &words)
}

/// Writes words to a buffer at the indices of `lanes`.
#[inline(always)]
pub fn scatter<L: Lanes>(buffer: &Buffer, first: u32, at: &Array<u32>, words: Words<L>, lanes: Mask<L>) {
    let words = words.to_array();
    let bits = lanes.bits();
    if bits.count_ones() as usize == L::COUNT {
        for lane in 0..L::COUNT {
            buffer.set(first + at[lane], words[lane]);
        }
        return;
    }
    for lane in lanes_of(bits) {
        let lane = lane % MOST_LANES;
        buffer.set(first + at[lane], words[lane]);
    }
}

/// Writes all attributes of the pixels at plane indices `at`, their class with what is above it, and no claim.
#[inline(always)]
pub fn store_attributes<L: Lanes>(
    l: L,
    planes: &Buffer,
    pitch: u32,
    at: &Array<u32>,
    a: &WideAttributes<L>,
    class: Words<L>,
    lanes: Mask<L>,
) {
    let half_word = inlined(
        #[inline(always)]
        |x: Floats<L>| (fraction(l, x) * 65536.0).truncated(),
    );
    let repeats =
        whole_repeats(l, a.s).shifted_left(CLASS_REPEATS_S) | whole_repeats(l, a.t).shifted_left(CLASS_REPEATS_T);
    for (plane, words) in [
        (PLANE_POSITION_X, a.position.x.to_bits()),
        (PLANE_POSITION_Y, a.position.y.to_bits()),
        (PLANE_POSITION_Z, a.position.z.to_bits()),
        (PLANE_GCOL_R, a.gcol.x.to_bits()),
        (PLANE_GCOL_G, a.gcol.y.to_bits()),
        (PLANE_GCOL_B, a.gcol.z.to_bits()),
        (PLANE_NORMAL, pack_normal(l, a.normal)),
        (PLANE_TEXCOORD, half_word(a.s) | half_word(a.t).shifted_left(16)),
        (PLANE_OBJECT, a.object),
        (PLANE_SHADOW, a.shadow_bits),
        (PLANE_BEHIND, a.behind),
        (PLANE_CLASS, class | repeats),
        (PLANE_CLAIM, Words::splat(l, NO_CLAIM)),
    ] {
        scatter(planes, plane * pitch, at, words, lanes);
    }
}

/// Reads all attributes of the pixels at plane indices `at`.
#[inline(always)]
pub fn load_attributes<L: Lanes>(l: L, planes: &Buffer, pitch: u32, at: &Array<u32>) -> WideAttributes<L> {
    let words = inlined(
        #[inline(always)]
        |plane: u32| gather(l, planes, plane * pitch, at),
    );
    let floats = inlined(
        #[inline(always)]
        |plane: u32| words(plane).as_floats(),
    );
    let (texcoord, class) = (words(PLANE_TEXCOORD), words(PLANE_CLASS));
    // From -128 on: near 0 a float holds all of a coordinate.
    let coordinate = inlined(
        #[inline(always)]
        |shift: u32, half_word: Words<L>| {
            let whole = class.shifted_left(24 - shift).shifted_right_signed(24).signed_to_floats();
            whole + (half_word.signed_to_floats() + Floats::splat(l, 0.5)) * (1.0 / 65536.0)
        },
    );
    WideAttributes {
        position: Vectors { x: floats(PLANE_POSITION_X), y: floats(PLANE_POSITION_Y), z: floats(PLANE_POSITION_Z) },
        normal: unpack_normal(l, words(PLANE_NORMAL)),
        s: coordinate(CLASS_REPEATS_S, texcoord & Words::splat(l, 0xffff)),
        t: coordinate(CLASS_REPEATS_T, texcoord.shifted_right(16)),
        gcol: Vectors { x: floats(PLANE_GCOL_R), y: floats(PLANE_GCOL_G), z: floats(PLANE_GCOL_B) },
        object: words(PLANE_OBJECT),
        shadow_bits: words(PLANE_SHADOW),
        behind: words(PLANE_BEHIND),
    }
}

/// Distance of reflected colours: linear with `STEP_GCOL_LINEAR`, else of the square roots of clamped channels.
#[inline(always)]
pub fn gcol_distance<L: Lanes>(l: L, a: Vectors<L>, b: Vectors<L>, flags: StepFlags) -> Floats<L> {
    let shown = inlined(
        #[inline(always)]
        |c: Vectors<L>| {
            if flags.contains(StepFlags::GCOL_LINEAR) {
                return c;
            }
            let root = inlined(
                #[inline(always)]
                |v: Floats<L>| v.max2(Floats::splat(l, 0.0)).min2(Floats::splat(l, 1.0)).sqrt(),
            );
            Vectors { x: root(c.x), y: root(c.y), z: root(c.z) }
        },
    );
    let e = shown(a) - shown(b);
    e.dot(e).sqrt()
}

/// Of `lanes`, those where post-correction takes two hits to be of different things.
#[inline(always)]
pub fn hits_differ<L: Lanes>(
    l: L,
    step: &StepParams,
    a: &WideAttributes<L>,
    b: &WideAttributes<L>,
    colors_a: &Array<u32>,
    colors_b: &Array<u32>,
    lanes: Mask<L>,
) -> Mask<L> {
    let mut visible = 0;
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        visible |= u32::from(look_different(colors_a[lane], colors_b[lane], step.t_visible)) << lane;
    }
    let objects = !a.object.equals(b.object);
    let nothing = a.object.equals(Words::splat(l, NO_OBJECT));
    let mut differs = Mask::splat(l, false);
    if step.flags.contains(StepFlags::COMPARE_SHADOW) {
        differs = differs | !a.shadow_bits.equals(b.shadow_bits);
    }
    if step.flags.contains(StepFlags::COMPARE_SHADING) {
        // Comparisons are written so that NaN differs, as in the kernel.
        differs = differs | !a.normal.dot(b.normal).ge(Floats::splat(l, step.t_norm));
        differs = differs | !gcol_distance(l, a.gcol, b.gcol, step.flags).le(Floats::splat(l, step.t_gcol));
    }
    lanes & (objects | (differs & Mask::from_bits(l, visible)).without(nothing))
}
