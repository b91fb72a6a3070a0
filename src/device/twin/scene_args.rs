// SPDX-License-Identifier: MIT OR Apache-2.0
//! What every twin function gets of the scene and the frame: `SCENE_PARAMS` of `kernels/types.h`.

use glam::Vec3;

use crate::layout::{FrameParams, Light, Material, Texture, Traversal, Triangle, TriangleShading};
use crate::prepare::kdtree::KdNode;

/// The scene's buffers as the kernels see them.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)] // documented in kernels/types.h
pub struct SceneArgs<'a> {
    pub frame: &'a FrameParams,
    pub lights: &'a [Light],
    pub nodes: &'a [KdNode],
    pub leaf_triangles: &'a [u32],
    pub triangles: &'a [Triangle],
    pub triangle_shading: &'a [TriangleShading],
    pub materials: &'a [Material],
    pub object_materials: &'a [u32],
    pub textures: &'a [Texture],
    pub texels: &'a [u32],
    pub tables: &'a [u32],
    /// Shade by the rules of the speed anchor (`RAREFY_ANCHOR`).
    pub anchor: bool,
    /// How rays walk through the tree (`RAREFY_SHORT_STACK`).
    pub traversal: Traversal,
}

/// Work counters of one item (`Work` of `kernels/types.h`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[allow(missing_docs)] // documented at the counter planes in layout.rs
pub struct Work {
    pub traversal_steps: u32,
    pub triangle_tests: u32,
    pub shadow_rays: u32,
    pub reflection_rays: u32,
    pub refraction_rays: u32,
    pub shaded: u32,
}

/// What is done with a ray, in the order of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The loop that looks for its closest hit.
    ClosestHit,
    /// What its hit costs beside loops through the tree.
    Shading,
    /// The loop of the shadow ray from its hit to this light.
    ShadowRay(u32),
}

/// What a ray tree tells of its work. [`Work`] is told sums; who wants to know what each loop costs listens to the rest.
pub trait Tally {
    /// The sums.
    fn work(&mut self) -> &mut Work;

    /// Ray number `ray` of secondary chain `chain` leaves; what begins from here on is done with it.
    #[inline]
    fn leaves_surface(&mut self, chain: u32, ray: u32) {
        let _ = (chain, ray);
    }

    /// The sums are about to grow by a part; all before it are done.
    #[inline]
    fn begins(&mut self, part: Part) {
        let _ = part;
    }
}

impl Tally for Work {
    #[inline]
    fn work(&mut self) -> &mut Work {
        self
    }
}

/// The first three components.
#[inline]
pub fn xyz(v: [f32; 4]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}
