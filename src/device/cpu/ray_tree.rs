// SPDX-License-Identifier: MIT OR Apache-2.0
//! A packet of pixels by Whitted ray tracing: `device/twin/ray_tree.rs` lane by lane.

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined, lanes_of};
use super::packet::{Rays, Stack};
use super::planes::{WideAttributes, hits_differ, load_attributes, store_attributes};
use super::shade::{ShadePoints, shade_local, srgb_words};
use super::surface::{SurfacePoints, of_materials, surface_points, surfaces};
use super::traverse::{any_hit, closest_hit};
use super::vectors::Vectors;
use crate::device::twin::known_shadows::known_shadows;
use crate::device::twin::scene_args::xyz;
use crate::device::twin::{FrameBuffers, SceneArgs};
use crate::layout::*;

/// The pixels of a packet.
#[derive(Debug, Clone, Copy)]
pub struct Pixels<const K: usize> {
    /// Column of each lane's pixel.
    pub x: [Array<u32>; K],
    /// Row of it.
    pub y: [Array<u32>; K],
    /// Bit i: lane i has a pixel.
    pub lanes: [u32; K],
}

impl<const K: usize> Pixels<K> {
    /// No pixels.
    pub const NONE: Self = Pixels { x: [[0; MOST_LANES]; K], y: [[0; MOST_LANES]; K], lanes: [0; K] };
}

/// Lights that pixels need not send shadow rays to, as in `device/twin/known_shadows.rs`.
#[derive(Clone, Copy)]
struct Known<L: Lanes> {
    lights: Words<L>,
    bits: Words<L>,
}

#[inline(always)]
fn any_of<L: Lanes, const K: usize>(l: L, masks: &[Mask<L>; K]) -> bool {
    let mut any = Mask::splat(l, false);
    for &mask in masks {
        any = any | mask;
    }
    any.any()
}

/// One bit per light that does not reach the points of `lanes`; lights that are known get no ray.
#[inline(always)]
fn shadow_test<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    points: &[SurfacePoints<L>; K],
    lanes: &[Mask<L>; K],
    known: Option<&[Known<L>; K]>,
    stack: &mut Stack<L, K>,
) -> [Words<L>; K] {
    let zero = Floats::splat(l, 0.0);
    let mut bits = [Words::splat(l, 0); K];
    let mut origin = [Vectors { x: zero, y: zero, z: zero }; K];
    for k in 0..K {
        origin[k] = points[k].outside(scene);
    }
    for (i, light) in scene.lights.iter().enumerate().take(scene.frame.light_count as usize) {
        let light = Vectors::splat(l, xyz(light.position));
        let mut rays = Rays { origin, direction: origin, alive: *lanes };
        let mut shadowed = *lanes;
        let mut limit = [zero; K];
        for k in 0..K {
            let p = &points[k];
            let to_light = light - origin[k];
            let faces = p.normal.dot(to_light).gt(zero) & p.geometric_normal.dot(to_light).gt(zero);
            let faces = lanes[k] & faces;
            shadowed[k] = lanes[k].without(faces);
            let mut asks = faces;
            if let Some(known) = known {
                let is_known = faces & known[k].lights.has(l, 1 << i);
                shadowed[k] = shadowed[k] | (is_known & known[k].bits.has(l, 1 << i));
                asks = faces.without(is_known);
            }
            let distance = to_light.dot(to_light).sqrt();
            limit[k] = if scene.anchor { distance } else { distance * SHADOW_REACH };
            rays.direction[k] = to_light * (Floats::splat(l, 1.0) / distance);
            rays.alive[k] = asks;
        }
        if any_of(l, &rays.alive) {
            let hidden = any_hit(l, scene, &rays, &limit, stack);
            for k in 0..K {
                shadowed[k] = shadowed[k] | (rays.alive[k] & hidden[k]);
            }
        }
        let bit = Words::splat(l, 1 << i);
        for k in 0..K {
            bits[k] = bits[k] | shadowed[k].select_words(bit, Words::splat(l, 0));
        }
    }
    bits
}

