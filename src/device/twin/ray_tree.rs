// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/ray_tree.clh`: one pixel by Whitted ray tracing.

use glam::Vec3;

use super::FrameBuffers;
use super::known_shadows::{KnownShadows, known_shadows};
use super::planes::{
    Attributes, StoredHit, Words, color_index, hits_differ, pixel_direction, plane_index, store_attributes, store_work,
};
use super::scene_args::{Part, SceneArgs, Tally, Work, xyz};
use super::shade::{ShadePoint, shade_local, srgb_word};
use super::traverse::{Hit, any_hit, closest_hit};
use super::triangle_test::plane_normal;
use crate::layout::*;
use crate::math::{dot, max2, min2, normalize, unpack_normal};

/// A hit point with everything that shading and secondary rays need.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)] // documented in kernels/common/ray_tree.clh
pub struct SurfacePoint {
    pub position: Vec3,
    pub geometric_normal: Vec3,
    pub normal: Vec3,
    pub s: f32,
    pub t: f32,
    pub object: u32,
    pub material: u32,
    pub offset: f32,
}

impl SurfacePoint {
    fn shade_point(&self, shadow_bits: u32) -> ShadePoint {
        ShadePoint {
            material: self.material,
            position: self.position,
            normal: self.normal,
            s: self.s,
            t: self.t,
            shadow_bits,
        }
    }

    /// Where rays that leave on the ray's side start.
    fn outside(&self, scene: &SceneArgs) -> Vec3 {
        if scene.anchor { self.position } else { self.position + self.geometric_normal * self.offset }
    }
}

/// The surface point of a hit of the ray `o + t * d`.
pub fn surface_point(scene: &SceneArgs, o: Vec3, d: Vec3, hit: &Hit) -> SurfacePoint {
    let shading = &scene.triangle_shading[hit.triangle as usize];
    let triangle = &scene.triangles[hit.triangle as usize];
    let g = normalize(plane_normal(triangle));
    let geometric_normal = if dot(g, d) > 0.0 { -g } else { g };
    let (object, material) = (shading.object, shading.material);
    if scene.anchor {
        let offset = scene.frame.epsilon;
        let position = o + d * hit.t + geometric_normal * offset;
        let normal = geometric_normal;
        return SurfacePoint { position, geometric_normal, normal, s: 0.0, t: 0.0, object, material, offset };
    }
    let (u, v) = (hit.u, hit.v);
    let w = 1.0 - u - v;
    let [a, b, c] = triangle.corners.map(xyz);
    let (e1, e2) = (b - a, c - a);
    let position = a + e1 * u + e2 * v;
    let size = a.abs() + e1.abs() + e2.abs();
    let sum = size.x + size.y + size.z;
    let offset = max2(sum * OFFSET_ERROR, min2(sum * OFFSET_MOST, scene.frame.epsilon));
    let n = unpack_normal(shading.normals[0]) * w
        + unpack_normal(shading.normals[1]) * u
        + unpack_normal(shading.normals[2]) * v;
    let n2 = dot(n, n);
    let unit = if n2 > 1.0e-12 { n * (1.0 / n2.sqrt()) } else { geometric_normal };
    let normal = if dot(unit, geometric_normal) < 0.0 { -unit } else { unit };
    let [s0, t0, s1, t1, s2, t2] = shading.texcoords;
    let s = s0 * w + s1 * u + s2 * v;
    let t = t0 * w + t1 * u + t2 * v;
    SurfacePoint { position, geometric_normal, normal, s, t, object, material, offset }
}

/// One bit per light that does not reach the point; those that are known get no ray.
pub fn shadow_test(scene: &SceneArgs, p: &SurfacePoint, known: &KnownShadows, tally: &mut impl Tally) -> u32 {
    let o = p.outside(scene);
    let mut bits = 0;
    for (i, light) in scene.lights.iter().enumerate().take(scene.frame.light_count as usize) {
        let to_light = xyz(light.position) - o;
        let mut shadowed = !(dot(p.normal, to_light) > 0.0 && dot(p.geometric_normal, to_light) > 0.0);
        if !shadowed && known.lights >> i & 1 != 0 {
            shadowed = known.bits >> i & 1 != 0;
        } else if !shadowed {
            tally.begins(Part::ShadowRay(i as u32));
            tally.work().shadow_rays += 1;
            let distance = dot(to_light, to_light).sqrt();
            let reach = if scene.anchor { distance } else { distance * SHADOW_REACH };
            shadowed = any_hit(scene, o, to_light * (1.0 / distance), reach, tally.work());
        }
        bits |= u32::from(shadowed) << i;
    }
    bits
}

