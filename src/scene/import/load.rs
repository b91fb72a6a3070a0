// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a folder or an OBJ file to a [`Scene`].

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::LoadOptions;
use super::assemble::{self, Geometry, TexcoordMap};
use super::find::{Finder, Found, without_comment_and_quotes};
use super::fit::{Extents, fitted_camera, fitted_light};
use super::material::{Finish, Kinds};
use super::mtl::{self, MtlMaterial};
use super::normals::{self, Smoothing};
use super::notices::Notices;
use super::obj::{self, ObjFile};
use super::origin;
use super::source::{FileSource, Source};
use super::texture::{Alpha, Role, Textures};
use super::view::{self, ViewFile};
use crate::error::printable;
use crate::monitor::Monitor;
use crate::scene::{LoadNotes, Material, MaterialNote, Scene, SceneParts, Texture, UnusedKey, View};
use crate::{Error, Result};

/// Loads the scene at `path`: a folder with `scene.obj` (and `view.json`), or an OBJ file (`view.json` beside it is
/// used). Without a view the camera and a light are fitted to the scene, and a warning says so.
///
/// `monitor` is told what is being done, and can end it.
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
    load_listing(path, options, monitor).map(|(scene, _)| scene)
}

/// As [`load_with`], with the files that were read, for whoever must not overwrite them.
///
/// # Errors
/// As for [`load`].
pub fn load_listing(path: &Path, options: &LoadOptions, monitor: &Monitor) -> Result<(Scene, Vec<PathBuf>)> {
    let files = find_files(path)?;
    let source = Source::disk(files.obj.parent().unwrap_or(Path::new("")), options)?;
    // Even these may be links.
    if let Some(outside) = [Some(&files.obj), files.view.as_ref()].into_iter().flatten().find(|p| source.forbids(p)) {
        let message = "lies outside the scene's folder, to which these options confine it";
        return Err(Error::scene(outside.display().to_string(), message));
    }
    let scene = load_files(files, &source, options, monitor)?;
    Ok((scene, source.opened()))
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
    monitor.restart();
    let origin = origin::of(source, &obj, monitor)?;
    let mut view_file = match &view {
        Some(view) => view::read(source, view, origin)?,
        None => ViewFile::default(),
    };
    let file = obj::read(source, &obj, origin, options, &monitor.part("reading geometry", 0.0, 0.6))?;
    let mut warnings = file.warnings.clone();
    let duplicate_names = file.reopened_groups.clone();
    let mut unused_keys = file.unused_keys.clone();

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
    let smoothing = std::mem::take(&mut geometry.smoothing);
    let (positions, triangles) = (&geometry.positions, &geometry.triangles);
    normals::compute(positions, triangles, &missing, &smoothing, &mut geometry.corner_normals, &part)?;
    let follows_groups = |(&missing, &s): (&u8, &Smoothing)| missing != 0 && s != Smoothing::Unsaid;
    let notes = LoadNotes {
        triangles_without_normals: missing.iter().filter(|&&m| m != 0).count(),
        triangles_smoothed_by_groups: missing.iter().zip(&smoothing).filter(|&both| follows_groups(both)).count(),
        triangles_without_texcoords: textured_without_texcoords(&geometry, &palette.materials),
        dropped_triangles: geometry.dropped,
        duplicate_names,
        missing_textures: palette.missing_textures,
        extent_given: view_file.extent.is_some(),
        unused_keys: {
            unused_keys.extend(palette.unused_keys);
            unused_keys
        },
        materials: palette.notes,
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
        origin,
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
    unused_keys: Vec<UnusedKey>,
    notes: Vec<MaterialNote>,
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
        let mut unused_keys = Vec::new();
        let defined = read_libraries(&mut finder, obj, file, warnings, &mut unused_keys)?;
        let mut textures = Textures::new(finder, options, monitor);
        let mut materials = Vec::with_capacity(defined.len() + 1);
        let mut maps = Vec::with_capacity(defined.len() + 1);
        let mut notes = Vec::new();
        let kinds = Kinds::new(view);
        for (done, (folder, m)) in defined.iter().enumerate() {
            monitor.check()?;
            monitor.tell(done as f32 / defined.len() as f32);
            let finish = finished(&kinds, m, folder, &mut textures, warnings)?;
            notes.push((materials.len() as u32, finish.note));
            materials.push(finish.material);
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
                let finish = finished(&kinds, &m, Path::new(""), &mut textures, warnings)?;
                notes.push((materials.len() as u32, finish.note));
                materials.push(finish.material);
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
            kinds.tell_unknown(path, |name| by_name.contains_key(name), warnings);
        }
        let material_of: Vec<u32> = file.materials.iter().map(|(name, _)| by_name[name]).collect();
        let texcoord_maps = material_of.iter().map(|&m| maps[m as usize]).collect();
        let (textures, missing_textures) = (textures.textures, textures.missing);
        // Of materials that no face has there is nothing to say.
        let used: HashSet<u32> = material_of.iter().copied().collect();
        let notes = notes.into_iter().filter(|(i, note)| used.contains(i) && note.says_something());
        Ok(Palette {
            materials,
            textures,
            missing_textures,
            material_of,
            texcoord_maps,
            default_material,
            unused_keys,
            notes: notes.map(|(_, note)| note).collect(),
        })
    }
}

