// SPDX-License-Identifier: MIT OR Apache-2.0
//! Twin of `kernels/common/kdtree.clh`: closest hit and any hit over the kd-tree.

use glam::Vec3;

use super::scene_args::{SceneArgs, Work};
use super::triangle_test::RayTests;
use super::walk_short::ShortWalk;
use super::walk_stack::StackWalk;
use crate::layout::{FAR_AWAY, NO_TEXTURE, NO_TRIANGLE, TRIANGLE_CUTOUT, TRIANGLE_GLASS, Traversal};
use crate::math::{fraction, max2, min2};
use crate::prepare::kdtree::KdNode;

/// Widens the end of a cell's interval by four units in the last place.
pub const WIDEN_UP: f32 = 1.000_000_5;
/// Widens its beginning likewise.
pub const WIDEN_DOWN: f32 = 0.999_999_5;
/// Components of directions smaller than this count as this.
pub const DIRECTION_FLOOR: f32 = 1.0e-20;

/// A point on a triangle, as a ray finds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray in lengths of its direction.
    pub t: f32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
    /// Triangle id, or [`NO_TRIANGLE`].
    pub triangle: u32,
}

impl Hit {
    /// The hit of a ray that hits nothing.
    pub const NONE: Hit = Hit { t: FAR_AWAY, u: 0.0, v: 0.0, triangle: NO_TRIANGLE };
}

fn safe_inverse(d: f32) -> f32 {
    let floored = if d.abs() < DIRECTION_FLOOR {
        if d.is_sign_negative() { -DIRECTION_FLOOR } else { DIRECTION_FLOOR }
    } else {
        d
    };
    1.0 / floored
}

/// Whether the triangle's cut-out texture has a hole at `(u, v)`.
pub fn is_hole(scene: &SceneArgs, triangle: u32, u: f32, v: f32) -> bool {
    let shading = &scene.triangle_shading[triangle as usize];
    let id = scene.materials[shading.material as usize].cutout_texture;
    if id == NO_TEXTURE {
        return false;
    }
    let w = 1.0 - u - v;
    let [s0, t0, s1, t1, s2, t2] = shading.texcoords;
    let s = fraction(s0 * w + s1 * u + s2 * v);
    let t = fraction(t0 * w + t1 * u + t2 * v);
    let texture = &scene.textures[id as usize];
    let (width, height) = (texture.width, texture.height);
    let x = ((s * width as f32) as u32).min(width - 1);
    let y = height - 1 - ((t * height as f32) as u32).min(height - 1);
    (scene.texels[(texture.offset + y * width + x) as usize] >> 24) < 128
}

/// A ray on its way through the tree: `node`, and the part of the ray within it.
pub(super) struct Walker<'a> {
    pub nodes: &'a [KdNode],
    pub org: [f32; 4],
    pub inv: [f32; 4],
    pub sign: [u32; 4],
    pub t_min: f32,
    pub t_max: f32,
    pub node: u32,
}

/// Where a ray goes at an inner node.
pub(super) struct Fork {
    pub t_split: f32,
    pub near: u32,
    pub far: u32,
}

impl<'a> Walker<'a> {
    /// `None` if the ray passes by the tree's box.
    fn begin(scene: &SceneArgs<'a>, o: Vec3, d: Vec3, t_limit: f32) -> Option<Self> {
        let inv = [safe_inverse(d.x), safe_inverse(d.y), safe_inverse(d.z), 0.0];
        let sign = inv.map(|i| u32::from(i < 0.0));
        let (lo, hi) = (&scene.frame.bounds_min, &scene.frame.bounds_max);
        let (ax, bx) = ((lo[0] - o.x) * inv[0], (hi[0] - o.x) * inv[0]);
        let (ay, by) = ((lo[1] - o.y) * inv[1], (hi[1] - o.y) * inv[1]);
        let (az, bz) = ((lo[2] - o.z) * inv[2], (hi[2] - o.z) * inv[2]);
        let t_min = max2(0.0, max2(min2(ax, bx), max2(min2(ay, by), min2(az, bz))) * WIDEN_DOWN);
        let t_max = min2(t_limit, min2(max2(ax, bx), min2(max2(ay, by), max2(az, bz))) * WIDEN_UP);
        let org = [o.x, o.y, o.z, 0.0];
        (t_min <= t_max).then_some(Walker { nodes: scene.nodes, org, inv, sign, t_min, t_max, node: 0 })
    }

    #[inline]
    pub fn at(&self) -> KdNode {
        self.nodes[self.node as usize]
    }

