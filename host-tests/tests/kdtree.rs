// SPDX-License-Identifier: MIT OR Apache-2.0
//! The kd-tree builder on random and degenerate scenes: well-formed, deterministic, within its limits.
#![allow(clippy::unwrap_used)]

use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use rarefy::Error;
use rarefy::kdtree::{BuildOptions, KdNode, KdTree, MAX_BYTES_PER_TRIANGLE, MAX_DEPTH};

/// Positions and triangles.
type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// Triangles that share no corners.
fn soup(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Mesh {
    let positions: Vec<Vec3> = triangles.into_iter().flatten().collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (positions, triangles)
}

/// Random numbers that are the same everywhere (xorshift).
struct Random(u64);

impl Random {
    /// In `[0, 1)`.
    fn unit(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * size
    }
}

/// `count` triangles of about `size` in a unit cube.
fn random_soup(seed: u64, count: usize, size: f32) -> Mesh {
    let mut random = Random(seed);
    soup((0..count).map(|_| {
        let at = random.point(1.0);
        [at + random.point(size), at + random.point(size), at + random.point(size)]
    }))
}

/// A closed sphere of `8 n^2` triangles.
fn sphere(n: u32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=2 * n {
        for j in 0..2 * n {
            let step = std::f32::consts::PI / (2 * n) as f32;
            let (theta, phi) = (i as f32 * step, j as f32 * 2.0 * step);
            positions.push(Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()));
            if i < 2 * n {
                let (a, b) = (2 * n * i + j, 2 * n * i + (j + 1) % (2 * n));
                triangles.extend([[a, b, a + 2 * n], [b, b + 2 * n, a + 2 * n]]);
            }
        }
    }
    (positions, triangles)
}

/// A grid of `2 n^2` triangles in the plane where `axis` is `at`.
fn flat_grid(n: u32, axis: usize, at: f32) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=n {
        for j in 0..=n {
            let mut p = [0.0; 3];
            p[axis] = at;
            p[(axis + 1) % 3] = i as f32 * 0.1;
            p[(axis + 2) % 3] = j as f32 * 0.1;
            positions.push(p.into());
            if i < n && j < n {
                let a = i * (n + 1) + j;
                triangles.extend([[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]]);
            }
        }
    }
    (positions, triangles)
}

fn joined(meshes: impl IntoIterator<Item = Mesh>) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (p, t) in meshes {
        let base = positions.len() as u32;
        positions.extend(p);
        triangles.extend(t.into_iter().map(|t| t.map(|corner| corner + base)));
    }
    (positions, triangles)
}

/// Every awkward input that the builder must cope with.
fn awkward_meshes() -> Vec<(&'static str, Mesh)> {
    let one = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let slanted = [Vec3::ZERO, Vec3::new(1.0, 0.3, 0.2), Vec3::new(0.1, 1.0, 0.9)];
    let mut random = Random(5);
    let needles: Vec<[Vec3; 3]> = (0..300)
        .map(|_| {
            let (a, b) = (random.point(10.0), random.point(10.0));
            [a, b, b + random.point(1e-5)]
        })
        .collect();
    let huge_and_tiny = joined([
        soup([[Vec3::new(-111.0, 0.0, -111.0), Vec3::new(111.0, 0.0, -111.0), Vec3::new(0.0, 0.0, 111.0)]]),
        {
            let (mut positions, triangles) = random_soup(9, 500, 0.001);
            positions.iter_mut().for_each(|p| *p = *p * 0.05 + Vec3::new(3.0, 0.7, 2.0));
            (positions, triangles)
        },
        flat_grid(10, 1, 0.0),
    ]);
    let nearly_axis_parallel: Vec<[Vec3; 3]> = (0..200)
        .map(|i| {
            let x = 1.0 + (i % 5) as f32 * f32::EPSILON;
            let y = (i / 5) as f32 * 0.01;
            [Vec3::new(x, y, 0.0), Vec3::new(1.0, y + 1.0, f32::EPSILON), Vec3::new(1.0 + f32::EPSILON, y, 1.0)]
        })
        .collect();
    vec![
        ("no triangle", soup([])),
        ("one triangle", soup([one])),
        ("two", soup([one, slanted])),
        ("all corners in the origin", soup([[Vec3::ZERO; 3]; 20])),
        ("points and lines", soup((0..50).map(|i| [Vec3::X * i as f32, Vec3::X * i as f32, Vec3::Y * (i / 2) as f32]))),
        ("3000 equal flat triangles", soup(vec![one; 3000])),
        ("3000 equal slanted triangles", soup(vec![slanted; 3000])),
        ("flat in x", flat_grid(20, 0, 3.7)),
        ("flat in y", flat_grid(20, 1, 0.0)),
        ("flat in z", flat_grid(20, 2, -1e4)),
        ("stacked planes", joined((0..20).map(|i| flat_grid(5, i % 3, i as f32 * 0.025)))),
        ("needles", soup(needles)),
        ("huge and tiny", huge_and_tiny),
        ("nearly axis-parallel", soup(nearly_axis_parallel)),
        ("sphere", sphere(12)),
        ("nested equal spheres", joined([sphere(6), sphere(6), sphere(6)])),
        ("big coordinates", {
            let (mut positions, triangles) = random_soup(3, 200, 0.3);
            positions.iter_mut().for_each(|p| *p *= 7e11);
            (positions, triangles)
        }),
        ("tiny coordinates", {
            let (mut positions, triangles) = random_soup(3, 200, 0.3);
            positions.iter_mut().for_each(|p| *p *= 1e-20);
            (positions, triangles)
        }),
        ("far from the origin", {
            let (mut positions, triangles) = random_soup(4, 300, 0.2);
            positions.iter_mut().for_each(|p| *p = *p * 0.01 + Vec3::splat(1000.0));
            (positions, triangles)
        }),
        ("one far outlier", {
            joined([random_soup(4, 300, 0.2), soup([[Vec3::splat(1e9), Vec3::splat(1.1e9), Vec3::X * 1e9]])])
        }),
        ("random, large", random_soup(1, 300, 1.0)),
        ("random, small", random_soup(2, 3000, 0.05)),
    ]
}

