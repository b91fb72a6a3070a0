// SPDX-License-Identifier: MIT OR Apache-2.0
//! Baked files changed at random, mostly with a checksum that is right again: each is a scene that can be drawn or an
//! error, never a panic, a read beyond an array or a walk without end.
//!
//! The long run takes `RAREFY_FUZZ_INPUTS` inputs (half a million) from `RAREFY_FUZZ_SEED` on (1):
//! `cargo test -p rarefy-host-tests --test baked_mutated -- --ignored --nocapture` prints what came of them.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::sync::Arc;

use rarefy::{
    DeviceChoice, DeviceOptions, Error, Keep, Monitor, PreparedScene, RenderOptions, Renderer, Result, Shading,
};
use rarefy_host_tests::baked::{parts, reseal, tiny};

/// Random numbers (splitmix64): the same for the same seed, on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// A word that is likely to break something where `before` stood.
fn word(random: &mut Random, before: u32) -> u32 {
    const ODD: [u32; 16] = [
        0,
        1,
        2,
        3,
        4,
        7,
        0x7fff_ffff,
        0x8000_0000,
        0xffff_fffc,
        0xffff_fffe,
        0xffff_ffff,
        0x7fc0_0000,
        0x7f80_0000,
        0xff80_0000,
        0x0000_0001,
        0x3f80_0000,
    ];
    match random.below(6) {
        0 => ODD[random.below(ODD.len())],
        1 => before ^ (1 << random.below(32)),
        2 => before.wrapping_add(random.below(9) as u32).wrapping_sub(4),
        3 => before.wrapping_add((random.below(9) as u32).wrapping_sub(4) << 2),
        // A float nearby.
        4 => (f32::from_bits(before) * (0.9 + 0.2 * random.below(1001) as f32 / 1000.0)).to_bits(),
        _ => random.next() as u32,
    }
}

/// Changes a sound file in one to four places.
fn mutate(random: &mut Random, sound: &[u8]) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    let spans = parts(sound);
    for _ in 0..=random.below(4) {
        let span = spans[random.below(spans.len())];
        if span.count == 0 {
            continue;
        }
        let word_at = |random: &mut Random| span.word(random.below(span.count), random.below(span.element / 4));
        let at = word_at(random);
        let before = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        match random.below(8) {
            // Two elements, or parts of them, change places.
            0 => {
                let other = word_at(random);
                let length = (4 * (1 + random.below(4))).min(sound.len() - at.max(other));
                for i in 0..length {
                    bytes.swap(at + i, other + i);
                }
            }
            // Any byte, names included.
            1 => {
                let any = 32 + random.below(sound.len() - 32);
                bytes[any] = random.next() as u8;
            }
            _ => bytes[at..at + 4].copy_from_slice(&word(random, before).to_le_bytes()),
        }
    }
    match random.below(40) {
        0 => bytes.truncate(random.below(sound.len())),
        1 => bytes.extend((0..random.below(100)).map(|i| i as u8)),
        _ => {}
    }
    if random.below(20) != 0 {
        reseal(&mut bytes);
    }
    bytes
}

fn read(bytes: &[u8]) -> Result<PreparedScene> {
    PreparedScene::from_baked(bytes, &Monitor::default())
}

/// Draws a few pixels. The twin checks every index, so that reading beyond an array is a panic.
fn draw(scene: PreparedScene) -> Result<()> {
    let options = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
    let mut renderer = Renderer::new(Arc::new(scene), &options, &Monitor::default())?;
    let size = RenderOptions { width: 9, height: 7, ..RenderOptions::default() };
    renderer.render(&size, Keep::default()).map(drop)
}

/// What may be given any bytes: what a fuzzer calls.
fn target(bytes: &[u8], drawn: bool) -> &'static str {
    match read(bytes) {
        Ok(scene) if drawn => match draw(scene) {
            Ok(()) => "drawn",
            Err(error) => panic!("accepted, but not drawn: {error}"),
        },
        Ok(_) => "accepted",
        Err(Error::InvalidScene { place, message }) => match place.split(": ").nth(1) {
            None if message.contains("damaged") => "damaged",
            None if message.contains("this is no") || message.contains("version") => "foreign",
            None if message.starts_with("view") => "view",
            None => "names",
            Some(place) => {
                const PLACES: [&str; 9] = [
                    "triangles",
                    "nodes",
                    "leaf_triangles",
                    "materials",
                    "object_materials",
                    "textures",
                    "bounds",
                    "epsilon",
                    "origin",
                ];
                let array = place.split('[').next().unwrap();
                PLACES.iter().find(|known| **known == array).unwrap_or_else(|| panic!("unknown place {place}"))
            }
        },
        Err(error) => panic!("not an invalid scene: {error}"),
    }
}

fn run(seed: u64, inputs: u64) -> BTreeMap<&'static str, u64> {
    let mut sound = Vec::new();
    tiny().bake(&mut sound).unwrap();
    let mut outcomes = BTreeMap::new();
    for number in 0..inputs {
        // A seed of its own for each input, so that one can be repeated by itself.
        let mut random = Random(seed.wrapping_mul(0x1000_0000_01b3).wrapping_add(number));
        let bytes = mutate(&mut random, &sound);
        let outcome = std::panic::catch_unwind(|| target(&bytes, number % 16 == 0));
        match outcome {
            Ok(outcome) => *outcomes.entry(outcome).or_insert(0) += 1,
            Err(_) => panic!("input {number} of seed {seed} panicked"),
        }
    }
    outcomes
}

#[test]
fn changed_files_are_scenes_or_errors() {
    let outcomes = run(0, 20_000);
    println!("{outcomes:?}");
    // Mutations reach every rule, and some leave a scene that is another one.
    for outcome in [
        "accepted",
        "drawn",
        "damaged",
        "view",
        "names",
        "triangles",
        "nodes",
        "leaf_triangles",
        "materials",
        "object_materials",
        "textures",
        "bounds",
        "epsilon",
    ] {
        assert!(outcomes.contains_key(outcome), "{outcome}: none of {outcomes:?}");
    }
}

#[test]
#[ignore = "long: half a million changed baked files"]
fn many_changed_files_are_scenes_or_errors() {
    let number = |name: &str, usual| std::env::var(name).map_or(usual, |text| text.parse().unwrap());
    let (seed, inputs) = (number("RAREFY_FUZZ_SEED", 1), number("RAREFY_FUZZ_INPUTS", 500_000));
    let outcomes = run(seed, inputs);
    println!("{inputs} inputs from seed {seed}: {outcomes:?}");
    assert_eq!(outcomes.values().sum::<u64>(), inputs);
}

#[test]
fn the_scene_that_is_changed_is_sound() {
    assert_eq!(tiny().shading(), Shading::Full);
    let mut sound = Vec::new();
    tiny().bake(&mut sound).unwrap();
    assert_eq!(target(&sound, true), "drawn");
}
