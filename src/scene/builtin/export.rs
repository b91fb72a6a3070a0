// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes a generated scene as OBJ, MTL, PNG and `view.json`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::model::Model;
use crate::scene::Surface;
use crate::{Error, Result};

/// The text of `scene.obj`. Numbers are written with as many digits as give the same `f32` when read.
pub fn obj_text(model: &Model) -> String {
    let mut out = format!(
        "# built-in scene \"{}\" of Rarefy, {} triangles\nmtllib scene.mtl\n",
        model.name,
        model.triangle_count()
    );
    let mut first = 1;
    for group in &model.groups {
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
            let [a, b, c] = t.map(|i| i as usize + first);
            let _ = writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
        }
        first += mesh.positions.len();
    }
    out
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
/// If `folder` exists and is not an empty folder, or cannot be written.
pub fn write_model(model: &Model, folder: &Path) -> Result<()> {
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
    let parent = match folder.parent() {
        Some(p) if !p.as_os_str().is_empty() => p.to_path_buf(),
        _ => PathBuf::from("."),
    };
    fs::create_dir_all(&parent).map_err(|e| Error::io(&parent, e))?;
    // Written beside the target and renamed at the end, so that a failure leaves nothing behind.
    let aside = tempfile::Builder::new().prefix(".rarefy-").tempdir_in(&parent).map_err(|e| Error::io(&parent, e))?;
    let inner = aside.path().join("scene");
    let textures = inner.join("textures");
    let made = if model.textures.is_empty() { &inner } else { &textures };
    fs::create_dir_all(made).map_err(|e| Error::io(folder, e))?;
    let put = |name: &str, text: &str| fs::write(inner.join(name), text).map_err(|e| Error::io(folder.join(name), e));
    put("scene.obj", &obj_text(model))?;
    put("scene.mtl", &mtl_text(model))?;
    put("view.json", model.view)?;
    for picture in &model.textures {
        let path = textures.join(&picture.name);
        let shown = folder.join("textures").join(&picture.name);
        image::save_buffer(&path, &picture.rgb, picture.width, picture.height, image::ExtendedColorType::Rgb8)
            .map_err(|e| match e {
                image::ImageError::IoError(source) => Error::io(&shown, source),
                other => Error::Image { path: shown.clone(), message: other.to_string() },
            })?;
    }
    // Renaming onto an empty folder works on Unix only, so it is taken away first.
    match fs::remove_dir(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(Error::io(folder, e)),
        _ => {}
    }
    fs::rename(&inner, folder).map_err(|e| Error::io(folder, e))
}

fn refuse(folder: &Path, message: &str) -> Error {
    Error::option("-o", format!("{}: {message}", folder.display()))
}