fn build(mesh: &Mesh, options: &BuildOptions) -> KdTree {
    KdTree::build(&mesh.0, &mesh.1, options, &|_| {}).unwrap()
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
    let seen = std::sync::Mutex::new(Vec::new());
    let options = BuildOptions { threads: Some(3), ..BuildOptions::default() };
    KdTree::build(&mesh.0, &mesh.1, &options, &|share| seen.lock().unwrap().push(share)).unwrap();
    let seen = seen.into_inner().unwrap();
    assert_eq!((seen[0], seen[seen.len() - 1]), (0.0, 1.0));
    assert!(seen.len() > 5, "only {} reports", seen.len());
    assert!(seen.is_sorted());
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
    let error = KdTree::build(&mesh.0, &mesh.1, &options, &|_| {}).unwrap_err();
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
        let error = KdTree::build(&mesh.0, &mesh.1, &options, &|_| {}).unwrap_err();
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
        let error = KdTree::build(&positions, &[[0, 1, 0], triangle], &BuildOptions::default(), &|_| {}).unwrap_err();
        assert!(matches!(error, Error::InvalidScene { .. }), "{error}");
        assert!(error.to_string().contains("triangle 1"), "no place in: {error}");
    }
}

/// Moeller and Trumbore's test in floats: the ray parameter of a hit.
fn hit(o: Vec3, d: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (e1, e2) = (b - a, c - a);
    let p = d.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let s = o - a;
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(p) / det, d.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t.is_finite()).then_some(t)
}

fn corners(mesh: &Mesh, id: u32) -> [Vec3; 3] {
    mesh.1[id as usize].map(|corner| mesh.0[corner as usize])
}

