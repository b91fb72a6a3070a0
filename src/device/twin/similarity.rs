// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/similarity.clh`: the seven checks and the interpolation.

use super::FrameBuffers;
use super::planes::{
    Attributes, color_index, gcol_distance, load_attributes, plane_index, store_attributes, store_work,
};
use super::scene_args::{SceneArgs, Work, xyz};
use super::shade::{ShadePoint, sample_texture, shade_local, srgb_word};
use crate::layout::*;
use crate::math::{dot, fraction, normalize};

fn wraps(a: f32, b: f32, t_tex: f32) -> bool {
    (a < t_tex && b > 1.0 - t_tex) || (b < t_tex && a > 1.0 - t_tex)
}

fn unwrap(a: f32, b: f32) -> f32 {
    if b - a > 128.0 {
        b - 256.0
    } else if a - b > 128.0 {
        b + 256.0
    } else {
        b
    }
}

fn textures_part(step: &StepParams, a: &Attributes, b: &Attributes) -> bool {
    if step.flags.contains(StepFlags::UNWRAP) {
        return !((unwrap(a.s, b.s) - a.s).abs() <= step.t_tex) || !((unwrap(a.t, b.t) - a.t).abs() <= step.t_tex);
    }
    wraps(fraction(a.s), fraction(b.s), step.t_tex) || wraps(fraction(a.t), fraction(b.t), step.t_tex)
}

/// Whether the texture of what two references see in a mirror or behind glass looks different midway from their mean. Where
/// they see it too far apart, as in curved mirrors, nobody knows what is midway, and the colours must do.
pub fn texture_between(scene: &SceneArgs, step: &StepParams, m: &Material, a: &Attributes, b: &Attributes) -> bool {
    if !step.flags.contains(StepFlags::BEHIND) || a.behind == NO_OBJECT || a.behind != b.behind {
        return false;
    }
    let texture = scene.materials[scene.object_materials[a.behind as usize] as usize].diffuse_texture;
    if texture == NO_TEXTURE {
        return false;
    }
    let (bs, bt) = (unwrap(a.s, b.s), unwrap(a.t, b.t));
    if !((bs - a.s).abs() <= step.t_tex) || !((bt - a.t).abs() <= step.t_tex) {
        return false;
    }
    let sample = |s: f32, t: f32| sample_texture(scene, texture, fraction(s), fraction(t));
    let weight = xyz(if m.surface == SURFACE_MIRROR { m.reflectance } else { m.transmission });
    let mean = (sample(a.s, a.t) + sample(bs, bt)) * 0.5;
    let midway = sample((a.s + bs) * 0.5, (a.t + bt) * 0.5);
    !(gcol_distance(mean * weight, midway * weight, step.flags) <= step.t_gcol)
}

/// The fail mask of a pair of references: bit `FAIL_*` set where that test fails and is switched on.
pub fn similarity_checks(scene: &SceneArgs, step: &StepParams, a: &Attributes, b: &Attributes) -> FailMask {
    if a.object != b.object {
        return FailMask::G1 & step.tests;
    }
    if a.object == NO_OBJECT {
        return if step.t_pos > 0.0 { FailMask::empty() } else { FailMask::G2 & step.tests };
    }
    let mut mask = FailMask::empty();
    let e = b.position - a.position;
    let distance = dot(e, e).sqrt();
    // Comparisons are written so that NaN fails, as in the kernel.
    if !(distance <= step.t_pos) || !(step.t_pos > 0.0) {
        mask |= FailMask::G2;
    }
    if !(dot(a.normal, b.normal) >= step.t_norm) {
        mask |= FailMask::G3;
    }
    let flat = step.t_conv * distance;
    let (slope_a, slope_b) = (dot(e, a.normal), -dot(e, b.normal));
    let sa = if slope_a.abs() <= flat { 0.0 } else { slope_a };
    let sb = if slope_b.abs() <= flat { 0.0 } else { slope_b };
    if (sa > 0.0 && sb < 0.0) || (sa < 0.0 && sb > 0.0) {
        mask |= FailMask::G4;
    }
    let material = &scene.materials[scene.object_materials[a.object as usize] as usize];
    if material.diffuse_texture != NO_TEXTURE && textures_part(step, a, b) {
        mask |= FailMask::TX;
    }
    if a.shadow_bits != b.shadow_bits {
        mask |= FailMask::SH;
    }
    if !(gcol_distance(a.gcol, b.gcol, step.flags) <= step.t_gcol) || texture_between(scene, step, material, a, b) {
        mask |= FailMask::GC;
    }
    mask & step.tests
}