#[inline(always)]
fn reflect_directions<L: Lanes>(l: L, p: &SurfacePoints<L>, d: Vectors<L>) -> Vectors<L> {
    let about = inlined(
        #[inline(always)]
        |n: Vectors<L>| d - n * (d.dot(n) * 2.0),
    );
    let r = about(p.normal);
    let outward = r.dot(p.geometric_normal).gt(Floats::splat(l, 0.0));
    outward.select_vectors(r, about(p.geometric_normal)).normalize(l)
}

/// Lanes of total internal reflection, reflectance and refracted directions: `fresnel` of the twin.
#[inline(always)]
fn fresnel<L: Lanes>(l: L, d: Vectors<L>, n: Vectors<L>, eta: Floats<L>) -> (Mask<L>, Floats<L>, Vectors<L>) {
    let one = Floats::splat(l, 1.0);
    let cos_i = (-d.dot(n)).max2(Floats::splat(l, 0.0)).min2(one);
    let sin2_t = eta * eta * (one - cos_i * cos_i);
    let total = sin2_t.ge(one);
    let cos_t = (one - sin2_t).sqrt();
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let refracted = (d * eta + n * (eta * cos_i - cos_t)).normalize(l);
    (total, (parallel * parallel + perpendicular * perpendicular) * 0.5, refracted)
}

/// Rays about to leave surfaces.
#[derive(Clone, Copy)]
struct Chains<L: Lanes> {
    origin: Vectors<L>,
    direction: Vectors<L>,
    weight: Vectors<L>,
    inside: Mask<L>,
    refracted: Mask<L>,
}

/// Continues the chains of `lanes` at `p`; returns the lanes in which there is a mirror or glass to do so.
#[inline(always)]
fn continue_chains<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    p: &SurfacePoints<L>,
    lanes: Mask<L>,
    split_reflection: Mask<L>,
    c: &mut Chains<L>,
) -> (Mask<L>, Mask<L>) {
    let one = Floats::splat(l, 1.0);
    let m = surfaces(l, scene, p.material, lanes);
    let is = inlined(
        #[inline(always)]
        |kind: u32| m.kind.equals(Words::splat(l, kind)),
    );
    let (mirror, thin) = (is(SURFACE_MIRROR), is(SURFACE_THIN_GLASS));
    let glass = is(SURFACE_GLASS) | thin;
    let on = lanes & (mirror | glass);
    if !on.any() {
        return (on, thin);
    }
    let mut reflects = mirror;
    let mut weight = c.weight * m.reflectance;
    let mut refracted_direction = c.direction;
    if (on & glass).any() {
        let eta = c.inside.without(thin).select(m.ior, one / m.ior);
        let against = p.normal.dot(c.direction).lt(Floats::splat(l, 0.0));
        let n = against.select_vectors(p.normal, p.geometric_normal);
        let (total, f, refracted) = fresnel(l, c.direction, n, eta);
        let f = total.select(one, f);
        let by_glass = glass & (split_reflection | f.ge(one));
        reflects = mirror | by_glass;
        let through = c.weight * (m.transmission * (one - f));
        weight = mirror.select_vectors(weight, by_glass.select_vectors(c.weight * f, through));
        refracted_direction = thin.select_vectors(c.direction, refracted);
    }
    let refracts = on.without(reflects);
    let reflected = reflect_directions(l, p, c.direction);
    let beyond = p.position - p.geometric_normal * p.offset;
    let next = Chains {
        origin: reflects.select_vectors(p.outside(scene), beyond),
        direction: reflects.select_vectors(reflected, refracted_direction),
        weight,
        inside: c.inside ^ refracts.without(thin),
        refracted: refracts,
    };
    c.origin = on.select_vectors(next.origin, c.origin);
    c.direction = on.select_vectors(next.direction, c.direction);
    c.weight = on.select_vectors(next.weight, c.weight);
    c.inside = next.inside;
    c.refracted = on.select_mask(next.refracted, c.refracted);
    (on, thin)
}

/// What secondary rays find: GCOL of the paper, the object seen in a mirror or behind glass, texture coordinates there.
#[derive(Clone, Copy)]
struct Secondary<L: Lanes> {
    gcol: Vectors<L>,
    behind: Words<L>,
    s: Floats<L>,
    t: Floats<L>,
}