/// The least (t, id) over all triangles.
fn closest_of_all(mesh: &Mesh, o: Vec3, d: Vec3) -> Option<(f32, u32)> {
    let hits = (0..mesh.1.len() as u32).filter_map(|id| hit(o, d, corners(mesh, id)).map(|t| (t, id)));
    hits.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

/// The least (t, id) over all triangles of leaves whose cells the ray meets, by slabs in 64 bits, without any order.
fn closest_in_tree(tree: &KdTree, mesh: &Mesh, o: Vec3, d: Vec3) -> Option<(f32, u32)> {
    let mut best: Option<(f32, u32)> = None;
    let mut stack = vec![(0usize, tree.bounds_min, tree.bounds_max)];
    while let Some((index, lo, hi)) = stack.pop() {
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for a in 0..3 {
            let (o, d, lo, hi) = (o[a] as f64, d[a] as f64, lo[a] as f64, hi[a] as f64);
            if d == 0.0 {
                if o < lo || o > hi {
                    far = -1.0;
                }
            } else {
                let (t0, t1) = ((lo - o) / d, (hi - o) / d);
                (near, far) = (near.max(t0.min(t1)), far.min(t0.max(t1)));
            }
        }
        // Roundings of 64 bits only: the tree itself must allow for those of the 32-bit test.
        if near > far * (1.0 + 1e-12) {
            continue;
        }
        let node = tree.nodes[index];
        if node.is_leaf() {
            let first = node.split_or_first as usize;
            for &id in &tree.leaf_triangles[first..first + node.payload() as usize] {
                if let Some(t) = hit(o, d, corners(mesh, id))
                    && best.is_none_or(|best| (t, id) < best)
                {
                    best = Some((t, id));
                }
            }
        } else {
            let (axis, child) = (node.axis() as usize, node.payload() as usize);
            let (mut middle_hi, mut middle_lo) = (hi, lo);
            middle_hi[axis] = node.split();
            middle_lo[axis] = node.split();
            stack.push((child, lo, middle_hi));
            stack.push((child + 1, middle_lo, hi));
        }
    }
    best
}

/// Shoots rays, many of them parallel to axes and through corners. Returns how many there were, how many should hit, and
/// those for which `tree` and brute force disagree.
fn shoot(tree: &KdTree, mesh: &Mesh, random: &mut Random) -> (usize, usize, Vec<String>) {
    let (lo, hi) = (Vec3::from(tree.bounds_min), Vec3::from(tree.bounds_max));
    let (mut hits, mut disagreements) = (0, Vec::new());
    for i in 0..400 {
        let corner = mesh.0[(random.unit() * mesh.0.len() as f32) as usize];
        let o = match i % 4 {
            // On a corner's coordinates in two axes: rays in the planes that split cells.
            0 => Vec3::new(corner.x, corner.y, lo.z - 0.5 * (hi - lo).max_element()),
            1 => corner,
            _ => lo + (hi - lo) * random.point(1.0),
        };
        let target = corners(mesh, (random.unit() * mesh.1.len() as f32) as u32);
        let (u, v) = (random.unit(), random.unit());
        let inside = target[0] + (target[1] - target[0]) * u * (1.0 - v) + (target[2] - target[0]) * v;
        let d = match i % 4 {
            0 => Vec3::Z,
            1 => [Vec3::X, Vec3::NEG_Y, Vec3::new(1.0, 1.0, 0.0), Vec3::Z][i / 4 % 4],
            _ => (inside - o).normalize_or(Vec3::X),
        };
        let expected = closest_of_all(mesh, o, d);
        let found = closest_in_tree(tree, mesh, o, d);
        hits += expected.is_some() as usize;
        if found != expected {
            disagreements.push(format!("ray {i} from {o} to {d}: {found:?}, not {expected:?}"));
        }
    }
    (400, hits, disagreements)
}

#[test]
fn rays_hit_the_same_triangle_in_the_tree_as_among_all() {
    let mut random = Random(99);
    let (mut rays, mut hits) = (0, 0);
    for (name, mesh) in awkward_meshes().into_iter().filter(|(_, mesh)| !mesh.1.is_empty()) {
        let mut tree = build(&mesh, &BuildOptions::default());
        let (shot, expected, disagreements) = shoot(&tree, &mesh, &mut random);
        assert!(disagreements.is_empty(), "{name}: {disagreements:#?}");
        rays += shot;
        hits += expected;
        // With the first triangle of every leaf left out, some rays must disagree.
        for node in &mut tree.nodes {
            if node.is_leaf() && node.payload() > 0 {
                *node = KdNode::leaf(node.split_or_first + 1, node.payload() - 1);
            }
        }
        if name == "sphere" || name == "random, small" {
            assert!(!shoot(&tree, &mesh, &mut random).2.is_empty(), "{name}: lost triangles were not noticed");
        }
    }
    assert!(hits > rays / 3, "only {hits} of {rays} rays hit");
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

/// The `v` and `f` lines of an OBJ text; faces with more corners become fans.
fn positions_and_faces(text: &str) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f32> = words.take(3).map(|w| w.parse().unwrap()).collect();
                positions.push(Vec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let number = |w: &str| w.split('/').next().unwrap().parse::<i64>().unwrap();
                let index = |n: i64| if n < 0 { positions.len() as i64 + n } else { n - 1 } as u32;
                let face: Vec<u32> = words.map(|w| index(number(w))).collect();
                triangles.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]]));
            }
            _ => {}
        }
    }
    (positions, triangles)
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
