// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes of our own, made by deterministic code: a café to look at, and four tiny scenes for tests.
//!
//! Each scene has a folder `scenes/NAME` with its `view.json` and the parameters of its generator; both are part of
//! the library. The generators use `+ - * /` and square roots alone, so that every platform makes the same bytes.

pub mod cafe;
mod convert;
mod export;
pub mod mesh;
mod model;
pub mod paint;
pub mod tiny;

use std::path::Path;

use serde::de::DeserializeOwned;

pub use export::{mtl_text, obj_text};
pub use model::{Finish, Group, Model, Picture};

use crate::error::Setting;
use crate::{Error, Result, Scene};

/// The names of all built-in scenes.
pub const NAMES: [&str; 5] = ["cafe", "wall", "spheres", "rods", "mirror-room"];

/// Makes a built-in scene.
///
/// # Errors
/// If there is no scene of that name; the message lists those that exist.
pub fn generate(name: &str) -> Result<Model> {
    let model = match name {
        "cafe" => cafe::generate(
            &parameters(name, include_str!("../../../scenes/cafe/parameters.json"))?,
            include_str!("../../../scenes/cafe/view.json"),
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
    model.finish()
}

/// Writes a built-in scene as `scene.obj`, `scene.mtl`, `textures/*.png` and `view.json`, whole or not at all.
///
/// # Errors
/// If there is no scene of that name, or if `folder` exists and is not an empty folder, or cannot be written.
pub fn write(name: &str, folder: &Path) -> Result<()> {
    export::write_model(&generate(name)?, folder)
}

/// Makes a built-in scene ready to be drawn, without files: the same scene as loading what [`write()`] wrote.
///
/// # Errors
/// If there is no scene of that name; the message lists those that exist.
pub fn to_scene(name: &str) -> Result<Scene> {
    convert::scene_of(&generate(name)?)
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const CAFE: &str = include_str!("../../../scenes/cafe/parameters.json");

    /// What the café's generator says about parameters in which `from` is replaced by `to`.
    fn changed(from: &str, to: &str) -> Result<Model> {
        assert!(CAFE.contains(from), "{from}");
        cafe::generate(&parameters("cafe", &CAFE.replace(from, to))?, "{}")?.finish()
    }

    #[test]
    fn parameters_out_of_range_are_refused_with_key_and_range() {
        assert!(changed("\"seed\": 2016", "\"seed\": 1").is_ok());
        for (from, to, expected) in [
            ("\"tube_radius\": 0.0145", "\"tube_radius\": 0.5", "`chair.tube_radius` is 0.5; it must lie between"),
            ("\"leaves\": 34", "\"leaves\": 1000000", "`leaves`"),
            ("\"texture\": 512", "\"texture\": 100000", "`texture`"),
            ("\"radius\": 0.38", "\"radius\": -1", "`tables.radius`"),
            ("\"seed\": 2016", "\"sead\": 2016", "scenes/cafe/parameters.json:2: unknown field `sead`"),
            ("\"leaves\": 34", "\"leaves\": -1", "scenes/cafe/parameters.json:"),
        ] {
            let message = changed(from, to).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn other_parameters_and_seeds_make_other_scenes() {
        let base = changed("\"seed\": 2016", "\"seed\": 2016").unwrap();
        let other = changed("\"seed\": 2016", "\"seed\": 2017").unwrap();
        assert!(base.groups != other.groups && base.textures != other.textures);
        let finer = changed("\"glass_sides\": 21", "\"glass_sides\": 42").unwrap();
        assert!(finer.triangle_count() > base.triangle_count());
    }
}
