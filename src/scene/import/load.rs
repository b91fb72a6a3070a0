// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a folder or an OBJ file to a [`Scene`].

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::LoadOptions;
use super::assemble::{self, Geometry, TexcoordMap};
use super::find::{Finder, Found, without_comment_and_quotes};
use super::fit::{Extents, fitted_camera, fitted_light};
use super::mtl::{self, MtlMaterial};
use super::normals;
use super::notices::Notices;
use super::obj::{self, ObjFile};
use super::source::{FileSource, Source};
use super::texture::{Role, Textures};
use super::view::{self, ViewFile};
use crate::error::printable;
use crate::monitor::Monitor;
use crate::scene::{LoadNotes, Material, Scene, SceneParts, Surface, Texture, View};
use crate::{Error, Result};

/// Loads the scene at `path`: a folder with `scene.obj` (and `view.json`), or an OBJ file (`view.json` beside it is
/// used). Without a view the camera and a light are fitted to the scene, and a warning says so.
///
/// `monitor` hears what is being done, and can end it.
///
/// # Errors
/// Files that cannot be read or make no sense; each message names the file and, where there is one, line or key.
/// What can be mended or left out is, with a sentence in [`Scene::warnings`]. [`Error::LimitExceeded`] for more than a
/// budget of [`LoadOptions`] allows. [`Error::Cancelled`].
pub fn load(path: &Path, monitor: &Monitor) -> Result<Scene> {
    load_with(path, &LoadOptions::default(), monitor)
}

/// As [`load`], with options.
///
/// # Errors
/// As for [`load`].
pub fn load_with(path: &Path, options: &LoadOptions, monitor: &Monitor) -> Result<Scene> {
    let files = find_files(path)?;
    let source = Source::disk(files.obj.parent().unwrap_or(Path::new("")), options)?;
    // Even these may be links.
    if let Some(outside) = [Some(&files.obj), files.view.as_ref()].into_iter().flatten().find(|p| source.forbids(p)) {
        let message = "lies outside the scene's folder, to which these options confine it";
        return Err(Error::scene(outside.display().to_string(), message));
    }
    load_files(files, &source, options, monitor)
}

/// Loads the scene `name` from files that are no files of the file system: the same scene as [`load`] makes of the same
/// files. `name` is the OBJ file's, or that of a folder with `scene.obj`; `view.json` and what the files name is looked
/// for beside it.
///
/// # Errors
/// As for [`load`], and those of `files`.
pub fn load_from(name: &str, files: &dyn FileSource, options: &LoadOptions, monitor: &Monitor) -> Result<Scene> {
    let source = Source::caller(files);
    let path = Path::new(name);
    let obj = path.join("scene.obj");
    let (obj, named_after) = if source.is_file(&obj)? { (obj, path) } else { (path.to_path_buf(), path) };
    if !source.is_file(&obj)? {
        let message = "no such file; a scene is an .obj file or a folder with scene.obj";
        return Err(Error::scene(name, message));
    }
    let view = obj.with_file_name("view.json");
    let view = source.is_file(&view)?.then_some(view);
    let name = base_name(named_after).unwrap_or_else(|| "scene".into());
    load_files(Files { name, obj, view }, &source, options, monitor)
}

