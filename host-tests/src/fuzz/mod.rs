// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fuzz targets: what must hold for any bytes. `fuzz/` runs them under libFuzzer, `tests/fuzz.rs` with [`mutate`].
//!
//! A target panics on what must not be. An input that is refused with an error is a good input.

pub mod mutate;

use std::collections::BTreeMap;

use rarefy::internal::device::open::{DeviceChoice, DeviceOptions};
use rarefy::internal::device::profiles::Profile;
use rarefy::internal::method::counts::Keep;
use rarefy::internal::scene::{self, LoadOptions, Scene};

use crate::fixtures::Random;
use crate::frames::renderer_of;
use crate::option_space::options;

/// A target: its name, which is that of its seeds' folder, and what it does with an input.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: [Target; 6] =
    [("obj", obj), ("mtl", mtl), ("view", view), ("profile", profile), ("picture", picture), ("scene", whole_scene)];

const OBJ: &[u8] = include_bytes!("../../../fuzz/seeds/obj/room.obj");
const MTL: &[u8] = include_bytes!("../../../fuzz/seeds/mtl/two.mtl");
const VIEW: &[u8] = include_bytes!("../../../fuzz/seeds/view/full.json");
const PICTURE: &[u8] = include_bytes!("../../../fuzz/seeds/picture/rgba.png");

/// Loads a scene of these files; small budgets, so that no input takes long. What loads is valid.
fn load(obj: &[u8], mtl: &[u8], view: &[u8], picture: &[u8]) -> Option<Scene> {
    let files = [("scene.obj", obj), ("m.mtl", mtl), ("view.json", view), ("t.png", picture)];
    let files: BTreeMap<String, Vec<u8>> =
        files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    let options =
        LoadOptions { max_texture_bytes: 1 << 20, max_face_corners: 2_000, max_names: 2_000, ..LoadOptions::default() };
    let scene = match scene::load_from("scene.obj", &files, &options, &rarefy::Monitor::default()) {
        Ok(scene) => scene,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return None;
        }
    };
    assert!(!scene.triangles().is_empty());
    // The constructor checks all that a scene promises.
    let again = Scene::new(scene.clone().into_parts());
    assert!(again.is_ok(), "a loaded scene is not valid: {:?}", again.err());
    scene::doctor::examine(&scene);
    Some(scene)
}

/// The scene of the seeds, which is good: else changes of it would reach little.
///
/// # Panics
/// If it does not load.
pub fn scene_of_the_seeds() -> Scene {
    load(OBJ, MTL, VIEW, PICTURE).unwrap()
}

/// An OBJ file.
pub fn obj(data: &[u8]) {
    load(data, MTL, VIEW, PICTURE);
}

/// A file of materials.
pub fn mtl(data: &[u8]) {
    load(OBJ, data, VIEW, PICTURE);
}

/// A `view.json`.
pub fn view(data: &[u8]) {
    load(OBJ, MTL, data, PICTURE);
}

/// A texture.
pub fn picture(data: &[u8]) {
    load(OBJ, MTL, VIEW, data);
}

/// A device profile.
pub fn profile(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    if let Ok(profile) = Profile::from_json("fuzz", &text) {
        let choices = profile.choices();
        assert!(choices.work_group("step1").iter().all(|side| (1..=4096).contains(side)));
        let written = serde_json::to_string(&profile).unwrap();
        assert!(Profile::from_json("fuzz", &written).is_ok(), "a profile does not read what it wrote: {written}");
    }
}

/// A scene and options: 8 bytes that the options follow from, a byte that says which files follow, and these, each
/// behind its length in two bytes; a file that is left out is that of the seeds. Draws the scene by the CPU twin.
pub fn whole_scene(data: &[u8]) {
    let Some((head, mut rest)) = data.split_at_checked(9) else { return };
    let seed = u64::from_le_bytes(head[..8].try_into().unwrap());
    let mut take = |bit: u8, otherwise: &'static [u8]| -> Vec<u8> {
        if head[8] & bit == 0 {
            return otherwise.to_vec();
        }
        let (length, after) = rest.split_at_checked(2).unwrap_or((&[], &[]));
        let length = length.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)).min(after.len());
        let (file, after) = after.split_at(length);
        rest = after;
        file.to_vec()
    };
    let (obj, mtl, view, picture) = (take(1, OBJ), take(2, MTL), take(4, VIEW), take(8, PICTURE));
    let Some(scene) = load(&obj, &mtl, &view, &picture) else { return };
    let options = options(&mut Random::new(seed | 1), 20);
    let device = DeviceOptions { device: DeviceChoice::Twin, ..DeviceOptions::default() };
    // A scene may be too much for the tree, but then it is told.
    let Ok(mut renderer) = renderer_of(&scene, &device, &rarefy::Monitor::default()) else { return };
    let frame = match renderer.render_exactly(&options, Keep::EVERYTHING) {
        Ok(frame) => frame,
        Err(error) => panic!("{options:?}: {error}"),
    };
    let (pixels, samples) = (frame.stats.pixels, options.sample_size());
    let all = u64::from(samples.0) * u64::from(samples.1);
    assert_eq!(pixels.base + pixels.traced + pixels.interpolated + pixels.corrected, all, "{options:?}");
    assert!(frame.pixels.iter().all(|pixel| pixel >> 24 == 255), "{options:?}: a pixel is not opaque");
}
