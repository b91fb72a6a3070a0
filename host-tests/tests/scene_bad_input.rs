// SPDX-License-Identifier: MIT OR Apache-2.0
//! Broken and unusual scene files: each gives one message with place and remedy, or is drawn right.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use glam::{Vec2, Vec3};
use rarefy::internal::math::unpack_normal;
use rarefy::internal::scene::{self, Scene, Surface};
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const VIEW: &str = r#"{"camera": {"eye": [0,0,5], "look_at": [0,0,0], "up": [0,1,0], "fov_y_degrees": 45},
    "extent": 1, "lights": [{"position": [0,3,3], "intensity": 9}]}"#;

/// A scene folder with these files (name, contents).
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(dir.path().join(name), bytes).unwrap();
    }
    dir
}

fn load(files: &[(&str, &[u8])]) -> rarefy::Result<Scene> {
    scene::load(folder(files).path(), &rarefy::Monitor::default())
}

/// Loads `scene.obj` beside a good view.
fn load_obj(obj: impl AsRef<[u8]>) -> rarefy::Result<Scene> {
    load(&[("scene.obj", obj.as_ref()), ("view.json", VIEW.as_bytes())])
}

/// Loads a triangle with this `view.json`.
fn load_view(view: &str) -> rarefy::Result<Scene> {
    load(&[("scene.obj", TRIANGLE.as_bytes()), ("view.json", view.as_bytes())])
}

/// The message must hold each of `parts`.
#[track_caller]
fn refused(result: rarefy::Result<Scene>, parts: &[&str]) {
    let message = match result {
        Ok(scene) => panic!("accepted with warnings {:?}", scene.warnings()),
        Err(e) => e.to_string(),
    };
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert!(!message.contains('\n'), "more than one line: {message}");
}

#[track_caller]
fn warned(scene: &Scene, parts: &[&str]) {
    let fits = |w: &String| parts.iter().all(|p| w.contains(p));
    assert!(scene.warnings().iter().any(fits), "no warning has {parts:?}: {:#?}", scene.warnings());
}

/// Sum of the triangles' areas.
fn area(scene: &Scene) -> f32 {
    let corners = scene.triangles().iter().map(|t| t.map(|v| scene.positions()[v as usize]));
    corners.map(|[a, b, c]| (b - a).cross(c - a).length() * 0.5).sum()
}

#[test]
fn the_plain_triangle_loads_without_a_warning() {
    let scene = load_obj(TRIANGLE).unwrap();
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    assert_eq!((scene.triangles().len(), scene.objects().len()), (1, 1));
    assert_eq!(unpack_normal(scene.corner_normals()[0][1]), Vec3::Z);
    assert_eq!(scene.materials()[scene.objects()[0].material as usize].name, "(default)");
}

#[test]
fn files_that_are_not_there() {
    refused(scene::load(Path::new("no/such/place"), &rarefy::Monitor::default()), &["no/such/place", "scene.obj"]);
    refused(load(&[("view.json", b"{}")]), &["scene.obj", "not found"]);
}