    #[inline]
    pub fn fork(&self, node: KdNode) -> Fork {
        let axis = node.axis() as usize;
        let (lower, sign) = (node.payload(), self.sign[axis]);
        Fork { t_split: (node.split() - self.org[axis]) * self.inv[axis], near: lower + sign, far: lower + 1 - sign }
    }

    /// Goes to the near child of a node whose far child is entered at `t_split`.
    #[inline]
    pub fn enter_near(&mut self, fork: &Fork) {
        self.node = fork.near;
        self.t_max = fork.t_split * WIDEN_UP;
    }
}

/// A way of walking: the cells along a ray, near ones first.
pub(super) trait Walk<'a>: Sized {
    /// Starts at the root; `traversal` is that of the scene.
    fn start(walker: Walker<'a>, traversal: Traversal) -> Self;

    /// The ray on its way.
    fn walker(&mut self) -> &mut Walker<'a>;

    /// Goes down to the next leaf (`DESCEND`).
    fn descend(&mut self, work: &mut Work);

    /// Goes to the nearest child that was left out (`NEXT_CELL`); `false` if there is none.
    fn next_cell(&mut self) -> bool;

    /// Goes down to the next leaf and returns the range of its entries.
    #[inline]
    fn leaf(&mut self, work: &mut Work) -> std::ops::Range<usize> {
        self.descend(work);
        let node = self.walker().at();
        let first = node.split_or_first as usize;
        first..first + node.payload() as usize
    }

    /// Where the cells after this leaf begin.
    #[inline]
    fn end_of_leaf(&mut self) -> f32 {
        let walker = self.walker();
        walker.t_min = walker.t_max * WIDEN_DOWN;
        walker.t_min
    }
}

/// The closest hit of the ray `o + t * d`: the one with the least (t, triangle id).
pub fn closest_hit(scene: &SceneArgs, o: Vec3, d: Vec3, work: &mut Work) -> Hit {
    match scene.traversal {
        Traversal::PrivateStack => closest_by::<StackWalk>(scene, o, d, work),
        Traversal::ShortStack | Traversal::Stackless => closest_by::<ShortWalk>(scene, o, d, work),
    }
}

/// Whether anything that casts a shadow lies on the ray before `t_limit`, by more than roundings explain.
pub fn any_hit(scene: &SceneArgs, o: Vec3, d: Vec3, t_limit: f32, work: &mut Work) -> bool {
    match scene.traversal {
        Traversal::PrivateStack => any_by::<StackWalk>(scene, o, d, t_limit, work),
        Traversal::ShortStack | Traversal::Stackless => any_by::<ShortWalk>(scene, o, d, t_limit, work),
    }
}

fn closest_by<'a, W: Walk<'a>>(scene: &SceneArgs<'a>, o: Vec3, d: Vec3, work: &mut Work) -> Hit {
    let mut best = Hit::NONE;
    let Some(walker) = Walker::begin(scene, o, d, FAR_AWAY) else { return best };
    let tests = RayTests::begin(o, d, walker.inv);
    let mut walk = W::start(walker, scene.traversal);
    loop {
        for &id in &scene.leaf_triangles[walk.leaf(work)] {
            work.triangle_tests += 1;
            let Some(c) = tests.crossing(&scene.triangles[id as usize]) else { continue };
            let ahead = if c.bits & TRIANGLE_GLASS != 0 { c.ahead + 2.0 * c.error } else { c.ahead };
            let t = ahead / c.slope;
            if t < best.t || (t == best.t && id < best.triangle) {
                let (u, v) = c.weights();
                if !(c.bits & TRIANGLE_CUTOUT != 0 && is_hole(scene, id, u, v)) {
                    best = Hit { t, u, v, triangle: id };
                }
            }
        }
        let next = walk.end_of_leaf();
        if best.t < next || !walk.next_cell() {
            return best;
        }
    }
}

fn any_by<'a, W: Walk<'a>>(scene: &SceneArgs<'a>, o: Vec3, d: Vec3, t_limit: f32, work: &mut Work) -> bool {
    let Some(walker) = Walker::begin(scene, o, d, t_limit) else { return false };
    let tests = RayTests::begin(o, d, walker.inv);
    let mut walk = W::start(walker, scene.traversal);
    loop {
        for &id in &scene.leaf_triangles[walk.leaf(work)] {
            work.triangle_tests += 1;
            let Some(c) = tests.crossing(&scene.triangles[id as usize]) else { continue };
            if c.ahead + c.error < t_limit * c.slope && c.bits & TRIANGLE_GLASS == 0 {
                let (u, v) = c.weights();
                if !(c.bits & TRIANGLE_CUTOUT != 0 && is_hole(scene, id, u, v)) {
                    return true;
                }
            }
        }
        walk.end_of_leaf();
        if !walk.next_cell() {
            return false;
        }
    }
}