fn reflect_direction(p: &SurfacePoint, d: Vec3) -> Vec3 {
    let r = d - p.normal * (2.0 * dot(d, p.normal));
    if dot(r, p.geometric_normal) > 0.0 {
        return normalize(r);
    }
    normalize(d - p.geometric_normal * (2.0 * dot(d, p.geometric_normal)))
}

/// Unpolarised reflectance of a boundary by Fresnel's equations, and the refracted direction; `None` at total
/// internal reflection. `eta` is the outer over the inner index of refraction, `n` points against `d`.
pub fn fresnel(d: Vec3, n: Vec3, eta: f32) -> Option<(f32, Vec3)> {
    let cos_i = min2(max2(-dot(d, n), 0.0), 1.0);
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let refracted = normalize(d * eta + n * (eta * cos_i - cos_t));
    Some((0.5 * (parallel * parallel + perpendicular * perpendicular), refracted))
}

/// A ray about to leave a surface.
struct Chain {
    origin: Vec3,
    direction: Vec3,
    weight: Vec3,
    inside: bool,
    refracted: bool,
}

fn continue_chain(scene: &SceneArgs, p: &SurfacePoint, split_reflection: bool, c: &mut Chain) -> bool {
    let m = &scene.materials[p.material as usize];
    let outside = p.outside(scene);
    if m.surface == SURFACE_MIRROR {
        c.weight *= xyz(m.reflectance);
        c.direction = reflect_direction(p, c.direction);
        c.origin = outside;
        c.refracted = false;
        return true;
    }
    if m.surface != SURFACE_GLASS && m.surface != SURFACE_THIN_GLASS {
        return false;
    }
    let ior = m.specular[3];
    let thin = m.surface == SURFACE_THIN_GLASS;
    let eta = if c.inside && !thin { ior } else { 1.0 / ior };
    let n = if dot(p.normal, c.direction) < 0.0 { p.normal } else { p.geometric_normal };
    let (f, refracted) = fresnel(c.direction, n, eta).unwrap_or((1.0, Vec3::ZERO));
    if split_reflection || f >= 1.0 {
        c.weight *= f;
        c.direction = reflect_direction(p, c.direction);
        c.origin = outside;
        c.refracted = false;
        return true;
    }
    c.weight *= xyz(m.transmission) * (1.0 - f);
    c.direction = if thin { c.direction } else { refracted };
    c.origin = p.position - p.geometric_normal * p.offset;
    c.inside = if thin { c.inside } else { !c.inside };
    c.refracted = true;
    true
}

/// What secondary rays find.
#[derive(Debug, Clone, Copy)]
pub struct Secondary {
    /// The light that they gather: GCOL of the paper.
    pub gcol: Vec3,
    /// The object seen in a mirror or behind glass, panes not counted; [`NO_OBJECT`] if there is none.
    pub behind: u32,
    /// Texture coordinates there.
    pub s: f32,
    /// Likewise.
    pub t: f32,
}

/// Sends secondary rays from the first hit `p`.
pub fn gather_secondary(scene: &SceneArgs, p: &SurfacePoint, d: Vec3, tally: &mut impl Tally) -> Secondary {
    let surface = scene.materials[p.material as usize].surface;
    let mut found = Secondary { gcol: Vec3::ZERO, behind: NO_OBJECT, s: p.s, t: p.t };
    if surface == SURFACE_OPAQUE {
        return found;
    }
    let mut sum = Vec3::ZERO;
    let chains = if surface == SURFACE_MIRROR { 1 } else { 2 };
    for chain in 0..chains {
        let mut c = Chain { origin: p.position, direction: d, weight: Vec3::ONE, inside: false, refracted: false };
        let mut at = *p;
        let mut split_reflection = chains == 2 && chain == 0;
        let (mut spent, mut panes) = (0, 0);
        while spent < scene.frame.depth_limit && panes < PANES_MOST {
            let at_pane = scene.materials[at.material as usize].surface == SURFACE_THIN_GLASS;
            if !continue_chain(scene, &at, split_reflection, &mut c) {
                break;
            }
            if max2(c.weight.x, max2(c.weight.y, c.weight.z)) < WEIGHT_CUTOFF {
                break;
            }
            split_reflection = false;
            tally.leaves_surface(chain, spent + panes);
            if at_pane && c.refracted {
                panes += 1;
            } else {
                spent += 1;
            }
            if c.refracted {
                tally.work().refraction_rays += 1;
            } else {
                tally.work().reflection_rays += 1;
            }
            tally.begins(Part::ClosestHit);
            let hit = closest_hit(scene, c.origin, c.direction, tally.work());
            if hit.triangle == NO_TRIANGLE {
                sum += c.weight * xyz(scene.frame.background);
                break;
            }
            at = surface_point(scene, c.origin, c.direction, &hit);
            let is_pane = scene.materials[at.material as usize].surface == SURFACE_THIN_GLASS;
            if chain + 1 == chains && found.behind == NO_OBJECT && !is_pane {
                (found.behind, found.s, found.t) = (at.object, at.s, at.t);
            }
            let shadow_bits = shadow_test(scene, &at, &KnownShadows::default(), tally);
            tally.begins(Part::Shading);
            tally.work().shaded += 1;
            sum += c.weight * shade_local(scene, &at.shade_point(shadow_bits), -c.direction);
        }
    }
    found.gcol = sum;
    found
}

