// SPDX-License-Identifier: MIT OR Apache-2.0
//! The fuzz targets of `fuzz/` on a stable compiler: a fixed run of changed seeds.
#![allow(clippy::unwrap_used, missing_docs)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use rarefy::internal::device::profiles::Profile;
use rarefy_host_tests::fixtures::Random;
use rarefy_host_tests::fuzz::{TARGETS, Target, mutate, scene_of_the_seeds};

/// Hands the target each seed and `count` changed ones.
fn run((name, target): Target, seed: u64, count: usize) {
    let seeds = mutate::seeds(name);
    seeds.iter().for_each(|input| target(input));
    let mut random = Random::new(seed);
    for at in 0..count {
        let input = mutate::mutated(&mut random, &seeds);
        if catch_unwind(AssertUnwindSafe(|| target(&input))).is_err() {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}"));
            std::fs::write(&kept, &input).unwrap();
            panic!("{name}: input {at} of seed {seed} breaks it; it is kept in {}", kept.display());
        }
    }
    println!("{name}: {count} inputs");
}

fn target(name: &str) -> Target {
    TARGETS.into_iter().find(|(of, _)| *of == name).unwrap()
}

/// `FUZZ_INPUTS` for other counts, in hundredths of the usual ones, `FUZZ_SEED` for other inputs.
fn run_long(name: &str, count: usize) {
    let number = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<usize>().ok());
    run(target(name), number("FUZZ_SEED").unwrap_or(16) as u64, count * number("FUZZ_INPUTS").unwrap_or(100) / 100);
}

#[test]
fn no_target_minds_a_few_changed_seeds() {
    TARGETS.into_iter().for_each(|target| run(target, 7, 150));
}

#[test]
fn seeds_are_good_inputs_and_changes_change_them() {
    for (name, _) in TARGETS {
        let seeds = mutate::seeds(name);
        let mut random = Random::new(1);
        let other = (0..100).filter(|_| !seeds.contains(&mutate::mutated(&mut random, &seeds))).count();
        assert!(other > 80, "{name}: {other}");
    }
    let scene = scene_of_the_seeds();
    assert_eq!((scene.textures().len(), scene.view().lights.len(), scene.view().extent), (2, 2, 2.0));
    assert!(scene.triangles().len() > 4 && scene.materials().len() > 1, "{scene:?}");
    for seed in mutate::seeds("profile") {
        Profile::from_json("seed", std::str::from_utf8(&seed).unwrap()).unwrap();
    }
    let again = |seed| mutate::mutated(&mut Random::new(seed), &mutate::seeds("obj"));
    assert_eq!(again(5), again(5));
    assert_ne!(again(5), again(6));
}

/// The control: what a target breaks on is reported, with the input.
#[test]
fn an_input_that_breaks_a_target_is_kept() {
    let fails = |input: &[u8]| assert!(!input.contains(&0), "the control");
    let run = catch_unwind(|| run(("obj", fails), 3, 2_000));
    let message = *run.unwrap_err().downcast::<String>().unwrap();
    assert!(message.contains("breaks it"), "{message}");
    assert!(std::fs::read(Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz-obj")).unwrap().contains(&0));
}

#[test]
#[ignore = "long: changed OBJ files"]
fn obj_files() {
    run_long("obj", 40_000);
}

#[test]
#[ignore = "long: changed MTL files"]
fn mtl_files() {
    run_long("mtl", 30_000);
}

#[test]
#[ignore = "long: changed view.json files"]
fn view_files() {
    run_long("view", 30_000);
}

#[test]
#[ignore = "long: changed profiles"]
fn profiles() {
    run_long("profile", 30_000);
}

#[test]
#[ignore = "long: changed pictures"]
fn pictures() {
    run_long("picture", 20_000);
}

#[test]
#[ignore = "long: changed scenes, drawn with random options"]
fn whole_scenes() {
    run_long("scene", 10_000);
}
