// SPDX-License-Identifier: MIT OR Apache-2.0
//! From the models of an OBJ file to the arrays of a scene: triangles, objects, corner attributes.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec2, Vec2, Vec3};

use super::locate;
use super::normals::Smoothing;
use super::obj::{self, FAR_TEXCOORD, MISSING, ObjFile};
use super::options::reserve;
use super::source::Source;
use super::triangulate::{self, Split, Work};
use super::twins::Twins;
use crate::error::Remedy;
use crate::math::pack_normal;
use crate::monitor::Monitor;
use crate::scene::{MAX_COORDINATE, MAX_TRIANGLES, Object, check};
use crate::{Error, Result};

/// How the texture coordinates of a material are moved: `map_Kd` options `-s` and `-o`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TexcoordMap {
    /// Factors.
    pub scale: Vec2,
    /// Added after scaling.
    pub offset: Vec2,
}

impl Default for TexcoordMap {
    fn default() -> Self {
        TexcoordMap { scale: Vec2::ONE, offset: Vec2::ZERO }
    }
}

/// The geometry of a scene. Lists run as those of [`crate::scene::Scene`].
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub corner_normals: Vec<[u32; 3]>,
    pub corner_texcoords: Vec<[Vec2; 3]>,
    pub triangle_objects: Vec<u32>,
    pub objects: Vec<Object>,
    /// Bits 0 to 2 of each triangle: the corner has no normal yet.
    pub corners_without_normal: Vec<u8>,
    /// The smoothing group of each triangle; empty if the file has none.
    pub smoothing: Vec<Smoothing>,
    /// By object: triangles that lack a texture coordinate.
    pub without_texcoords: Vec<usize>,
    /// Triangles dropped because they have no area.
    pub dropped: usize,
    pub warnings: Vec<String>,
}

/// What happened to faces, for the warnings.
struct Faces<'a> {
    work: Work<'a>,
    twins: Twins,
    polygons_approximate: usize,
    first_approximate: Option<String>,
    polygons_degenerate: usize,
    /// Faces so far, and the smoothing groups that are still to come.
    count: u64,
    smoothing: std::iter::Peekable<std::vec::IntoIter<(u64, Smoothing)>>,
    has_smoothing: bool,
    smoothing_now: Smoothing,
}

impl Faces<'_> {
    /// Goes on to the next face.
    fn begin(&mut self) {
        while let Some((_, smoothing)) = self.smoothing.next_if(|&(first, _)| first <= self.count) {
            self.smoothing_now = smoothing;
        }
        self.count += 1;
    }
}

/// The materials of an OBJ file.
pub(super) struct FileMaterials<'a> {
    /// Each one's place among the scene's, by the file's number.
    pub of: &'a [u32],
    /// By the file's number.
    pub maps: &'a [TexcoordMap],
    /// That of faces without one.
    pub default: u32,
}

/// Faces that are added before it is asked whether the work is to end.
const FACES_AT_ONCE: usize = 4096;

