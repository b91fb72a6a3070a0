// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scenes that a report draws: as they are, or changed in one thing so that a sweep has its steps. Views and materials
//! are fixed here, before anything is measured.

use std::path::Path;

use glam::{Vec2, Vec3};

use crate::error::{Error, Result, Setting};
use crate::math::{pack_normal, unpack_normal};
use crate::monitor::Monitor;
use crate::prepare::{PreparedScene, Shading};
use crate::scene::{Camera, Scene, SceneParts, Surface, builtin};

/// How a scene is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Recipe<'a> {
    /// A built-in scene, or a scene's path.
    AsItIs(&'a str),
    /// `cafe` with the materials of the first so many of [`MIRRORS`] made half mirrors.
    Mirrors(usize),
    /// `cafe`, seen as by one of [`VIEWS`].
    View(usize),
    /// `spheres` with each triangle cut into n x n equal ones, which changes no pixel's surface.
    Finer(u32),
}

/// Materials of `cafe` that become mirrors, step by step of the reflective sweep; each step keeps those before it.
pub const MIRRORS: [&[&str]; 5] =
    [&["marble", "porcelain"], &["floor"], &["panelling", "walnut", "oak"], &["plaster", "bentwood", "trim"], &[""]];

/// How much a surface of the reflective sweep reflects; it keeps the rest of its own colour.
const REFLECTANCE: f32 = 0.5;

/// A view of `cafe`: what it looks at, the eye and the point in the middle of the picture.
pub type NamedView = (&'static str, [f32; 3], [f32; 3]);

/// The views of the traced-pixel sweep.
pub const VIEWS: [NamedView; 5] = [
    ("floor and wall", [1.6, 1.6, 2.4], [2.4, 0.6, 0.6]),
    ("window side", [1.0, 1.5, 0.0], [-2.8, 1.4, 0.8]),
    ("the table from above", [1.8, 1.9, 2.6], [0.4, 0.4, 0.8]),
    ("the whole room", [1.8, 1.6, 3.3], [-0.3, 0.98, -1.5]),
    ("the counter", [0.4, 1.5, 0.6], [-0.4, 1.2, -2.4]),
];

impl Recipe<'_> {
    /// Makes the scene, ready to be drawn.
    ///
    /// # Errors
    /// Whatever loading and preparing report.
    pub fn prepare(self, monitor: &Monitor) -> Result<PreparedScene> {
        if let Recipe::AsItIs(name) = self
            && PreparedScene::is_baked_file(Path::new(name))
        {
            return PreparedScene::from_baked_file(Path::new(name), monitor);
        }
        PreparedScene::new(&self.scene(monitor)?, Shading::Full, monitor)
    }

    fn scene(self, monitor: &Monitor) -> Result<Scene> {
        match self {
            Recipe::AsItIs(name) if builtin::NAMES.contains(&name) && !Path::new(name).exists() => {
                builtin::to_scene_watched(name, monitor)
            }
            Recipe::AsItIs(path) => crate::scene::load(Path::new(path), monitor),
            Recipe::Mirrors(steps) => {
                let names = MIRRORS[..steps].concat();
                Scene::new(with_mirrors(builtin::to_scene("cafe")?.into_parts(), &names)?)
            }
            Recipe::View(at) => {
                let mut scene = builtin::to_scene("cafe")?;
                let (_, eye, look_at) = VIEWS[at];
                let camera = Camera { eye: eye.into(), look_at: look_at.into(), ..scene.view().camera };
                scene.set_view(crate::scene::View { camera, ..scene.view().clone() })?;
                Ok(scene)
            }
            Recipe::Finer(parts) => Scene::new(finer(builtin::to_scene("spheres")?.into_parts(), parts)),
        }
    }
}

/// Makes half mirrors of the materials of these names; an empty name stands for all that are opaque.
fn with_mirrors(mut parts: SceneParts, names: &[&str]) -> Result<SceneParts> {
    let all = names.contains(&"");
    for name in names.iter().filter(|name| !name.is_empty()) {
        if !parts.materials.iter().any(|m| m.name == *name) {
            return Err(Error::option(Setting::BuiltinScene, name, "a material of the scene"));
        }
    }
    for material in &mut parts.materials {
        let chosen = all || names.contains(&material.name.as_str());
        if chosen && material.surface == Surface::Opaque {
            (material.surface, material.specular) = (Surface::Mirror, Vec3::splat(REFLECTANCE));
        }
    }
    Ok(parts)
}

/// Cuts each triangle into `n` x `n` triangles of its shape, in its plane.
fn finer(parts: SceneParts, n: u32) -> SceneParts {
    let mut out = SceneParts {
        positions: Vec::new(),
        triangles: Vec::new(),
        corner_normals: Vec::new(),
        corner_texcoords: Vec::new(),
        triangle_objects: Vec::new(),
        ..parts.clone()
    };
    let step = 1.0 / n as f32;
    for (at, triangle) in parts.triangles.iter().enumerate() {
        let corners = triangle.map(|index| parts.positions[index as usize]);
        let normals = parts.corner_normals[at].map(unpack_normal);
        let texcoords = parts.corner_texcoords[at];
        let first = out.positions.len() as u32;
        let mut points: Vec<(u32, Vec2)> = Vec::new();
        // A triangular grid, row by row: row r has r + 1 points. Corners stay exactly where they are.
        for row in 0..=n {
            for column in 0..=row {
                let weights = [n - row, row - column, column].map(|w| w as f32 * step);
                let mix = |v: [Vec3; 3]| v[0] * weights[0] + v[1] * weights[1] + v[2] * weights[2];
                let t = texcoords[0] * weights[0] + texcoords[1] * weights[1] + texcoords[2] * weights[2];
                out.positions.push(mix(corners));
                points.push((pack_normal(mix(normals).normalize_or_zero()), t));
            }
        }
        let start = |row: u32| row * (row + 1) / 2;
        let mut add = |corners: [u32; 3]| {
            out.triangles.push(corners.map(|c| first + c));
            out.corner_normals.push(corners.map(|c| points[c as usize].0));
            out.corner_texcoords.push(corners.map(|c| points[c as usize].1));
            out.triangle_objects.push(parts.triangle_objects[at]);
        };
        for row in 0..n {
            for column in 0..=row {
                let (upper, lower) = (start(row) + column, start(row + 1) + column);
                add([upper, lower, lower + 1]);
                if column < row {
                    add([upper, lower + 1, upper + 1]);
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn finer_scenes_have_the_same_surface() {
        let parts = builtin::to_scene("rods").unwrap().into_parts();
        let area = |parts: &SceneParts| {
            let of = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|index| parts.positions[index as usize].as_dvec3());
                0.5 * (b - a).cross(c - a).length()
            };
            parts.triangles.iter().map(of).sum::<f64>()
        };
        let whole = area(&parts);
        for n in [1, 2, 5] {
            let finer = finer(parts.clone(), n);
            assert_eq!(finer.triangles.len(), parts.triangles.len() * (n * n) as usize);
            assert!((area(&finer) / whole - 1.0).abs() < 1e-5, "{n}");
            Scene::new(finer).unwrap();
        }
    }

    #[test]
    fn every_step_of_the_sweeps_can_be_made() {
        for steps in 1..=MIRRORS.len() {
            Recipe::Mirrors(steps).scene(&Monitor::default()).unwrap();
        }
        for view in 0..VIEWS.len() {
            Recipe::View(view).scene(&Monitor::default()).unwrap();
        }
        let parts = builtin::to_scene("spheres").unwrap().into_parts();
        assert!(with_mirrors(parts, &["no such material"]).is_err());
    }
}
