// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scene as the kernels read it: a kd-tree and flat arrays, ready for upload.

use std::collections::BTreeSet;
use std::time::Instant;

use glam::{DVec3, Vec3};

use crate::error::{Error, Remedy, Result};
use crate::layout::{self, *};
use crate::memory;
use crate::monitor::Monitor;
use crate::prepare::coincident;
use crate::prepare::kdtree::{BuildOptions, KdTree, cell_epsilon};
use crate::scene::{Scene, Surface, View, check::has_area};

/// By which rules surfaces are shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// Everything the scene asks for.
    #[default]
    Full,
    /// The rules of the speed anchor: no textures or glass, geometric normals, listed mirrors at 0.8 / 0.2, two
    /// reflections, ambient 0.1, black background.
    Anchor,
}

crate::names::named!(Shading of Shading { Full = "full", Anchor = "anchor" });

/// A scene as the kernels read it: a kd-tree, flat arrays, textures, and the view that it is looked at from unless
/// another one is set.
///
/// It is checked when it is made and cannot be changed afterwards. [`PreparedScene::bake`] writes it to a file that loads
/// in a fraction of the time. Threads and renderers may share one in an
/// [`std::sync::Arc`]; it holds nothing of the [`Scene`] that it was made of.
#[derive(Debug, Clone)]
pub struct PreparedScene {
    pub(crate) name: String,
    pub(crate) view: View,
    pub(crate) kdtree_ms: f64,
    /// The kd-tree with its leaf entries and box.
    pub(crate) tree: KdTree,
    /// Triangles for traversal.
    pub(crate) triangles: Vec<Triangle>,
    /// Triangles for shading.
    pub(crate) triangle_shading: Vec<TriangleShading>,
    /// Materials.
    pub(crate) materials: Vec<layout::Material>,
    /// The material of each object.
    pub(crate) object_materials: Vec<u32>,
    /// The name of each object.
    pub(crate) object_names: Vec<String>,
    /// Where each texture's texels lie; never empty.
    pub(crate) textures: Vec<layout::Texture>,
    /// Texels of all textures; never empty.
    pub(crate) texels: Vec<u32>,
    /// sRGB tables.
    pub(crate) tables: Vec<u32>,
    /// Shading rules that the arrays are made for.
    pub(crate) shading: Shading,
    /// Thickness of the tree's cells around flat surfaces, scene units; by the anchor's rules, the offset of secondary and
    /// shadow rays.
    pub(crate) epsilon: f32,
    /// Where positions count from.
    pub(crate) origin: DVec3,
}

/// Triangles that are flattened before it is asked whether the work is to end.
const TRIANGLES_AT_ONCE: usize = 1 << 16;

fn float4(v: Vec3, w: f32) -> [f32; 4] {
    [v.x, v.y, v.z, w]
}

impl PreparedScene {
    /// Builds the kd-tree of `scene`, on all cores, and flattens everything for `shading`. `monitor` watches.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] if the texels do not fit 32-bit offsets, or memory for the tree cannot be had;
    /// [`Error::Cancelled`].
    pub fn new(scene: &Scene, shading: Shading, monitor: &Monitor) -> Result<Self> {
        monitor.restart();
        let started = Instant::now();
        let part = monitor.part("kd-tree", 0.0, 1.0);
        let tree = KdTree::build(scene.positions(), scene.triangles(), &BuildOptions::default(), &part)?;
        let kdtree_ms = started.elapsed().as_secs_f64() * 1e3;
        let anchor = shading == Shading::Anchor;
        let (textures, texels) = flatten_textures(scene)?;
        let materials = scene.materials().iter().map(|m| flatten_material(m, anchor)).collect();
        let object_materials = scene.objects().iter().map(|o| o.material).collect();
        let (triangles, triangle_shading) = flatten_triangles(scene, anchor, monitor)?;
        let largest = tree.bounds_min.iter().chain(&tree.bounds_max).fold(0.0f32, |m, v| m.max(v.abs()));
        let epsilon = if anchor { 1.0e-4 * diagonal(scene) } else { 2.0 * cell_epsilon(largest) };
        Ok(PreparedScene {
            name: scene.name().into(),
            view: scene.view().clone(),
            kdtree_ms,
            tree,
            triangles,
            triangle_shading,
            materials,
            object_materials,
            object_names: scene.objects().iter().map(|object| object.name.clone()).collect(),
            textures,
            texels,
            tables: layout::tables(),
            shading,
            epsilon,
            origin: scene.origin(),
        })
    }