/// Makes the arrays.
pub(super) fn assemble(
    source: &Source,
    path: &Path,
    file: ObjFile,
    materials: &FileMaterials,
    monitor: &Monitor,
) -> Result<Geometry> {
    let mut geometry = Geometry::default();
    let total: usize = file.models.iter().map(triangles_of).sum();
    let vertices: usize = file.models.iter().map(|m| m.mesh.positions.len() / 3).sum();
    if total.max(vertices) > MAX_TRIANGLES {
        return Err(Error::LimitExceeded {
            what: path.display().to_string(),
            limit: "triangles".into(),
            wanted: format!("{total} triangles, {vertices} vertices"),
            allowed: format!("{MAX_TRIANGLES}"),
            remedies: &[Remedy::SmallerScene],
        });
    }
    reserve(&mut geometry.positions, vertices, path)?;
    reserve(&mut geometry.triangles, total, path)?;
    reserve(&mut geometry.corner_normals, total, path)?;
    reserve(&mut geometry.corner_texcoords, total, path)?;
    reserve(&mut geometry.triangle_objects, total, path)?;
    reserve(&mut geometry.corners_without_normal, total, path)?;

    let mut objects: HashMap<(String, u32), u32> = HashMap::new();
    let mut shifts: Vec<DVec2> = Vec::new();
    let mut faces = Faces {
        work: Work::new(monitor),
        twins: Twins::find(&file.models, path)?,
        polygons_approximate: 0,
        first_approximate: None,
        polygons_degenerate: 0,
        count: 0,
        has_smoothing: !file.smoothing.is_empty(),
        smoothing: file.smoothing.into_iter().peekable(),
        smoothing_now: Smoothing::default(),
    };
    if faces.has_smoothing {
        reserve(&mut geometry.smoothing, total, path)?;
    }
    let mut welder = Welder::default();
    let mut models = file.models.into_iter().peekable();
    while let Some(model) = models.next() {
        monitor.check()?;
        monitor.tell(geometry.triangles.len() as f32 / total.max(1) as f32);
        if model.mesh.indices.is_empty() {
            continue;
        }
        let mesh = model.mesh;
        check_numbers(source, path, &mesh)?;
        let material = mesh.material_id.map_or(materials.default, |id| materials.of[id]);
        let map = mesh.material_id.map_or(TexcoordMap::default(), |id| materials.maps[id]);
        let goes_on = models.peek().is_some_and(|next| next.name == model.name);
        let indices = welder.place(&model.name, goes_on, &mesh, &mut geometry.positions);
        let object = *objects.entry((model.name, material)).or_insert_with_key(|(group, material)| {
            let name = group.parse().ok().and_then(|id: usize| file.groups.get(id).cloned()).unwrap_or_default();
            let name = if name.is_empty() { "(unnamed)".to_string() } else { name };
            geometry.objects.push(Object { name, material: *material });
            geometry.without_texcoords.push(0);
            (geometry.objects.len() - 1) as u32
        });
        if shifts.len() < geometry.objects.len() {
            shifts.push(whole_repeats(&file.texcoords, &mesh, map));
        }
        let shift = shifts[object as usize];
        let shape = Shape { mesh: &mesh, texcoords: &file.texcoords, indices: &indices, object, map, shift };
        add_faces(&mut geometry, &mut faces, &shape, monitor)?;
    }
    let at = path.display();
    if let Some(first) = faces.first_approximate {
        geometry.warnings.push(format!(
            "{at}: {} polygons cross themselves or have too many corners and were split as fans (first in `{first}`); \
             triangulate them in the modelling program",
            faces.polygons_approximate
        ));
    }
    geometry.dropped += faces.polygons_degenerate;
    if geometry.triangles.is_empty() {
        let message = if geometry.dropped > 0 {
            format!("all {} faces are degenerate (no area); nothing to draw", geometry.dropped)
        } else {
            "no faces (`f` lines); nothing to draw".into()
        };
        return Err(Error::scene(at.to_string(), message));
    }
    if geometry.dropped > 0 {
        geometry.warnings.push(format!("{at}: {} degenerate triangles (no area) left out", geometry.dropped));
    }
    Ok(geometry)
}

/// How many triangles the faces of a model make, before degenerate ones are dropped.
fn triangles_of(model: &tobj::Model) -> usize {
    let mesh = &model.mesh;
    if mesh.face_arities.is_empty() {
        mesh.indices.len() / 3
    } else {
        mesh.face_arities.iter().map(|&n| n.saturating_sub(2) as usize).sum()
    }
}

/// Refuses numbers that are not finite or too large; the line is looked up only then.
fn check_numbers(source: &Source, path: &Path, mesh: &tobj::Mesh) -> Result<()> {
    let fine = |v: &f32| v.abs() <= MAX_COORDINATE;
    let fine_or_missing = |v: &f32| fine(v) || *v == MISSING;
    if mesh.positions.iter().all(fine) && mesh.normals.iter().all(fine_or_missing) {
        return Ok(());
    }
    Err(locate::bad_number(source, path).unwrap_or_else(|| {
        Error::scene(path.display().to_string(), format!("a coordinate is not finite or beyond {MAX_COORDINATE:e}"))
    }))
}

/// Puts the vertices of models into one list. Models of one group (its materials) share vertices at the same place,
/// as they did in the file, so that smooth shading knows no seams between materials.
#[derive(Default)]
struct Welder {
    group: String,
    places: HashMap<[u32; 3], u32>,
}

impl Welder {
    /// Appends the vertices of `mesh` to `positions`; the place of each. `goes_on`: the next model is of this group too.
    fn place(&mut self, group: &str, goes_on: bool, mesh: &tobj::Mesh, positions: &mut Vec<Vec3>) -> Vec<u32> {
        if self.group != group {
            self.places = HashMap::new();
            self.group = group.to_string();
        }
        let first_new = positions.len();
        let mut indices = Vec::with_capacity(mesh.positions.len() / 3);
        for p in mesh.positions.chunks_exact(3) {
            let point = Vec3::new(p[0], p[1], p[2]);
            let known = if self.places.is_empty() { None } else { self.places.get(&bits(point)) };
            indices.push(known.copied().unwrap_or_else(|| {
                positions.push(point);
                (positions.len() - 1) as u32
            }));
        }
        if goes_on {
            for (i, &p) in positions.iter().enumerate().skip(first_new) {
                self.places.entry(bits(p)).or_insert(i as u32);
            }
        }
        indices
    }
}