/// Whether the pixel `(x, y)` of a list of step4 gets its ray; one that needs none becomes `CLASS_CONFIRMED`.
pub fn needs_correction_ray(frame: &FrameParams, step: &StepParams, planes: &Words, (x, y): (u32, u32)) -> bool {
    let at = PLANE_CLASS * frame.plane_pitch + plane_index(frame, x, y);
    if planes.get(at) & CLASS_MASK != CLASS_INTERPOLATED {
        return false;
    }
    if !step.flags.contains(StepFlags::SETTLE) && (frame.interior_begin..frame.interior_end).contains(&y) {
        return true;
    }
    planes.set(at, planes.get(at) & !CLASS_MASK | CLASS_CONFIRMED);
    false
}

/// The ray tree of the pixel `(x, y)`: what its ray hits, and its colour. `attributes` hold what the pixel's check left.
pub fn ray_tree(
    scene: &SceneArgs,
    step: &StepParams,
    attributes: &Words,
    (x, y): (u32, u32),
    pixel_class: u32,
    tally: &mut impl Tally,
) -> (Attributes, Vec3) {
    let frame = scene.frame;
    let o = xyz(frame.eye);
    let d = normalize(pixel_direction(frame, x, y));
    tally.begins(Part::ClosestHit);
    let hit = closest_hit(scene, o, d, tally.work());
    if hit.triangle == NO_TRIANGLE {
        return (Attributes::MISS, xyz(frame.background));
    }
    tally.begins(Part::Shading);
    tally.work().shaded += 1;
    let p = surface_point(scene, o, d, &hit);
    let known = known_shadows(scene, step, attributes, (x, y), pixel_class, (p.object, p.material));
    let shadow_bits = shadow_test(scene, &p, &known, tally);
    let secondary = gather_secondary(scene, &p, d, tally);
    // The coordinates of a mirror without a texture are free for what is seen in it.
    let textured = scene.materials[p.material as usize].diffuse_texture != NO_TEXTURE;
    let a = Attributes {
        position: p.position,
        normal: p.normal,
        s: if textured { p.s } else { secondary.s },
        t: if textured { p.t } else { secondary.t },
        object: p.object,
        shadow_bits,
        gcol: secondary.gcol,
        behind: if textured { NO_OBJECT } else { secondary.behind },
    };
    let color = shade_local(scene, &p.shade_point(a.shadow_bits), -d) + a.gcol;
    (a, color)
}

/// Traces and shades the pixel `(x, y)`; see the kernel for what is written when.
pub fn trace_pixel(scene: &SceneArgs, x: u32, y: u32, pixel_class: u32, step: &StepParams, out: &FrameBuffers) {
    let mut work = Work::default();
    let frame = scene.frame;
    let at = plane_index(frame, x, y);
    let (a, color) = ray_tree(scene, step, &out.attributes, (x, y), pixel_class, &mut work);
    let word = srgb_word(scene.tables, color);
    if pixel_class != CLASS_BASE || step.flags.contains(StepFlags::STORE) {
        let pitch = frame.plane_pitch;
        let planes = &out.attributes;
        let mut new_class = pixel_class;
        if pixel_class == CLASS_CORRECTED {
            let before = StoredHit { planes, pitch, at };
            let differs = hits_differ(step, &a, &before, || out.color.get(color_index(frame, x, y)), || word);
            new_class = if differs { CLASS_CORRECTED } else { CLASS_CONFIRMED };
        }
        let mask = if pixel_class == CLASS_BASE { 0 } else { planes.get(PLANE_CLASS * pitch + at) & CLASS_CHECKED };
        store_attributes(planes, pitch, at, &a, mask | new_class);
        planes.set(PLANE_CLAIM * pitch + at, NO_CLAIM);
    }
    store_work(&out.counters, frame.plane_pitch, at, &work);
    out.color.set(color_index(frame, x, y), word);
}
