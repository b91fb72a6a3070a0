// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes of our own, made by deterministic code: a café to look at, and four tiny scenes for tests.
//!
//! Each scene has a folder `scenes/NAME` with its `view.json` and the parameters of its generator; both are part of
//! the library. The generators use `+ - * /` and square roots alone, so that every platform makes the same bytes.

pub mod cafe;
mod export;
pub mod mesh;
mod model;
pub mod paint;
pub mod tiny;

use std::path::Path;

use serde::de::DeserializeOwned;

pub use export::{mtl_text, obj_text};
pub use model::{Finish, Group, Model, Picture};

use crate::{Error, Result};

/// The names of all built-in scenes.
pub const NAMES: [&str; 5] = ["cafe", "wall", "spheres", "rods", "mirror-room"];

/// Makes a built-in scene.
///
/// # Errors
/// If there is no scene of that name; the message lists those that exist.
pub fn generate(name: &str) -> Result<Model> {
    let model = match name {
        "cafe" => cafe::generate(
            &parameters(name, include_str!("../../scenes/cafe/parameters.json"))?,
            include_str!("../../scenes/cafe/view.json"),
        )?,
        "wall" => tiny::wall(
            &parameters(name, include_str!("../../scenes/wall/parameters.json"))?,
            include_str!("../../scenes/wall/view.json"),
        )?,
        "spheres" => tiny::spheres(
            &parameters(name, include_str!("../../scenes/spheres/parameters.json"))?,
            include_str!("../../scenes/spheres/view.json"),
        )?,
        "rods" => tiny::rods(
            &parameters(name, include_str!("../../scenes/rods/parameters.json"))?,
            include_str!("../../scenes/rods/view.json"),
        )?,
        "mirror-room" => tiny::mirror_room(
            &parameters(name, include_str!("../../scenes/mirror-room/parameters.json"))?,
            include_str!("../../scenes/mirror-room/view.json"),
        )?,
        _ => {
            let message = format!("no built-in scene has this name; there are {}", NAMES.join(", "));
            return Err(Error::option(name, message));
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

/// The built-in scene `name`, ready to draw.
pub fn to_scene(name: &str) -> Result<crate::Scene> {
    let d = tempfile::tempdir().map_err(|e| Error::io("tmp", e))?;
    let p = d.path().join(name);
    write(name, &p)?;
    crate::scene::load(&p, &|_, _| ())
}
