// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scene files changed at random: each gives a valid scene or an error, never a panic.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use proptest::prelude::*;
use rarefy::internal::scene::{self, LoadOptions, Scene};

/// From memory: thousands of folders would take their time.
fn load(files: &[(&str, &[u8])]) -> rarefy::Result<Scene> {
    let files: BTreeMap<String, Vec<u8>> =
        files.iter().map(|&(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    scene::load_from("scene.obj", &files, &LoadOptions::default(), &rarefy::Monitor::default())
}

/// Two by one texels.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let picture = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 255, 255, 255, 100]).unwrap();
    picture.write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    bytes
}

const OBJ: &str = "mtllib m.mtl\no room\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl a\n\
                   f 1/1/1 2/2/1 3/1/1 4/2/1\ng lamp \\\n two\nusemtl b\nf -4//-1 -3//-1 -2//-1\nl 1 2\nf 1 2 3\n";
const MTL: &str = "newmtl a\nKd 1 .5 0\nKs 0.2\nNs 20\nmap_Kd -s 2 2 1 t.png\nmap_d t.png\nnewmtl b\nillum 7\nNi 1.5\nTf 1 1 1\nTr .5\n";
const VIEW: &str = r#"{"camera":{"eye":[1,1,5],"look_at":[0,0,0],"up":[0,1,0],"fov_y_degrees":40},"extent":2,
    "lights":[{"position":[1,2,3],"intensity":[1,1,1]}],"suggested_ambient":0.1,"glass_materials":["b"],"triangles":4}"#;
const WORDS: [&str; 24] = [
    "nan",
    "inf",
    "-1",
    "0",
    "1e39",
    "99999999999999999999",
    "/",
    "//",
    "\\\n",
    "\r",
    "\n",
    " ",
    "f ",
    "v ",
    "vt 1",
    "vn ",
    "g ",
    "usemtl ",
    "mtllib ",
    "[",
    "}",
    "\"",
    "-9223372036854775808",
    "\0",
];

/// A change of a text: place (as a fraction), bytes removed there, bytes put there.
fn change() -> impl Strategy<Value = (f64, usize, Vec<u8>)> {
    let word = proptest::sample::select(&WORDS[..]).prop_map(|w| w.as_bytes().to_vec());
    let noise = proptest::collection::vec(any::<u8>(), 0..6);
    (0.0..1.0, 0..12usize, prop_oneof![word, noise])
}

fn mutate(original: &[u8], changes: &[(f64, usize, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for (place, removed, inserted) in changes {
        let at = (place * bytes.len() as f64) as usize;
        let end = (at + removed).min(bytes.len());
        bytes.splice(at..end, inserted.iter().copied());
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: ProptestConfig::default().cases.max(600), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_change_gives_a_valid_scene_or_an_error(
        obj in proptest::collection::vec(change(), 0..4),
        // Seldom, so that the others are reached.
        mtl in proptest::option::weighted(0.3, change()),
        view in proptest::option::weighted(0.2, change()),
        picture in proptest::option::weighted(0.1, change()),
    ) {
        let (obj, mtl) = (mutate(OBJ.as_bytes(), &obj), mutate(MTL.as_bytes(), mtl.as_slice()));
        let (view, picture) = (mutate(VIEW.as_bytes(), view.as_slice()), mutate(&png(), picture.as_slice()));
        let loaded = load(&[("scene.obj", &obj), ("m.mtl", &mtl), ("view.json", &view), ("t.png", &picture)]);
        if let Ok(scene) = loaded {
            prop_assert!(!scene.triangles().is_empty());
            prop_assert!(scene.positions().iter().all(|p| p.is_finite()));
            prop_assert!(scene.corner_texcoords().iter().flatten().all(|t| t.is_finite()));
            prop_assert!(scene.triangles().iter().flatten().all(|&v| (v as usize) < scene.positions().len()));
            prop_assert!(scene.triangle_objects().iter().all(|&o| (o as usize) < scene.objects().len()));
            prop_assert!(scene.objects().iter().all(|o| (o.material as usize) < scene.materials().len()));
            for m in scene.materials() {
                let textures = m.diffuse_texture.iter().chain(&m.cutout_texture);
                prop_assert!(textures.copied().all(|t| (t as usize) < scene.textures().len()));
                prop_assert!(m.diffuse.is_finite() && m.shininess >= 0.0 && m.index_of_refraction >= 1.0);
            }
            scene::doctor::examine(&scene);
        }
    }
}

/// Without changes the files are good: else the test above would test little.
#[test]
fn the_unchanged_files_load() {
    let png = png();
    let files: [(&str, &[u8]); 4] =
        [("scene.obj", OBJ.as_bytes()), ("m.mtl", MTL.as_bytes()), ("view.json", VIEW.as_bytes()), ("t.png", &png)];
    let scene = load(&files).unwrap();
    assert_eq!((scene.triangles().len(), scene.objects().len(), scene.textures().len()), (4, 2, 2));
    assert_eq!(scene.objects()[1].name, "lamp   two");
}
