// SPDX-License-Identifier: MIT OR Apache-2.0
//! All ways of walking through the tree find the same hits by the same tests, on any tree and for any ray, and kernels
//! built for any of them draw the same pictures. Only steps differ: those of the device are those of its twin.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;

use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use rarefy::internal::device::executor::Executor;
use rarefy::internal::device::frame_memory::FrameBuffer;
use rarefy::internal::device::opencl::OpenOptions;
use rarefy::internal::device::stage::LAUNCHES;
use rarefy::internal::device::twin::SceneArgs;
use rarefy::internal::device::twin::executor::TwinExecutor;
use rarefy::internal::device::twin::scene_args::Work;
use rarefy::internal::device::twin::traverse::{Hit, any_hit, closest_hit};
use rarefy::internal::layout::Traversal;
use rarefy::internal::method::options::{Mode, RenderOptions};
use rarefy::internal::prepare::Shading;
use rarefy::internal::prepare::kdtree::{KdNode, KdTree, MAX_DEPTH};
use rarefy::internal::scene::{Scene, Surface};
use rarefy_host_tests::fixtures::{Random, SceneBuilder, Stand, blocks, glass, matte, mirror, sweeps, v};
use rarefy_host_tests::frames::{Prepared, device, no_opencl, twin, walking_by, words};

const WITHOUT_ARRAYS: [Traversal; 2] = [Traversal::ShortStack, Traversal::Stackless];

fn random_scene(random: &mut Random, count: usize, size: f32) -> Scene {
    let mut builder = SceneBuilder::new("random").camera(v(0.5, 0.6, 3.0), v(0.5, 0.5, 0.5), 30.0);
    builder = builder.environment(0.2, v(0.1, 0.2, 0.3)).light(v(0.2, 3.0, 2.0), 8.0).light(v(2.0, 1.0, 3.0), 4.0);
    for material in [matte(v(0.8, 0.5, 0.3)), mirror(0.7), glass(Surface::Glass, 1.5), glass(Surface::ThinGlass, 1.5)] {
        builder.object(material);
        for _ in 0..count.div_ceil(4) {
            let at = random.point(1.0);
            builder.triangle([(); 3].map(|()| at + random.point(size)));
        }
    }
    builder.build(1.0)
}

/// A tree over boxes, split anywhere: by `slice` a thin slice at a time, as deep as trees may be.
struct Grower<'a> {
    random: &'a mut Random,
    boxes: Vec<[Vec3; 2]>,
    tree: KdTree,
    slice: bool,
}

impl Grower<'_> {
    fn grow(&mut self, at: usize, lo: Vec3, hi: Vec3, ids: &[u32], depth: usize) {
        let axis = self.random.below(3);
        let share = if self.slice { self.random.range(0.01, 0.08) } else { self.random.range(0.2, 0.8) };
        let split = lo[axis] + (hi[axis] - lo[axis]) * share;
        let most = if self.slice { MAX_DEPTH } else { 14 };
        if depth == most || !self.slice && ids.len() < 3 || !(lo[axis] < split && split < hi[axis]) {
            self.tree.nodes[at] = KdNode::leaf(self.tree.leaf_triangles.len() as u32, ids.len() as u32);
            self.tree.leaf_triangles.extend_from_slice(ids);
            return;
        }
        let child = self.tree.nodes.len();
        self.tree.nodes.extend([KdNode::leaf(0, 0); 2]);
        self.tree.nodes[at] = KdNode::inner(axis as u32, split, child as u32);
        let (mut middle_hi, mut middle_lo) = (hi, lo);
        (middle_hi[axis], middle_lo[axis]) = (split, split);
        let overlapping = |keep: &dyn Fn(&[Vec3; 2]) -> bool| {
            ids.iter().copied().filter(|&id| keep(&self.boxes[id as usize])).collect::<Vec<_>>()
        };
        let below = overlapping(&|b| b[0][axis] <= split);
        let above = overlapping(&|b| b[1][axis] >= split);
        if self.slice {
            // The slice is a leaf.
            self.tree.nodes[child] = KdNode::leaf(self.tree.leaf_triangles.len() as u32, below.len() as u32);
            self.tree.leaf_triangles.extend_from_slice(&below);
        } else {
            self.grow(child, lo, middle_hi, &below, depth + 1);
        }
        self.grow(child + 1, middle_lo, hi, &above, depth + 1);
    }
}

/// A scene with a tree that no builder would make.
fn odd_stand(seed: u64, slice: bool) -> Stand {
    let mut random = Random::new(seed);
    let count = 1 + random.below(120);
    let scene = random_scene(&mut random, count, 0.4);
    let mut stand = Stand::new(&scene, 1, 1, 0);
    let corners = |id: usize| scene.triangles()[id].map(|i| scene.positions()[i as usize]);
    let boxes = (0..scene.triangles().len()).map(corners).map(|[a, b, c]| [a.min(b).min(c), a.max(b).max(c)]).collect();
    let (lo, hi) = (stand.prepared.tree().bounds_min, stand.prepared.tree().bounds_max);
    let tree =
        KdTree { nodes: vec![KdNode::leaf(0, 0); 2], leaf_triangles: Vec::new(), bounds_min: lo, bounds_max: hi };
    let mut grower = Grower { random: &mut random, boxes, tree, slice };
    let ids: Vec<u32> = (0..scene.triangles().len() as u32).collect();
    grower.grow(0, Vec3::from(lo), Vec3::from(hi), &ids, 0);
    (stand.nodes, stand.leaf_triangles) = (grower.tree.nodes, grower.tree.leaf_triangles);
    stand
}