fn load_files(files: Files, source: &Source, options: &LoadOptions, monitor: &Monitor) -> Result<Scene> {
    let Files { name, obj, view } = files;
    // First the small files: a wrong key should not cost the time of a large mesh.
    let mut view_file = match &view {
        Some(view) => view::read(source, view)?,
        None => ViewFile::default(),
    };
    monitor.restart();
    let file = obj::read(source, &obj, options, &monitor.part("reading geometry", 0.0, 0.6))?;
    let mut warnings = file.warnings.clone();
    let duplicate_names = file.reopened_groups.clone();

    let part = monitor.part("reading materials", 0.6, 0.8);
    let palette = Palette::load(source, &obj, &file, &view_file, view.as_deref(), options, &mut warnings, &part)?;

    let part = monitor.part("building triangles", 0.8, 0.9);
    let materials = assemble::FileMaterials {
        of: &palette.material_of,
        maps: &palette.texcoord_maps,
        default: palette.default_material,
    };
    let mut geometry = assemble::assemble(source, &obj, file, &materials, &part)?;
    warnings.append(&mut geometry.warnings);
    if let Some(expected) = view_file.triangles
        && expected != (geometry.triangles.len() + geometry.dropped) as u64
    {
        let (at, found) = (obj.display(), geometry.triangles.len() + geometry.dropped);
        warnings.push(format!("{at}: {found} triangles, though view.json says {expected}"));
    }

    let part = monitor.part("computing normals", 0.9, 1.0);
    let missing = std::mem::take(&mut geometry.corners_without_normal);
    normals::compute(&geometry.positions, &geometry.triangles, &missing, &mut geometry.corner_normals, &part)?;
    let notes = LoadNotes {
        triangles_without_normals: missing.iter().filter(|&&m| m != 0).count(),
        triangles_without_texcoords: textured_without_texcoords(&geometry, &palette.materials),
        dropped_triangles: geometry.dropped,
        duplicate_names,
        missing_textures: palette.missing_textures,
        extent_given: view_file.extent.is_some(),
    };
    drop(missing);

    let place = view.as_ref().map_or_else(|| format!("{} (no view.json)", obj.display()), |v| v.display().to_string());
    let view = make_view(&mut view_file, &geometry, &place, &mut warnings);
    for warning in &mut warnings {
        if let Cow::Owned(escaped) = printable(warning) {
            *warning = escaped;
        }
    }
    monitor.check()?;
    part.tell(1.0);
    Scene::new(SceneParts {
        name,
        positions: geometry.positions,
        triangles: geometry.triangles,
        corner_normals: geometry.corner_normals,
        corner_texcoords: geometry.corner_texcoords,
        triangle_objects: geometry.triangle_objects,
        objects: geometry.objects,
        materials: palette.materials,
        textures: palette.textures,
        view,
        warnings,
        notes,
    })
}

/// The files of a scene.
struct Files {
    name: String,
    obj: PathBuf,
    view: Option<PathBuf>,
}

fn find_files(path: &Path) -> Result<Files> {
    let meta = std::fs::metadata(path).map_err(|e| {
        if e.kind() == std::io::ErrorKind::NotFound {
            let message = "no such file or folder; a scene is a folder with scene.obj and view.json, or an .obj file";
            Error::scene(path.display().to_string(), message)
        } else {
            Error::io(path, e)
        }
    })?;
    let (folder, obj) = if meta.is_dir() {
        let obj = path.join("scene.obj");
        if !obj.is_file() {
            return Err(Error::scene(
                obj.display().to_string(),
                "not found; a scene folder holds scene.obj and view.json",
            ));
        }
        (path.to_path_buf(), obj)
    } else {
        (path.parent().unwrap_or(Path::new("")).to_path_buf(), path.to_path_buf())
    };
    let named_after =
        if meta.is_dir() { path.canonicalize().ok().and_then(|p| base_name(&p)) } else { base_name(path) };
    let view = folder.join("view.json");
    Ok(Files { name: named_after.unwrap_or_else(|| "scene".into()), obj, view: view.is_file().then_some(view) })
}

fn base_name(path: &Path) -> Option<String> {
    path.file_stem().map(|s| s.to_string_lossy().into_owned())
}

/// The materials of a scene and what refers to them.
struct Palette {
    materials: Vec<Material>,
    textures: Vec<Texture>,
    missing_textures: Vec<String>,
    /// By the OBJ file's material number.
    material_of: Vec<u32>,
    texcoord_maps: Vec<TexcoordMap>,
    default_material: u32,
}

