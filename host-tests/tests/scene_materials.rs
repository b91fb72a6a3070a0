// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files as exporters write them (`host-tests/cases`): do materials stay what they are meant to be, and is every key that
//! is not used told?
#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use rarefy::Monitor;
use rarefy::internal::method::options::Mode;
use rarefy::internal::scene::doctor::{Finding, Severity, examine, notices};
use rarefy::internal::scene::{self, Scene, Surface};
use rarefy_host_tests::command::{rarefy_in, root};
use rarefy_host_tests::fixtures::{draw, options, twin_renderer};

const SIZE: u32 = 64;

fn case(name: &str) -> PathBuf {
    root().join("host-tests/cases").join(name)
}

fn load(name: &str) -> Scene {
    scene::load(&case(name), &Monitor::default()).unwrap()
}

/// The sRGB bytes of some pixels of the case's picture, traced in full.
fn pixels<const N: usize>(name: &str, at: [(u32, u32); N]) -> [[u8; 3]; N] {
    let frame = draw(&mut twin_renderer(load(name)), &options(Mode::Full, SIZE, SIZE, 2));
    at.map(|(x, y)| {
        let [r, g, b, _] = frame.pixels[(y * SIZE + x) as usize].to_le_bytes();
        [r, g, b]
    })
}

fn middle(name: &str) -> [u8; 3] {
    pixels(name, [(SIZE / 2, SIZE / 2)])[0]
}

#[track_caller]
fn is_coloured(found: [u8; 3], what: &str, holds: impl Fn(i32, i32, i32) -> bool) {
    let [r, g, b] = found.map(i32::from);
    assert!(holds(r, g, b), "{what} is not what this pixel is: {found:?}");
}

#[track_caller]
fn noticed(name: &str, words: &[&str]) {
    let lines = notices(&load(name));
    assert!(words.iter().all(|w| lines.iter().any(|l| l.contains(w))), "{words:?} are not in {lines:#?}");
}

#[track_caller]
fn found(name: &str, severity: Severity, topic: &str, words: &str) {
    let findings = examine(&load(name));
    let fits = |f: &Finding| f.severity == severity && f.topic == topic && f.message.contains(words);
    assert!(findings.iter().any(fits), "no {severity:?} about {topic} with `{words}`: {findings:#?}");
}

/// The quarters of the four-coloured picture.
const QUARTERS: [(u32, u32); 4] = [(20, 20), (44, 20), (20, 44), (44, 44)];

#[track_caller]
fn shows_the_picture(name: &str) {
    let [red, green, blue, yellow] = pixels(name, QUARTERS);
    is_coloured(red, "red", |r, g, b| r > 2 * g && r > 2 * b && r < 255);
    is_coloured(green, "green", |r, g, b| g > 2 * r && g > 2 * b && g < 255);
    is_coloured(blue, "blue", |r, g, b| b > 2 * r && b > 2 * g && b < 255);
    is_coloured(yellow, "yellow", |r, g, b| r > 2 * b && g > 2 * b && r < 255);
}

#[test]
fn ordinary_materials_of_maya_and_cinema_4d_are_seen() {
    // Behind each is a magenta wall, which glass would show.
    shows_the_picture("10a-maya-illum4");
    is_coloured(middle("10b-maya-illum4-kd"), "red", |r, g, b| r > g + 50 && (g - b).abs() < 3);
    is_coloured(middle("10c-c4d-illum7"), "yellow", |r, g, b| r > b + 50 && g > b + 50);
    for name in ["10a-maya-illum4", "10b-maya-illum4-kd", "10c-c4d-illum7"] {
        noticed(name, &["1 opaque (illum asks for glass, no other key does", "`m`"]);
    }
    // A glass body with no colour and an index of refraction stays one, and is told.
    let glass = load("30a-glass-on-floor-coplanar");
    assert!(glass.materials().iter().any(|m| m.name == "box" && m.surface == Surface::Glass));
    noticed("30a-glass-on-floor-coplanar", &["1 glass (illum asks for glass, Ni is above 1", "`box`"]);
}

#[test]
fn highlights_that_are_none_leave_the_colour() {
    for name in ["11a-Ks1-Ns0", "11c-illum1-Ks1-Ns0"] {
        is_coloured(middle(name), "brown", |r, g, b| r > g + 5 && g > b + 5 && r < 250);
    }
    noticed("11a-Ks1-Ns0", &["Ns below 1 is no highlight"]);
    noticed("11c-illum1-Ks1-Ns0", &["illum 0 and 1 have no highlight"]);
    shows_the_picture("12a-Tr1-meshlab");
    noticed("12a-Tr1-meshlab", &["Tr 1 without d is taken for solid, as MeshLab means it"]);
}

#[test]
fn a_surface_shines_as_its_ke_says() {
    // Black but for its own light.
    assert_eq!(middle("11e-Ke"), [255; 3]);
    noticed("11e-Ke", &["Ke: it shines, but lights nothing else; place lights in view.json (`m`)"]);
    // The picture that says where it shines is not read: better dark than bright all over, and it is told.
    assert_eq!(middle("11h-map_Ke"), [0; 3]);
    noticed("11h-map_Ke", &["Ke with map_Ke is not used", "not used: `map_Ke` (line 4)"]);
}

