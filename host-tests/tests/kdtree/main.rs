// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kd-tree builder on random and degenerate scenes: well-formed, deterministic, within its limits.
#![allow(clippy::unwrap_used)]

mod meshes;
mod rays;

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use rarefy::Error;
use rarefy::internal::monitor::{Cancel, Event, Monitor};
use rarefy::internal::prepare::kdtree::{BuildOptions, KdNode, KdTree, MAX_BYTES_PER_TRIANGLE, MAX_DEPTH};

use meshes::{Mesh, awkward_meshes, flat_grid, joined, positions_and_faces, random_soup, soup, sphere};

fn build(mesh: &Mesh, options: &BuildOptions) -> KdTree {
    KdTree::build(&mesh.0, &mesh.1, options, &rarefy::Monitor::default()).unwrap()
}

fn built_well(mesh: &Mesh, options: &BuildOptions) -> KdTree {
    let tree = build(mesh, options);
    tree.assert_well_formed(&mesh.0, &mesh.1);
    tree
}

#[test]
fn trees_over_awkward_meshes_are_well_formed() {
    for (name, mesh) in awkward_meshes() {
        println!("{name}: {} triangles", mesh.1.len());
        for options in [
            BuildOptions::default(),
            BuildOptions { intersection_cost: 3.0, empty_bonus: 0.0, ..BuildOptions::default() },
            BuildOptions { intersection_cost: 0.1, max_depth: Some(5), ..BuildOptions::default() },
        ] {
            let tree = built_well(&mesh, &options);
            let s = tree.statistics();
            let most = (MAX_BYTES_PER_TRIANGLE * mesh.1.len() as u64).max(1 << 16) + 16;
            assert!(s.bytes <= most, "{name}: {} bytes, more than {most}", s.bytes);
        }
    }
}