#[inline(always)]
fn shade<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    p: &SurfacePoints<L>,
    shadow_bits: Words<L>,
    lanes: Mask<L>,
    view: Vectors<L>,
) -> Vectors<L> {
    let SurfacePoints { material, position, normal, s, t, .. } = *p;
    shade_local(l, scene, &ShadePoints { lanes, material, position, normal, s, t, shadow_bits }, view)
}

/// Sends secondary rays from the first hits `points` of the rays `direction`.
#[inline(always)]
fn gather_secondary<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    points: &[SurfacePoints<L>; K],
    direction: &[Vectors<L>; K],
    lanes: &[Mask<L>; K],
    stack: &mut Stack<L, K>,
) -> [Secondary<L>; K] {
    let (zero, none) = (Floats::splat(l, 0.0), Mask::splat(l, false));
    let black = Vectors { x: zero, y: zero, z: zero };
    let no_object = Words::splat(l, NO_OBJECT);
    let mut found = [Secondary { gcol: black, behind: no_object, s: zero, t: zero }; K];
    for k in 0..K {
        (found[k].s, found[k].t) = (points[k].s, points[k].t);
    }
    let (mut first, mut second) = ([none; K], [none; K]);
    for k in 0..K {
        let kind = of_materials(
            l,
            scene,
            points[k].material,
            lanes[k],
            #[inline(always)]
            |m| m.surface,
        );
        let sends = lanes[k].without(kind.equals(Words::splat(l, SURFACE_OPAQUE)));
        first[k] = sends;
        second[k] = sends.without(kind.equals(Words::splat(l, SURFACE_MIRROR)));
    }
    // A mirror has one chain; glass has one for what it reflects and, after it, one for what comes through.
    for (chain, begins) in [first, second].into_iter().enumerate() {
        if !any_of(l, &begins) {
            continue;
        }
        let mut at = *points;
        let mut alive = begins;
        let mut split = if chain == 0 { second } else { [none; K] };
        let mut is_last = [!none; K];
        if chain == 0 {
            for k in 0..K {
                is_last[k] = !second[k];
            }
        }
        let (mut spent, mut panes) = ([Words::splat(l, 0); K], [Words::splat(l, 0); K]);
        let mut c = [Chains { origin: black, direction: black, weight: black, inside: none, refracted: none }; K];
        for k in 0..K {
            c[k].origin = points[k].position;
            c[k].direction = direction[k];
            c[k].weight = Vectors::splat(l, glam::Vec3::ONE);
        }
        loop {
            let mut rays = Rays { origin: *direction, direction: *direction, alive };
            for k in 0..K {
                let within =
                    spent[k].lt(Words::splat(l, scene.frame.depth_limit)) & panes[k].lt(Words::splat(l, PANES_MOST));
                let (on, at_pane) = continue_chains(l, scene, &at[k], alive[k] & within, split[k], &mut c[k]);
                let on = on.without(c[k].weight.greatest().lt(Floats::splat(l, WEIGHT_CUTOFF)));
                split[k] = none;
                let one = Words::splat(l, 1);
                let through_pane = at_pane & c[k].refracted;
                panes[k] = panes[k] + (on & through_pane).select_words(one, Words::splat(l, 0));
                spent[k] = spent[k] + on.without(through_pane).select_words(one, Words::splat(l, 0));
                (rays.origin[k], rays.direction[k], rays.alive[k]) = (c[k].origin, c[k].direction, on);
            }
            if !any_of(l, &rays.alive) {
                break;
            }
            let hits = closest_hit(l, scene, &rays, stack);
            let background = Vectors::splat(l, xyz(scene.frame.background));
            for k in 0..K {
                let missed = rays.alive[k] & hits[k].triangle.equals(Words::splat(l, NO_TRIANGLE));
                let light = found[k].gcol + c[k].weight * background;
                found[k].gcol = missed.select_vectors(light, found[k].gcol);
                alive[k] = rays.alive[k].without(missed);
                if !alive[k].any() {
                    continue;
                }
                let p = surface_points(l, scene, c[k].origin, c[k].direction, &hits[k], alive[k]);
                let kind = of_materials(
                    l,
                    scene,
                    p.material,
                    alive[k],
                    #[inline(always)]
                    |m| m.surface,
                );
                let is_pane = kind.equals(Words::splat(l, SURFACE_THIN_GLASS));
                let seen = (alive[k] & is_last[k] & found[k].behind.equals(no_object)).without(is_pane);
                found[k].behind = seen.select_words(p.object, found[k].behind);
                found[k].s = seen.select(p.s, found[k].s);
                found[k].t = seen.select(p.t, found[k].t);
                at[k] = p;
            }
            if !any_of(l, &alive) {
                break;
            }
            let shadow_bits = shadow_test(l, scene, &at, &alive, None, stack);
            for k in 0..K {
                if alive[k].any() {
                    let color = shade(l, scene, &at[k], shadow_bits[k], alive[k], -c[k].direction);
                    let light = found[k].gcol + c[k].weight * color;
                    found[k].gcol = alive[k].select_vectors(light, found[k].gcol);
                }
            }
        }
    }
    found
}

