// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs by deterministic mutation of seeds: the fuzz targets on a stable compiler, the same inputs in every run.

use std::path::PathBuf;

use crate::command::root;
use crate::fixtures::Random;

/// What files of text are made of, and numbers at the borders of ranges.
const WORDS: [&str; 72] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1",
    "1e39",
    "-1e39",
    "1e-45",
    "0.5",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "99999999999999999999",
    "-9223372036854775808",
    "/",
    "//",
    "\\\n",
    "\r",
    "\n",
    "\r\n",
    " ",
    "\t",
    "\0",
    "\u{feff}",
    "ü",
    "#",
    "[",
    "]",
    "{",
    "}",
    "\"",
    ",",
    ":",
    "null",
    "true",
    "[]",
    "{}",
    "f ",
    "v ",
    "vt ",
    "vn ",
    "g ",
    "o ",
    "s ",
    "usemtl ",
    "mtllib ",
    "newmtl ",
    "Kd ",
    "Ks ",
    "Ns ",
    "Ni ",
    "Tf ",
    "Tr ",
    "d ",
    "illum ",
    "map_Kd ",
    "map_d ",
    "-s ",
    "-o ",
    "-clamp ",
    "\"camera\"",
    "\"lights\"",
    "\"extent\"",
    "\"limits\"",
    "\"choices\"",
    "\"value\"",
];

/// The seeds of a target.
///
/// # Panics
/// If there are none.
pub fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = root().join("fuzz/seeds").join(target);
    let mut paths: Vec<PathBuf> = folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    paths.into_iter().map(|path| std::fs::read(path).unwrap()).collect()
}

/// A changed seed: one to six changes, such as other bytes, words, numbers, parts that are missing, twice there, or from
/// another seed.
pub fn mutated(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..1 + random.below(6) {
        change(random, &mut bytes, seeds);
    }
    // Some grow from change to change.
    bytes.truncate(1 << 16);
    bytes
}

/// A part of up to `most` bytes.
fn part(random: &mut Random, length: usize, most: usize) -> std::ops::Range<usize> {
    let start = random.below(length + 1);
    start..(start + random.below(most + 1)).min(length)
}

fn change(random: &mut Random, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
    let length = bytes.len();
    match random.below(8) {
        0 if length > 0 => bytes[random.below(length)] ^= 1 << random.below(8),
        1 if length > 0 => bytes[random.below(length)] = random.bits() as u8,
        2 => drop(bytes.drain(part(random, length, 12))),
        3 => drop(bytes.drain(part(random, length, length / 2))),
        4 => {
            let part = bytes[part(random, length, 200)].to_vec();
            let at = random.below(length + 1);
            bytes.splice(at..at, part);
        }
        5 => {
            let other = &seeds[random.below(seeds.len())];
            let part = other[part(random, other.len(), 200)].to_vec();
            let at = random.below(length + 1);
            bytes.splice(at..at, part);
        }
        6 => {
            // Another number or word in place of one.
            let at = random.below(length + 1);
            let is_space = |byte: &u8| matches!(byte, b' ' | b'\n' | b'/' | b',' | b':' | b']');
            let start = bytes[..at].iter().rposition(is_space).map_or(0, |space| space + 1);
            let end = bytes[start..].iter().position(is_space).map_or(length, |length| start + length);
            bytes.splice(start..end, WORDS[random.below(WORDS.len())].bytes());
        }
        _ => {
            let at = random.below(length + 1);
            bytes.splice(at..at, WORDS[random.below(WORDS.len())].bytes());
        }
    }
}
