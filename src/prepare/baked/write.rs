// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writing baked scenes: once through everything for the checksum, once more to write.

use std::io::{self, BufWriter, Write};

use bytemuck::Pod;

use super::{Head, LightWords, MAGIC, PREFIX_BYTES, VERSION, to_little_endian};
use crate::error::Remedy;
use crate::prepare::{PreparedScene, Shading};
use crate::{Error, Result, memory};

/// What is about to be written.
pub(super) struct Plan<'a> {
    scene: &'a PreparedScene,
    head: Head,
    lights: Vec<LightWords>,
    name_lengths: Vec<u32>,
}

impl<'a> Plan<'a> {
    pub fn new(scene: &'a PreparedScene) -> Result<Self> {
        let view = &scene.view;
        let camera = &view.camera;
        let mut name_lengths = memory::with_room("the names of objects", scene.object_names.len())?;
        for name in &scene.object_names {
            name_lengths.push(count(scene, "bytes of a name", name.len())?);
        }
        let names: usize = scene.object_names.iter().map(String::len).sum();
        let head = Head {
            shading: match scene.shading {
                Shading::Full => 0,
                Shading::Anchor => 1,
            },
            lights: count(scene, "lights", view.lights.len())?,
            nodes: count(scene, "nodes", scene.tree.nodes.len())?,
            leaf_triangles: count(scene, "leaf entries", scene.tree.leaf_triangles.len())?,
            triangles: count(scene, "triangles", scene.triangles.len())?,
            materials: count(scene, "materials", scene.materials.len())?,
            objects: count(scene, "objects", scene.object_materials.len())?,
            textures: count(scene, "textures", scene.textures.len())?,
            texels: count(scene, "texels", scene.texels.len())?,
            name_bytes: count(scene, "bytes of a name", scene.name.len())?,
            object_name_bytes: count(scene, "bytes of names", names)?,
            eye: camera.eye.to_array(),
            look_at: camera.look_at.to_array(),
            up: camera.up.to_array(),
            fov_y_degrees: camera.fov_y_degrees,
            ambient: view.ambient.to_array(),
            background: view.background.to_array(),
            extent: view.extent,
            epsilon: scene.epsilon,
            bounds_min: scene.tree.bounds_min,
            bounds_max: scene.tree.bounds_max,
            origin: scene.origin.to_array().map(|v| [v.to_bits() as u32, (v.to_bits() >> 32) as u32]),
        };
        let light = |light: &crate::scene::Light| {
            let [[px, py, pz], [ix, iy, iz]] = [light.position.to_array(), light.intensity.to_array()];
            [px, py, pz, ix, iy, iz]
        };
        Ok(Plan { scene, head, lights: view.lights.iter().map(light).collect(), name_lengths })
    }

    pub fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        let (mut sum, mut length) = (crc32fast::Hasher::new(), PREFIX_BYTES);
        self.each(&mut |bytes| {
            length += bytes.len() as u64;
            Ok(())
        })?;
        sum.update(&length.to_le_bytes());
        self.each(&mut |bytes| {
            sum.update(bytes);
            Ok(())
        })?;
        // Names are short, and there may be many.
        let mut writer = BufWriter::new(writer);
        writer.write_all(MAGIC)?;
        writer.write_all(&VERSION.to_le_bytes())?;
        writer.write_all(&sum.finalize().to_le_bytes())?;
        writer.write_all(&length.to_le_bytes())?;
        self.each(&mut |bytes| writer.write_all(bytes))?;
        writer.flush()
    }

    /// Gives `take` everything behind the prefix, in order.
    fn each(&self, take: &mut dyn FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let scene = self.scene;
        words(std::slice::from_ref(&self.head), take)?;
        words(&self.lights, take)?;
        words(&scene.tree.nodes, take)?;
        words(&scene.tree.leaf_triangles, take)?;
        words(&scene.triangles, take)?;
        words(&scene.triangle_shading, take)?;
        words(&scene.materials, take)?;
        words(&scene.object_materials, take)?;
        words(&scene.textures, take)?;
        words(&scene.texels, take)?;
        words(&self.name_lengths, take)?;
        take(scene.name.as_bytes())?;
        scene.object_names.iter().try_for_each(|name| take(name.as_bytes()))
    }
}

/// Words that are turned at once, where they have to be.
const WORDS_AT_ONCE: usize = 1 << 16;

fn words<T: Pod>(values: &[T], take: &mut dyn FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
    let words: &[u32] = bytemuck::cast_slice(values);
    if cfg!(target_endian = "little") {
        return take(bytemuck::cast_slice(words));
    }
    for part in words.chunks(WORDS_AT_ONCE) {
        let mut part = part.to_vec();
        to_little_endian(&mut part);
        take(bytemuck::cast_slice(&part))?;
    }
    Ok(())
}

fn count(scene: &PreparedScene, what: &str, count: usize) -> Result<u32> {
    u32::try_from(count).map_err(|_| Error::LimitExceeded {
        what: format!("the baked scene {}", scene.name),
        limit: what.into(),
        wanted: count.to_string(),
        allowed: u32::MAX.to_string(),
        remedies: &[Remedy::SmallerScene],
    })
}
