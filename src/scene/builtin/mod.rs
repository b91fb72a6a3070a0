// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes of our own, made by deterministic code: a café, a finish line, a kitchen, a conference room, a bathroom and a
//! courtyard to look at, and four tiny scenes for tests.
//!
//! Each scene has a folder `scenes/NAME` with its `view.json` and the parameters of its generator; both are part of
//! the library. The generators use `+ - * /` and square roots alone, so that every platform makes the same bytes.

#[cfg(feature = "rooms")]
pub mod bathroom;
pub mod cafe;
#[cfg(feature = "rooms")]
pub mod conference;
mod convert;
#[cfg(feature = "rooms")]
pub mod courtyard;
mod export;
#[cfg(feature = "rooms")]
pub mod kitchen;
pub mod mesh;
mod model;
pub mod paint;
// Without the rooms, the café uses a few of them.
#[cfg_attr(not(feature = "rooms"), allow(dead_code))]
pub mod parts;
#[cfg(feature = "rooms")]
pub mod runner;
#[cfg(test)]
mod solid;
pub mod tiny;

use std::path::Path;

use serde::de::DeserializeOwned;

pub use export::{mtl_text, obj_text};
pub use model::{Finish, Group, Model, Picture};

use crate::error::Setting;
use crate::monitor::Monitor;
use crate::{Error, Result, Scene};

/// The names of all built-in scenes.
#[cfg(not(feature = "rooms"))]
pub const NAMES: [&str; 5] = ["cafe", "wall", "spheres", "rods", "mirror-room"];

/// The names of all built-in scenes.
#[cfg(feature = "rooms")]
pub const NAMES: [&str; 10] =
    ["cafe", "runner", "kitchen", "conference", "bathroom", "courtyard", "wall", "spheres", "rods", "mirror-room"];

/// Those of them that take large generators, which the Android library leaves out.
#[cfg(feature = "rooms")]
pub const ROOMS: [&str; 5] = ["runner", "kitchen", "conference", "bathroom", "courtyard"];

/// Those of them that have millions of triangles, and take seconds to make.
#[cfg(feature = "rooms")]
pub const HUGE: [&str; 1] = ["courtyard"];

/// Makes a built-in scene.
///
/// # Errors
/// If there is no scene of that name; the message lists those that exist.
pub fn generate(name: &str) -> Result<Model> {
    generate_watched(name, &Monitor::default())
}

/// As [`generate`], with progress; it ends when it is cancelled.
///
/// # Errors
/// If there is no scene of that name, or [`Error::Cancelled`].
pub fn generate_watched(name: &str, monitor: &Monitor) -> Result<Model> {
    let (making, finishing) = (monitor.part("scene", 0.0, 0.5), monitor.part("scene", 0.5, 1.0));
    making.check()?;
    let model = match name {
        "cafe" => cafe::generate(
            &parameters(name, include_str!("../../../scenes/cafe/parameters.json"))?,
            include_str!("../../../scenes/cafe/view.json"),
        )?,
        #[cfg(feature = "rooms")]
        "runner" => runner::generate(
            &parameters(name, include_str!("../../../scenes/runner/parameters.json"))?,
            include_str!("../../../scenes/runner/view.json"),
        )?,
        #[cfg(feature = "rooms")]
        "kitchen" => kitchen::generate(
            &parameters(name, include_str!("../../../scenes/kitchen/parameters.json"))?,
            include_str!("../../../scenes/kitchen/view.json"),
        )?,
        #[cfg(feature = "rooms")]
        "conference" => conference::generate(
            &parameters(name, include_str!("../../../scenes/conference/parameters.json"))?,
            include_str!("../../../scenes/conference/view.json"),
        )?,
        #[cfg(feature = "rooms")]
        "bathroom" => bathroom::generate(
            &parameters(name, include_str!("../../../scenes/bathroom/parameters.json"))?,
            include_str!("../../../scenes/bathroom/view.json"),
        )?,
        #[cfg(feature = "rooms")]
        "courtyard" => courtyard::generate(
            &parameters(name, include_str!("../../../scenes/courtyard/parameters.json"))?,
            include_str!("../../../scenes/courtyard/view.json"),
            &making,
        )?,
        "wall" => tiny::wall(
            &parameters(name, include_str!("../../../scenes/wall/parameters.json"))?,
            include_str!("../../../scenes/wall/view.json"),
        )?,
        "spheres" => tiny::spheres(
            &parameters(name, include_str!("../../../scenes/spheres/parameters.json"))?,
            include_str!("../../../scenes/spheres/view.json"),
        )?,
        "rods" => tiny::rods(
            &parameters(name, include_str!("../../../scenes/rods/parameters.json"))?,
            include_str!("../../../scenes/rods/view.json"),
        )?,
        "mirror-room" => tiny::mirror_room(
            &parameters(name, include_str!("../../../scenes/mirror-room/parameters.json"))?,
            include_str!("../../../scenes/mirror-room/view.json"),
        )?,
        _ => {
            return Err(Error::option(Setting::BuiltinScene, name, crate::settings::list(&NAMES)));
        }
    };
    model.finish(&finishing)
}

