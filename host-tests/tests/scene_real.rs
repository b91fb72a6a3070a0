// SPDX-License-Identifier: MIT OR Apache-2.0
//! The six real scenes, where they are at hand: they load whole, and what is said about them is true.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use rarefy::internal::scene::{self, Scene, Surface};

/// The folder of real scenes beside the repository, or `None` and a line that says so.
fn real_scenes() -> Option<PathBuf> {
    let here = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").into());
    let folder = Path::new(&here).join("../../shared/scenes");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: ../shared/scenes is not here");
    None
}

fn load(folder: &Path, name: &str) -> Scene {
    scene::load(&folder.join(name), &rarefy::Monitor::default()).unwrap()
}

fn material<'a>(scene: &'a Scene, name: &str) -> &'a scene::Material {
    scene.materials().iter().find(|m| m.name == name).unwrap()
}

#[test]
fn all_six_load_whole() {
    let Some(folder) = real_scenes() else { return };
    for (name, triangles, groups, textures) in [
        ("modern-hall", 28_615, 32, 3),
        ("figures", 64_672, 8, 0),
        ("classroom", 103_830, 79, 3),
        ("living-room", 142_971, 65, 5),
        ("bathroom", 379_850, 853, 7),
        ("kitchen", 1_050_505, 289, 11),
    ] {
        let scene = load(&folder, name);
        println!("{name}: {:?} {:#?}", scene.notes(), scene.warnings());
        assert_eq!(scene.name(), name);
        assert_eq!(scene.triangles().len() + scene.notes().dropped_triangles, triangles, "{name}");
        assert_eq!(scene.objects().len(), groups, "{name}");
        assert_eq!(scene.textures().len(), textures, "{name}");
        for lengths in [scene.corner_normals().len(), scene.corner_texcoords().len(), scene.triangle_objects().len()] {
            assert_eq!(lengths, scene.triangles().len(), "{name}");
        }
        assert!(scene.triangles().iter().flatten().all(|&v| (v as usize) < scene.positions().len()));
        assert!(scene.notes().missing_textures.is_empty() && scene.notes().extent_given);
    }
}

#[test]
fn surfaces_follow_the_lists_of_the_view() {
    let Some(folder) = real_scenes() else { return };
    let bathroom = load(&folder, "bathroom");
    assert_eq!(material(&bathroom, "BulbGlass").surface, Surface::ThinGlass);
    assert_eq!(material(&bathroom, "Mirror").surface, Surface::Mirror);
    let living_room = load(&folder, "living-room");
    assert_eq!(material(&living_room, "Glass").surface, Surface::Glass);
    assert_eq!(material(&living_room, "FireplaceGlass").surface, Surface::Mirror);
    let mask = material(&living_room, "Leaves").cutout_texture.unwrap();
    let texels = &living_room.textures()[mask as usize].texels;
    let holes = texels.iter().filter(|t| (**t >> 24) < 128).count();
    assert!(holes * 10 > texels.len() && holes * 10 < texels.len() * 9, "{holes} of {} texels are holes", texels.len());
}

#[test]
fn the_doctor_finds_what_is_known_about_the_scenes() {
    let Some(folder) = real_scenes() else { return };
    let findings = |name: &str| {
        let findings = scene::doctor::examine(&load(&folder, name));
        println!("{name}");
        for f in &findings {
            println!("  {:?} {}: {}", f.severity, f.topic, f.message);
        }
        findings
    };
    let says = |findings: &[scene::doctor::Finding], topic: &str, words: &str| {
        findings.iter().any(|f| f.topic == topic && f.message.contains(words))
    };
    // The classroom's ground plane (Mesh035) reaches out to 110 m.
    let classroom = findings("classroom");
    assert!(says(&classroom, "extent", "`Mesh035`") && says(&classroom, "triangles", "`Mesh035`"));
    let kitchen = findings("kitchen");
    assert!(says(&kitchen, "normals", "(100.0 %)"));
    assert!(!says(&kitchen, "extent", ""));
    for name in ["modern-hall", "figures", "living-room", "bathroom"] {
        assert!(!findings(name).is_empty());
    }
}