/// A ray of any kind, NaN and infinities among them.
fn odd_ray(random: &mut Random, i: usize) -> (Vec3, Vec3) {
    let special = [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-30, -1e-42, 3e38, 1.0, -1.0];
    let mut any = || special[random.below(special.len())];
    match i % 6 {
        0 => (v(any(), any(), any()), v(any(), any(), any())),
        1 => {
            let d = v(any(), any(), any());
            (random.point(1.0), d)
        }
        2 => {
            let axis = random.below(3);
            let mut d = Vec3::ZERO;
            d[axis] = if random.unit() < 0.5 { 1.0 } else { -1.0 };
            (random.point(1.4) - d * 2.0, d)
        }
        3 => (random.point(1.0), random.direction()),
        // Along a diagonal: through many cells.
        4 => (Vec3::splat(-1.0) + random.point(0.2), Vec3::ONE + random.point(0.1)),
        _ => (Vec3::splat(2.4) - random.point(0.2), -Vec3::ONE + random.point(0.1)),
    }
}

type Found = (Hit, bool, Work, Work);

fn walk(args: &SceneArgs, traversal: Traversal, (o, d): (Vec3, Vec3), limit: f32) -> Found {
    let args = SceneArgs { traversal, ..*args };
    let (mut closest, mut any) = (Work::default(), Work::default());
    (closest_hit(&args, o, d, &mut closest), any_hit(&args, o, d, limit, &mut any), closest, any)
}

/// Everything but the steps: bit for bit.
fn found(f: &Found) -> ([u32; 4], bool, [u32; 2]) {
    let hit = [f.0.t.to_bits(), f.0.u.to_bits(), f.0.v.to_bits(), f.0.triangle];
    (hit, f.1, [f.2.triangle_tests, f.3.triangle_tests])
}

/// Walks in every way; returns how many rays hit, and how many took more steps without a private stack.
fn all_ways(seed: u64, slice: bool, rays: usize) -> (usize, usize) {
    let stand = odd_stand(seed, slice);
    let args = stand.args();
    let mut random = Random::new(seed);
    let (mut hits, mut longer) = (0, 0);
    for i in 0..rays {
        let ray = odd_ray(&mut random, i);
        let limit = [0.3, 1.5, 1e3, f32::NAN][i % 4];
        let stack = walk(&args, Traversal::PrivateStack, ray, limit);
        let [short, none] = WITHOUT_ARRAYS.map(|traversal| walk(&args, traversal, ray, limit));
        assert_eq!(found(&short), found(&stack), "short stack: {ray:?}");
        assert_eq!(found(&none), found(&stack), "no stack: {ray:?}");
        let steps = |f: &Found| f.2.traversal_steps + f.3.traversal_steps;
        assert!(steps(&stack) <= steps(&short) && steps(&short) <= steps(&none), "{ray:?}");
        hits += usize::from(stack.0 != Hit::NONE);
        longer += usize::from(steps(&short) > steps(&stack));
    }
    (hits, longer)
}

proptest! {
    #![proptest_config(Config { cases: 60, rng_seed: RngSeed::Fixed(2016), failure_persistence: None, ..Config::default() })]

    #[test]
    fn any_ray_in_any_tree_finds_the_same_in_every_way(seed in 1u64..u64::MAX, slice in any::<bool>()) {
        all_ways(seed, slice, 300);
    }
}

#[test]
fn deep_trees_outrun_the_short_stack() {
    let (mut hits, mut longer) = (0, 0);
    for seed in 1..30u64 {
        let (hit, long) = all_ways(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15), true, 300);
        (hits, longer) = (hits + hit, longer + long);
    }
    println!("{hits} hits, {longer} rays restarted");
    assert!(hits > 1000 && longer > 1000, "{hits} hits, {longer} rays restarted");
}

/// Picture and attribute planes of a frame whose sides are multiples of its blocks.
fn planes(prepared: &Prepared, executor: &mut dyn Executor, options: &RenderOptions) -> (Vec<u32>, Vec<u32>) {
    let (drawn, frame) = prepared.draw_observed(executor, options, false, &mut []).unwrap();
    (drawn.pixels, words(executor, &frame, FrameBuffer::Attributes))
}

fn sized(width: u32, height: u32) -> RenderOptions {
    RenderOptions { width, height, ..RenderOptions::default() }
}