/// Writes a built-in scene as `scene.obj`, `scene.mtl`, `textures/*.png` and `view.json`, whole or not at all.
///
/// # Errors
/// If there is no scene of that name, or if `folder` exists and is not an empty folder, or cannot be written.
pub fn write(name: &str, folder: &Path) -> Result<()> {
    write_watched(name, folder, &Monitor::default())
}

/// As [`write()`], with progress; it ends when it is cancelled, and leaves nothing behind then.
///
/// # Errors
/// Those of [`write()`], or [`Error::Cancelled`].
pub fn write_watched(name: &str, folder: &Path, monitor: &Monitor) -> Result<()> {
    let model = generate_watched(name, &monitor.part("scene", 0.0, 0.5))?;
    export::write_model(&model, folder, &monitor.part("scene", 0.5, 1.0))
}

/// Makes a built-in scene ready to be drawn, without files: the same scene as loading what [`write()`] wrote.
///
/// # Errors
/// If there is no scene of that name; the message lists those that exist.
pub fn to_scene(name: &str) -> Result<Scene> {
    to_scene_watched(name, &Monitor::default())
}

/// As [`to_scene`], with progress; it ends when it is cancelled.
///
/// # Errors
/// Those of [`to_scene`], or [`Error::Cancelled`].
pub fn to_scene_watched(name: &str, monitor: &Monitor) -> Result<Scene> {
    let model = generate_watched(name, &monitor.part("scene", 0.0, 0.8))?;
    convert::scene_of(model, &monitor.part("scene", 0.8, 1.0))
}

/// Reads a generator's parameters.
fn parameters<T: DeserializeOwned>(name: &str, text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|e| Error::Syntax {
        path: format!("scenes/{name}/parameters.json").into(),
        line: e.line(),
        message: e.to_string(),
    })
}

/// Checks that a parameter lies in its range.
fn check(scene: &str, key: &str, value: f32, range: std::ops::RangeInclusive<f32>) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let message = format!("`{key}` is {value}; it must lie between {} and {}", range.start(), range.end());
    Err(Error::scene(format!("scenes/{scene}/parameters.json"), message))
}

