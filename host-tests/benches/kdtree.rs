// SPDX-License-Identifier: MIT OR Apache-2.0
//! Kd-tree build times: `cargo bench -p rarefy-host-tests --bench kdtree -- [RUNS] [SCENE ...]`.
//!
//! Prints one line a scene: build time in ms (median of RUNS, 5 by default) on 1 and 2 threads, computing ms per
//! 100,000 triangles on one core, and what the tree is like. Uses a generated scene and, if they are there, those of
//! `../shared/scenes` (or of the folder that the variable SCENES names). INTERSECTION_COST and EMPTY_BONUS set the
//! builder's parameters. The last column is the peak of MB that the process held at once during a build on 2 threads,
//! without the scene (where the system tells).

use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::Vec3;
use rarefy::internal::prepare::kdtree::{BuildOptions, KdTree};

/// Positions and triangles of an OBJ file; of its lines, `v` and `f` only.
fn read_obj(path: &Path) -> Option<(Vec<Vec3>, Vec<[u32; 3]>)> {
    let text = std::fs::read_to_string(path).ok()?;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f32> = words.take(3).map(|w| w.parse().unwrap_or(0.0)).collect();
                positions.push(Vec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let number = |w: &str| w.split('/').next().and_then(|w| w.parse::<i64>().ok()).unwrap_or(1);
                let index = |n: i64| if n < 0 { positions.len() as i64 + n } else { n - 1 } as u32;
                let corners: Vec<u32> = words.map(|w| index(number(w))).collect();
                triangles.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
            }
            _ => {}
        }
    }
    Some((positions, triangles))
}

/// A room with bumpy balls in it: 100,000 triangles, the same on every machine.
fn generated_room() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for ball in 0..10u32 {
        let centre = Vec3::new((ball % 5) as f32 * 2.1, (ball / 5) as f32 * 1.7, (ball * 7 % 10) as f32);
        let first = positions.len() as u32;
        for i in 0..=50u32 {
            for j in 0..100u32 {
                let (theta, phi) = (i as f32 * 0.0628, j as f32 * 0.0628);
                let r = 0.8 + 0.02 * (9.0 * theta).sin() * (7.0 * phi).cos();
                positions.push(centre + r * Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()));
                if i < 50 {
                    let (a, b) = (first + i * 100 + j, first + i * 100 + (j + 1) % 100);
                    triangles.extend([[a, b, a + 100], [b, b + 100, a + 100]]);
                }
            }
        }
    }
    let first = positions.len() as u32;
    for i in 0..8u32 {
        let pick = |bit: u32, lo: f32, hi: f32| if i >> bit & 1 == 0 { lo } else { hi };
        positions.push(Vec3::new(pick(0, -2.0, 11.0), pick(1, -1.0, 4.0), pick(2, -2.0, 12.0)));
    }
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        triangles.extend([[a, b, c].map(|k| first + k), [a, c, d].map(|k| first + k)]);
    }
    (positions, triangles)
}

/// A line of `/proc/self/status` in MB, where there is such a file.
fn process_mb(key: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(key))?;
    line.split_ascii_whitespace().nth(1)?.parse::<f64>().ok().map(|kb| kb / 1024.0)
}

/// Milliseconds that this thread has computed, where the system tells: unlike wall time it hardly depends on what else
/// the machine does.
fn thread_ms() -> Option<f64> {
    let times = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    times.split_ascii_whitespace().next()?.parse::<f64>().ok().map(|ns| ns / 1e6)
}

/// Medians of wall time and of this thread's computing time.
fn median_ms(runs: usize, mut work: impl FnMut()) -> (f64, f64) {
    let (mut wall, mut computing): (Vec<f64>, Vec<f64>) = (0..runs)
        .map(|_| {
            let (start, before) = (Instant::now(), thread_ms());
            work();
            let wall = start.elapsed().as_secs_f64() * 1e3;
            (wall, before.zip(thread_ms()).map_or(wall, |(before, after)| after - before))
        })
        .unzip();
    wall.sort_by(f64::total_cmp);
    computing.sort_by(f64::total_cmp);
    (wall[runs / 2], computing[runs / 2])
}

fn measure(name: &str, positions: &[Vec3], triangles: &[[u32; 3]], runs: usize) {
    let options = |threads| BuildOptions {
        threads: Some(threads),
        intersection_cost: variable("INTERSECTION_COST", BuildOptions::default().intersection_cost),
        empty_bonus: variable("EMPTY_BONUS", BuildOptions::default().empty_bonus),
        ..BuildOptions::default()
    };
    let build = |threads| match KdTree::build(positions, triangles, &options(threads), &rarefy::Monitor::default()) {
        Ok(tree) => tree,
        Err(e) => panic!("{name}: {e}"),
    };
    // Writing 5 there sets the peak back to what is held now.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let before = process_mb("VmRSS").unwrap_or(0.0);
    let s = build(2).statistics();
    let peak = process_mb("VmHWM").map_or("-".into(), |peak| format!("{:.0}", peak - before));
    let (one, core) = median_ms(runs, || drop(build(1)));
    let (two, _) = median_ms(runs, || drop(build(2)));
    println!(
        "{name:<12} {:>9} {one:>8.0} {two:>8.0} {:>7.0} {:>9} {:>9} {:>6.2} {:>5} {:>6.2} {:>6.2} {:>6.2} {:>7.3} {:>7.1} {peak:>6}",
        triangles.len(),
        core * 1e5 / triangles.len() as f64,
        s.nodes,
        s.leaf_entries,
        s.duplication,
        s.max_depth,
        s.expected_steps,
        s.expected_leaves,
        s.expected_tests,
        s.sah_cost,
        s.bytes as f64 / 1048576.0,
    );
}

/// A number from the environment, for experiments with the builder's parameters.
fn variable(name: &str, default: f32) -> f32 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let runs = words.iter().find_map(|w| w.parse().ok()).unwrap_or(5).max(1);
    let names: Vec<&String> = words.iter().filter(|w| w.parse::<usize>().is_err()).collect();
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| *n == name);
    println!(
        "{:<12} {:>9} {:>8} {:>8} {:>7} {:>9} {:>9} {:>6} {:>5} {:>6} {:>6} {:>6} {:>7} {:>7} {:>6}",
        "scene",
        "triangles",
        "1 thr ms",
        "2 thr ms",
        "ms/100K",
        "nodes",
        "entries",
        "dup",
        "depth",
        "steps",
        "leaves",
        "tests",
        "SAH",
        "MB",
        "peak"
    );
    if wanted("generated") {
        let (positions, triangles) = generated_room();
        measure("generated", &positions, &triangles, runs);
    }
    let scenes = std::env::var_os("SCENES").map(PathBuf::from);
    let scenes = scenes.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes"));
    if !scenes.is_dir() {
        println!("skipped: ../shared/scenes is not here");
        return;
    }
    for name in ["modern-hall", "figures", "classroom", "living-room", "bathroom", "kitchen"] {
        if wanted(name) {
            match read_obj(&scenes.join(name).join("scene.obj")) {
                Some((positions, triangles)) => measure(name, &positions, &triangles, runs),
                None => println!("skipped: {name} cannot be read"),
            }
        }
    }
}