/// The attributes midway between two references of one object.
pub fn interpolate(frame: &FrameParams, step: &StepParams, a: &Attributes, b: &Attributes) -> Attributes {
    if a.object == NO_OBJECT {
        return *a;
    }
    let mut wa = 0.5;
    if step.flags.contains(StepFlags::PERSPECTIVE) {
        let za = dot(a.position - xyz(frame.eye), xyz(frame.forward));
        let zb = dot(b.position - xyz(frame.eye), xyz(frame.forward));
        wa = zb / (za + zb);
    }
    let wb = 1.0 - wa;
    let texture = |a: f32, b: f32| {
        if step.flags.contains(StepFlags::UNWRAP) {
            a * wa + unwrap(a, b) * wb
        } else {
            fraction(a) * wa + fraction(b) * wb
        }
    };
    Attributes {
        position: a.position * wa + b.position * wb,
        normal: normalize(a.normal * wa + b.normal * wb),
        s: texture(a.s, b.s),
        t: texture(a.t, b.t),
        gcol: a.gcol * wa + b.gcol * wb,
        object: a.object,
        shadow_bits: a.shadow_bits,
        behind: if a.behind == b.behind { a.behind } else { NO_OBJECT },
    }
}

/// Another opposite pair around `(x, y)` that is alike, and alike with `a` or `b`, the upper and lower neighbours.
fn find_other_pair(
    scene: &SceneArgs,
    step: &StepParams,
    (x, y): (u32, u32),
    (a, b): (&Attributes, &Attributes),
    neighbour: &dyn Fn(u32, u32) -> Attributes,
) -> Option<(Attributes, Attributes)> {
    let (dx, dy) = (step.step_x / 2, step.reference_dy);
    if x + dx >= scene.frame.width {
        return None;
    }
    let alike = |a: &Attributes, b: &Attributes| similarity_checks(scene, step, a, b).is_empty();
    let is_wide = |a: &Attributes, y: u32| [x - dx, x + dx].iter().any(|&x| alike(a, &neighbour(x, y)));
    let (a_is_wide, b_is_wide) = (is_wide(a, y - dy), is_wide(b, y + dy));
    let pairs = [(y, y), (y - dy, y + dy), (y + dy, y - dy)].into_iter().map(|(left, right)| {
        let (p, q) = (neighbour(x - dx, left), neighbour(x + dx, right));
        let joins = |a: &Attributes| alike(a, &p) && alike(a, &q);
        let found = alike(&p, &q) && (b_is_wide && joins(a) || a_is_wide && joins(b));
        found.then_some((p, q))
    });
    pairs.flatten().next()
}

/// Whether a ray that hits what `a` hit sends secondary rays.
fn sends_secondary(scene: &SceneArgs, a: &Attributes) -> bool {
    a.object != NO_OBJECT
        && scene.materials[scene.object_materials[a.object as usize] as usize].surface != SURFACE_OPAQUE
}

/// Checks pixel `(x, y)` against its two references; interpolates and shades it or marks it pending.
pub fn check_pixel(scene: &SceneArgs, step: &StepParams, x: u32, y: u32, out: &FrameBuffers) {
    let frame = scene.frame;
    let planes = &out.attributes;
    let pitch = frame.plane_pitch;
    let at = plane_index(frame, x, y);
    if x < step.reference_dx || x + step.reference_dx >= frame.width || y + step.reference_dy >= frame.height {
        planes.set(PLANE_CLASS * pitch + at, CLASS_PENDING);
        return;
    }
    let neighbour = |x: u32, y: u32| load_attributes(planes, pitch, plane_index(frame, x, y));
    let a = neighbour(x - step.reference_dx, y - step.reference_dy);
    let b = neighbour(x + step.reference_dx, y + step.reference_dy);
    let mask = similarity_checks(scene, step, &a, &b);
    let pair = if mask.is_empty() {
        Some((a, b))
    } else if step.flags.contains(StepFlags::OTHER_PAIRS) {
        find_other_pair(scene, step, (x, y), (&a, &b), &neighbour)
    } else {
        None
    };
    let Some((a, b)) = pair else {
        let secondary = sends_secondary(scene, &a) || sends_secondary(scene, &b);
        let secondary = if secondary { CLASS_SECONDARY } else { 0 };
        planes.set(PLANE_CLASS * pitch + at, CLASS_PENDING | mask.bits() | secondary);
        return;
    };
    let m = interpolate(frame, step, &a, &b);
    store_attributes(planes, pitch, at, &m, CLASS_INTERPOLATED);
    planes.set(PLANE_CLAIM * pitch + at, NO_CLAIM);
    let mut color = xyz(frame.background);
    let mut work = Work::default();
    if m.object != NO_OBJECT {
        let point = ShadePoint {
            material: scene.object_materials[m.object as usize],
            position: m.position,
            normal: m.normal,
            s: m.s,
            t: m.t,
            shadow_bits: m.shadow_bits,
        };
        work.shaded += 1;
        color = shade_local(scene, &point, normalize(xyz(frame.eye) - m.position)) + m.gcol;
    }
    store_work(&out.counters, pitch, at, &work);
    out.color.set(color_index(frame, x, y), srgb_word(scene.tables, color));
}