#[cfg(all(test, feature = "rooms"))]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// What a scene's generator says about parameters in which `from` is replaced by `to`.
    fn changed(scene: &str, from: &str, to: &str) -> Result<Model> {
        let text = match scene {
            "cafe" => include_str!("../../../scenes/cafe/parameters.json"),
            "runner" => include_str!("../../../scenes/runner/parameters.json"),
            "kitchen" => include_str!("../../../scenes/kitchen/parameters.json"),
            "conference" => include_str!("../../../scenes/conference/parameters.json"),
            "courtyard" => include_str!("../../../scenes/courtyard/parameters.json"),
            _ => include_str!("../../../scenes/bathroom/parameters.json"),
        };
        assert!(text.contains(from), "{from}");
        let text = text.replace(from, to);
        let model = match scene {
            "cafe" => cafe::generate(&parameters(scene, &text)?, "{}"),
            "runner" => runner::generate(&parameters(scene, &text)?, "{}"),
            "kitchen" => kitchen::generate(&parameters(scene, &text)?, "{}"),
            "conference" => conference::generate(&parameters(scene, &text)?, "{}"),
            "courtyard" => courtyard::generate(&parameters(scene, &text)?, "{}", &Monitor::default()),
            _ => bathroom::generate(&parameters(scene, &text)?, "{}"),
        };
        model?.finish(&Monitor::default())
    }

    #[test]
    fn parameters_out_of_range_are_refused_with_key_and_range() {
        for scene in ["cafe", "runner", "kitchen", "conference", "bathroom"] {
            assert!(changed(scene, "\"seed\": 2016", "\"seed\": 1").is_ok());
        }
        let cafe = [
            ("\"tube_radius\": 0.0145", "\"tube_radius\": 0.5", "`chair.tube_radius` is 0.5; it must lie between"),
            ("\"leaves\": 34", "\"leaves\": 1000000", "`leaves`"),
            ("\"texture\": 512", "\"texture\": 100000", "`texture`"),
            ("\"radius\": 0.38", "\"radius\": -1", "`tables.radius`"),
            ("\"seed\": 2016", "\"sead\": 2016", "scenes/cafe/parameters.json:2: unknown field `sead`"),
            ("\"leaves\": 34", "\"leaves\": -1", "scenes/cafe/parameters.json:"),
        ];
        let runner = [
            ("\"cell\": 0.0222", "\"cell\": 0.0001", "`cell` is 0.0001; it must lie between"),
            ("\"lane\": 1.22", "\"lane\": 3", "`lane` is 3"),
            ("[0.0, -5.0]", "[9.0, -5.0]", "`hurdles` is 9"),
            ("\"turns\": 0.02", "\"turns\": 1e9", "`runners.turns`"),
            ("\"pose\": \"wins\"", "\"pose\": \"falls\"", "unknown variant `falls`"),
            ("\"rod_sides\": 10", "\"rod_sides\": 1", "`rod_sides` is 1"),
        ];
        let kitchen = [
            ("\"wall_tile\": 0.12", "\"wall_tile\": 0", "`wall_tile` is 0; it must lie between"),
            ("\"sill\": 1.10", "\"sill\": 0.5", "`window.sill` is 0.5"),
            ("\"head\": 2.12", "\"head\": 2.65", "`window.head` is 2.65"),
            ("\"size\": [1.5, 0.86]", "\"size\": [1.5, 4]", "`table.size` is 4"),
            ("\"jars\": 9", "\"jars\": 0", "`jars` is 0"),
            ("\"turns\": 0.48", "\"turns\": 1e9", "`chairs.turns`"),
            ("\"at\": [-0.25, 1.75, 0.75]", "\"at\": [-0.25, 2.65, 0.75]", "`lamps.at` is 2.65"),
            ("\"spices\"", "\"spice\"", "unknown field `spice`"),
        ];
        let conference = [
            ("\"wide\": 1.9", "\"wide\": 2.9", "`windows.wide` is 2.9; it must lie between"),
            ("\"head\": 2.45", "\"head\": 2.8", "`windows.head` is 2.8"),
            ("\"tilt\": 0.055", "\"tilt\": 0.3", "`blinds.tilt` is 0.3"),
            ("\"slats\": 52", "\"slats\": 1000", "`blinds.slats`"),
            ("\"size\": [1.55, 5.6]", "\"size\": [1.55, 56]", "`table.size` is 56"),
            ("\"seats\": 7", "\"seats\": 0", "`seats` is 0"),
            ("\"at\": [0.0, 1.88, -1.3]", "\"at\": [0.0, 2.88, -1.3]", "`lamps.at` is 2.88"),
            ("\"battens\"", "\"battons\"", "unknown field `battons`"),
        ];
        let courtyard = [
            ("\"bay\": 2.4", "\"bay\": 1", "`bay` is 1; it must lie between"),
            ("\"bays\": [5, 6]", "\"bays\": [5, 60]", "`bays` is 60"),
            ("\"at\": [4.3, 2.2]", "\"at\": [5.3, 2.2]", "`trees.at` is 5.3"),
            ("\"trunk\": 1.6", "\"trunk\": 16", "`trees.trunk` is 16"),
            ("\"tree_leaves\": 62000", "\"tree_leaves\": 0", "`tree_leaves` is 0"),
            ("\"fountain\": [0.0, 0.3]", "\"fountain\": [0.0, 9]", "`fountain` is 9"),
            ("\"roof_tile\": 0.24", "\"roof_tile\": 0", "`roof_tile` is 0"),
            ("\"pots\"", "\"pot\"", "unknown field `pot`"),
        ];
        let bathroom = [
            ("\"tiles\": 0.98", "\"tiles\": 2", "`room.tiles` is 2"),
            ("\"far\": -0.6", "\"far\": -1.5", "`window.far` is -1.5"),
            ("\"size\": [1.05, 1.05]", "\"size\": [1.05, 3]", "`shower.size` is 3"),
            ("\"size\": [0.72, 1.62]", "\"size\": [0.1, 1.62]", "`tub.size` is 0.1"),
            ("\"mosaic_tile\": 0.04", "\"mosaic_tile\": -1", "`mosaic_tile` is -1"),
            ("\"bubbles\": 270", "\"bubbles\": 1000000", "`bubbles`"),
            ("\"mat\": [20, 30]", "\"mat\": [20, 0]", "`mat` is 0"),
            ("\"stakes\": 30", "\"stakes\": 1", "`stakes` is 1"),
            ("\"leaves\"", "\"leafs\"", "unknown field `leafs`"),
        ];
        for (scene, cases) in [
            ("cafe", cafe.as_slice()),
            ("runner", runner.as_slice()),
            ("kitchen", kitchen.as_slice()),
            ("conference", conference.as_slice()),
            ("courtyard", courtyard.as_slice()),
            ("bathroom", bathroom.as_slice()),
        ] {
            for (from, to, expected) in cases {
                let message = changed(scene, from, to).unwrap_err().to_string();
                assert!(message.contains(expected), "{message}");
            }
        }
    }

    #[test]
    fn other_parameters_and_seeds_make_other_scenes() {
        for (scene, from, to) in [
            ("cafe", "\"glass_sides\": 21", "\"glass_sides\": 42"),
            ("runner", "\"cell\": 0.0222", "\"cell\": 0.02"),
            ("kitchen", "\"small_sides\": 14", "\"small_sides\": 28"),
            ("conference", "\"small_sides\": 16", "\"small_sides\": 20"),
            ("bathroom", "\"towel_cells\": 34", "\"towel_cells\": 60"),
        ] {
            let base = changed(scene, "\"seed\": 2016", "\"seed\": 2016").unwrap();
            let other = changed(scene, "\"seed\": 2016", "\"seed\": 2017").unwrap();
            // Nothing but pictures is strewn at the finish line.
            assert!((base.groups != other.groups) == (scene != "runner") && base.textures != other.textures);
            let finer = changed(scene, from, to).unwrap();
            assert!(finer.triangle_count() > base.triangle_count());
        }
    }
}