/// Directions from the eye through the middles of pixels; not unit.
#[inline(always)]
fn pixel_directions<L: Lanes>(l: L, frame: &FrameParams, x: &Array<u32>, y: &Array<u32>) -> Vectors<L> {
    let (x, y) = (Words::from_array(l, x), Words::from_array(l, y));
    let one = Floats::splat(l, 1.0);
    // Coordinates have 16 bits: twice one and one more is exact as a float.
    let middle = inlined(
        #[inline(always)]
        |v: Words<L>| (v.shifted_left(1) + Words::splat(l, 1)).signed_to_floats(),
    );
    let sx = middle(x) / Floats::splat(l, frame.width as f32) - one;
    let sy = one - middle(y) / Floats::splat(l, frame.height as f32);
    Vectors::splat(l, xyz(frame.forward))
        + Vectors::splat(l, xyz(frame.right)) * sx
        + Vectors::splat(l, xyz(frame.up)) * sy
}

/// What the checks of a packet's pixels leave known of their shadows.
#[inline(always)]
fn known_of<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    step: &StepParams,
    buffers: &FrameBuffers,
    pixels: &Pixels<K>,
    pixel_class: u32,
    (points, hit): (&[SurfacePoints<L>; K], &[Mask<L>; K]),
) -> Option<[Known<L>; K]> {
    if pixel_class == CLASS_BASE || !step.flags.contains(StepFlags::REUSE_SHADOWS) {
        return None;
    }
    let zero = Words::splat(l, 0);
    let mut known = [Known { lights: zero, bits: zero }; K];
    for k in 0..K {
        let (objects, materials) = (points[k].object.to_array(), points[k].material.to_array());
        let (mut lights, mut bits) = ([0; MOST_LANES], [0; MOST_LANES]);
        for lane in lanes_of(hit[k].bits()) {
            let lane = lane % MOST_LANES;
            let at = (pixels.x[k][lane], pixels.y[k][lane]);
            let surface = (objects[lane], materials[lane]);
            let of_lane = known_shadows(scene, step, &buffers.attributes, at, pixel_class, surface);
            (lights[lane], bits[lane]) = (of_lane.lights, of_lane.bits);
        }
        known[k] = Known { lights: Words::from_array(l, &lights), bits: Words::from_array(l, &bits) };
    }
    Some(known)
}