    /// The scene's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The view that came with the scene.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// What was taken off all positions, those of the view too: [`Scene::origin`].
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of materials.
    pub fn material_count(&self) -> usize {
        self.materials.len()
    }

    /// Number of textures that its materials look up.
    pub fn texture_count(&self) -> usize {
        let looked_up: BTreeSet<u32> =
            self.materials.iter().flat_map(|m| [m.diffuse_texture, m.cutout_texture]).collect();
        looked_up.iter().filter(|&&texture| texture != NO_TEXTURE).count()
    }

    /// The names of its objects, by their ids: those that the plane of objects holds.
    pub fn object_names(&self) -> &[String] {
        &self.object_names
    }

    /// The kd-tree.
    pub fn tree(&self) -> &KdTree {
        &self.tree
    }

    /// The rules that surfaces are shaded by.
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// How long the kd-tree took to build, in milliseconds; 0 if it came from a baked file.
    pub fn kdtree_ms(&self) -> f64 {
        self.kdtree_ms
    }

    /// Bytes that an upload takes.
    pub fn bytes(&self) -> u64 {
        let of = |bytes: usize| bytes as u64;
        of(size_of_val(&self.tree.nodes[..]))
            + of(size_of_val(&self.tree.leaf_triangles[..]))
            + of(size_of_val(&self.triangles[..]))
            + of(size_of_val(&self.triangle_shading[..]))
            + of(size_of_val(&self.materials[..]))
            + of(size_of_val(&self.object_materials[..]))
            + of(size_of_val(&self.textures[..]))
            + of(size_of_val(&self.texels[..]))
            + of(size_of_val(&self.tables[..]))
    }
}

/// Lights as kernels read them.
pub(crate) fn flatten_lights(lights: &[crate::scene::Light]) -> Vec<layout::Light> {
    let flat = |l: &crate::scene::Light| layout::Light {
        position: float4(l.position, 0.0),
        intensity: float4(l.intensity, 0.0),
    };
    lights.iter().map(flat).collect()
}

fn flatten_triangles(scene: &Scene, anchor: bool, monitor: &Monitor) -> Result<(Vec<Triangle>, Vec<TriangleShading>)> {
    let mut one_sided = coincident::one_sided(scene, monitor)?.into_iter().peekable();
    let mut triangles = memory::with_room("the triangles", scene.triangles().len())?;
    let mut triangle_shading = memory::with_room("the triangles", scene.triangles().len())?;
    for (id, corners) in scene.triangles().iter().enumerate() {
        if id % TRIANGLES_AT_ONCE == 0 {
            monitor.check()?;
        }
        let mut corners = corners.map(|i| scene.positions()[i as usize]);
        let first = coincident::least_corner(corners);
        corners.rotate_left(first);
        let object = scene.triangle_objects()[id];
        let material = scene.objects()[object as usize].material;
        let mut flags = if anchor { 0 } else { triangle_flags(&scene.materials()[material as usize]) };
        if one_sided.next_if_eq(&(id as u32)).is_some() && !anchor {
            flags |= TRIANGLE_ONE_SIDED;
        }
        triangles.push(flatten_triangle(corners, flags));
        let (mut normals, mut texcoords) = (scene.corner_normals()[id], scene.corner_texcoords()[id]);
        normals.rotate_left(first);
        texcoords.rotate_left(first);
        let [t0, t1, t2] = texcoords;
        triangle_shading.push(TriangleShading {
            normals,
            object,
            texcoords: [t0.x, t0.y, t1.x, t1.y, t2.x, t2.y],
            material,
            pad0: 0,
        });
    }
    Ok((triangles, triangle_shading))
}

/// A triangle with the plane through its corners, which in single precision would be lost in long thin ones.
fn flatten_triangle(corners: [Vec3; 3], flags: u32) -> Triangle {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let n = (b - a).cross(c - a);
    let axis = if n.x.abs() > n.y.abs().max(n.z.abs()) { 0 } else { 1 + usize::from(n.z.abs() >= n.y.abs()) };
    let slope = |i: usize| (n[(axis + i) % 3] / n[axis]) as f32;
    // What has no area is a point, which no ray hits.
    let (corners, p, q) = if has_area(corners) { (corners, slope(1), slope(2)) } else { ([corners[0]; 3], 0.0, 0.0) };
    let bits = f32::from_bits(flags | (axis as u32) << TRIANGLE_AXIS_SHIFT);
    Triangle { corners: [float4(corners[0], bits), float4(corners[1], p), float4(corners[2], q)] }
}