impl Palette {
    #[allow(clippy::too_many_arguments)] // each of them once
    fn load(
        source: &Source,
        obj: &Path,
        file: &ObjFile,
        view: &ViewFile,
        view_path: Option<&Path>,
        options: &LoadOptions,
        warnings: &mut Vec<String>,
        monitor: &Monitor,
    ) -> Result<Self> {
        let mut finder = Finder::new(source, obj, monitor);
        let defined = read_libraries(&mut finder, obj, file, warnings)?;
        let mut textures = Textures::new(finder, options, monitor);
        let mut materials = Vec::with_capacity(defined.len() + 1);
        let mut maps = Vec::with_capacity(defined.len() + 1);
        let kinds = Kinds::new(view);
        for (done, (folder, m)) in defined.iter().enumerate() {
            monitor.check()?;
            monitor.tell(done as f32 / defined.len() as f32);
            materials.push(kinds.material(m, folder, &mut textures, warnings)?);
            maps.push(m.diffuse_map.as_ref().map_or(TexcoordMap::default(), |map| map.texcoords));
            if let (Some(colour), Some(mask)) = (&m.diffuse_map, &m.cutout_map)
                && colour.texcoords != mask.texcoords
            {
                warnings
                    .push(format!("material `{}`: map_d has other -s or -o than map_Kd; map_Kd's are used", m.name));
            }
        }
        warnings.append(&mut textures.take_warnings());
        let mut by_name: HashMap<String, u32> =
            materials.iter().enumerate().map(|(i, m): (_, &Material)| (m.name.clone(), i as u32)).collect();
        let mut by_lower_case: HashMap<String, u32> = HashMap::new();
        for (i, m) in materials.iter().enumerate() {
            by_lower_case.entry(m.name.to_lowercase()).or_insert(i as u32);
        }
        let default_material = materials.len() as u32;
        materials.push(Material::default());
        maps.push(TexcoordMap::default());
        // Materials that no file defines keep their names, so that objects stay apart and lists find them.
        let (mut unknown, mut renamed) = (Vec::new(), Vec::new());
        for (name, line) in &file.materials {
            if by_name.contains_key(name) {
                continue;
            }
            let meant = without_comment_and_quotes(name);
            let meant = by_name.get(meant).or_else(|| by_lower_case.get(&meant.to_lowercase())).copied();
            if name.is_empty() {
                by_name.insert(String::new(), default_material);
            } else if let Some(meant) = meant {
                by_name.insert(name.clone(), meant);
                renamed.push((name, line, meant));
            } else {
                let m = MtlMaterial { name: name.clone(), ..Default::default() };
                by_name.insert(name.clone(), materials.len() as u32);
                materials.push(kinds.material(&m, Path::new(""), &mut textures, warnings)?);
                maps.push(TexcoordMap::default());
                unknown.push((name, line));
            }
        }
        let and_more = |count: usize| if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
        if let Some(&(name, line, meant)) = renamed.first() {
            let (at, more, meant) = (obj.display(), and_more(renamed.len()), &materials[meant as usize].name);
            warnings.push(format!("{at}:{line}: no MTL file defines material `{name}`{more}; `{meant}` is meant"));
        }
        if let Some((name, line)) = unknown.first() {
            let more = and_more(unknown.len());
            let at = obj.display();
            warnings.push(format!("{at}:{line}: no MTL file defines material `{name}`{more}; drawn light grey"));
        }
        if let Some(path) = view_path {
            kinds.tell_unknown(path, &by_name, warnings);
        }
        let material_of: Vec<u32> = file.materials.iter().map(|(name, _)| by_name[name]).collect();
        let texcoord_maps = material_of.iter().map(|&m| maps[m as usize]).collect();
        let (textures, missing_textures) = (textures.textures, textures.missing);
        Ok(Palette { materials, textures, missing_textures, material_of, texcoord_maps, default_material })
    }
}

/// The materials of all MTL files, each with the folder that its textures are relative to.
fn read_libraries(
    finder: &mut Finder,
    obj: &Path,
    file: &ObjFile,
    warnings: &mut Vec<String>,
) -> Result<Vec<(PathBuf, MtlMaterial)>> {
    let source = finder.source();
    let folder = obj.parent().unwrap_or(Path::new(""));
    let mut read_paths = HashSet::new();
    let mut materials: Vec<(PathBuf, MtlMaterial)> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let (mut own, mut told) = (Vec::new(), Notices::default());
    for (argument, line) in &file.libraries {
        for (name, found) in find_libraries(finder, folder, argument)? {
            told.shorten(&mut own, 0);
            let at = obj.display();
            let lacks = |why: &str| format!("{at}:{line}: MTL file `{name}` {why}; its materials are drawn light grey");
            let path = match found {
                Found::There(path) => path,
                Found::Elsewhere(path) => {
                    let taken = path.display();
                    own.push(format!("{at}:{line}: MTL file `{name}` not found there; {taken} is used"));
                    path
                }
                Found::Forbidden => {
                    own.push(lacks("lies outside the scene's folder and may not be read"));
                    continue;
                }
                Found::Nowhere => {
                    own.push(lacks("not found"));
                    continue;
                }
            };
            if !read_paths.insert(path.clone()) {
                continue;
            }
            let mut read = Library { materials: Vec::new(), warnings: Vec::new() };
            match mtl::read(source, &path, &mut read.warnings) {
                Ok(materials) => read.materials = materials,
                Err(e @ (Error::Cancelled | Error::LimitExceeded { .. })) => return Err(e),
                Err(e) => read.warnings.push(format!("{e}; its materials are drawn light grey")),
            }
            let textures = path.parent().unwrap_or(Path::new("")).to_path_buf();
            let (mut again, before) = (Notices::default(), read.warnings.len());
            for m in read.materials {
                again.shorten(&mut read.warnings, before);
                match places.get(&m.name) {
                    Some(&i) => {
                        read.warnings.push(format!(
                            "{}: material `{}` is defined in another MTL file too; this one counts",
                            path.display(),
                            m.name
                        ));
                        materials[i] = (textures.clone(), m);
                    }
                    None => {
                        places.insert(m.name.clone(), materials.len());
                        materials.push((textures.clone(), m));
                    }
                }
            }
            read.warnings.append(&mut again.take(&format!("more materials of {} are defined again", path.display())));
            // The words of a file that is none of the scene's are not for those who see the messages.
            if !read.warnings.is_empty() && source.is_outside(folder, &path) {
                let (at, count) = (path.display(), read.warnings.len());
                warnings
                    .push(format!("{at}: {count} things are wrong; not told, for it lies outside the scene's folder"));
            } else {
                own.append(&mut read.warnings);
            }
        }
    }
    told.shorten(&mut own, 0);
    warnings.append(&mut own);
    warnings.append(&mut told.take("more things are wrong with MTL files"));
    Ok(materials)
}

