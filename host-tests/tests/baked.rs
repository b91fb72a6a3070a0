// SPDX-License-Identifier: MIT OR Apache-2.0
//! Baked scenes: the picture stays what it was, and whatever is wrong with a file is an error with its place.
#![allow(clippy::unwrap_used, missing_docs)]

use std::io::Cursor;
use std::sync::Arc;

use rarefy::{
    Cancel, DeviceChoice, DeviceOptions, Error, Keep, Monitor, PreparedScene, RenderOptions, Renderer, Shading, builtin,
};
use rarefy_host_tests::baked::{Field, Part, parts, reseal, tiny};
use rarefy_host_tests::command::{rarefy_in, root};

fn bytes_of(scene: &PreparedScene) -> Vec<u8> {
    let mut bytes = Vec::new();
    scene.bake(&mut bytes).unwrap();
    bytes
}

fn read(bytes: &[u8]) -> rarefy::Result<PreparedScene> {
    PreparedScene::from_baked(bytes, &Monitor::default())
}

fn message(bytes: &[u8]) -> String {
    match read(bytes) {
        Ok(_) => panic!("accepted"),
        Err(error @ Error::InvalidScene { .. }) => error.to_string(),
        Err(error) => panic!("not an invalid scene: {error}"),
    }
}

fn picture(scene: PreparedScene) -> Vec<u32> {
    let options = DeviceOptions { device: DeviceChoice::Cpu, ..DeviceOptions::default() };
    let mut renderer = Renderer::new(Arc::new(scene), &options, &Monitor::default()).unwrap();
    let size = RenderOptions { width: 61, height: 47, ..RenderOptions::default() };
    renderer.render(&size, Keep::default()).unwrap().pixels
}

fn prepared(name: &str, shading: Shading) -> PreparedScene {
    PreparedScene::new(&builtin(name).unwrap(), shading, &Monitor::default()).unwrap()
}

#[test]
fn a_baked_scene_is_the_scene_and_draws_its_picture() {
    // Glass, mirrors, holes and textures among them.
    for (name, shading) in [
        ("cafe", Shading::Full),
        ("spheres", Shading::Full),
        ("rods", Shading::Full),
        ("mirror-room", Shading::Full),
        ("spheres", Shading::Anchor),
    ] {
        let scene = prepared(name, shading);
        let bytes = bytes_of(&scene);
        let back = read(&bytes).unwrap();
        assert_eq!(back.name(), name);
        assert_eq!(back.view(), scene.view());
        assert_eq!(back.shading(), shading);
        assert_eq!(back.object_names(), scene.object_names());
        assert!(!back.object_names().is_empty());
        assert_eq!(back.bytes(), scene.bytes());
        assert_eq!(back.tree().statistics(), scene.tree().statistics());
        assert_eq!(bytes_of(&back), bytes, "{name}: baked again");
        assert_eq!(picture(back), picture(scene), "{name}");
    }
    assert_ne!(bytes_of(&prepared("spheres", Shading::Full)), bytes_of(&prepared("spheres", Shading::Anchor)));
}

#[test]
fn a_file_of_version_3_stays_readable() {
    // If this fails because nodes or structs changed, the format needs another version, and this test another file.
    let path = root().join("host-tests/golden/tiny-version-3.baked");
    if std::env::var_os("RAREFY_BLESS").is_some() {
        std::fs::write(&path, bytes_of(&tiny())).unwrap();
    }
    let kept = std::fs::read(&path).unwrap();
    assert_eq!(bytes_of(&tiny()), kept, "to renew: RAREFY_BLESS=1 cargo test -p rarefy-host-tests --test baked");
    assert_eq!(picture(read(&kept).unwrap()), picture(tiny()));
}