/// Traces and shades a packet of pixels: `trace_pixel` of the twin, without counters.
#[inline(always)]
pub fn trace_pixels<L: Lanes, const K: usize>(
    l: L,
    scene: &SceneArgs,
    pixels: &Pixels<K>,
    pixel_class: u32,
    step: &StepParams,
    buffers: &FrameBuffers,
    stack: &mut Stack<L, K>,
) {
    let frame = scene.frame;
    let zero = Floats::splat(l, 0.0);
    let none = Mask::splat(l, false);
    let eye = Vectors::splat(l, xyz(frame.eye));
    let mut rays = Rays { origin: [eye; K], direction: [eye; K], alive: [none; K] };
    for k in 0..K {
        rays.alive[k] = Mask::from_bits(l, pixels.lanes[k]);
        rays.direction[k] = pixel_directions(l, frame, &pixels.x[k], &pixels.y[k]).normalize(l);
    }
    let hits = closest_hit(l, scene, &rays, stack);
    let mut points = [SurfacePoints::nowhere(l); K];
    let mut hit = [none; K];
    for k in 0..K {
        hit[k] = rays.alive[k].without(hits[k].triangle.equals(Words::splat(l, NO_TRIANGLE)));
        if hit[k].any() {
            points[k] = surface_points(l, scene, rays.origin[k], rays.direction[k], &hits[k], hit[k]);
        }
    }
    let known = known_of(l, scene, step, buffers, pixels, pixel_class, (&points, &hit));
    let shadow_bits = shadow_test(l, scene, &points, &hit, known.as_ref(), stack);
    let secondary = gather_secondary(l, scene, &points, &rays.direction, &hit, stack);
    let background = Vectors::splat(l, xyz(frame.background));
    let black = Vectors { x: zero, y: zero, z: zero };
    let no_object = Words::splat(l, NO_OBJECT);
    for k in 0..K {
        let (p, s, lanes) = (&points[k], &secondary[k], hit[k]);
        let texture = of_materials(
            l,
            scene,
            p.material,
            lanes,
            #[inline(always)]
            |m| m.diffuse_texture,
        );
        // The coordinates of a mirror without a texture are free for what is seen in it.
        let textured = !texture.equals(Words::splat(l, NO_TEXTURE));
        let a = WideAttributes {
            position: lanes.select_vectors(p.position, black),
            normal: lanes.select_vectors(p.normal, black),
            s: lanes.select(textured.select(p.s, s.s), zero),
            t: lanes.select(textured.select(p.t, s.t), zero),
            gcol: lanes.select_vectors(s.gcol, black),
            object: lanes.select_words(p.object, no_object),
            shadow_bits: lanes.select_words(shadow_bits[k], Words::splat(l, 0)),
            behind: lanes.without(textured).select_words(s.behind, no_object),
        };
        let mut color = background;
        if lanes.any() {
            let own = shade(l, scene, p, shadow_bits[k], lanes, -rays.direction[k]) + s.gcol;
            color = lanes.select_vectors(own, background);
        }
        let words = srgb_words(scene, color, rays.alive[k]);
        store(l, frame, step, buffers, pixel_class, (&pixels.x[k], &pixels.y[k], rays.alive[k]), (&a, &words));
    }
}

/// Writes the attributes, classes and colours of a vector of traced pixels.
#[inline(always)]
fn store<L: Lanes>(
    l: L,
    frame: &FrameParams,
    step: &StepParams,
    buffers: &FrameBuffers,
    pixel_class: u32,
    (x, y, lanes): (&Array<u32>, &Array<u32>, Mask<L>),
    (a, words): (&WideAttributes<L>, &Array<u32>),
) {
    let (mut at, mut color_at) = ([0; MOST_LANES], [0; MOST_LANES]);
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        at[lane] = plane_index(frame, x[lane], y[lane]);
        color_at[lane] = color_index(frame, x[lane], y[lane]);
    }
    if pixel_class != CLASS_BASE || step.flags.contains(StepFlags::STORE) {
        let pitch = frame.plane_pitch;
        let planes = &buffers.attributes;
        let mut class = Words::splat(l, pixel_class);
        if pixel_class == CLASS_CORRECTED {
            let before = load_attributes(l, planes, pitch, &at);
            let mut colors = [0; MOST_LANES];
            for lane in lanes_of(lanes.bits()) {
                let lane = lane % MOST_LANES;
                colors[lane] = buffers.color.get(color_at[lane]);
            }
            let differ = hits_differ(l, step, a, &before, &colors, words, lanes);
            class = differ.select_words(class, Words::splat(l, CLASS_CONFIRMED));
        }
        if pixel_class != CLASS_BASE {
            let mut masks = [0; MOST_LANES];
            for lane in lanes_of(lanes.bits()) {
                let lane = lane % MOST_LANES;
                masks[lane] = planes.get(PLANE_CLASS * pitch + at[lane]) & CLASS_CHECKED;
            }
            class = class | Words::from_array(l, &masks);
        }
        store_attributes(l, planes, pitch, &at, a, class, lanes);
    }
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        buffers.color.set(color_at[lane], words[lane]);
    }
}
