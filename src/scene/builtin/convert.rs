// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a generated model to a [`Scene`], without files.

use std::collections::HashMap;

use glam::Vec3;

use super::model::Model;
use crate::math::pack_normal;
use crate::monitor::Monitor;
use crate::scene::{LoadNotes, Material, Object, SceneParts, Texture, complete_view};
use crate::{Error, Result, Scene};

/// Makes the scene that [`crate::scene::load`] would make from the model's files. Each mesh is given back as soon as it
/// was taken over: a scene of millions of triangles is in memory once.
pub fn scene_of(mut model: Model, monitor: &Monitor) -> Result<Scene> {
    let (view, warnings) = complete_view(&format!("scenes/{}/view.json", model.name), model.view)?;
    let mut parts = SceneParts { name: model.name.clone(), view, warnings, ..SceneParts::default() };
    parts.notes = LoadNotes { extent_given: true, ..LoadNotes::default() };
    let mut known = HashMap::new();
    for m in &model.materials {
        let mut texture = |name: &Option<String>, is_mask: bool| match name {
            None => Ok(None),
            Some(name) => match known.get(&(name.clone(), is_mask)) {
                Some(&index) => Ok(Some(index)),
                None => {
                    let index = parts.textures.len() as u32;
                    parts.textures.push(texture_of(&model, name, is_mask)?);
                    known.insert((name.clone(), is_mask), index);
                    Ok::<_, Error>(Some(index))
                }
            },
        };
        let diffuse_texture = texture(&m.texture, false)?;
        let cutout_texture = texture(&m.mask, true)?;
        // Only glasses have these in their files.
        let base = Material::default();
        let passes = matches!(m.surface, crate::scene::Surface::Glass | crate::scene::Surface::ThinGlass);
        parts.materials.push(Material {
            name: m.name.clone(),
            diffuse: Vec3::from(m.diffuse),
            specular: Vec3::from(m.specular),
            shininess: m.shininess,
            emission: base.emission,
            transmission: if passes { Vec3::from(m.transmission) } else { base.transmission },
            index_of_refraction: if passes { m.index_of_refraction } else { base.index_of_refraction },
            opacity: base.opacity,
            surface: m.surface,
            diffuse_texture,
            cutout_texture,
        });
    }
    parts.materials.push(Material::default());
    let groups = std::mem::take(&mut model.groups);
    let count = groups.len() as f32;
    let triangles = groups.iter().map(|g| g.mesh.triangles.len()).sum();
    parts.positions.reserve(groups.iter().map(|g| g.mesh.positions.len()).sum());
    parts.triangles.reserve(triangles);
    parts.corner_normals.reserve(triangles);
    parts.corner_texcoords.reserve(triangles);
    parts.triangle_objects.reserve(triangles);
    for (k, group) in groups.into_iter().enumerate() {
        monitor.check()?;
        monitor.tell(k as f32 / count);
        let unknown = || Error::scene(model.name.clone(), format!("unknown material `{}`", group.material));
        let material = model.material_index(&group.material).ok_or_else(unknown)? as u32;
        let object = parts.objects.len() as u32;
        parts.objects.push(Object { name: group.name.clone(), material });
        let mesh = &group.mesh;
        let first = parts.positions.len() as u32;
        parts.positions.extend_from_slice(&mesh.positions);
        let normals: Vec<u32> = mesh.normals.iter().map(|&n| pack_normal(n)).collect();
        for t in &mesh.triangles {
            parts.triangles.push(t.map(|i| first + i));
            parts.corner_normals.push(t.map(|i| normals[i as usize]));
            parts.corner_texcoords.push(t.map(|i| mesh.texcoords[i as usize]));
            parts.triangle_objects.push(object);
        }
    }
    Scene::new(parts)
}

/// The texture that a picture becomes: a mask's opacity is its grey value.
fn texture_of(model: &Model, name: &str, is_mask: bool) -> Result<Texture> {
    let unknown = || Error::scene(model.name.clone(), format!("unknown picture `{name}`"));
    let picture = model.textures.iter().find(|p| p.name == name).ok_or_else(unknown)?;
    let texel = |p: &[u8]| u32::from_le_bytes([p[0], p[1], p[2], if is_mask { p[0] } else { 255 }]);
    Ok(Texture {
        name: format!("textures/{name}"),
        width: picture.width,
        height: picture.height,
        texels: picture.rgb.chunks_exact(3).map(texel).collect(),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::builtin::generate;

    #[test]
    fn a_view_without_camera_or_a_model_with_unknown_names_is_refused() {
        let mut model = generate("spheres").unwrap();
        assert!(scene_of(model.clone(), &Monitor::default()).is_ok());
        model.groups[0].material = "none".into();
        assert!(
            scene_of(model.clone(), &Monitor::default()).unwrap_err().to_string().contains("unknown material `none`")
        );
        let mut model = generate("spheres").unwrap();
        model.textures.clear();
        assert!(
            scene_of(model.clone(), &Monitor::default())
                .unwrap_err()
                .to_string()
                .contains("unknown picture `checks.png`")
        );
        let mut model = generate("wall").unwrap();
        model.view = "{\"lights\": [], \"extent\": 1}";
        assert_eq!(
            scene_of(model.clone(), &Monitor::default()).unwrap_err().to_string(),
            "scenes/wall/view.json: `camera` is missing"
        );
    }
}