#[test]
fn a_scene_is_read_from_the_middle_of_a_larger_file() {
    let bytes = bytes_of(&tiny());
    let length = bytes.len() as u64;
    for (before, after) in [(0, 0), (1, 0), (4097, 33), (3, 100_000)] {
        let whole = [vec![0xa5u8; before], bytes.clone(), vec![0x5a; after]].concat();
        let mut file = Cursor::new(whole);
        let read = |file: &mut Cursor<Vec<u8>>, offset: usize, length: u64| {
            PreparedScene::from_baked_part(file, offset as u64, length, &Monitor::default())
        };
        let scene = read(&mut file, before, length).unwrap();
        assert_eq!(file.position(), before as u64 + length, "nothing behind it is read");
        assert_eq!(bytes_of(&scene), bytes);
        assert!(read(&mut file, before + 1, length).is_err());
        for wrong in [0, 1, 31, 32, length - 1, length + 1, u64::MAX] {
            assert!(read(&mut file, before, wrong).is_err(), "{wrong} bytes at {before}");
        }
    }
}

#[test]
fn a_file_that_is_cut_off_anywhere_is_refused() {
    let bytes = bytes_of(&tiny());
    for length in 0..bytes.len() {
        let said = message(&bytes[..length]);
        assert!(said.starts_with("baked scene: this "), "{said}");
        // The same when the length is that of the file, but the data are not there.
        let mut cut = Cursor::new(&bytes[..length]);
        assert!(PreparedScene::from_baked_part(&mut cut, 0, bytes.len() as u64, &Monitor::default()).is_err());
    }
    assert!(message(&[&bytes[..], &[0]].concat()).contains("damaged"));
}

#[test]
fn every_byte_that_changes_is_noticed() {
    let mut bytes = bytes_of(&tiny());
    for at in 0..bytes.len() {
        for change in [1, 0x80, 0xff] {
            bytes[at] ^= change;
            assert!(read(&bytes).is_err(), "byte {at} changed by {change:#x}");
            bytes[at] ^= change;
        }
    }
    assert!(read(&bytes).is_ok());
}

#[test]
fn another_version_and_other_files_are_told_apart() {
    let mut bytes = bytes_of(&tiny());
    bytes[16] = 7;
    let said = message(&bytes);
    assert!(said.contains("has version 7, this Rarefy reads version 3; bake it again"), "{said}");
    for other in [&b"v 0 0 0\nv 1 0 0\n"[..], b"", b"rarefy baked", b"rarefy baked\n\x1a\n and more of them that are"] {
        assert!(message(other).contains("this is no baked scene"), "{other:?}");
        assert!(!PreparedScene::is_baked(other));
    }
    assert!(PreparedScene::is_baked(&bytes[..16]));
}

/// Changes a word of an array of the tiny scene, with a checksum that is right, and returns what is said.
fn with(part: Part, index: usize, field: usize, value: u32) -> String {
    let mut bytes = bytes_of(&tiny());
    let at = parts(&bytes)[part as usize].word(index, field);
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
    reseal(&mut bytes);
    message(&bytes)
}