proptest! {
    #![proptest_config(Config { cases: 60, rng_seed: RngSeed::Fixed(2016), failure_persistence: None, ..Config::default() })]

    #[test]
    fn trees_over_random_meshes_are_well_formed(
        seed in 1u64..u64::MAX, count in 1usize..400, size in 0.001f32..1.5, cost in 0.1f32..4.0, snap in 0u32..3
    ) {
        let mut mesh = random_soup(seed, count, size);
        // Positions on a coarse grid make coplanar, axis-parallel, touching and degenerate triangles.
        let grid = [0.0, 8.0, 64.0][snap as usize];
        if grid > 0.0 {
            mesh.0.iter_mut().for_each(|p| *p = (*p * grid).round() / grid);
        }
        built_well(&mesh, &BuildOptions { intersection_cost: cost, ..BuildOptions::default() });
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    // Enough triangles for many nodes that are split in parallel.
    let mesh = joined([random_soup(7, 30_000, 0.03), sphere(20)]);
    let with = |threads| build(&mesh, &BuildOptions { threads, ..BuildOptions::default() });
    let reference = with(Some(1));
    reference.assert_well_formed(&mesh.0, &mesh.1);
    for threads in [Some(1), Some(2), Some(3), Some(4), None] {
        let tree = with(threads);
        assert!(tree.nodes == reference.nodes, "nodes differ with {threads:?} threads");
        assert!(tree.leaf_triangles == reference.leaf_triangles, "leaves differ with {threads:?} threads");
        assert_eq!((tree.bounds_min, tree.bounds_max), (reference.bounds_min, reference.bounds_max));
    }
}

#[test]
fn progress_runs_from_zero_to_one_and_never_back() {
    let mesh = random_soup(7, 20_000, 0.03);
    let seen = Arc::new(Mutex::new(Vec::new()));
    let log = Arc::clone(&seen);
    let monitor = Monitor::new(move |event| {
        if let Event::Progress { phase, share } = event {
            assert_eq!(phase, "kd-tree");
            log.lock().unwrap().push(share);
        }
    });
    let options = BuildOptions { threads: Some(3), ..BuildOptions::default() };
    KdTree::build(&mesh.0, &mesh.1, &options, &monitor).unwrap();
    let seen = seen.lock().unwrap();
    assert_eq!((seen[0], seen[seen.len() - 1]), (0.0, 1.0));
    assert!(seen.len() > 5, "only {} reports", seen.len());
    assert!(seen.is_sorted());
}

/// Cancels at each report in turn: whatever has grown by then, there is no tree, and no panic.
#[test]
fn a_tree_can_be_cancelled_at_any_report() {
    let mesh = random_soup(7, 20_000, 0.03);
    let mut cancelled = 0;
    for threads in [Some(1), Some(3)] {
        for cancel_at in (0..).step_by(2) {
            let cancel = Cancel::default();
            let (token, heard) = (cancel.clone(), Arc::new(AtomicU32::new(0)));
            let count = Arc::clone(&heard);
            let monitor = Monitor::new(move |_| {
                if count.fetch_add(1, Ordering::Relaxed) == cancel_at {
                    token.cancel();
                }
            });
            let options = BuildOptions { threads, ..BuildOptions::default() };
            let built = KdTree::build(&mesh.0, &mesh.1, &options, &monitor.with_cancel(&cancel));
            if heard.load(Ordering::Relaxed) <= cancel_at {
                assert!(built.unwrap().nodes == build(&mesh, &options).nodes);
                break;
            }
            // The last report says that all is done: too late to cancel.
            if let Err(error) = built {
                assert!(matches!(error, Error::Cancelled), "{error}");
                cancelled += 1;
            }
        }
    }
    assert!(cancelled > 10, "cancelled only {cancelled} times");
}

#[test]
fn statistics_fit_together() {
    for (name, mesh) in awkward_meshes() {
        let tree = build(&mesh, &BuildOptions::default());
        let s = tree.statistics();
        println!("{name}: {s:?}");
        assert_eq!(s.nodes, 2 * s.leaves - 1);
        assert_eq!(s.nodes + 1, tree.nodes.len(), "all slots but one are used");
        assert!(s.empty_leaves < s.leaves || mesh.1.is_empty());
        assert_eq!(s.leaf_entries, tree.leaf_triangles.len());
        assert_eq!(s.bytes, 8 * tree.nodes.len() as u64 + 4 * s.leaf_entries as u64);
        assert!(s.max_depth <= MAX_DEPTH);
        assert!(s.duplication >= 1.0 || mesh.1.is_empty());
        assert!(s.max_leaf_triangles <= mesh.1.len());
        let test_cost = BuildOptions::default().intersection_cost as f64;
        assert!((s.sah_cost - (s.expected_steps + test_cost * s.expected_tests)).abs() <= 1e-9 * s.sah_cost);
        // Each split was chosen because it is cheaper than a leaf (by the empty bonus at most dearer).
        assert!(s.sah_cost <= test_cost * mesh.1.len() as f64 / 0.8 + 1e-9, "{name}: dearer than one leaf");
    }
}

#[test]
fn every_triangle_is_in_some_leaf() {
    let mesh = random_soup(8, 2000, 0.1);
    let mut ids = build(&mesh, &BuildOptions::default()).leaf_triangles;
    ids.sort_unstable();
    ids.dedup();
    assert!(ids.iter().copied().eq(0..2000));
}

#[test]
fn splitting_pays() {
    let mesh = sphere(40);
    let s = built_well(&mesh, &BuildOptions::default()).statistics();
    // 12,800 triangles in one leaf would cost 5120.
    assert!(s.sah_cost < 80.0, "cost {}", s.sah_cost);
    assert!(s.duplication < 6.0, "duplication {}", s.duplication);
    assert!(s.expected_tests < 40.0, "tests {}", s.expected_tests);
}

#[test]
fn walls_in_one_plane_are_not_duplicated() {
    // Planes of grids, one above the other: each triangle belongs into one layer only.
    let mesh = joined((0..30).map(|i| flat_grid(1, 1, i as f32)));
    let s = built_well(&mesh, &BuildOptions::default()).statistics();
    assert!(s.duplication <= 1.5, "duplication {}", s.duplication);
}

#[test]
fn depth_limits_hold() {
    let mesh = random_soup(11, 2000, 0.1);
    for depth in [0, 1, 2, 7, 12] {
        let tree = built_well(&mesh, &BuildOptions { max_depth: Some(depth), ..BuildOptions::default() });
        assert_eq!(tree.statistics().max_depth, depth);
    }
    let tree = built_well(&mesh, &BuildOptions::default());
    // 8 + 1.3 log2(2000) = 22.3
    assert!(tree.statistics().max_depth <= 22);
}

#[test]
fn memory_limits_hold() {
    let mesh = joined([random_soup(11, 3000, 0.3), soup(vec![[Vec3::ZERO, Vec3::X, Vec3::ONE]; 100])]);
    let full = build(&mesh, &BuildOptions::default()).statistics().bytes;
    let least = 16 + 4 * 3100;
    for limit in [least, least + 15, least + 16, 13_000, 20_000, 40_000, 100_000] {
        assert!(limit < full, "the limit {limit} limits nothing");
        let with = |threads| BuildOptions { memory_limit_bytes: limit, threads, ..BuildOptions::default() };
        let tree = built_well(&mesh, &with(Some(1)));
        let s = tree.statistics();
        assert!(s.bytes <= limit, "{} bytes with a limit of {limit}", s.bytes);
        assert_eq!(tree.nodes, build(&mesh, &with(Some(4))).nodes);
        if limit >= 20_000 {
            assert!(s.bytes > limit / 2, "only {} bytes used with a limit of {limit}", s.bytes);
        }
    }
    let options = BuildOptions { memory_limit_bytes: least - 1, ..BuildOptions::default() };
    let error = KdTree::build(&mesh.0, &mesh.1, &options, &rarefy::Monitor::default()).unwrap_err();
    assert!(matches!(error, Error::LimitExceeded { .. }));
    let message = error.to_string();
    assert!(message.contains("12416") && message.contains("12415"), "no numbers in: {message}");
}

#[test]
fn bad_options_are_refused() {
    let mesh = soup([[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    let good = BuildOptions::default();
    for options in [
        BuildOptions { traversal_cost: 0.0, ..good.clone() },
        BuildOptions { traversal_cost: f32::NAN, ..good.clone() },
        BuildOptions { intersection_cost: -1.0, ..good.clone() },
        BuildOptions { intersection_cost: f32::INFINITY, ..good.clone() },
        BuildOptions { empty_bonus: 1.0, ..good.clone() },
        BuildOptions { empty_bonus: f32::NAN, ..good.clone() },
        BuildOptions { max_depth: Some(MAX_DEPTH + 1), ..good.clone() },
        BuildOptions { threads: Some(0), ..good.clone() },
    ] {
        let error = KdTree::build(&mesh.0, &mesh.1, &options, &rarefy::Monitor::default()).unwrap_err();
        assert!(matches!(error, Error::InvalidOption { .. }), "{options:?}: {error}");
    }
}

#[test]
fn bad_triangles_are_refused() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
    for (positions, triangle) in [
        (corners.to_vec(), [0, 1, 3]),
        (vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0)], [0, 1, 2]),
        (vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, 0.0, f32::INFINITY)], [0, 1, 2]),
        (vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, -2e12, 0.0)], [0, 1, 2]),
    ] {
        let error =
            KdTree::build(&positions, &[[0, 1, 0], triangle], &BuildOptions::default(), &rarefy::Monitor::default())
                .unwrap_err();
        assert!(matches!(error, Error::InvalidScene { .. }), "{error}");
        assert!(error.to_string().contains("triangle 1"), "no place in: {error}");
    }
}