/// The bits of a point; -0 and 0 are one.
fn bits(p: Vec3) -> [u32; 3] {
    (p + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// Faces of one object and material.
struct Shape<'a> {
    mesh: &'a tobj::Mesh,
    /// Where the mesh's vertices lie in the scene.
    indices: &'a [u32],
    /// The file's.
    texcoords: &'a [DVec2],
    object: u32,
    map: TexcoordMap,
    /// Whole repetitions of the texture that are taken off its coordinates.
    shift: DVec2,
}

/// How many whole repetitions of the texture to take off an object's texture coordinates: those that its first corner lies
/// away from 0, if that is far. Single precision would make rags of textures there; an object's corners stay together.
fn whole_repeats(all: &[DVec2], mesh: &tobj::Mesh, map: TexcoordMap) -> DVec2 {
    let first = mesh.texcoord_indices.iter().find_map(|&i| obj::texcoord(all, mesh, i));
    let first = first.map_or(DVec2::ZERO, |t| t * map.scale.as_dvec2() + map.offset.as_dvec2());
    if first.abs().max_element() < FAR_TEXCOORD { DVec2::ZERO } else { first.floor() }
}

fn add_faces(g: &mut Geometry, faces: &mut Faces, shape: &Shape, monitor: &Monitor) -> Result<()> {
    let &Shape { mesh, indices, object, .. } = shape;
    let mut corners = Vec::new();
    let mut split = Vec::new();
    let mut first = 0;
    let face_count = if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { mesh.face_arities.len() };
    for face in 0..face_count {
        if face % FACES_AT_ONCE == 0 {
            monitor.check()?;
        }
        faces.begin();
        let arity = mesh.face_arities.get(face).map_or(3, |&n| n as usize);
        let vertices = &mesh.indices[first..first + arity];
        if arity == 3 {
            add_triangle(g, faces, shape, [first, first + 1, first + 2]);
        } else {
            corners.clear();
            corners.extend(vertices.iter().map(|&v| g.positions[indices[v as usize] as usize]));
            if let Some(known) = faces.twins.known(&corners) {
                for t in &known {
                    add_triangle(g, faces, shape, t.map(|c| first + c as usize));
                }
                first += arity;
                continue;
            }
            split.clear();
            match triangulate::split(&corners, &mut faces.work, &mut split)? {
                Split::Exact => {}
                Split::Degenerate => faces.polygons_degenerate += 1,
                Split::Approximate => {
                    faces.polygons_approximate += 1;
                    faces.first_approximate.get_or_insert_with(|| g.objects[object as usize].name.clone());
                }
            }
            faces.twins.remember(&corners, &split);
            for t in &split {
                add_triangle(g, faces, shape, t.map(|c| first + c as usize));
            }
        }
        first += arity;
    }
    Ok(())
}

/// Adds one triangle, unless it has no area. `at`: its corners' places in the mesh's index lists.
fn add_triangle(g: &mut Geometry, faces: &Faces, shape: &Shape, at: [usize; 3]) {
    let &Shape { mesh, indices, texcoords: all, object, map, shift } = shape;
    let triangle = at.map(|c| indices[mesh.indices[c] as usize]);
    if !check::has_area(triangle.map(|v| g.positions[v as usize])) {
        g.dropped += 1;
        return;
    }
    let mut normals = [0; 3];
    let mut without = 0;
    let mut texcoords = [Vec2::ZERO; 3];
    let mut lacks_texcoord = false;
    for k in 0..3 {
        let normal = mesh.normal_indices.get(at[k]).map(|&i| vector(&mesh.normals, i));
        match normal {
            // Packing takes any length; the smallest are noise.
            Some(n) if n.x != MISSING && n.abs().max_element() > 1.0e-20 => normals[k] = pack_normal(n),
            _ => without |= 1 << k,
        }
        match mesh.texcoord_indices.get(at[k]).and_then(|&i| obj::texcoord(all, mesh, i)) {
            Some(t) if shift == DVec2::ZERO => texcoords[k] = t.as_vec2() * map.scale + map.offset,
            Some(t) => texcoords[k] = (t * map.scale.as_dvec2() + map.offset.as_dvec2() - shift).as_vec2(),
            None => lacks_texcoord = true,
        }
    }
    g.triangles.push(triangle);
    g.corner_normals.push(normals);
    g.corner_texcoords.push(texcoords);
    g.triangle_objects.push(object);
    g.corners_without_normal.push(without);
    if faces.has_smoothing {
        g.smoothing.push(faces.smoothing_now);
    }
    g.without_texcoords[object as usize] += usize::from(lacks_texcoord);
}

fn vector(values: &[f32], index: u32) -> Vec3 {
    let i = index as usize * 3;
    Vec3::new(values[i], values[i + 1], values[i + 2])
}
