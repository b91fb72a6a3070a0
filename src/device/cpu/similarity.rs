// SPDX-License-Identifier: MIT OR Apache-2.0
//! The seven checks and the interpolation for vectors of pixels: `device/twin/similarity.rs` lane by lane.

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined, lanes_of};
use super::planes::{WideAttributes, gather, gcol_distance, load_attributes, scatter, store_attributes};
use super::shade::{ShadePoints, sample_textures, shade_local, srgb_words};
use super::vectors::{VectorArray, Vectors, fraction};
use crate::device::twin::scene_args::xyz;
use crate::device::twin::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// A launch of `check`.
#[derive(Clone, Copy)]
pub struct Check<'a, L: Lanes> {
    /// The instruction set.
    pub l: L,
    /// The scene.
    pub scene: &'a SceneArgs<'a>,
    /// The launch.
    pub step: &'a StepParams,
    /// Its buffers.
    pub buffers: &'a FrameBuffers,
}

/// `unwrap` of the twin: the coordinate nearest to `a` that means the same as `b`.
#[inline(always)]
fn unwrap<L: Lanes>(l: L, a: Floats<L>, b: Floats<L>) -> Floats<L> {
    let half = Floats::splat(l, 128.0);
    let whole = Floats::splat(l, 256.0);
    let (above, below) = ((b - a).gt(half), (a - b).gt(half));
    above.select(b - whole, below.select(b + whole, b))
}