#[test]
fn every_rule_is_checked_behind_the_checksum() {
    let nan = f32::NAN.to_bits();
    let float = f32::to_bits;
    let nodes = tiny().tree().nodes.clone();
    let leaf = (0..nodes.len()).find(|&i| i != 1 && nodes[i].is_leaf() && nodes[i].payload() > 1).unwrap();
    let inner = (0..nodes.len()).rev().find(|&i| i != 1 && !nodes[i].is_leaf()).unwrap();
    let axis = nodes[inner].axis();
    for (said, at) in [
        (with(Part::Head, 0, Field::SHADING, 2), "there is no shading 2"),
        (with(Part::Head, 0, Field::EYE, nan), "view: camera.eye"),
        (with(Part::Head, 0, Field::FOV, float(180.0)), "view: camera.fov_y_degrees"),
        (with(Part::Head, 0, Field::AMBIENT, float(-1.0)), "view: ambient"),
        (with(Part::Head, 0, Field::EXTENT, 0), "view: extent"),
        (with(Part::Head, 0, Field::EPSILON, 0), "epsilon: 0"),
        (with(Part::Head, 0, Field::EPSILON, nan), "epsilon: NaN"),
        (with(Part::Head, 0, Field::BOUNDS, nan), "bounds: "),
        (with(Part::Head, 0, Field::BOUNDS, float(3.0e38)), "bounds: "),
        (with(Part::Head, 0, Field::ORIGIN + 1, 0x7ff0_0000), "origin: "),
        (with(Part::Head, 0, Field::LIGHTS, 33), "its counts do not come to"),
        (with(Part::Lights, 0, 2, nan), "view: lights[0].position"),
        (with(Part::Lights, 0, 3, float(-1.0)), "view: lights[0].intensity"),
        (with(Part::Nodes, inner, 0, nan), "is not between"),
        (with(Part::Nodes, inner, 0, float(1.0e9)), "is not between"),
        (with(Part::Nodes, inner, 1, (inner as u32 & !1) << 2 | axis), "are no pair behind it"),
        (with(Part::Nodes, inner, 1, (nodes[inner].payload() + 1) << 2 | axis), "are no pair behind it"),
        (with(Part::Nodes, inner, 1, 0xffff_fffc | axis), "are no pair behind it"),
        (with(Part::Nodes, leaf, 0, u32::MAX), &format!("nodes[{leaf}]: ")),
        (with(Part::Nodes, leaf, 1, u32::MAX), &format!("nodes[{leaf}]: ")),
        (with(Part::Nodes, leaf, 1, (nodes[leaf].payload() - 1) << 2 | 3), "leaf_triangles: leaves have"),
        (
            with(Part::LeafTriangles, nodes[leaf].split_or_first as usize, 0, u32::MAX),
            "do not ascend, or are not below",
        ),
        (with(Part::LeafTriangles, nodes[leaf].split_or_first as usize + 1, 0, u32::MAX), "do not ascend"),
        (with(Part::Triangles, 1, 0, nan), "triangles[1]: its corner"),
        (with(Part::Triangles, 1, 3, 1), "triangles[1].flags"),
        (with(Part::Triangles, 1, 3, 3 << 8), "triangles[1]: its plane has no axis 3"),
        (with(Part::Triangles, 1, 4, float(f32::INFINITY)), "triangles[1]: its corner"),
        (with(Part::Triangles, 1, 9, nan), "triangles[1]: its corner"),
        (with(Part::Triangles, 1, 7, float(1.5)), "triangles[1]: the slopes"),
        (with(Part::Triangles, 1, 11, nan), "triangles[1]: the slopes"),
        (with(Part::TriangleShading, 2, 3, 99), "triangles[2].object: there is no object 99"),
        (with(Part::TriangleShading, 2, 4, nan), "triangles[2].texcoords"),
        (with(Part::TriangleShading, 2, 10, u32::MAX), "triangles[2].material"),
        (with(Part::Materials, 0, 0, nan), "materials[0].diffuse"),
        (with(Part::Materials, 0, 3, float(-1.0)), "materials[0].shininess"),
        (with(Part::Materials, 0, 7, float(0.5)), "materials[0].index_of_refraction"),
        (with(Part::Materials, 0, 11, float(2.0)), "materials[0].own"),
        (with(Part::Materials, 0, 12, float(-0.5)), "materials[0].transmission"),
        (with(Part::Materials, 0, 16, float(-0.5)), "materials[0].emission"),
        (with(Part::Materials, 0, 20, 4), "materials[0].surface"),
        (with(Part::Materials, 0, 21, 77), "materials[0].diffuse_texture"),
        (with(Part::Materials, 0, 22, 77), "materials[0].cutout_texture"),
        (with(Part::ObjectMaterials, 0, 0, 77), "object_materials[0]: there is no material 77"),
        (with(Part::Textures, 0, 0, u32::MAX), "textures[0]: it ends at texel"),
        (with(Part::Textures, 0, 1, 0), "textures[0]: 0x"),
        (with(Part::Textures, 0, 2, 16385), "x16385 texels"),
        (with(Part::NameLengths, 0, 0, u32::MAX), "do not have the lengths"),
    ] {
        assert!(said.contains(at), "`{at}` is not in: {said}");
        assert!(said.starts_with("baked scene"), "{said}");
    }
    // The root becomes an empty leaf.
    let mut bytes = bytes_of(&tiny());
    let root = parts(&bytes)[Part::Nodes as usize].word(0, 0);
    bytes[root..root + 8].copy_from_slice(&[0, 0, 0, 0, 3, 0, 0, 0]);
    reseal(&mut bytes);
    let said = message(&bytes);
    assert!(said.contains(&format!("nodes: 2 of {} belong to the tree", nodes.len())), "{said}");
    // The last byte belongs to a name.
    let mut bytes = bytes_of(&tiny());
    *bytes.last_mut().unwrap() = 0xff;
    reseal(&mut bytes);
    assert!(message(&bytes).contains("no UTF-8"));
}