proptest! {
    #![proptest_config(Config { cases: 12, rng_seed: RngSeed::Fixed(805), failure_persistence: None, ..Config::default() })]

    #[test]
    fn random_scenes_look_the_same_in_every_way(seed in 1u64..u64::MAX, count in 4usize..200, size in 0.05f32..0.8) {
        let prepared = Prepared::new(random_scene(&mut Random::new(seed), count, size), Shading::Full);
        for options in [sized(48, 36), RenderOptions { mode: Mode::Full, ..sized(48, 36) }] {
            let expected = planes(&prepared, &mut twin(), &options);
            for traversal in WITHOUT_ARRAYS {
                let mut twin = TwinExecutor::walking_by(traversal);
                prop_assert!(planes(&prepared, &mut twin, &options) == expected, "{}", traversal.name());
            }
        }
    }
}

#[test]
fn every_launch_equals_that_of_a_twin_that_walks_alike() {
    if no_opencl() {
        return;
    }
    let prepared = Prepared::named("zoo");
    let frames = [
        RenderOptions { mode: Mode::Full, ..sized(50, 38) },
        sized(50, 38),
        RenderOptions { method: blocks(4), ..sized(50, 38) },
        RenderOptions { method: sweeps(), ..sized(50, 38) },
    ];
    for traversal in WITHOUT_ARRAYS {
        let mut device = device(true, &walking_by(traversal));
        assert_eq!(device.traversal(), traversal);
        let mut results = Vec::new();
        for options in &frames {
            results.extend(prepared.parity(&mut device, options, true, None).unwrap());
        }
        let different: Vec<_> = results.iter().filter(|result| result.different > 0).collect();
        assert!(different.is_empty(), "{}: {different:#?}", traversal.name());
        let launched: BTreeSet<&str> = results.iter().map(|result| result.kernel.label(result.stage)).collect();
        assert_eq!(launched, LAUNCHES.iter().map(|(.., label)| *label).collect());
    }
    // A twin that walks otherwise is told by its steps, and by nothing else.
    let mut device = device(true, &walking_by(Traversal::Stackless));
    let counted = |executor: &mut dyn Executor| {
        let (drawn, frame) = prepared.draw_observed(executor, &frames[0], true, &mut []).unwrap();
        (executor.read(&frame, FrameBuffer::Counters, 0..2 * drawn.pixels.len()).unwrap(), drawn)
    };
    let (on_device, on_twin) = (counted(&mut device), counted(&mut twin()));
    assert!(on_device.1 == on_twin.1);
    let pixels = on_device.1.pixels.len();
    assert_ne!(on_device.0[..pixels], on_twin.0[..pixels], "steps");
    assert_eq!(on_device.0[pixels..], on_twin.0[pixels..], "triangle tests");
}

#[test]
fn strict_kernels_draw_the_same_in_every_way() {
    if no_opencl() {
        return;
    }
    for name in ["zoo", "cafe"] {
        let prepared = Prepared::named(name);
        let options = sized(96, 64);
        let expected = planes(&prepared, &mut device(true, &OpenOptions::default()), &options);
        for traversal in WITHOUT_ARRAYS {
            let mut device = device(true, &walking_by(traversal));
            assert!(planes(&prepared, &mut device, &options) == expected, "{name}, {}", traversal.name());
        }
        let other = planes(&prepared, &mut twin(), &RenderOptions { depth: 1, ..options });
        assert!(other != expected, "the comparison sees nothing");
    }
}

/// Steps of all rays of a frame on the twin, and the picture.
fn steps(prepared: &Prepared, traversal: Traversal, options: &RenderOptions) -> (u64, Vec<u32>) {
    let mut twin = TwinExecutor::walking_by(traversal);
    let (drawn, frame) = prepared.draw_observed(&mut twin, options, true, &mut []).unwrap();
    // The first counter plane; with these sizes no block sticks out.
    let words = twin.read(&frame, FrameBuffer::Counters, 0..drawn.pixels.len()).unwrap();
    (words.iter().map(|&word| u64::from(word)).sum(), drawn.pixels)
}

#[test]
#[ignore = "long: six real scenes in every way"]
fn steps_in_real_scenes() {
    let folder = rarefy_host_tests::command::root().join("../shared/scenes");
    if !folder.is_dir() {
        println!("skipped: ../shared/scenes is not here");
        return;
    }
    let mut scenes: Vec<_> = folder.read_dir().unwrap().map(|e| e.unwrap().path()).filter(|p| p.is_dir()).collect();
    scenes.sort();
    println!("steps at 512x512, full / adaptive: private stack, and how many times as many otherwise");
    for path in scenes {
        let prepared =
            Prepared::new(rarefy::internal::scene::load(&path, &rarefy::Monitor::default()).unwrap(), Shading::Full);
        let mut line = format!("{:12}", prepared.scene.name());
        for options in [RenderOptions { mode: Mode::Full, ..sized(512, 512) }, sized(512, 512)] {
            let (least, expected) = steps(&prepared, Traversal::PrivateStack, &options);
            line += &format!("  {:7.2} M", least as f64 / 1e6);
            for traversal in WITHOUT_ARRAYS {
                let (count, pixels) = steps(&prepared, traversal, &options);
                assert!(pixels == expected, "{}: {}", prepared.scene.name(), traversal.name());
                line += &format!("  {} {:.3}", traversal.name(), count as f64 / least as f64);
            }
        }
        println!("{line}");
    }
}
