// SPDX-License-Identifier: MIT OR Apache-2.0
//! What rays hit: surface points and their materials, gathered lane by lane.

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined, lanes_of};
use super::traverse::Hits;
use super::vectors::{VectorArray, Vectors, unpack_normal};
use crate::device::twin::SceneArgs;
use crate::device::twin::triangle_test::plane_normal;
use crate::layout::{NO_OBJECT, OFFSET_ERROR, OFFSET_MOST};

/// Hit points with everything that shading and secondary rays need; lanes without a hit hold anything.
#[derive(Clone, Copy)]
#[allow(missing_docs)] // documented in kernels/common/ray_tree.clh
pub struct SurfacePoints<L: Lanes> {
    pub position: Vectors<L>,
    pub geometric_normal: Vectors<L>,
    pub normal: Vectors<L>,
    pub s: Floats<L>,
    pub t: Floats<L>,
    pub object: Words<L>,
    pub material: Words<L>,
    pub offset: Floats<L>,
}

impl<L: Lanes> SurfacePoints<L> {
    /// Points of no surface.
    #[inline(always)]
    pub fn nowhere(l: L) -> Self {
        let zero = Floats::splat(l, 0.0);
        let origin = Vectors { x: zero, y: zero, z: zero };
        SurfacePoints {
            position: origin,
            geometric_normal: origin,
            normal: origin,
            s: zero,
            t: zero,
            object: Words::splat(l, NO_OBJECT),
            material: Words::splat(l, 0),
            offset: zero,
        }
    }

    /// Where rays that leave on the ray's side start.
    #[inline(always)]
    pub fn outside(&self, scene: &SceneArgs) -> Vectors<L> {
        if scene.anchor { self.position } else { self.position + self.geometric_normal * self.offset }
    }
}

/// The surface points of hits of the rays `o + t * d` in `lanes`.
#[inline(always)]
pub fn surface_points<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    o: Vectors<L>,
    d: Vectors<L>,
    hits: &Hits<L>,
    lanes: Mask<L>,
) -> SurfacePoints<L> {
    let mut plane = VectorArray::zeros();
    let mut corners = [VectorArray::zeros(), VectorArray::zeros(), VectorArray::zeros()];
    let mut normals: [Array<u32>; 3] = [[0; MOST_LANES]; 3];
    let mut texcoords: [Array<f32>; 6] = [[0.0; MOST_LANES]; 6];
    let (mut objects, mut materials) = ([NO_OBJECT; MOST_LANES], [0; MOST_LANES]);
    let ids = hits.triangle.to_array();
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        let id = ids[lane] as usize;
        let (triangle, shading) = (&scene.triangles[id], &scene.triangle_shading[id]);
        plane.set(lane, &plane_normal(triangle).to_array());
        objects[lane] = shading.object;
        materials[lane] = shading.material;
        if scene.anchor {
            continue;
        }
        for (to, from) in corners.iter_mut().zip(&triangle.corners) {
            to.set(lane, from);
        }
        for (to, from) in normals.iter_mut().zip(shading.normals) {
            to[lane] = from;
        }
        for (to, from) in texcoords.iter_mut().zip(shading.texcoords) {
            to[lane] = from;
        }
    }
    let zero = Floats::splat(l, 0.0);
    let g = plane.get(l).normalize(l);
    let geometric_normal = g.dot(d).gt(zero).select_vectors(-g, g);
    let (object, material) = (Words::from_array(l, &objects), Words::from_array(l, &materials));
    if scene.anchor {
        let offset = Floats::splat(l, scene.frame.epsilon);
        let position = o + d * hits.t + geometric_normal * offset;
        let normal = geometric_normal;
        return SurfacePoints { position, geometric_normal, normal, s: zero, t: zero, object, material, offset };
    }
    let (u, v) = (hits.u, hits.v);
    let w = Floats::splat(l, 1.0) - u - v;
    let [a, b, c] = [corners[0].get(l), corners[1].get(l), corners[2].get(l)];
    let (e1, e2) = (b - a, c - a);
    let position = a + e1 * u + e2 * v;
    let size = a.abs() + e1.abs() + e2.abs();
    let sum = size.x + size.y + size.z;
    let least = (sum * OFFSET_MOST).min2(Floats::splat(l, scene.frame.epsilon));
    let offset = (sum * OFFSET_ERROR).max2(least);
    let n = unpack_normal(l, Words::from_array(l, &normals[0])) * w
        + unpack_normal(l, Words::from_array(l, &normals[1])) * u
        + unpack_normal(l, Words::from_array(l, &normals[2])) * v;
    let n2 = n.dot(n);
    let has_length = n2.gt(Floats::splat(l, 1.0e-12));
    let unit = has_length.select_vectors(n * (Floats::splat(l, 1.0) / n2.sqrt()), geometric_normal);
    let normal = unit.dot(geometric_normal).lt(zero).select_vectors(-unit, unit);
    let interpolate = inlined(
        #[inline(always)]
        |corner: [usize; 3]| {
            let at = inlined(
                #[inline(always)]
                |i: usize| Floats::from_array(l, &texcoords[i]),
            );
            let (p, q, r) = (at(corner[0]), at(corner[1]), at(corner[2]));
            p * w + q * u + r * v
        },
    );
    let (s, t) = (interpolate([0, 2, 4]), interpolate([1, 3, 5]));
    SurfacePoints { position, geometric_normal, normal, s, t, object, material, offset }
}

/// What secondary rays ask of materials.
pub struct Surfaces<L: Lanes> {
    /// `SURFACE_*`.
    pub kind: Words<L>,
    /// Colour of the mirror.
    pub reflectance: Vectors<L>,
    /// Colour of the glass.
    pub transmission: Vectors<L>,
    /// Index of refraction.
    pub ior: Floats<L>,
}

/// The materials of points in `lanes`.
#[inline(always)]
pub fn surfaces<L: Lanes>(l: L, scene: &SceneArgs, material: Words<L>, lanes: Mask<L>) -> Surfaces<L> {
    let (mut reflectance, mut transmission) = (VectorArray::zeros(), VectorArray::zeros());
    let (mut kinds, mut iors) = ([0; MOST_LANES], [1.0; MOST_LANES]);
    let ids = material.to_array();
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        let m = &scene.materials[ids[lane] as usize];
        kinds[lane] = m.surface;
        iors[lane] = m.specular[3];
        reflectance.set(lane, &m.reflectance);
        transmission.set(lane, &m.transmission);
    }
    Surfaces {
        kind: Words::from_array(l, &kinds),
        reflectance: reflectance.get(l),
        transmission: transmission.get(l),
        ior: Floats::from_array(l, &iors),
    }
}

/// One word of each lane's material, 0 in other lanes.
#[inline(always)]
pub fn of_materials<L: Lanes>(
    l: L,
    scene: &SceneArgs,
    material: Words<L>,
    lanes: Mask<L>,
    word: impl Fn(&crate::layout::Material) -> u32,
) -> Words<L> {
    let ids = material.to_array();
    let mut words = [0; MOST_LANES];
    for lane in lanes_of(lanes.bits()) {
        let lane = lane % MOST_LANES;
        words[lane] = word(&scene.materials[ids[lane] as usize]);
    }
    Words::from_array(l, &words)
}