impl<L: Lanes> Check<'_, L> {
    #[inline(always)]
    fn splat(&self, value: f32) -> Floats<L> {
        Floats::splat(self.l, value)
    }

    #[inline(always)]
    fn word(&self, word: u32) -> Words<L> {
        Words::splat(self.l, word)
    }

    /// `word` in `lanes`, 0 in the others.
    #[inline(always)]
    fn bits_in(&self, lanes: Mask<L>, word: u32) -> Words<L> {
        lanes.select_words(self.word(word), self.word(0))
    }

    /// Where the pixels at `(x + dx, y)` lie in a plane, in `lanes`.
    #[inline(always)]
    fn places(&self, x: &Array<u32>, y: u32, dx: i64, lanes: Mask<L>) -> Array<u32> {
        let mut at = [0; MOST_LANES];
        for lane in lanes_of(lanes.bits()) {
            let lane = lane % MOST_LANES;
            at[lane] = plane_index(self.scene.frame, (i64::from(x[lane]) + dx) as u32, y);
        }
        at
    }

    /// What pixels hit.
    #[inline(always)]
    fn references(&self, at: &Array<u32>) -> WideAttributes<L> {
        self.l.enter(
            #[inline(always)]
            || load_attributes(self.l, &self.buffers.attributes, self.scene.frame.plane_pitch, at),
        )
    }

    /// Lanes that another object at `at` than `object` does not decide: of most other pairs nothing else must be read.
    #[inline(always)]
    fn same_object(&self, object: Words<L>, at: &Array<u32>, lanes: Mask<L>) -> Mask<L> {
        if !lanes.any() || !self.step.tests.contains(FailMask::G1) {
            return lanes;
        }
        lanes & self.object(at).equals(object)
    }

    #[inline(always)]
    fn object(&self, at: &Array<u32>) -> Words<L> {
        gather(self.l, &self.buffers.attributes, PLANE_OBJECT * self.scene.frame.plane_pitch, at)
    }

    /// One word of the material of each lane's object.
    #[inline(always)]
    fn of_objects(&self, object: Words<L>, lanes: Mask<L>, word: impl Fn(&Material) -> u32) -> Words<L> {
        let ids = object.to_array();
        let mut words = [0; MOST_LANES];
        for lane in lanes_of(lanes.bits()) {
            let lane = lane % MOST_LANES;
            let material = self.scene.object_materials[ids[lane] as usize];
            words[lane] = word(&self.scene.materials[material as usize]);
        }
        Words::from_array(self.l, &words)
    }

    #[inline(always)]
    fn textures_part(&self, a: &WideAttributes<L>, b: &WideAttributes<L>) -> Mask<L> {
        let l = self.l;
        let t_tex = self.splat(self.step.t_tex);
        if self.step.flags.contains(StepFlags::UNWRAP) {
            let near = inlined(
                #[inline(always)]
                |a: Floats<L>, b: Floats<L>| (unwrap(l, a, b) - a).abs().le(t_tex),
            );
            return !near(a.s, b.s) | !near(a.t, b.t);
        }
        let high = self.splat(1.0) - t_tex;
        let wraps = inlined(
            #[inline(always)]
            |a: Floats<L>, b: Floats<L>| {
                let (a, b) = (fraction(l, a), fraction(l, b));
                (a.lt(t_tex) & b.gt(high)) | (b.lt(t_tex) & a.gt(high))
            },
        );
        wraps(a.s, b.s) | wraps(a.t, b.t)
    }

    /// Lanes in which the texture of what is seen in a mirror or behind glass looks different midway from the references' mean.
    #[inline(always)]
    fn texture_between(&self, a: &WideAttributes<L>, b: &WideAttributes<L>, lanes: Mask<L>) -> Mask<L> {
        let (l, scene, step) = (self.l, self.scene, self.step);
        let none = Mask::splat(l, false);
        let same = a.behind.equals(b.behind).without(a.behind.equals(self.word(NO_OBJECT)));
        let mut lanes = lanes & same;
        if !step.flags.contains(StepFlags::BEHIND) || !lanes.any() {
            return none;
        }
        let textures = self.of_objects(
            a.behind,
            lanes,
            #[inline(always)]
            |m| m.diffuse_texture,
        );
        let t_tex = self.splat(step.t_tex);
        let (bs, bt) = (unwrap(l, a.s, b.s), unwrap(l, a.t, b.t));
        lanes = lanes.without(textures.equals(self.word(NO_TEXTURE)));
        lanes = lanes & (bs - a.s).abs().le(t_tex) & (bt - a.t).abs().le(t_tex);
        if !lanes.any() {
            return none;
        }
        let (objects, textures) = (a.object.to_array(), textures.to_array());
        let mut weight = VectorArray::zeros();
        for lane in lanes_of(lanes.bits()) {
            let m = &scene.materials[scene.object_materials[objects[lane % MOST_LANES] as usize] as usize];
            weight.set(lane, if m.surface == SURFACE_MIRROR { &m.reflectance } else { &m.transmission });
        }
        let sample = inlined(
            #[inline(always)]
            |s: Floats<L>, t: Floats<L>| sample_textures(l, scene, &textures, (fraction(l, s), fraction(l, t)), lanes),
        );
        let half = self.splat(0.5);
        let mean = (sample(a.s, a.t) + sample(bs, bt)) * half;
        let midway = sample((a.s + bs) * half, (a.t + bt) * half);
        let weight = weight.get(l);
        lanes.without(gcol_distance(l, mean * weight, midway * weight, step.flags).le(self.splat(step.t_gcol)))
    }

    /// The fail mask of each pair of references: bit `FAIL_*` set where that test fails and is switched on.
    ///
    /// A function of its own, as [`Self::references`]: a dozen copies of it would take minutes to compile.
    #[inline(always)]
    fn similarity_checks(&self, a: &WideAttributes<L>, b: &WideAttributes<L>, lanes: Mask<L>) -> Words<L> {
        self.l.enter(
            #[inline(always)]
            || self.similarity_checks_inlined(a, b, lanes),
        )
    }

    #[inline(always)]
    fn similarity_checks_inlined(&self, a: &WideAttributes<L>, b: &WideAttributes<L>, lanes: Mask<L>) -> Words<L> {
        let (l, step) = (self.l, self.step);
        let other_object = !a.object.equals(b.object);
        let nothing = a.object.equals(self.word(NO_OBJECT)).without(other_object);
        let hits = lanes.without(other_object | nothing);
        let mut mask = self.bits_in(other_object, FAIL_G1);
        if !(step.t_pos > 0.0) {
            mask = mask | self.bits_in(nothing, FAIL_G2);
        }
        if hits.any() {
            let zero = self.splat(0.0);
            let e = b.position - a.position;
            let distance = e.dot(e).sqrt();
            // Comparisons are written so that NaN fails, as in the kernel.
            let near = distance.le(self.splat(step.t_pos)) & Mask::splat(l, step.t_pos > 0.0);
            let mut fails = self.bits_in(!near, FAIL_G2);
            fails = fails | self.bits_in(!a.normal.dot(b.normal).ge(self.splat(step.t_norm)), FAIL_G3);
            let flat = distance * step.t_conv;
            let (slope_a, slope_b) = (e.dot(a.normal), -e.dot(b.normal));
            let sa = slope_a.abs().le(flat).select(zero, slope_a);
            let sb = slope_b.abs().le(flat).select(zero, slope_b);
            let bends = (sa.gt(zero) & sb.lt(zero)) | (sa.lt(zero) & sb.gt(zero));
            fails = fails | self.bits_in(bends, FAIL_G4);
            let texture = self.of_objects(
                a.object,
                hits,
                #[inline(always)]
                |m| m.diffuse_texture,
            );
            let textured = hits.without(texture.equals(self.word(NO_TEXTURE)));
            if textured.any() {
                fails = fails | self.bits_in(textured & self.textures_part(a, b), FAIL_TX);
            }
            fails = fails | self.bits_in(!a.shadow_bits.equals(b.shadow_bits), FAIL_SH);
            let alike = gcol_distance(l, a.gcol, b.gcol, step.flags).le(self.splat(step.t_gcol));
            let between = self.texture_between(a, b, hits & alike);
            fails = fails | self.bits_in(!alike | between, FAIL_GC);
            mask = mask | hits.select_words(fails, self.word(0));
        }
        lanes.select_words(mask & self.word(step.tests.bits()), self.word(0))
    }

    /// Lanes in which two references are alike.
    #[inline(always)]
    fn alike(&self, p: &WideAttributes<L>, q: &WideAttributes<L>, lanes: Mask<L>) -> Mask<L> {
        if !lanes.any() {
            return lanes;
        }
        lanes & self.similarity_checks(p, q, lanes).equals(self.word(0))
    }

    /// The attributes midway between two references of one object.
    #[inline(always)]
    fn interpolate(&self, a: &WideAttributes<L>, b: &WideAttributes<L>) -> WideAttributes<L> {
        let (l, frame, step) = (self.l, self.scene.frame, self.step);
        let mut wa = self.splat(0.5);
        if step.flags.contains(StepFlags::PERSPECTIVE) {
            let (eye, forward) = (Vectors::splat(l, xyz(frame.eye)), Vectors::splat(l, xyz(frame.forward)));
            let za = (a.position - eye).dot(forward);
            let zb = (b.position - eye).dot(forward);
            wa = zb / (za + zb);
        }
        let wb = self.splat(1.0) - wa;
        let unwraps = step.flags.contains(StepFlags::UNWRAP);
        let texture = inlined(
            #[inline(always)]
            |a: Floats<L>, b: Floats<L>| {
                if unwraps { a * wa + unwrap(l, a, b) * wb } else { fraction(l, a) * wa + fraction(l, b) * wb }
            },
        );
        let nothing = a.object.equals(self.word(NO_OBJECT));
        let normal = (a.normal * wa + b.normal * wb).normalize(l);
        WideAttributes {
            position: nothing.select_vectors(a.position, a.position * wa + b.position * wb),
            normal: nothing.select_vectors(a.normal, normal),
            s: nothing.select(a.s, texture(a.s, b.s)),
            t: nothing.select(a.t, texture(a.t, b.t)),
            gcol: nothing.select_vectors(a.gcol, a.gcol * wa + b.gcol * wb),
            object: a.object,
            shadow_bits: a.shadow_bits,
            behind: (nothing | a.behind.equals(b.behind)).select_words(a.behind, self.word(NO_OBJECT)),
        }
    }

    /// Puts other opposite pairs around the pixels of `lanes` in place of `a` and `b`, the upper and lower neighbours, where
    /// they are alike, and alike with one of these. Returns the lanes that got one.
    #[inline(always)]
    fn other_pairs(
        &self,
        (x, y): (&Array<u32>, u32),
        (a, b): (&mut WideAttributes<L>, &mut WideAttributes<L>),
        lanes: Mask<L>,
    ) -> Mask<L> {
        let (l, step) = (self.l, self.step);
        let (dx, dy) = (step.step_x / 2, step.reference_dy);
        let mut within = 0;
        for lane in lanes_of(lanes.bits()) {
            within |= u32::from(x[lane % MOST_LANES] + dx < self.scene.frame.width) << lane;
        }
        let mut open = lanes & Mask::from_bits(l, within);
        let none = Mask::splat(l, false);
        if !open.any() {
            return none;
        }
        let side = i64::from(dx);
        let alike_at = inlined(
            #[inline(always)]
            |c: &WideAttributes<L>, dx: i64, y: u32, lanes: Mask<L>| {
                let at = self.places(x, y, dx, lanes);
                let lanes = self.same_object(c.object, &at, lanes);
                if lanes.any() { self.alike(c, &self.references(&at), lanes) } else { none }
            },
        );
        let wide = inlined(
            #[inline(always)]
            |c: &WideAttributes<L>, y: u32| {
                let left = alike_at(c, -side, y, open);
                left | alike_at(c, side, y, open.without(left))
            },
        );
        let (a_is_wide, b_is_wide) = (wide(a, y - dy), wide(b, y + dy));
        open = open & (a_is_wide | b_is_wide);
        let mut found = none;
        let (old_a, old_b) = (*a, *b);
        for (left, right) in [(y, y), (y - dy, y + dy), (y + dy, y - dy)] {
            if !open.any() {
                break;
            }
            let (at_p, at_q) = (self.places(x, left, -side, open), self.places(x, right, side, open));
            let pair = self.same_object(self.object(&at_p), &at_q, open);
            if !pair.any() {
                continue;
            }
            let (p, q) = (self.references(&at_p), self.references(&at_q));
            let pair = self.alike(&p, &q, pair);
            let by_a = pair & b_is_wide;
            let by_a = self.alike(&old_a, &q, self.alike(&old_a, &p, by_a));
            let by_b = (pair & a_is_wide).without(by_a);
            let by_b = self.alike(&old_b, &q, self.alike(&old_b, &p, by_b));
            let joins = by_a | by_b;
            for (to, from) in [(&mut *a, &p), (&mut *b, &q)] {
                *to = to.replaced(joins, from);
            }
            found = found | joins;
            open = open.without(joins);
        }
        found
    }

    /// Checks the pixels `x` of row `y` against their references; interpolates and shades them or marks them pending.
    #[inline(always)]
    pub fn check_pixels(&self, x: &Array<u32>, y: u32, lanes: Mask<L>) {
        let (l, scene, step) = (self.l, self.scene, self.step);
        let frame = scene.frame;
        let planes = &self.buffers.attributes;
        let pitch = frame.plane_pitch;
        let mut at = [0; MOST_LANES];
        let mut inner = 0;
        for lane in lanes_of(lanes.bits()) {
            let lane = lane % MOST_LANES;
            at[lane] = plane_index(frame, x[lane], y);
            let is_border = x[lane] < step.reference_dx
                || x[lane] + step.reference_dx >= frame.width
                || y + step.reference_dy >= frame.height;
            inner |= u32::from(!is_border) << lane;
        }
        let inner = Mask::from_bits(l, inner);
        let border = lanes.without(inner);
        if border.any() {
            scatter(planes, PLANE_CLASS * pitch, &at, self.word(CLASS_PENDING), border);
        }
        if !inner.any() {
            return;
        }
        let dx = i64::from(step.reference_dx);
        let mut a = self.references(&self.places(x, y - step.reference_dy, -dx, inner));
        let mut b = self.references(&self.places(x, y + step.reference_dy, dx, inner));
        let mask = self.similarity_checks(&a, &b, inner);
        let mut pending = inner.without(mask.equals(self.word(0)));
        if pending.any() {
            let sends = inlined(
                #[inline(always)]
                |object: Words<L>| {
                    let hits = pending.without(object.equals(self.word(NO_OBJECT)));
                    let kind = self.of_objects(
                        object,
                        hits,
                        #[inline(always)]
                        |m| m.surface,
                    );
                    hits.without(kind.equals(self.word(SURFACE_OPAQUE)))
                },
            );
            let secondary = sends(a.object) | sends(b.object);
            if step.flags.contains(StepFlags::OTHER_PAIRS) {
                pending = pending.without(self.other_pairs((x, y), (&mut a, &mut b), pending));
            }
            let class = mask | self.word(CLASS_PENDING) | self.bits_in(secondary, CLASS_SECONDARY);
            scatter(planes, PLANE_CLASS * pitch, &at, class, pending);
        }
        let interpolated = inner.without(pending);
        if !interpolated.any() {
            return;
        }
        let m = self.interpolate(&a, &b);
        store_attributes(l, planes, pitch, &at, &m, self.word(CLASS_INTERPOLATED), interpolated);
        let mut color = Vectors::splat(l, xyz(frame.background));
        let hits = interpolated.without(m.object.equals(self.word(NO_OBJECT)));
        if hits.any() {
            let ids = gather_objects(l, scene, m.object, hits);
            let WideAttributes { position, normal, s, t, shadow_bits, .. } = m;
            let points = ShadePoints { lanes: hits, material: ids, position, normal, s, t, shadow_bits };
            let view = (Vectors::splat(l, xyz(frame.eye)) - position).normalize(l);
            color = hits.select_vectors(shade_local(l, scene, &points, view) + m.gcol, color);
        }
        let words = srgb_words(scene, color, interpolated);
        for lane in lanes_of(interpolated.bits()) {
            let lane = lane % MOST_LANES;
            self.buffers.color.set(color_index(frame, x[lane], y), words[lane]);
        }
    }
}

/// The material of each lane's object.
#[inline(always)]
fn gather_objects<L: Lanes>(l: L, scene: &SceneArgs, object: Words<L>, lanes: Mask<L>) -> Words<L> {
    let ids = object.to_array();
    let mut words = [0; MOST_LANES];
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        words[lane] = scene.object_materials[ids[lane] as usize];
    }
    Words::from_array(l, &words)
}

impl<L: Lanes> WideAttributes<L> {
    /// `other` in `lanes`, `self` in the others.
    #[inline(always)]
    fn replaced(&self, lanes: Mask<L>, other: &Self) -> Self {
        WideAttributes {
            position: lanes.select_vectors(other.position, self.position),
            normal: lanes.select_vectors(other.normal, self.normal),
            s: lanes.select(other.s, self.s),
            t: lanes.select(other.t, self.t),
            gcol: lanes.select_vectors(other.gcol, self.gcol),
            object: lanes.select_words(other.object, self.object),
            shadow_bits: lanes.select_words(other.shadow_bits, self.shadow_bits),
            behind: lanes.select_words(other.behind, self.behind),
        }
    }
}