#[test]
fn real_scenes_have_well_formed_trees() {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    if !scenes.is_dir() {
        println!("skipped: ../shared/scenes is not here");
        return;
    }
    for name in ["modern-hall", "classroom"] {
        let mesh = positions_and_faces(&std::fs::read_to_string(scenes.join(name).join("scene.obj")).unwrap());
        let s = built_well(&mesh, &BuildOptions::default()).statistics();
        println!("{name}: {s:?}");
        assert!(s.duplication < 6.0 && s.sah_cost < 40.0, "{name}: {s:?}");
    }
}

/// Whether `assert_well_formed` accepts a tree; its message if not.
fn complaint(tree: &KdTree, mesh: &Mesh) -> Option<String> {
    let result = std::panic::catch_unwind(|| tree.assert_well_formed(&mesh.0, &mesh.1));
    result
        .err()
        .map(|e| e.downcast_ref::<String>().cloned().or(e.downcast_ref::<&str>().map(|s| s.to_string())).unwrap())
}

#[test]
fn damaged_trees_are_found() {
    let mesh = random_soup(21, 500, 0.2);
    let good = build(&mesh, &BuildOptions::default());
    assert_eq!(complaint(&good, &mesh), None);
    let leaf = good.nodes.iter().rposition(|n| n.is_leaf() && n.payload() >= 2).unwrap();
    let inner = good.nodes.iter().rposition(|n| !n.is_leaf()).unwrap();
    let first = good.nodes[leaf].split_or_first as usize;
    type Damage = Box<dyn Fn(&mut KdTree)>;
    let damages: Vec<(&str, &str, Damage)> = vec![
        (
            "a lost triangle",
            "is not in it",
            Box::new(move |t| {
                // The last entry of the list is left out.
                let n = t.nodes[leaf];
                t.nodes[leaf] = KdNode::leaf(n.split_or_first, n.payload() - 1);
            }),
        ),
        ("a foreign triangle", "", Box::new(move |t| t.leaf_triangles[first] = 0)),
        ("swapped ids", "do not ascend", Box::new(move |t| t.leaf_triangles.swap(first, first + 1))),
        (
            "a shared entry",
            "another leaf too",
            Box::new(move |t| {
                t.nodes[leaf].split_or_first -= 1;
            }),
        ),
        ("entries out of range", "out of range", Box::new(move |t| t.nodes[leaf].split_or_first = u32::MAX)),
        ("an entry of no leaf", "belongs to no leaf", Box::new(|t| t.leaf_triangles.push(0))),
        (
            "a cycle",
            "not an even pair behind it",
            Box::new(move |t| {
                t.nodes[inner] = KdNode::inner(t.nodes[inner].axis(), t.nodes[inner].split(), 0);
            }),
        ),
        ("odd children", "not an even pair", Box::new(move |t| t.nodes[inner].axis_and_payload += 4)),
        (
            "children out of range",
            "out of range",
            Box::new(move |t| {
                t.nodes[inner].axis_and_payload += 4 * t.nodes.len() as u32;
            }),
        ),
        (
            "a node reached twice",
            "",
            Box::new(|t| {
                let (a, b) = (t.nodes[0].payload() as usize, t.nodes[0].payload() as usize + 1);
                t.nodes[a].axis_and_payload = t.nodes[b].axis_and_payload;
            }),
        ),
        (
            "an unreachable pair",
            "cannot be reached",
            Box::new(|t| {
                t.nodes.extend([KdNode::leaf(0, 0); 2]);
            }),
        ),
        ("an odd number of nodes", "odd number", Box::new(|t| t.nodes.push(KdNode::leaf(0, 0)))),
        (
            "a plane outside its cell",
            "not strictly between",
            Box::new(move |t| {
                t.nodes[inner].split_or_first = 1e9f32.to_bits();
            }),
        ),
        ("a NaN plane", "not strictly between", Box::new(move |t| t.nodes[inner].split_or_first = f32::NAN.to_bits())),
        ("a moved plane", "", Box::new(|t| t.nodes[0].split_or_first = (t.nodes[0].split() + 0.05).to_bits())),
        (
            "the wrong axis",
            "",
            Box::new(|t| {
                t.nodes[0].axis_and_payload = (t.nodes[0].axis_and_payload & !3) | ((t.nodes[0].axis() + 1) % 3);
            }),
        ),
        ("bounds too tight", "not strictly within", Box::new(|t| t.bounds_max[1] -= 0.01)),
        ("no nodes", "fewer than", Box::new(|t| t.nodes.clear())),
    ];
    for (name, message, damage) in damages {
        let mut tree = good.clone();
        damage(&mut tree);
        let complaint = complaint(&tree, &mesh).unwrap_or_else(|| panic!("{name} was not noticed"));
        assert!(complaint.contains(message), "{name}: expected \"{message}\", got \"{complaint}\"");
    }
}
