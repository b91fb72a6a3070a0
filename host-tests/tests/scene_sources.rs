// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the files of a scene come from: memory, folders with odd names, files that nobody should trust; and what they may
//! cost.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rarefy::internal::monitor::{Cancel, Monitor};
use rarefy::internal::scene::{self, LoadOptions, Scene, builtin};
use rarefy::{Error, Result};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const VIEW: &str = r#"{"camera": {"eye": [0,0,5], "look_at": [0,0,0]}, "extent": 1, "lights": []}"#;

fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let picture = image::RgbImage::from_raw(1, 1, vec![255, 0, 0]).unwrap();
    picture.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

type Files = BTreeMap<String, Vec<u8>>;

fn files(list: &[(&str, &[u8])]) -> Files {
    let mut files: Files = list.iter().map(|&(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    files.entry("view.json".into()).or_insert(VIEW.into());
    files
}

fn load_from(files: &Files, options: &LoadOptions) -> Result<Scene> {
    scene::load_from("scene.obj", files, options, &Monitor::default())
}

#[test]
fn the_cafe_from_memory_is_the_cafe_from_its_folder() {
    let base = tempfile::tempdir().unwrap();
    let folder = base.path().join("cafe");
    builtin::write("cafe", &folder).unwrap();
    let from_folder = scene::load(&folder, &Monitor::default()).unwrap();
    // A closure that knows names only, as an Android asset manager does.
    let open = |name: &str| {
        let inner = name.strip_prefix("assets/cafe/").unwrap_or_else(|| panic!("asked for {name}"));
        Ok(fs::read(folder.join(inner)).ok())
    };
    for name in ["assets/cafe", "assets/cafe/scene.obj"] {
        let mut parts =
            scene::load_from(name, &open, &LoadOptions::default(), &Monitor::default()).unwrap().into_parts();
        assert_eq!(parts.name, if name.ends_with("obj") { "scene" } else { "cafe" });
        parts.name = "cafe".into();
        assert!(Scene::new(parts).unwrap() == from_folder);
    }
    let error = scene::load_from("assets/cafe/none.obj", &open, &LoadOptions::default(), &Monitor::default());
    assert!(error.unwrap_err().to_string().contains("assets/cafe/none.obj: no such file"));
}

#[test]
fn an_error_of_the_source_ends_loading_and_is_handed_on() {
    let open = |name: &str| match name {
        "scene.obj" => Ok(Some(format!("mtllib a.mtl\n{TRIANGLE}").into_bytes())),
        "a.mtl" => Err(Error::scene("archive", "is damaged")),
        _ => Ok(None),
    };
    let error = scene::load_from("scene.obj", &open, &LoadOptions::default(), &Monitor::default()).unwrap_err();
    assert_eq!(error.to_string(), "archive: is damaged");
}

/// Loads `scene/scene.obj` of a folder where these files lie.
fn load_disk(list: &[(&str, &[u8])], options: &LoadOptions) -> Scene {
    let base = tempfile::tempdir().unwrap();
    for (name, bytes) in list {
        let path = base.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    scene::load_with(&base.path().join("scene"), options, &Monitor::default()).unwrap()
}

const CONFINED: LoadOptions =
    LoadOptions { confined: true, max_texture_bytes: 1 << 20, max_face_corners: 1000, max_names: 1000 };

#[test]
fn a_confined_scene_reads_nothing_outside_its_folder() {
    let png = png();
    let obj = format!("mtllib ../m.mtl b.mtl\nusemtl a\n{TRIANGLE}usemtl b\nf 1 3 2\n");
    let list: [(&str, &[u8]); 6] = [
        ("scene/scene.obj", obj.as_bytes()),
        ("scene/view.json", VIEW.as_bytes()),
        ("m.mtl", b"newmtl a\nKd 1 0 0\n"),
        ("scene/b.mtl", b"newmtl b\nmap_Kd ../secret.png\nmap_d textures/own.png\n"),
        ("secret.png", &png),
        ("scene/textures/own.png", &png),
    ];
    let open = load_disk(&list, &LoadOptions::default());
    assert_eq!((open.textures().len(), open.warnings().len()), (2, 0), "{:?}", open.warnings());
    let confined = load_disk(&list, &CONFINED);
    assert_eq!(confined.textures().len(), 1);
    let told = |what: &str| confined.warnings().iter().filter(|w| w.contains(what)).count();
    assert_eq!(
        told("MTL file `../m.mtl` lies outside the scene's folder and may not be read"),
        1,
        "{:?}",
        confined.warnings()
    );
    assert_eq!(told("secret.png: texture lies outside the scene's folder and may not be read"), 1);
    assert!(confined.materials().iter().all(|m| m.diffuse.x != 1.0 || m.diffuse.y == 1.0), "m.mtl was read");
}

#[cfg(unix)]
#[test]
fn links_lead_a_confined_scene_nowhere() {
    let base = tempfile::tempdir().unwrap();
    let folder = base.path().join("scene");
    fs::create_dir(&folder).unwrap();
    fs::write(base.path().join("out.mtl"), "newmtl a\n").unwrap();
    fs::write(folder.join("in.mtl"), "newmtl a\n").unwrap();
    std::os::unix::fs::symlink("../out.mtl", folder.join("out.mtl")).unwrap();
    std::os::unix::fs::symlink("in.mtl", folder.join("link.mtl")).unwrap();
    for (name, is_read) in [("out.mtl", false), ("link.mtl", true), ("in.mtl", true)] {
        fs::write(folder.join("scene.obj"), format!("mtllib {name}\nusemtl a\n{TRIANGLE}")).unwrap();
        let scene = scene::load_with(&folder, &CONFINED, &Monitor::default()).unwrap();
        assert_eq!(!scene.warnings().iter().any(|w| w.contains("may not be read")), is_read, "{name}");
        let scene = scene::load(&folder, &Monitor::default()).unwrap();
        assert!(!scene.warnings().iter().any(|w| w.contains("MTL")), "{:?}", scene.warnings());
    }
    // The scene's own two files.
    fs::write(base.path().join("out.json"), VIEW).unwrap();
    std::os::unix::fs::symlink("../out.json", folder.join("view.json")).unwrap();
    scene::load(&folder, &Monitor::default()).unwrap();
    let message = scene::load_with(&folder, &CONFINED, &Monitor::default()).unwrap_err().to_string();
    assert!(message.contains("view.json: lies outside the scene's folder"), "{message}");
    fs::remove_file(folder.join("view.json")).unwrap();
    fs::rename(folder.join("scene.obj"), base.path().join("out.obj")).unwrap();
    std::os::unix::fs::symlink("../out.obj", folder.join("scene.obj")).unwrap();
    scene::load(&folder, &Monitor::default()).unwrap();
    let message = scene::load_with(&folder, &CONFINED, &Monitor::default()).unwrap_err().to_string();
    assert!(message.contains("scene.obj: lies outside the scene's folder"), "{message}");
}

#[test]
fn words_of_a_file_that_is_none_of_the_scenes_are_not_quoted() {
    let secret: &[u8] = b"newmtl a\nKd swordfish 1 1\nswordfish:x:0:0\nNs swordfish\n";
    for (mtllib, quoted) in [("../passwd", false), ("passwd", true)] {
        let obj = format!("mtllib {mtllib}\nusemtl a\n{TRIANGLE}");
        let inside = if quoted { "scene/passwd" } else { "passwd" };
        let scene = load_disk(&[("scene/scene.obj", obj.as_bytes()), (inside, secret)], &LoadOptions::default());
        let all = format!("{:?} {:?}", scene.warnings(), scene.notes());
        assert_eq!(all.contains("swordfish"), quoted, "{all}");
        assert!(quoted || all.contains("3 things are wrong or not used; not told"), "{all}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn names_need_not_be_utf_8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let base = tempfile::tempdir().unwrap();
    let folder = base.path().join(OsStr::from_bytes(b"caf\xe9"));
    fs::create_dir(&folder).unwrap();
    // In the file as in the file system, in Latin-1 or Shift-JIS; and in the file in Latin-1, in the file system in UTF-8.
    for (written, on_disk) in [
        (&b"t\xfcr.png"[..], &b"t\xfcr.png"[..]),
        (b"\x93\x79.png", b"\x93\x79.png"),
        (b"t\xfcr.png", "tür.png".as_bytes()),
        ("tür.png".as_bytes(), b"t\xfcr.png"),
        ("木.png".as_bytes(), "木.png".as_bytes()),
    ] {
        let mut obj = b"mtllib m\xe9.mtl\nusemtl a\n".to_vec();
        obj.extend_from_slice(TRIANGLE.as_bytes());
        fs::write(folder.join("scene.obj"), &obj).unwrap();
        fs::write(folder.join(OsStr::from_bytes(b"m\xe9.mtl")), [&b"newmtl a\nmap_Kd "[..], written].concat()).unwrap();
        let texture = folder.join(OsStr::from_bytes(on_disk));
        fs::write(&texture, png()).unwrap();
        let scene = scene::load(&folder, &Monitor::default()).unwrap();
        assert_eq!(scene.textures().len(), 1, "{:?}", scene.warnings());
        fs::remove_file(texture).unwrap();
    }
}

#[test]
fn control_characters_do_not_reach_messages() {
    let obj = format!("mtllib a\x1b[2J.mtl\nusemtl \x07bell\u{202e}\n{TRIANGLE}");
    let scene = load_from(&files(&[("scene.obj", obj.as_bytes())]), &LoadOptions::default()).unwrap();
    let all: Vec<String> =
        scene::doctor::examine(&scene).into_iter().map(|f| f.message).chain(scene.warnings().to_vec()).collect();
    assert!(all.iter().any(|w| w.contains(r"a\u{1b}[2J.mtl")) && all.iter().any(|w| w.contains(r"\u{7}bell\u{202e}")));
    assert!(!all.iter().any(|w| w.contains(char::is_control) || w.contains('\u{202e}')), "{all:?}");
    let bad = "v 0 0 0\nv 1 0 \x1b[31m\nv 0 1 0\nf 1 2 3\n";
    let error = load_from(&files(&[("scene.obj", bad.as_bytes())]), &LoadOptions::default()).unwrap_err().to_string();
    assert!(error.contains(r"\u{1b}[31m") && !error.contains(char::is_control), "{error}");
}

#[test]
fn each_budget_refuses_with_its_numbers_and_allows_the_most() {
    let names = |n: usize| (0..n).map(|i| format!("g {i}\nf 1 2 3\n")).collect::<String>();
    let corners = |n: usize| {
        let ring: String = (0..n).map(|i| (i as f32).sin_cos()).map(|(s, c)| format!("v {s} {c} 0\n")).collect();
        ring + "f" + &(1..=n).map(|i| format!(" {i}")).collect::<String>()
    };
    let textures = |n: usize| {
        let mtl: String = (0..n).map(|i| format!("newmtl {i}\nmap_Kd {i}.png\n")).collect();
        let mut all =
            files(&[("scene.obj", format!("mtllib m.mtl\n{TRIANGLE}").as_bytes()), ("m.mtl", mtl.as_bytes())]);
        all.extend((0..n).map(|i| (format!("{i}.png"), png())));
        all
    };
    let obj = |text: String| files(&[("scene.obj", text.as_bytes())]);
    let options = LoadOptions { max_texture_bytes: 3 << 2, max_face_corners: 50, max_names: 20, ..CONFINED };
    // The unnamed group counts.
    for (most, over, what) in [
        (obj(TRIANGLE.to_owned() + &names(19)), obj(TRIANGLE.to_owned() + &names(20)), "limit `names` allows 20"),
        (
            obj(corners(50)),
            obj(corners(51)),
            "scene.obj:52: a face needs 51 corners, the limit `corners of a face` allows 50",
        ),
        (textures(3), textures(4), "limit `texture memory` allows"),
    ] {
        load_from(&most, &options).unwrap();
        load_from(&over, &LoadOptions::default()).unwrap();
        let error = load_from(&over, &options).unwrap_err();
        assert!(matches!(error, Error::LimitExceeded { .. }) && error.to_string().contains(what), "{error}");
    }
    let view = |bytes: usize| {
        let mut all = files(&[("scene.obj", TRIANGLE.as_bytes())]);
        let mut text = VIEW.to_owned();
        text.extend(std::iter::repeat_n(' ', bytes - VIEW.len()));
        all.insert("view.json".into(), text.into_bytes());
        all
    };
    load_from(&view(1 << 20), &options).unwrap();
    let error = load_from(&view((1 << 20) + 1), &options).unwrap_err().to_string();
    assert!(error.contains("view.json needs 1048577 bytes"), "{error}");
    let nested = |depth: usize| {
        let mut all = files(&[("scene.obj", TRIANGLE.as_bytes())]);
        let notes = format!("{{\"notes\": {}{}, ", "[".repeat(depth), "]".repeat(depth));
        all.insert("view.json".into(), VIEW.replacen('{', &notes, 1).into_bytes());
        all
    };
    load_from(&nested(100), &options).unwrap();
    assert!(load_from(&nested(200), &options).unwrap_err().to_string().contains("recursion limit"));
}

#[test]
fn missing_textures_without_end_are_told_in_few_words_and_searched_for_in_few_places() {
    let count = 5000;
    let mtl: String =
        (0..count).map(|i| format!("newmtl {i}\nmap_Kd C:\\tex\\{i}.png\nmap_d C:\\tex\\{i}.png\n")).collect();
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let asked = AtomicUsize::new(0);
    let open = |name: &str| {
        asked.fetch_add(1, Ordering::Relaxed);
        Ok(match name {
            "scene.obj" => Some(obj.clone().into_bytes()),
            "m.mtl" => Some(mtl.clone().into_bytes()),
            _ => None,
        })
    };
    let scene = scene::load_from("scene.obj", &open, &LoadOptions::default(), &Monitor::default()).unwrap();
    assert_eq!(scene.notes().missing_textures.len(), count);
    assert!(scene.warnings().len() < 60, "{} warnings", scene.warnings().len());
    assert!(scene.warnings().iter().any(|w| w.contains("9950 more textures are missing")), "{:?}", scene.warnings());
    // Two spellings of each; and where else a thousand of them may be.
    let asked = asked.into_inner();
    assert!(asked < 2 * 2 * count + 1000 * 100, "asked for {asked} files");
}

#[test]
fn loading_ends_when_it_is_cancelled_between_textures() {
    let mtl: String = (0..100).map(|i| format!("newmtl {i}\nmap_Kd {i}.png\n")).collect();
    let obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let (cancel, asked) = (Cancel::default(), AtomicUsize::new(0));
    let open = |name: &str| {
        if name.ends_with(".png") {
            asked.fetch_add(1, Ordering::Relaxed);
            cancel.cancel();
        }
        Ok(match name {
            "scene.obj" => Some(obj.clone().into_bytes()),
            "m.mtl" => Some(mtl.clone().into_bytes()),
            _ => None,
        })
    };
    let monitor = Monitor::default().with_cancel(&cancel);
    let result = scene::load_from("scene.obj", &open, &LoadOptions::default(), &monitor);
    assert!(matches!(result, Err(Error::Cancelled)));
    assert_eq!(asked.into_inner(), 1);
}

#[test]
fn a_folder_that_is_named_like_a_texture_is_no_texture() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let list: [(&str, &[u8]); 3] =
        [("scene/scene.obj", obj.as_bytes()), ("scene/m.mtl", b"newmtl a\nmap_Kd a.png\n"), ("scene/a.png/b", b"")];
    let scene = load_disk(&list, &LoadOptions::default());
    assert!(scene.warnings().iter().any(|w| w.contains("a.png: texture not found; the plain colour is drawn")));
    assert!(scene::load(Path::new("/dev/null"), &Monitor::default()).is_err());
}