#[test]
fn a_texture_shows_in_any_letter_case_and_at_kd_0() {
    shows_the_picture("11f-Kd0-map");
    noticed("11f-Kd0-map", &["Kd 0 with a texture"]);
    shows_the_picture("02r-map_kd-lowercase");
    is_coloured(middle("15c-uppercase-keys"), "red", |r, g, b| r > 100 && g == 0 && b == 0);
}

#[test]
fn alpha_and_map_opacity_cut_out() {
    for (name, because) in [("04b-kd-alpha", "map_Kd's alpha"), ("04e-map_opacity", "map_d")] {
        let frame = draw(&mut twin_renderer(load(name)), &options(Mode::Full, SIZE, SIZE, 2));
        let row = |y: u32| (0..SIZE).map(move |x| frame.pixels[(y * SIZE + x) as usize].to_le_bytes());
        let changes = |row: Vec<bool>| row.windows(2).filter(|w| w[0] != w[1]).count();
        // Through the middle of a row of holes: leaf and wall in turn.
        let most = (0..SIZE)
            .map(|y| {
                changes(
                    row.clone()(y).map(|[r, g, b, _]| g > r.saturating_add(30) && g > b.saturating_add(30)).collect(),
                )
            })
            .max();
        assert!(most.unwrap() >= 6, "{name}: no row has holes");
        noticed(name, &["1 cut-out", because, "`leaf`"]);
    }
    noticed("04e-map_opacity", &["not used: `map_Tr` (line 4)"]);
}

#[test]
fn keys_that_are_not_used_are_told_once_with_their_line() {
    noticed(
        "14zz-bump-pbr",
        &["`map_Bump` (line 3), `norm` (line 4), `map_Ks` (line 5), `Pr` (line 6), `Pm` (line 7), `map_Pm` (line 8)"],
    );
    noticed("11g-map_Ka-only", &["`map_Ka` (line 3)"]);
    noticed("15h-vertex-colours", &["scene.obj: not used: `vertex colours` (4 times from line 2)"]);
    noticed("15k-zbrush-mrgb", &["scene.obj: not used: `#MRGB` (line 5)"]);
    found("14zz-bump-pbr", Severity::Note, "keys", "`norm` (line 4) is not used: surfaces are as smooth");
    // Nothing is said where nothing is left over.
    assert_eq!(notices(&load("02r-map_kd-lowercase")), [""; 0]);
}

#[test]
fn smoothing_groups_steer_the_shading() {
    // Across a tube of 8 sides in one group brightness changes by little from pixel to pixel; across one of 24 flat
    // sides it has steps.
    let steps = |name: &str| {
        let frame = draw(&mut twin_renderer(load(name)), &options(Mode::Full, SIZE, SIZE, 2));
        let row: Vec<i32> = (0..SIZE).map(|x| (frame.pixels[(32 * SIZE + x) as usize] & 255) as i32).collect();
        let inside = &row[12..52];
        let flat = inside.windows(2).filter(|w| (w[1] - w[0]).abs() <= 1).count();
        let largest = inside.windows(2).map(|w| (w[1] - w[0]).abs()).max().unwrap();
        (largest, flat)
    };
    let (largest, _) = steps("60a-s1-8sides");
    assert!(largest < 12, "a step of {largest}");
    let (largest, flat) = steps("60c-soff-24");
    assert!(largest > 12 && flat > 20, "steps of at most {largest}, {flat} pixels alike");
    found("60c-soff-24", Severity::Note, "normals", "48 of them by smoothing groups");
}

#[test]
fn the_doctor_counts_faces_that_cover_each_other() {
    found(
        "61-sketchup-two-sided",
        Severity::Note,
        "overlaps",
        "2 pairs of triangles (first in `f` and `b`) are the two sides of one sheet: each is seen from its front",
    );
    found(
        "31a-decal-coplanar",
        Severity::Warning,
        "overlaps",
        "(first in `wall` and `decal`) cover each other in one plane",
    );
    found("30a-glass-on-floor-coplanar", Severity::Note, "overlaps", "`floor` and `box`) touch, and one is glass");
    let clean = examine(&load("10b-maya-illum4-kd"));
    assert!(clean.iter().all(|f| f.topic != "overlaps"), "{clean:#?}");
}

#[test]
fn render_says_it_in_lines_on_standard_error() {
    let picture = tempfile::tempdir().unwrap();
    let out = picture.path().join("p.png");
    let (name, out) = (case("12a-Tr1-meshlab"), out.to_str().unwrap().to_owned());
    let draw = ["render", name.to_str().unwrap(), "--device", "cpu", "--size", "32x32", "-o", &out];
    let run = rarefy_in(picture.path(), &draw, &[]).expect(0);
    let notes: Vec<&str> = run.stderr.lines().collect();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("note: materials, not as written: Ns below 1"), "{notes:?}");
}