/// The materials of all MTL files, each with the folder that its textures are relative to.
fn read_libraries(
    finder: &mut Finder,
    obj: &Path,
    file: &ObjFile,
    warnings: &mut Vec<String>,
    unused_keys: &mut Vec<UnusedKey>,
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
            let mut read = Library::default();
            match mtl::read(source, &path, &mut read.warnings, &mut read.unused_keys) {
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
            let count = read.warnings.len() + read.unused_keys.len();
            if count > 0 && source.is_outside(folder, &path) {
                let at = path.display();
                warnings.push(format!(
                    "{at}: {count} things are wrong or not used; not told, for it lies outside the scene's folder"
                ));
            } else {
                own.append(&mut read.warnings);
                unused_keys.append(&mut read.unused_keys);
            }
        }
    }
    told.shorten(&mut own, 0);
    warnings.append(&mut own);
    warnings.append(&mut told.take("more things are wrong with MTL files"));
    Ok(materials)
}

/// What an MTL file gave.
#[derive(Default)]
struct Library {
    materials: Vec<MtlMaterial>,
    warnings: Vec<String>,
    unused_keys: Vec<UnusedKey>,
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

/// A material of an MTL file with its textures.
fn finished(
    kinds: &Kinds,
    m: &MtlMaterial,
    folder: &Path,
    textures: &mut Textures,
    warnings: &mut Vec<String>,
) -> Result<Finish> {
    let load = |map: &Option<mtl::Map>, role, textures: &mut Textures| match map {
        Some(map) => textures.load(folder, &map.file, role),
        None => Ok(None),
    };
    let diffuse_texture = load(&m.diffuse_map, Role::Colour, textures)?;
    let mut cutout_texture = load(&m.cutout_map, Role::Mask, textures)?;
    let mut finish = kinds.decide(m, diffuse_texture.is_some(), warnings);
    let mut because = "map_d";
    if m.cutout_map.is_none() {
        let alpha = diffuse_texture.map_or(Alpha::None, |t| textures.alpha(t));
        let name = &m.name;
        match (kinds.masked(name), alpha) {
            (Some(true), Alpha::Mask | Alpha::Other) => {
                cutout_texture = diffuse_texture;
                because = "map_Kd's alpha, listed in view.json";
            }
            (Some(true), Alpha::None) => warnings
                .push(format!("view.json: alpha_masked_materials: `{name}` has no map_d and no alpha in map_Kd")),
            (None, Alpha::Mask) => {
                cutout_texture = diffuse_texture;
                because = "map_Kd's alpha, all or nothing almost everywhere";
            }
            (None, Alpha::Other) => {
                finish
                    .note
                    .mended
                    .push("map_Kd's alpha is no mask and not used; list it in alpha_masked_materials if it is");
            }
            (Some(false), _) | (None, Alpha::None) => {}
        }
    }
    finish.material.diffuse_texture = diffuse_texture;
    finish.material.cutout_texture = cutout_texture;
    if cutout_texture.is_some() {
        finish.note.cutout_because = because;
    }
    Ok(finish)
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