/// What an MTL file gave.
struct Library {
    materials: Vec<MtlMaterial>,
    warnings: Vec<String>,
}

/// Most MTL files that one `mtllib` line may name.
const MOST_LIBRARIES: usize = 1000;

/// The files that an `mtllib` line names: one name with spaces, or several names.
fn find_libraries(finder: &mut Finder, folder: &Path, argument: &str) -> Result<Vec<(String, Found)>> {
    let is_there = |found: &Found| matches!(found, Found::There(_) | Found::Elsewhere(_));
    let whole = finder.find_as_written(folder, argument)?;
    let words: Vec<&str> = argument.split_whitespace().collect();
    if is_there(&whole) || !(2..=MOST_LIBRARIES).contains(&words.len()) {
        let found = if is_there(&whole) { whole } else { finder.find(folder, argument)? };
        return Ok(vec![(argument.to_owned(), found)]);
    }
    let mut any = false;
    for word in &words {
        any |= is_there(&finder.find_as_written(folder, word)?);
    }
    if !any {
        let found = finder.find(folder, argument)?;
        if is_there(&found) {
            return Ok(vec![(argument.to_owned(), found)]);
        }
    }
    let mut names = Vec::new();
    for word in words {
        names.push((word.to_owned(), finder.find(folder, word)?));
    }
    if !any && !names.iter().any(|(_, found)| is_there(found)) {
        return Ok(vec![(argument.to_owned(), whole)]);
    }
    Ok(names)
}

/// The name lists of a view.
struct Kinds<'a> {
    lists: [(&'static str, Option<HashSet<&'a str>>); 4],
}

const MIRROR: usize = 0;
const GLASS: usize = 1;
const THIN_GLASS: usize = 2;
const MASKED: usize = 3;

impl<'a> Kinds<'a> {
    fn new(view: &'a ViewFile) -> Self {
        fn set(names: &Option<Vec<String>>) -> Option<HashSet<&str>> {
            names.as_ref().map(|n| n.iter().map(String::as_str).collect())
        }
        Kinds {
            lists: [
                ("mirror_materials", set(&view.mirror_materials)),
                ("glass_materials", set(&view.glass_materials)),
                ("thin_glass_materials", set(&view.thin_glass_materials)),
                ("alpha_masked_materials", set(&view.alpha_masked_materials)),
            ],
        }
    }

    /// Whether list `kind` has `name`; `None`: there is no such list.
    fn listed(&self, kind: usize, name: &str) -> Option<bool> {
        self.lists[kind].1.as_ref().map(|list| list.contains(name))
    }

    fn surface(&self, m: &MtlMaterial, warnings: &mut Vec<String>) -> Surface {
        let thin = self.listed(THIN_GLASS, &m.name).unwrap_or(false);
        let model = m.illumination_model;
        let glass = self.listed(GLASS, &m.name).unwrap_or(matches!(model, Some(4 | 6 | 7 | 9)));
        let mirror = self.listed(MIRROR, &m.name).unwrap_or(matches!(model, Some(3 | 5)));
        let in_both = self.listed(MIRROR, &m.name) == Some(true) && (thin || self.listed(GLASS, &m.name) == Some(true));
        if in_both {
            warnings.push(format!("view.json: material `{}` is listed as mirror and as glass; drawn as glass", m.name));
        }
        match (thin, glass, mirror) {
            (true, _, _) => Surface::ThinGlass,
            (_, true, _) => Surface::Glass,
            (_, _, true) => Surface::Mirror,
            _ => Surface::Opaque,
        }
    }

