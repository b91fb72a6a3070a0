// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes a generated scene as OBJ, MTL, PNG and `view.json`.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::model::{Group, Model};
use crate::monitor::Monitor;
use crate::scene::Surface;
use crate::{Error, Result, files};

/// The text of `scene.obj`. Numbers are written with as many digits as give the same `f32` when read.
pub fn obj_text(model: &Model) -> String {
    let mut text = obj_head(model);
    let mut first = 1;
    for group in &model.groups {
        obj_group(&mut text, group, &mut first);
    }
    text
}

fn obj_head(model: &Model) -> String {
    let (name, count) = (&model.name, model.triangle_count());
    format!("# built-in scene \"{name}\" of Rarefy, {count} triangles\nmtllib scene.mtl\n")
}

/// Adds the text of a group, whose first vertex has the number `first`.
fn obj_group(out: &mut String, group: &Group, first: &mut usize) {
    let mesh = &group.mesh;
    // Writing to a String cannot fail.
    let _ = writeln!(out, "\ng {}", group.name);
    for p in &mesh.positions {
        let _ = writeln!(out, "v {} {} {}", p.x, p.y, p.z);
    }
    for t in &mesh.texcoords {
        let _ = writeln!(out, "vt {} {}", t.x, t.y);
    }
    for n in &mesh.normals {
        let _ = writeln!(out, "vn {} {} {}", n.x, n.y, n.z);
    }
    let _ = writeln!(out, "usemtl {}", group.material);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| i as usize + *first);
        let _ = writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
    }
    *first += mesh.positions.len();
}

/// The text of `scene.mtl`.
pub fn mtl_text(model: &Model) -> String {
    let mut out = format!("# materials of the built-in scene \"{}\" of Rarefy\n", model.name);
    for m in &model.materials {
        let rgb = |v: [f32; 3]| format!("{} {} {}", v[0], v[1], v[2]);
        let illum = match m.surface {
            Surface::Opaque => 2,
            Surface::Mirror => 3,
            Surface::Glass | Surface::ThinGlass => 7,
        };
        let _ = write!(
            out,
            "\nnewmtl {}\nillum {illum}\nKa 0 0 0\nKd {}\nKs {}\nNs {}\n",
            m.name,
            rgb(m.diffuse),
            rgb(m.specular),
            m.shininess
        );
        if matches!(m.surface, Surface::Glass | Surface::ThinGlass) {
            let _ = writeln!(out, "Ni {}\nTf {}", m.index_of_refraction, rgb(m.transmission));
        }
        if let Some(name) = &m.texture {
            let _ = writeln!(out, "map_Kd textures/{name}");
        }
        if let Some(name) = &m.mask {
            let _ = writeln!(out, "map_d textures/{name}");
        }
    }
    out
}

/// Writes a model into `folder`, whole or not at all.
///
/// # Errors
/// If `folder` exists and is not an empty folder, or cannot be written, or [`Error::Cancelled`].
pub fn write_model(model: &Model, folder: &Path, monitor: &Monitor) -> Result<()> {
    match fs::read_dir(folder) {
        Ok(mut entries) => {
            if entries.next().is_some() {
                return Err(refuse(folder, "the folder is not empty; name a new or an empty one"));
            }
        }
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
        Err(_) if folder.is_file() => return Err(refuse(folder, "this is a file; name a new or an empty folder")),
        Err(e) => return Err(Error::io(folder, e)),
    }
    files::write_folder(folder, |inner| {
        // Messages name where a file would have come to lie.
        let put =
            |name: &str, bytes: &[u8]| fs::write(inner.join(name), bytes).map_err(|e| Error::io(folder.join(name), e));
        write_obj(model, &inner.join("scene.obj"), &folder.join("scene.obj"), monitor)?;
        put("scene.mtl", mtl_text(model).as_bytes())?;
        put("view.json", model.view.as_bytes())?;
        if !model.textures.is_empty() {
            fs::create_dir(inner.join("textures")).map_err(|e| Error::io(folder.join("textures"), e))?;
        }
        for picture in &model.textures {
            let name = format!("textures/{}", picture.name);
            let mut encoded = Vec::new();
            PngEncoder::new(&mut encoded)
                .write_image(&picture.rgb, picture.width, picture.height, ExtendedColorType::Rgb8)
                .map_err(|e| Error::Image { path: folder.join(&name), message: e.to_string() })?;
            put(&name, &encoded)?;
        }
        Ok(())
    })
}

/// Writes `scene.obj` group by group: the whole text of a large scene takes hundreds of megabytes.
fn write_obj(model: &Model, path: &Path, shown: &Path, monitor: &Monitor) -> Result<()> {
    let fail = |e| Error::io(shown, e);
    let mut file = BufWriter::new(fs::File::create(path).map_err(fail)?);
    let mut text = obj_head(model);
    let mut first = 1;
    for (k, group) in model.groups.iter().enumerate() {
        monitor.check()?;
        monitor.tell(k as f32 / model.groups.len() as f32);
        obj_group(&mut text, group, &mut first);
        file.write_all(text.as_bytes()).map_err(fail)?;
        text.clear();
    }
    file.flush().map_err(fail)
}

fn refuse(folder: &Path, message: &str) -> Error {
    Error::io(folder, std::io::Error::new(std::io::ErrorKind::AlreadyExists, message))
}