fn diagonal(scene: &Scene) -> f32 {
    let (mut lo, mut hi) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    for p in scene.positions() {
        lo = lo.min(*p);
        hi = hi.max(*p);
    }
    (hi - lo).length()
}

fn triangle_flags(material: &crate::scene::Material) -> u32 {
    let cutout = if material.cutout_texture.is_some() { TRIANGLE_CUTOUT } else { 0 };
    let glass = matches!(material.surface, Surface::Glass | Surface::ThinGlass);
    cutout | if glass { TRIANGLE_GLASS } else { 0 }
}

fn flatten_material(m: &crate::scene::Material, anchor: bool) -> layout::Material {
    let surface = match m.surface {
        Surface::Opaque => SURFACE_OPAQUE,
        Surface::Mirror => SURFACE_MIRROR,
        Surface::Glass | Surface::ThinGlass if anchor => SURFACE_OPAQUE,
        Surface::Glass => SURFACE_GLASS,
        Surface::ThinGlass => SURFACE_THIN_GLASS,
    };
    // Own colour: Kd (1 - max Ks) on a mirror, as much of it as is opaque on glass.
    let (reflectance, own) = match (surface, anchor) {
        (SURFACE_MIRROR, true) => (Vec3::splat(0.8), 1.0 - 0.8),
        (SURFACE_MIRROR, false) => (m.specular, (1.0 - m.specular.max_element()).clamp(0.0, 1.0)),
        (SURFACE_GLASS | SURFACE_THIN_GLASS, _) => (Vec3::ZERO, m.opacity),
        _ => (Vec3::ZERO, 1.0),
    };
    let texture = |t: Option<u32>| if anchor { NO_TEXTURE } else { t.unwrap_or(NO_TEXTURE) };
    layout::Material {
        diffuse: float4(m.diffuse, m.shininess),
        specular: float4(m.specular, m.index_of_refraction),
        reflectance: float4(reflectance, own),
        transmission: float4(m.transmission * (1.0 - m.opacity), 0.0),
        emission: if anchor { [0.0; 4] } else { float4(m.emission, 0.0) },
        surface,
        diffuse_texture: texture(m.diffuse_texture),
        cutout_texture: texture(m.cutout_texture),
        pad0: 0,
    }
}

/// Offsets have 32 bits, and a vector at most half of the address space, whose last byte is `last_address`.
fn check_texels(name: &str, total: u64, last_address: u64) -> Result<()> {
    let most = (1u64 << 30).min(last_address / 8);
    if total < most {
        return Ok(());
    }
    Err(Error::LimitExceeded {
        what: format!("the textures of {name}"),
        limit: "texels".into(),
        wanted: format!("{total} texels"),
        allowed: format!("{} texels", most - 1),
        remedies: &[Remedy::ScaledPictures],
    })
}

fn flatten_textures(scene: &Scene) -> Result<(Vec<layout::Texture>, Vec<u32>)> {
    let total: u64 = scene.textures().iter().map(|t| t.texels.len() as u64).sum();
    check_texels(scene.name(), total, usize::MAX as u64)?;
    let mut textures = Vec::with_capacity(scene.textures().len().max(1));
    // Below 2^30, as was checked.
    let mut texels = memory::with_room("the textures", total as usize)?;
    for t in scene.textures() {
        textures.push(layout::Texture { offset: texels.len() as u32, width: t.width, height: t.height, pad0: 0 });
        texels.extend_from_slice(&t.texels);
    }
    if textures.is_empty() {
        textures.push(layout::Texture { offset: 0, width: 1, height: 1, pad0: 0 });
        texels.push(0xffff_ffff);
    }
    Ok((textures, texels))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_fit_offsets_and_the_address_space() {
        let (bits32, bits64) = (u64::from(u32::MAX), u64::MAX);
        for (last_address, most) in [(bits64, (1u64 << 30) - 1), (bits32, (1 << 29) - 2)] {
            assert!(check_texels("t", most, last_address).is_ok());
            assert!(4 * most <= last_address / 2, "a vector of {most} texels");
            for total in [most + 1, 1 << 32, u64::MAX] {
                let message = check_texels("t", total, last_address).unwrap_err().to_string();
                assert!(message.contains(&format!("allows {most} texels")), "{message}");
            }
        }
    }
}