#[test]
fn files_that_are_not_obj() {
    refused(load_obj(""), &["scene.obj", "file is empty"]);
    refused(load_obj("# nothing\n\n"), &["scene.obj", "no faces"]);
    refused(load_obj(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), &["scene.obj", "not a text file"]);
    let noise: Vec<u8> = (0..4000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    refused(load_obj(&noise), &["scene.obj"]);
    // Noise without NUL bytes.
    let noise: Vec<u8> = noise.into_iter().map(|b| b.max(1)).collect();
    refused(load_obj(&noise), &["scene.obj"]);
    for (mark, little) in [(&[0xff, 0xfe][..], true), (&[0xfe, 0xff][..], false), (&[][..], true)] {
        let units = TRIANGLE.encode_utf16();
        let text: Vec<u8> = units.flat_map(|u| if little { u.to_le_bytes() } else { u.to_be_bytes() }).collect();
        refused(load_obj([mark, &text].concat()), &["scene.obj", "UTF-16", "re-save the file as UTF-8"]);
    }
}

#[test]
fn numbers_that_are_none() {
    for (line, expected) in [
        ("v 0 nan 0", "`nan` is not a finite number"),
        ("v 0 -inf 0", "`-inf` is not a finite number"),
        ("v 0 1e999 0", "`1e999` is not a finite number"),
        ("v 0 1e30 0", "out of range"),
        ("v 0 x 0", "`x` is not a number"),
        ("v 0 0", "`v` with 2 numbers"),
        ("v 0 0 0 0 0", "`v` with 5 numbers"),
        ("v 0 0 1 0", "weight"),
        ("v 0 0 1 nan", "`nan` is not a finite number"),
        ("v \u{e9} 0 0", "not a number"),
    ] {
        // Line 3 is wrong, and used by the face.
        let text = format!("# c\nv 0 0 0\n{line}\nv 1 0 0\nv 0 1 0\nv 0 1 1\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 4/1/1\n");
        refused(load_obj(text), &["scene.obj:3: ", expected]);
    }
    refused(load_obj(b"v 0 0 0\nv 1 0 0\nv \xff 1 0\nf 1 2 3\n"), &["scene.obj:3: ", "not a number"]);
}

#[test]
fn indices_out_of_range() {
    for (face, expected) in [
        ("f 1 2 4", "corner `4`: index out of range: 3 vertices"),
        ("f 0 1 2", "index 0; OBJ files count from 1"),
        ("f 1 2 -4", "3 vertices (`v`) are defined above this line"),
        ("f 1 2 99999999999999999999999999", "out of range"),
        ("f 1 2 1.5", "whole number"),
        ("f 1 2 x", "whole number"),
        ("f 1/1/1/1 2 3", "more than three indices"),
        ("f /1 2 3", "no vertex index"),
        ("f 1 2 -", "whole number"),
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\n{face}\n");
        refused(load_obj(text), &["scene.obj:7: ", expected]);
    }
}

#[test]
fn nothing_to_draw() {
    refused(load_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n"), &["scene.obj", "no faces"]);
    refused(load_obj("v 0 0 0\nv 1 0 0\nl 1 2\np 1\n"), &["scene.obj", "no faces"]);
    let degenerate = "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 3 3 3\nf 1 2 3\nf 1 1 2\nf 1 2 3 4\n";
    refused(load_obj(degenerate), &["scene.obj", "all 3 faces are degenerate"]);
}

#[test]
fn degenerate_triangles_are_dropped_and_counted_once() {
    let scene = load_obj(format!("{TRIANGLE}f 1 1 2\nf 1 2 2\nv 2 0 0\nf 1 2 4\n")).unwrap();
    assert_eq!(scene.triangles().len(), 1);
    assert_eq!(scene.warnings().len(), 1);
    warned(&scene, &["scene.obj", "3 degenerate triangles", "left out"]);
}

#[test]
fn lines_and_points_are_left_out_and_told() {
    let scene = load_obj(format!("{TRIANGLE}l 1 2 3\np 1 2\nf 1 2\nf 1\n")).unwrap();
    assert_eq!(scene.triangles().len(), 1);
    warned(&scene, &["scene.obj:5", "2 line and point elements"]);
    warned(&scene, &["scene.obj:7", "2 faces with fewer than three corners"]);
}

#[test]
fn unusual_ways_to_write_the_same_triangle() {
    let expected = load_obj(TRIANGLE).unwrap();
    for text in [
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n",
        "v 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nf 1 \\\r\n  2\\\n 3 \\\n",
        "v\t0  0\t0\n  v 1 0 0  \nv 0 1 0\n\tf\t1 2   3\n",
        "v 0 0 0 1\nv 2 0 0 2\nv 0 1 0 1\nf 1 2 3\n",
        "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nv 1e0 0 0\nv -0 1.0 +0\nf 1// 2// 3//\n",
        "v 0 0 0 # a\nv 1 0 0#b\nv 0 1 0\nf 1/ 2/ 3/ # last\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\ns off\nfoo bar\nf 1 2 3\n# \\",
        // The comment's backslash does not swallow the face.
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n# C:\\scenes\\\nf 1 2 3\n",
    ] {
        let scene = load_obj(text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
        let corners =
            |s: &Scene| s.triangles().iter().map(|t| t.map(|v| s.positions()[v as usize])).collect::<Vec<_>>();
        assert_eq!(corners(&scene), corners(&expected), "{text:?}");
        assert_eq!(scene.corner_normals(), expected.corner_normals(), "{text:?}");
        assert!(scene.warnings().is_empty(), "{text:?}: {:?}", scene.warnings());
    }
}

#[test]
fn polygons_with_many_corners_and_concave_ones_keep_their_area() {
    // A comb: every other corner is reflex.
    let mut comb = String::new();
    let teeth = 500;
    for i in 0..teeth {
        comb += &format!("v {} 0 0\nv {} 1 0\n", 2 * i, 2 * i + 1);
    }
    comb += &format!("v {} -1 0\nv 0 -1 0\nf", 2 * teeth - 1);
    for i in 1..=2 * teeth + 2 {
        comb += &format!(" {i}");
    }
    let scene = load_obj(comb).unwrap();
    assert_eq!(scene.triangles().len(), 2 * teeth);
    // Under the zigzag from x = 0 to 2 * teeth - 1: mean height 1/2; below it, height 1.
    let expected = (2 * teeth - 1) as f32 * 1.5;
    assert!((area(&scene) - expected).abs() < 0.01, "{} instead of {expected}", area(&scene));
    assert!(scene.warnings().is_empty());

    let mut disc = String::new();
    for i in 0..1000 {
        let a = i as f32 / 1000.0 * std::f32::consts::TAU;
        disc += &format!("v {} 0 {}\n", a.cos(), -a.sin());
    }
    disc += &format!("f {}\n", (1..=1000).map(|i| i.to_string()).collect::<Vec<_>>().join(" "));
    let scene = load_obj(disc).unwrap();
    assert_eq!(scene.triangles().len(), 998);
    assert!((area(&scene) - std::f32::consts::PI).abs() < 1e-3);
    assert_eq!(unpack_normal(scene.corner_normals()[500][0]), Vec3::Y);

    // An arrow head; the fan from its first corner would cover the notch.
    let scene = load_obj("v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\nvt 0 0\nvt .2 0\nvt .3 0\nvt .4 0\nf 2/2 3/3 4/4 1/1\n")
        .unwrap();
    assert_eq!(area(&scene), 1.0);
    for (triangle, texcoords) in scene.triangles().iter().zip(scene.corner_texcoords()) {
        for (v, t) in triangle.iter().zip(texcoords) {
            let p = scene.positions()[*v as usize];
            let x = if p == Vec3::ZERO { 0.0 } else { 0.3 + 0.1 * p.y };
            assert!((t.x - x).abs() < 1e-6, "corner {p} has texture coordinate {t}");
        }
    }
}

#[test]
fn a_polygon_that_crosses_itself_is_told() {
    let bow_tie = "o tie\nv 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n";
    let scene = load_obj(bow_tie).unwrap();
    assert!(!scene.triangles().is_empty());
    warned(&scene, &["1 polygons cross themselves", "`tie`", "triangulate them"]);
}

#[test]
fn attributes_that_only_some_faces_have() {
    // tobj on its own gives the second triangle the normal and texture coordinate of the corner before it.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\nvn 0 1 0\nf 1/1/1 2/1/1 3/1/1\nf 1 2 3\nf 1//1 2//1 3//1\nf 1/1 2/1 3/1\n";
    let scene = load_obj(text).unwrap();
    let normal = |t: usize| unpack_normal(scene.corner_normals()[t][2]);
    assert_eq!([normal(0), normal(1), normal(2), normal(3)], [Vec3::Y, Vec3::Z, Vec3::Y, Vec3::Z]);
    let texcoord = |t: usize| scene.corner_texcoords()[t][2];
    let half = Vec2::splat(0.5);
    assert_eq!([texcoord(0), texcoord(1), texcoord(2), texcoord(3)], [half, Vec2::ZERO, Vec2::ZERO, half]);
    assert_eq!(scene.notes().triangles_without_normals, 2);
    // Lists that begin after the first face of a group.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nvt .5 .5\nvn 0 1 0\nf 1/1/1 2/1/1 3/1/1\n";
    let scene = load_obj(text).unwrap();
    assert_eq!(
        [unpack_normal(scene.corner_normals()[0][0]), unpack_normal(scene.corner_normals()[1][0])],
        [Vec3::Z, Vec3::Y]
    );
    assert_eq!((scene.corner_texcoords()[0][0], scene.corner_texcoords()[1][0]), (Vec2::ZERO, half));
    assert_eq!(scene.objects().len(), 1);
}

#[test]
fn objects_are_groups_in_materials_and_names_have_spaces() {
    let obj = format!(
        "mtllib my materials.mtl\no the big table\nusemtl dark wood\n{TRIANGLE}usemtl\tlight wood \nf 1 2 3\n\
         g lamp\nf 1 2 3\no the big table\nf 3 2 1\n"
    );
    let scene = load(&[
        ("scene.obj", obj.as_bytes()),
        ("my materials.mtl", b"newmtl dark wood\nKd .1 .1 .1\nnewmtl light wood\nKd .9 .9 .9\n"),
        ("view.json", VIEW.as_bytes()),
    ])
    .unwrap();
    let objects: Vec<_> = scene
        .objects()
        .iter()
        .map(|o| (o.name.as_str(), scene.materials()[o.material as usize].name.as_str()))
        .collect();
    let (table, lamp) = ("the big table", "lamp");
    assert_eq!(objects, [(table, "dark wood"), (table, "light wood"), (lamp, "light wood")]);
    assert_eq!(scene.triangle_objects(), [0, 1, 2, 1]);
    assert_eq!(scene.notes().duplicate_names, [table]);
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    // Vertices are shared between the materials of one object.
    assert_eq!(scene.triangles()[0], scene.triangles()[1]);
}

#[test]
fn a_missing_mtl_or_material_is_drawn_grey_and_told() {
    let obj = format!("mtllib gone.mtl\nusemtl a\n{TRIANGLE}usemtl b\nf 1 3 2\n");
    let view = VIEW.replacen('{', r#"{"mirror_materials": ["b"], "#, 1);
    let scene = load(&[("scene.obj", obj.as_bytes()), ("view.json", view.as_bytes())]).unwrap();
    warned(&scene, &["scene.obj:1", "MTL file `gone.mtl` not found", "grey"]);
    warned(&scene, &["scene.obj:2", "no MTL file defines material `a` and 1 more"]);
    assert_eq!(scene.objects().len(), 2);
    let surface = |o: usize| scene.materials()[scene.objects()[o].material as usize].surface;
    assert_eq!((surface(0), surface(1)), (Surface::Opaque, Surface::Mirror));
}

/// Two by one texels: opaque red, half-clear white.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let picture = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 255, 255, 255, 100]).unwrap();
    picture.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

fn load_texture(mtl: &str, name: &str, bytes: &[u8]) -> rarefy::Result<Scene> {
    let obj = "mtllib m.mtl\nusemtl a\nvt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n".to_string();
    let files: [(&str, &[u8]); 4] =
        [("scene.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), (name, bytes), ("view.json", VIEW.as_bytes())];
    load(&files)
}

#[test]
fn textures_arrive_and_masks_take_the_right_channel() {
    let mtl = "newmtl a\nmap_Kd -o 1 2 my pic.png\nmap_d my pic.png\n";
    let scene = load_texture(mtl, "my pic.png", &png()).unwrap();
    assert!(scene.warnings().len() == 1 && scene.warnings()[0].contains("map_Kd's are used"), "{:?}", scene.warnings());
    let m = &scene.materials()[scene.objects()[0].material as usize];
    assert_eq!((m.diffuse, m.surface), (Vec3::ONE, Surface::Opaque));
    assert_eq!(scene.corner_texcoords()[0][0], Vec2::new(1.0, 2.0));
    let texture = &scene.textures()[m.diffuse_texture.unwrap() as usize];
    assert_eq!((texture.width, texture.height, texture.texels.as_slice()), (2, 1, &[0xff00_00ff, 0x64ff_ffff][..]));
    let mask = &scene.textures()[m.cutout_texture.unwrap() as usize];
    assert_eq!((mask.texels[0] >> 24, mask.texels[1] >> 24), (255, 100));
    // Without alpha: luminance.
    let mut grey = Vec::new();
    let picture = image::RgbImage::from_raw(2, 1, vec![0, 0, 0, 200, 200, 200]).unwrap();
    picture.write_to(&mut std::io::Cursor::new(&mut grey), image::ImageFormat::Png).unwrap();
    let scene = load_texture("newmtl a\nmap_d g.png\n", "g.png", &grey).unwrap();
    let mask = &scene.textures()[0];
    assert_eq!((mask.texels[0] >> 24, mask.texels[1] >> 24), (0, 200));
}

#[test]
fn a_missing_or_foreign_texture_is_flat_and_told() {
    let scene = load_texture("newmtl a\nKd .2 .3 .4\nmap_Kd gone.png\n", "x", b"").unwrap();
    warned(&scene, &["gone.png", "texture not found", "plain colour"]);
    let m = &scene.materials()[scene.objects()[0].material as usize];
    assert_eq!((m.diffuse_texture, m.diffuse), (None, Vec3::new(0.2, 0.3, 0.4)));
    assert_eq!(scene.notes().missing_textures, ["gone.png"]);
    let scene = load_texture("newmtl a\nmap_Kd a.tga\n", "a.tga", b"\0\0\x02not a picture that is read").unwrap();
    warned(&scene, &["a.tga", "neither PNG nor JPEG", "convert it to PNG"]);
}

#[test]
fn damaged_pictures_are_flat_and_told() {
    let mtl = "newmtl a\nmap_Kd a.png\n";
    let whole = png();
    let is_told = |bytes: &[u8], what: &str| {
        let scene = load_texture(mtl, "a.png", bytes).unwrap();
        warned(&scene, &["a.png: ", what, "the plain colour is drawn"]);
        assert_eq!((scene.warnings().len(), scene.textures().len()), (1, 0));
        assert_eq!(scene.notes().missing_textures, ["a.png"]);
    };
    for length in [whole.len() - 20, 40, 20, 8] {
        is_told(&whole[..length], "damaged or cut short");
    }
    is_told(b"", "file is empty");
    is_told(b"\xff\xd8\xff\xe0", "damaged or cut short");
    is_told(&sized(&whole, 0, 4), "damaged or cut short");
    // A header that promises more than the file has, within the limits.
    is_told(&sized(&whole, 300, 300), "damaged or cut short");
    // A JPEG's decoder makes grey of what is missing.
    let mut jpeg = Vec::new();
    let noise = |x: u32, y: u32| image::Rgb([x * 37 + y * 91, x * 11, y * 53].map(|v| v as u8));
    image::RgbImage::from_fn(64, 64, noise)
        .write_to(&mut std::io::Cursor::new(&mut jpeg), image::ImageFormat::Jpeg)
        .unwrap();
    for length in [jpeg.len() - 1, jpeg.len() - 2, jpeg.len() / 2] {
        is_told(&jpeg[..length], "damaged or cut short");
    }
    // A preview in the header has an end of its own; what follows the end is no matter.
    let preview = [&jpeg[..2], b"\xff\xe1\x00\x06", b"\xff\xd8\xff\xd9", &jpeg[2..], b"more"].concat();
    assert_eq!(load_texture(mtl, "a.png", &preview).unwrap().textures().len(), 1);
    is_told(&preview[..preview.len() / 2], "damaged or cut short");
}

/// A PNG with another size in its header.
fn sized(png: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut bytes = png.to_vec();
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    bytes
}

#[test]
fn absurd_pictures_are_refused() {
    let mtl = "newmtl a\nmap_Kd a.png\n";
    let sized = |width, height| load_texture(mtl, "a.png", &sized(&png(), width, height));
    refused(sized(1 << 31, 1), &["a.png", "2147483648x1", "16384", "scale"]);
    refused(sized(16384, 16384), &["a.png", "16384x16384", "1024 MiB", "256 MiB"]);
    let mut wide = Vec::new();
    let picture = image::GrayImage::new(16385, 1);
    picture.write_to(&mut std::io::Cursor::new(&mut wide), image::ImageFormat::Jpeg).unwrap();
    refused(load_texture(mtl, "a.png", &wide), &["a.png", "16385x1", "16384"]);
}

#[test]
fn every_kind_of_picture_gives_its_texels() {
    use image::DynamicImage;
    let texels = |picture: DynamicImage, format| {
        let mut bytes = Vec::new();
        picture.write_to(&mut std::io::Cursor::new(&mut bytes), format).unwrap();
        load_texture("newmtl a\nmap_Kd a\n", "a", &bytes).unwrap().textures()[0].texels.clone()
    };
    let rgba =
        image::RgbaImage::from_fn(5, 3, |x, y| image::Rgba([x * 50, y * 90, x * y * 9, 255 - x].map(|v| v as u8)));
    let rgba = DynamicImage::from(rgba);
    for kind in [
        rgba.clone(),
        rgba.to_rgb8().into(),
        rgba.to_luma8().into(),
        rgba.to_luma_alpha8().into(),
        rgba.to_rgb16().into(),
        rgba.to_rgba16().into(),
        rgba.to_luma16().into(),
        rgba.to_luma_alpha16().into(),
    ] {
        let expected: Vec<u32> = kind.to_rgba8().pixels().map(|p| u32::from_le_bytes(p.0)).collect();
        assert_eq!(texels(kind.clone(), image::ImageFormat::Png), expected, "{:?}", kind.color());
    }
    let grey =
        texels(DynamicImage::from(image::GrayImage::from_pixel(3, 2, image::Luma([77]))), image::ImageFormat::Jpeg);
    assert_eq!(grey, [0xff4d_4d4d; 6]);
}

#[test]
fn what_is_wrong_in_an_mtl_is_left_out_and_told() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let with =
        |mtl: &[u8]| load(&[("scene.obj", obj.as_bytes()), ("m.mtl", mtl), ("view.json", VIEW.as_bytes())]).unwrap();
    let kd = |scene: &Scene| scene.materials()[scene.objects()[0].material as usize].diffuse;
    let scene = with(b"newmtl a\n\nKd 1 red 1\nKs 0 0 0\n");
    warned(&scene, &["m.mtl:3: ", "`Kd`", "`red` is not a number", "left out"]);
    warned(&with(b"newmtl a\nNi inf\n"), &["m.mtl:2: ", "not a finite number"]);
    warned(&with(b"newmtl\nKd 1 0 0\nnewmtl a\n"), &["m.mtl:1: ", "`newmtl` without a name"]);
    for (mtl, why) in [(&b"\xff\xfen\0e\0w\0"[..], "UTF-16"), (b"", "file is empty"), (b"\0\0\0\0", "not a text file")]
    {
        let scene = with(mtl);
        warned(&scene, &["m.mtl", why, "its materials are drawn light grey"]);
        assert_eq!(kd(&scene), Vec3::splat(0.7));
    }
    // Values that exporters write.
    let scene = with(b"newmtl a\r\nKd 2 1 1\r\nNi 0.001\r\nNs -5\r\nillum 2.0\r\n");
    warned(&scene, &["m.mtl:2", "limited to 0 .. 1"]);
    warned(&scene, &["m.mtl:4", "`Ns -5` is limited"]);
    warned(&scene, &["m.mtl:5", "`illum 2.0` is taken for 2"]);
    assert_eq!(scene.warnings().len(), 3, "{:?}", scene.warnings());
}

#[test]
fn normals_and_texture_coordinates_that_are_none_are_missing() {
    // Corner 2 has the bad one, whether the entry or the index is bad.
    for (vt, vn, face, warning) in [
        ("nan nan", "0 1 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:6: 1 texture coordinates (`vt`)"),
        ("-nan(ind) 0", "0 1 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:6: 1 texture coordinates (`vt`)"),
        ("", "0 1 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:6: 1 texture coordinates (`vt`)"),
        ("1e999 0", "0 1 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:6: 1 texture coordinates (`vt`)"),
        ("1e30 0", "0 1 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:6: 1 texture coordinates (`vt`)"),
        (".5 .5", "0 nan 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:7: 1 normals (`vn`)"),
        (".5 .5", "0 1e39 0", "f 1/1/1 2/2/2 3/1/1", "scene.obj:7: 1 normals (`vn`)"),
        (".5 .5", "0 1", "f 1/1/1 2/2/2 3/1/1", "scene.obj:7: 1 normals (`vn`)"),
        (".5 .5", "x y z", "f 1/1/1 2/2/2 3/1/1", "scene.obj:7: 1 normals (`vn`)"),
        (".5 .5", "0 1 0", "f 1/1/1 2/2/9 3/1/1", "scene.obj:8: 1 indices of faces"),
        (".5 .5", "0 1 0", "f 1/1/1 2/9/2 3/1/1", "scene.obj:8: 1 indices of faces"),
        (".5 .5", "0 1 0", "f 1/1/1 2/0/-9223372036854775807 3/1/1", "scene.obj:8: 2 indices of faces"),
        (".5 .5", "0 1 0", "f 1/1/1 2/a/b 3/1/1", "scene.obj:8: 2 indices of faces"),
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nvn 0 1 0\nvt {vt}\nvn {vn}\n{face}\n");
        let scene = load_obj(text).unwrap();
        warned(&scene, &[warning]);
        assert_eq!(scene.warnings().len(), 1);
        let (normals, texcoords) = (scene.corner_normals()[0].map(unpack_normal), scene.corner_texcoords()[0]);
        assert_eq!((normals[0], texcoords[0]), (Vec3::Y, Vec2::ONE));
        let bad_vt = warning.contains("`vt`)") || face.contains("/9/") || face.contains("/0/") || face.contains("/a/");
        assert_eq!(texcoords[1], if bad_vt { Vec2::ZERO } else { Vec2::splat(0.5) }, "{face} {vt}");
        let bad_vn = warning.contains("`vn`)") || face.contains("/9 ") || face.contains("-9") || face.contains("/b");
        assert_eq!(normals[1], if bad_vn { Vec3::Z } else { Vec3::Y }, "{face} {vn}");
    }
}

#[test]
fn texture_coordinates_far_from_0_lose_nothing() {
    let quad = |far: f64, s: f64| {
        let vt = |x: f64, y: f64| format!("vt {} {}\n", far + x, y - far);
        let corners = vt(0.25, 0.0) + &vt(0.25 + s, 0.0) + &vt(0.25 + s, 0.75) + &vt(0.25, 0.75);
        let text = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n{corners}f 1/1 2/2 3/3 4/4\n");
        load_obj(text).unwrap().corner_texcoords().to_vec()
    };
    let near = quad(0.0, 2.5);
    assert_eq!(near[0], [Vec2::new(0.25, 0.0), Vec2::new(2.75, 0.0), Vec2::new(2.75, 0.75)]);
    // What is near stays as it is, bit for bit.
    assert_eq!(quad(40.0, 2.5)[0][1], Vec2::new(42.75, -40.0));
    for far in [100.0, 1.0e5, 1.0e6, 1.0e7, 123_456_789.0] {
        assert_eq!(quad(far, 2.5), near, "{far}");
    }
    assert_ne!(quad(100.0, 2.4), near);
}

#[test]
fn surfaces_follow_the_lists_of_the_view_else_the_keys() {
    let obj = format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}");
    let kind = |mtl: &str, lists: &str| {
        let view = VIEW.replacen('{', &format!("{{{lists}"), 1);
        let files: [(&str, &[u8]); 3] =
            [("scene.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("view.json", view.as_bytes())];
        let scene = load(&files).unwrap();
        (scene.materials()[0].surface, scene.warnings().len())
    };
    let (mirror, glass) = ("newmtl a\nillum 3\nKs 1 1 1\n", "newmtl a\nillum 7\nd 0.1\nNi 1.5\n");
    assert_eq!(kind(mirror, ""), (Surface::Mirror, 0));
    assert_eq!(kind(glass, ""), (Surface::Glass, 0));
    assert_eq!(kind(mirror, r#""mirror_materials": [],"#), (Surface::Opaque, 0));
    assert_eq!(kind(glass, r#""mirror_materials": [],"#), (Surface::Glass, 0));
    let both = r#""glass_materials": ["a"], "thin_glass_materials": ["a"],"#;
    assert_eq!(kind("newmtl a\n", both), (Surface::ThinGlass, 0));
    let clash = r#""glass_materials": ["a"], "mirror_materials": ["a"],"#;
    assert_eq!(kind("newmtl a\n", clash), (Surface::Glass, 1));
    assert_eq!(kind("newmtl a\nd 0.3\n", ""), (Surface::ThinGlass, 0));
    assert_eq!(kind("newmtl a\nd 0.3\n", r#""glass_materials": [],"#), (Surface::Opaque, 1));
}

#[test]
fn views_that_make_no_sense() {
    let camera = |camera: &str| load_view(&format!(r#"{{"camera": {camera}}}"#));
    let (eye, look_at) = (r#""eye": [0,0,5]"#, r#""look_at": [0,0,0]"#);
    let key = |name: &'static str| format!("view.json: camera.{name}: ");
    refused(camera(r#"{"eye": [1,2,3], "look_at": [1,2,3]}"#), &[&key("look_at"), "same point as `eye`"]);
    refused(camera(&format!(r#"{{{eye}, {look_at}, "up": [0,0,2]}}"#)), &[&key("up"), "parallel to the line of sight"]);
    refused(camera(&format!(r#"{{{eye}, {look_at}, "up": [0,0,0]}}"#)), &[&key("up"), "no length"]);
    for fov in ["0", "180", "-5", "1e9"] {
        let text = format!(r#"{{{eye}, {look_at}, "fov_y_degrees": {fov}}}"#);
        refused(camera(&text), &[&key("fov_y_degrees"), "above 0 and below 180"]);
    }
    refused(camera(&format!("{{{eye}}}")), &[&key("look_at"), "is missing"]);
    refused(camera(r#"{"eye": [0,0], "look_at": [0,0,0]}"#), &[&key("eye"), "three numbers"]);
    refused(
        camera(r#"{"eye": [0,0,"a"], "look_at": [0,0,0]}"#),
        &[&key("eye[2]"), "a number is needed, this is a string"],
    );
    refused(camera(r#"{"eye": [0,0,1e39], "look_at": [0,0,0]}"#), &[&key("eye[2]"), "too large"]);
    refused(camera("[]"), &["view.json: camera: ", "an object {...} is needed, this is a list"]);

    let light = r#"{"position": [0,1,0]}"#;
    let lights = |n: usize| format!(r#"{{"lights": [{}]}}"#, vec![light; n].join(","));
    assert_eq!(load_view(&lights(32)).unwrap().view().lights.len(), 32);
    refused(load_view(&lights(33)), &["view.json: lights: ", "33 lights", "at most 32"]);
    for (text, parts) in [
        (r#"{"lights": [{"intensity": 1}]}"#, ["lights[0].position", "missing"]),
        (r#"{"lights": [{"position": [0,0,0], "intensity": -1}]}"#, ["lights[0].intensity", "out of range"]),
        (r#"{"lights": [{"position": [0,0,0], "intensity": [1,null,1]}]}"#, ["lights[0].intensity[1]", "this is null"]),
        (r#"{"lights": 3}"#, ["lights", "this is a number"]),
        (r#"{"extent": 0}"#, ["extent", "above 0"]),
        (r#"{"extent": "5 m"}"#, ["extent", "this is a string"]),
        (r#"{"suggested_ambient": [0.1, 0.1]}"#, ["suggested_ambient", "three numbers"]),
        (r#"{"background": -0.5}"#, ["background", "out of range"]),
        (r#"{"mirror_materials": "Mirror"}"#, ["mirror_materials", "a list [...] is needed, this is a string"]),
        (r#"{"glass_materials": [1]}"#, ["glass_materials[0]", "name is needed"]),
        (r#"{"triangles": -1}"#, ["triangles", "a count is needed"]),
        ("[]", ["view.json", "an object"]),
    ] {
        refused(load_view(text), &[&["view.json"][..], &parts[..]].concat());
    }
    refused(load_view("{\n\"extent\": NaN\n}"), &["view.json:2: ", "not JSON", "JSON has no NaN"]);
    refused(load_view("{\n\"extent\": 1e999\n}"), &["view.json:2: ", "not JSON"]);
    refused(load_view("{\n"), &["view.json:2: ", "not JSON"]);
    refused(load_view(""), &["view.json", "empty"]);
    refused(
        load(&[("scene.obj", TRIANGLE.as_bytes()), ("view.json", b"{\n\"name\": \"\xff\"}")]),
        &["view.json:2: ", "UTF-8"],
    );
    let deep = "[".repeat(100_000);
    refused(load_view(&format!(r#"{{"notes": {deep}"#)), &["view.json:1: ", "not JSON"]);
}

#[test]
fn unknown_keys_and_names_are_told_and_the_rest_is_used() {
    let view = VIEW
        .replacen(
            '{',
            r#"{"light": 3, "mirror_materials": ["Mirro"], "triangles": 7, "background": [0.1,0.2,0.3],
        "suggested_ambient": 0.5, "#,
            1,
        )
        .replace("\"up\"", "\"roll\": 3, \"up\"");
    let scene = load_view(&view).unwrap();
    warned(&scene, &["view.json", "unknown key `light`"]);
    warned(&scene, &["view.json", "unknown key `camera.roll`"]);
    warned(&scene, &["view.json", "mirror_materials: no material is named `Mirro`"]);
    warned(&scene, &["1 triangles", "view.json says 7"]);
    assert_eq!((scene.view().background, scene.view().ambient), (Vec3::new(0.1, 0.2, 0.3), Vec3::splat(0.5)));
    assert_eq!(scene.view().lights[0].intensity, Vec3::splat(9.0));
    assert_eq!((scene.view().camera.eye, scene.view().camera.fov_y_degrees), (Vec3::new(0.0, 0.0, 5.0), 45.0));
}

#[test]
fn without_a_view_camera_and_light_are_fitted() {
    // A unit cube of points and one corner of a ground plane far away.
    let mut obj = String::from("v 1e6 0 0\n");
    for i in 0..400 {
        let t = i as f32 / 399.0;
        obj += &format!("v {t} {} {}\n", (i % 20) as f32 / 19.0, (i / 20) as f32 / 19.0);
    }
    for i in 2..400 {
        obj += &format!("f {} {} {}\n", i, i - 1, i + 1);
    }
    obj += "f 1 2 3\n";
    let dir = folder(&[("cube.obj", obj.as_bytes())]);
    let scene = scene::load(&dir.path().join("cube.obj"), &rarefy::Monitor::default()).unwrap();
    assert_eq!(scene.name(), "cube");
    assert!((scene.view().extent - 1.0).abs() < 0.05, "extent {}", scene.view().extent);
    for what in ["`extent`", "`camera`", "`lights`"] {
        warned(&scene, &["cube.obj (no view.json)", what]);
    }
    let camera = scene.view().camera;
    assert!((camera.look_at - Vec3::splat(0.5)).length() < 0.05);
    let distance = (camera.eye - camera.look_at).length();
    assert!(distance > 1.0 && distance < 4.0);
    assert_eq!(scene.view().lights.len(), 1);
}
