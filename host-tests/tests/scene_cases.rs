// SPDX-License-Identifier: MIT OR Apache-2.0
//! Files as people have them (`host-tests/cases`): the picture shows what was meant, and a warning says what was mended.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;
use rarefy::Monitor;
use rarefy::internal::math::unpack_normal;
use rarefy::internal::method::options::Mode;
use rarefy::internal::scene::{self, LoadOptions, Material, Scene};
use rarefy_host_tests::command::root;
use rarefy_host_tests::fixtures::{draw, options, twin_renderer};

fn load(case: &str) -> Scene {
    scene::load(&root().join("host-tests/cases").join(case), &Monitor::default()).unwrap()
}

fn first_material(scene: &Scene) -> &Material {
    &scene.materials()[scene.objects()[0].material as usize]
}

/// The one warning has each of `parts`.
#[track_caller]
fn warned_once(scene: &Scene, parts: &[&str]) {
    let warnings = scene.warnings();
    assert!(warnings.len() == 1 && parts.iter().all(|p| warnings[0].contains(p)), "{parts:?}: {warnings:#?}");
}

#[test]
fn textures_are_found_where_they_are() {
    for (case, parts) in [
        ("01a-abs-win-path", ["C:/textures/duck.png", "01a-abs-win-path/duck.png is used"]),
        ("01b-abs-win-backslash", ["C:\\Users\\me\\textures\\duck.png", "01b-abs-win-backslash/duck.png is used"]),
        ("01c-abs-unix-path", ["/home/me/textures/duck.png: ", "01c-abs-unix-path/duck.png is used"]),
        ("01d-stale-subfolder", ["../../project/tex/duck.png: ", "01d-stale-subfolder/duck.png is used"]),
        ("02e-case-differs", ["Textures/DUCK.PNG: ", "02e-case-differs/textures/duck.png is used"]),
        ("02f-mtllib-case", ["scene.obj:1: MTL file `Scene.MTL`", "02f-mtllib-case/scene.mtl is used"]),
        ("02g-trailing-comment", ["duck.png # diffuse: ", "02g-trailing-comment/duck.png is used"]),
        ("02h-usemtl-comment", ["scene.obj:11: ", "material `m # red`; `m` is meant"]),
        ("02m-mtllib-abs", ["scene.obj:1: MTL file `D:\\proj\\a.mtl`", "02m-mtllib-abs/a.mtl is used"]),
    ] {
        let scene = load(case);
        warned_once(&scene, &parts);
        let texture = &scene.textures()[first_material(&scene).diffuse_texture.unwrap() as usize];
        assert_eq!((texture.width, texture.height), (8, 8), "{case}");
    }
    let quoted = load("02d-quoted");
    assert!(quoted.warnings()[0].contains("MTL file `\"test file.mtl\"`") && quoted.warnings().len() == 2);
    assert!(quoted.warnings()[1].contains("02d-quoted/test texture.png is used"));
    assert!(first_material(&quoted).diffuse_texture.is_some());
}

#[test]
fn a_bad_value_is_left_out_and_told() {
    for (case, parts) in [
        ("10i-illum-11", ["a.mtl:3: `illum`: `11`", "left out"]),
        ("10i-illum-2.0", ["a.mtl:3: `illum 2.0`", "taken for 2"]),
        ("13o-empty-map", ["a.mtl:3: `map_Kd`", "a file name is missing"]),
        ("13p-empty-map-d", ["a.mtl:3: `map_d`", "a file name is missing"]),
        ("15l-vn-nan", ["scene.obj:6: 1 normals", "computed instead"]),
        ("15n-vn-inf", ["scene.obj:5: 1 normals", "computed instead"]),
        ("15m-vt-nan", ["scene.obj:7: 1 texture coordinates", "taken as missing"]),
        ("21e-jpg-truncated", ["t.jpg: picture is damaged or cut short", "the plain colour is drawn"]),
        ("21m-jpg-half", ["t.jpg: picture is damaged or cut short", "the plain colour is drawn"]),
    ] {
        let scene = load(case);
        warned_once(&scene, &parts);
        let normals = scene.corner_normals().iter().flatten().map(|&n| unpack_normal(n));
        assert!(normals.into_iter().all(|n| n == Vec3::Z), "{case}");
    }
    let scene = load("14w-mtl-empty-file");
    assert!(scene.warnings()[0].contains("a.mtl: file is empty; its materials are drawn light grey"));
    assert_eq!(first_material(&scene).diffuse, Vec3::splat(0.7));
}

#[test]
fn a_sun_far_away_lights_the_scene() {
    let frame = draw(&mut twin_renderer(load("17-light-sun")), &options(Mode::Full, 32, 32, 2));
    // The ground in the middle is lit, and in the shadow of the green box it is not.
    let bright = |word: u32| word.to_le_bytes()[..3].iter().all(|&c| c > 150);
    let dark = |word: u32| word.to_le_bytes()[..3].iter().all(|&c| (60..130).contains(&c));
    assert!(frame.pixels.iter().any(|&p| bright(p)) && frame.pixels.iter().any(|&p| dark(p)));
}

#[test]
fn a_million_repeats_from_0_the_picture_is_the_same() {
    let far = load("23-uv-offset-1e6");
    let mut parts = far.clone().into_parts();
    // The file has 0 to 4 there, a million further on.
    let corners: Vec<f32> = parts.corner_texcoords.iter().flatten().flat_map(|t| t.to_array()).collect();
    assert!(corners.iter().all(|&c| c == 0.0 || c == 4.0), "{corners:?}");
    // Control: what single precision would have made of it.
    for t in parts.corner_texcoords.iter_mut().flatten() {
        *t += Vec3::splat(1.0e6).truncate();
    }
    let picture = |scene| draw(&mut twin_renderer(scene), &options(Mode::Full, 64, 64, 2)).pixels;
    assert_ne!(picture(Scene::new(parts).unwrap()), picture(far));
}

/// All files below a folder, by their names in it.
fn files_below(folder: &Path, prefix: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{prefix}{}", path.file_name().unwrap().to_str().unwrap());
        if path.is_dir() {
            files_below(&path, &format!("{name}/"), files);
        } else {
            files.insert(name, std::fs::read(&path).unwrap());
        }
    }
}

#[test]
fn memory_gives_the_same_scenes_with_the_same_warnings() {
    let cases = root().join("host-tests/cases");
    for case in cases.read_dir().unwrap() {
        let folder = case.unwrap().path();
        let mut files = BTreeMap::new();
        files_below(&folder, "", &mut files);
        let mut from_disk = scene::load(&folder, &Monitor::default()).unwrap().into_parts();
        let from_memory =
            scene::load_from("scene.obj", &files, &LoadOptions::default(), &Monitor::default()).unwrap().into_parts();
        // Names of places are relative to where the files are.
        let below = format!("{}/", folder.display());
        for warning in &mut from_disk.warnings {
            *warning = warning.replace(&below, "");
        }
        for key in &mut from_disk.notes.unused_keys {
            key.file = key.file.replace(&below, "");
        }
        from_disk.name = "scene".into();
        assert_eq!(from_disk, from_memory, "{}", folder.display());
    }
}