#[test]
fn reading_can_be_cancelled_and_failing_writers_are_told() {
    let bytes = bytes_of(&tiny());
    let cancel = Cancel::default();
    cancel.cancel();
    let monitor = Monitor::default().with_cancel(&cancel);
    assert!(matches!(PreparedScene::from_baked(&bytes, &monitor), Err(Error::Cancelled)));
    let mut full = [0u8; 100];
    assert!(matches!(tiny().bake(&mut &mut full[..]), Err(Error::Io { .. })));
}

#[test]
fn the_command_bakes_and_draws_what_it_baked() {
    let folder = tempfile::tempdir().unwrap();
    let rarefy = |arguments: &[&str]| rarefy_in(folder.path(), arguments, &[]);
    let baked = rarefy(&["bake", "rods", "-o", "rods.baked"]).expect(0);
    assert!(baked.stdout.starts_with("rods.baked: ") && baked.stdout.contains("full shading"), "{}", baked.stdout);
    let draw = |scene: &str, output: &str| {
        rarefy(&["render", scene, "--size", "60x50", "--device", "cpu", "-o", output]).expect(0);
        std::fs::read(folder.path().join(output)).unwrap()
    };
    assert_eq!(draw("rods.baked", "a.png"), draw("rods", "b.png"));
    // Baked again it is the same file; nothing is left beside the results.
    rarefy(&["bake", "rods.baked", "-o", "again.baked"]).expect(0);
    let file = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(file("again.baked"), file("rods.baked"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4);
    rarefy(&["render", "rods.baked", "--shading", "anchor"]).expect_error(&["--shading", "rods.baked", "`full`"]);
    rarefy(&["bake", "rods.baked", "-o", "rods.baked"]).expect_error(&["-o", "read by the same command"]);
    // The doctor counts the same as in the scene itself.
    let counts = |scene: &str| {
        let said = rarefy(&["doctor", scene]).expect(0).stdout;
        said.lines().next().unwrap().rsplit_once(": ").unwrap().1.to_owned()
    };
    rarefy(&["bake", "spheres", "-o", "spheres.baked"]).expect(0);
    for scene in ["rods", "spheres"] {
        assert_eq!(counts(&format!("{scene}.baked")), counts(scene));
    }
    assert!(!counts("spheres").contains(" 0 textures"));
    let said = rarefy(&["doctor", "rods.baked"]).expect(0).stdout;
    assert!(said.starts_with("rods: baked, version 3 of the format, full shading: "), "{said}");
    let json = rarefy(&["doctor", "rods.baked", "--json", "-"]).expect(0).stdout;
    assert!(json.contains("\"baked_version\": 3"), "{json}");
    let mut broken = file("rods.baked");
    broken.truncate(5000);
    std::fs::write(folder.path().join("broken.baked"), broken).unwrap();
    for command in ["render", "doctor"] {
        rarefy(&[command, "broken.baked"]).expect_error(&["broken.baked: this baked scene is damaged", "5000 bytes"]);
    }
}
