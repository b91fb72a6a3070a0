// SPDX-License-Identifier: MIT OR Apache-2.0
//! A generated scene before it becomes files or a [`crate::Scene`].

use std::collections::HashMap;

use super::mesh::Mesh;
use super::paint::Canvas;
use crate::monitor::Monitor;
use crate::scene::Surface;
use crate::{Error, Result};

/// A generated scene: named meshes, the materials they are made of, and the pictures on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Name of the built-in scene.
    pub name: String,
    /// Objects; each is one OBJ group in one material.
    pub groups: Vec<Group>,
    /// Materials in the order of the MTL file.
    pub materials: Vec<Finish>,
    /// Pictures that materials refer to by name.
    pub textures: Vec<Picture>,
    /// The text of the scene's `view.json`.
    pub view: &'static str,
}

/// One object of a generated scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name of the OBJ group, without blanks; unique in its scene.
    pub name: String,
    /// Name of its material.
    pub material: String,
    /// Its triangles.
    pub mesh: Mesh,
}

/// A material of a generated scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Finish {
    /// Name in the MTL file, without blanks.
    pub name: String,
    /// `Kd`, linear RGB.
    pub diffuse: [f32; 3],
    /// `Ks`, linear RGB.
    pub specular: [f32; 3],
    /// `Ns`: Blinn-Phong exponent.
    pub shininess: f32,
    /// `Tf`, linear RGB: colour of light that passes through glass.
    pub transmission: [f32; 3],
    /// `Ni`: index of refraction.
    pub index_of_refraction: f32,
    /// How rays are treated; `view.json` lists the names of mirrors and glasses.
    pub surface: Surface,
    /// `map_Kd`: name of a picture.
    pub texture: Option<String>,
    /// `map_d`: name of a grey picture; where it is darker than one half there are holes.
    pub mask: Option<String>,
}

/// A picture of a generated scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// File name without folder, such as `floor.png`.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Three sRGB bytes a texel, rows from the top.
    pub rgb: Vec<u8>,
}

impl Finish {
    /// A matte material of one linear colour.
    pub fn matte(name: &str, diffuse: [f32; 3]) -> Self {
        Finish {
            name: name.into(),
            diffuse,
            specular: [0.0; 3],
            shininess: 1.0,
            transmission: [1.0; 3],
            index_of_refraction: 1.5,
            surface: Surface::Opaque,
            texture: None,
            mask: None,
        }
    }

    /// A material with a highlight of strength `specular` and exponent `shininess`.
    pub fn glossy(name: &str, diffuse: [f32; 3], specular: f32, shininess: f32) -> Self {
        Finish { specular: [specular; 3], shininess, ..Finish::matte(name, diffuse) }
    }

    /// A mirror of one linear colour.
    pub fn mirror(name: &str, diffuse: [f32; 3], specular: [f32; 3]) -> Self {
        Finish { specular, shininess: 1000.0, surface: Surface::Mirror, ..Finish::matte(name, diffuse) }
    }

    /// Glass; `surface` says whether it has a thickness.
    pub fn glass(name: &str, surface: Surface, transmission: [f32; 3]) -> Self {
        Finish { specular: [0.3; 3], shininess: 400.0, transmission, surface, ..Finish::matte(name, [0.0; 3]) }
    }

    /// This material with a picture on it.
    pub fn with_texture(self, picture: &str) -> Self {
        Finish { texture: Some(picture.into()), ..self }
    }

    /// This material with holes.
    pub fn with_mask(self, picture: &str) -> Self {
        Finish { mask: Some(picture.into()), ..self }
    }
}

impl Model {
    /// An empty model.
    pub fn new(name: &str, view: &'static str) -> Self {
        Model { name: name.into(), groups: Vec::new(), materials: Vec::new(), textures: Vec::new(), view }
    }

    /// Adds an object.
    pub fn add(&mut self, name: impl Into<String>, material: &str, mesh: Mesh) {
        self.groups.push(Group { name: name.into(), material: material.into(), mesh });
    }

    /// Adds a picture.
    pub fn add_picture(&mut self, name: &str, canvas: Canvas) {
        let (width, height) = (canvas.width, canvas.height);
        self.textures.push(Picture { name: name.into(), width, height, rgb: canvas.into_rgb() });
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.groups.iter().map(|g| g.mesh.triangles.len()).sum()
    }

    /// The index of a material.
    pub fn material_index(&self, name: &str) -> Option<usize> {
        self.materials.iter().position(|m| m.name == name)
    }

    /// Puts vertices in the order of their first use and rounds all coordinates to the few digits that the OBJ file shows (positions to 0.01 mm), so that the file and
    /// the model hold the same numbers; checks that every name resolves and every object has triangles.
    pub(super) fn finish(mut self, monitor: &Monitor) -> Result<Model> {
        let snap = |v: f32, steps: f32| (v * steps).round() / steps + 0.0;
        let count = self.groups.len() as f32;
        for (k, group) in self.groups.iter_mut().enumerate() {
            monitor.check()?;
            monitor.tell(k as f32 / count);
            group.mesh.sort_vertices();
            let mesh = &mut group.mesh;
            for p in &mut mesh.positions {
                *p = p.to_array().map(|v| snap(v, 100_000.0)).into();
            }
            for n in &mut mesh.normals {
                *n = n.to_array().map(|v| snap(v, 10_000.0)).into();
            }
            for t in &mut mesh.texcoords {
                *t = t.to_array().map(|v| snap(v, 10_000.0)).into();
            }
        }
        let mut seen = HashMap::new();
        for group in &self.groups {
            let trouble = if self.material_index(&group.material).is_none() {
                Some(format!("has the unknown material `{}`", group.material))
            } else if group.mesh.triangles.is_empty() {
                Some("has no triangles; raise the numbers in parameters.json".into())
            } else if !group.mesh.positions.iter().all(|p| p.is_finite() && p.abs().max_element() < 1000.0) {
                Some("reaches beyond 1 km; lower the lengths in parameters.json".into())
            } else {
                seen.insert(group.name.as_str(), ()).map(|()| "exists twice".into())
            };
            if let Some(trouble) = trouble {
                return Err(Error::scene(self.name.clone(), format!("object `{}` {trouble}", group.name)));
            }
        }
        for picture in self.materials.iter().flat_map(|m| [&m.texture, &m.mask]).flatten() {
            if !self.textures.iter().any(|t| t.name == *picture) {
                return Err(Error::scene(self.name.clone(), format!("unknown picture `{picture}`")));
            }
        }
        Ok(self)
    }
}