    fn material(
        &self,
        m: &MtlMaterial,
        folder: &Path,
        textures: &mut Textures,
        warnings: &mut Vec<String>,
    ) -> Result<Material> {
        let base = Material::default();
        let surface = self.surface(m, warnings);
        if surface == Surface::Opaque && m.cutout_map.is_none() && m.opacity.is_some_and(|o| o < 0.999) {
            warnings.push(format!(
                "material `{}` has opacity {} and is drawn opaque; list it in view.json under thin_glass_materials",
                m.name,
                m.opacity.unwrap_or(1.0)
            ));
        }
        let load = |map: &Option<mtl::Map>, role, textures: &mut Textures| match map {
            Some(map) => textures.load(folder, &map.file, role),
            None => Ok(None),
        };
        let diffuse_texture = load(&m.diffuse_map, Role::Colour, textures)?;
        let mut cutout_texture = load(&m.cutout_map, Role::Mask, textures)?;
        if self.listed(MASKED, &m.name) == Some(true) && m.cutout_map.is_none() {
            cutout_texture = diffuse_texture.filter(|&t| textures.has_holes(t));
            if cutout_texture.is_none() {
                let name = &m.name;
                warnings
                    .push(format!("view.json: alpha_masked_materials: `{name}` has no map_d and no alpha in map_Kd"));
            }
        }
        // A picture without `Kd` shows as it is.
        let plain = if m.diffuse_map.is_some() { Vec3::ONE } else { base.diffuse };
        Ok(Material {
            name: m.name.clone(),
            diffuse: m.diffuse.unwrap_or(plain),
            specular: m.specular.unwrap_or(base.specular),
            shininess: m.shininess.unwrap_or(base.shininess),
            transmission: m.transmission.unwrap_or(base.transmission),
            index_of_refraction: m.index_of_refraction.unwrap_or(base.index_of_refraction),
            surface,
            diffuse_texture,
            cutout_texture,
        })
    }

    fn tell_unknown(&self, view: &Path, known: &HashMap<String, u32>, warnings: &mut Vec<String>) {
        for (key, list) in &self.lists {
            let mut unknown: Vec<&str> =
                list.iter().flatten().copied().filter(|name| !known.contains_key(*name)).collect();
            unknown.sort_unstable();
            if !unknown.is_empty() {
                let at = view.display();
                warnings.push(format!("{at}: {key}: no material is named {}", quoted(&unknown)));
            }
        }
    }
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

/// Triangles whose material has a picture and that do not say where on it they lie.
fn textured_without_texcoords(geometry: &Geometry, materials: &[Material]) -> usize {
    let textured = |m: &Material| m.diffuse_texture.is_some() || m.cutout_texture.is_some();
    geometry
        .objects
        .iter()
        .zip(&geometry.without_texcoords)
        .filter(|(object, _)| textured(&materials[object.material as usize]))
        .map(|(_, &count)| count)
        .sum()
}

/// Fills in what the view file does not say.
fn make_view(file: &mut ViewFile, geometry: &Geometry, place: &str, warnings: &mut Vec<String>) -> View {
    warnings.append(&mut file.warnings);
    let base = View::default();
    let mut extents = None;
    let mut fit = || *extents.get_or_insert_with(|| Extents::of(&geometry.positions, &geometry.triangles));
    let extent = file.extent.unwrap_or_else(|| {
        let extent = fit().extent();
        warnings
            .push(format!("{place}: no `extent`; {extent} is taken from the 1st-99th percentile box of the vertices"));
        extent
    });
    let camera = file.camera.unwrap_or_else(|| {
        warnings.push(format!("{place}: no `camera`; one is fitted to the scene"));
        fitted_camera(&fit())
    });
    let lights = file.lights.take().unwrap_or_else(|| {
        warnings.push(format!("{place}: no `lights`; one is fitted to the scene"));
        vec![fitted_light(&fit(), &camera)]
    });
    View {
        camera,
        lights,
        ambient: file.ambient.unwrap_or(base.ambient),
        background: file.background.unwrap_or(base.background),
        extent,
    }
}
