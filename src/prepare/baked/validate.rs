// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether a scene from a file keeps the rules that kernels rely on: with one that passes, no kernel and no twin reads
//! beyond an array, and every walk through the tree ends after at most as many steps as the tree has nodes.
//!
//! A scene that is made from [`crate::scene::Scene`] keeps all of them, so that whatever breaks one was not written by
//! [`PreparedScene::bake`]. Places are names of arrays with an index.

use crate::layout::{
    self, NO_TEXTURE, SURFACE_GLASS, SURFACE_MIRROR, SURFACE_OPAQUE, SURFACE_THIN_GLASS, TRIANGLE_AXIS_SHIFT,
    TRIANGLE_CUTOUT, TRIANGLE_GLASS, TRIANGLE_ONE_SIDED,
};
use crate::prepare::kdtree::{KdTree, MAX_DEPTH};
use crate::prepare::{PreparedScene, Shading};
use crate::scene::{
    MAX_COORDINATE, MAX_INDEX_OF_REFRACTION, MAX_RADIANCE, MAX_SHININESS, MAX_TEXCOORD, MAX_TEXTURE_SIDE, MAX_TRIANGLES,
};
use crate::{Error, Result};

/// Place within the scene, and what is wrong there.
type Wrong = (String, String);

type Checked = std::result::Result<(), Wrong>;

/// Checks everything; `file` is what messages name.
///
/// # Errors
/// [`Error::InvalidScene`] with the first rule that is broken.
pub(super) fn validate(scene: &PreparedScene, file: &str) -> Result<()> {
    scene.view.validate().map_err(|error| Error::scene(file, error.to_string()))?;
    check(scene).map_err(|(place, message)| Error::scene(format!("{file}: {place}"), message))
}

fn wrong<T>(place: impl Into<String>, message: impl Into<String>) -> std::result::Result<T, Wrong> {
    Err((place.into(), message.into()))
}

fn check(scene: &PreparedScene) -> Checked {
    let count = scene.triangles.len();
    if count == 0 || count > MAX_TRIANGLES {
        return wrong("triangles", format!("{count} triangles; a scene has 1 to {MAX_TRIANGLES}"));
    }
    if !(scene.epsilon > 0.0 && scene.epsilon <= 16.0 * MAX_COORDINATE) {
        return wrong("epsilon", format!("{} is out of range", scene.epsilon));
    }
    if !scene.origin.is_finite() {
        return wrong("origin", format!("{} is not finite", scene.origin));
    }
    textures(scene)?;
    for (i, material) in scene.materials.iter().enumerate() {
        material_is_sound(material, scene.textures.len())
            .map_err(|(key, message)| (format!("materials[{i}].{key}"), message))?;
    }
    let materials = scene.materials.len();
    if let Some((i, m)) = first(&scene.object_materials, |&m| m as usize >= materials) {
        return wrong(format!("object_materials[{i}]"), format!("there is no material {m}; there are {materials}"));
    }
    bounds(&scene.tree)?;
    triangles(scene)?;
    tree(&scene.tree, count)
}

/// The first value that `is_wrong`, with its place.
fn first<T>(values: &[T], is_wrong: impl Fn(&T) -> bool) -> Option<(usize, &T)> {
    values.iter().enumerate().find(|(_, value)| is_wrong(value))
}

/// Whether all of them are numbers of at most `limit` in size.
fn within(values: &[f32], limit: f32) -> bool {
    values.iter().all(|value| value.abs() <= limit)
}

/// Whether all of them are from 0 to `limit`.
fn is_colour(rgb: &[f32], limit: f32) -> bool {
    rgb.iter().all(|value| (0.0..=limit).contains(value))
}

fn textures(scene: &PreparedScene) -> Checked {
    if scene.textures.is_empty() || scene.texels.is_empty() {
        return wrong("textures", "there are none, not even the one that stands for none");
    }
    let texels = scene.texels.len() as u64;
    if texels >= 1 << 30 {
        return wrong("texels", format!("{texels} are too many for their offsets"));
    }
    for (i, t) in scene.textures.iter().enumerate() {
        let sides = 1..=MAX_TEXTURE_SIDE;
        if !sides.contains(&t.width) || !sides.contains(&t.height) {
            let message = format!("{}x{} texels; sides are 1 to {MAX_TEXTURE_SIDE}", t.width, t.height);
            return wrong(format!("textures[{i}]"), message);
        }
        let end = u64::from(t.offset) + u64::from(t.width) * u64::from(t.height);
        if end > texels {
            return wrong(format!("textures[{i}]"), format!("it ends at texel {end}; there are {texels}"));
        }
    }
    Ok(())
}

fn material_is_sound(m: &layout::Material, textures: usize) -> Checked {
    let (diffuse, specular, reflectance) = (m.diffuse, m.specular, m.reflectance);
    for (key, rgb) in [
        ("diffuse", diffuse),
        ("specular", specular),
        ("reflectance", reflectance),
        ("transmission", m.transmission),
        ("emission", m.emission),
    ] {
        if !is_colour(&rgb[..3], MAX_RADIANCE) {
            return wrong(key, format!("{:?} is out of range (0 to {MAX_RADIANCE:e})", &rgb[..3]));
        }
    }
    for (key, value, range) in [
        ("shininess", diffuse[3], 0.0..=MAX_SHININESS),
        ("index_of_refraction", specular[3], 1.0..=MAX_INDEX_OF_REFRACTION),
        ("own", reflectance[3], 0.0..=1.0),
    ] {
        if !range.contains(&value) {
            return wrong(key, format!("{value} is out of range ({} to {})", range.start(), range.end()));
        }
    }
    if ![SURFACE_OPAQUE, SURFACE_MIRROR, SURFACE_GLASS, SURFACE_THIN_GLASS].contains(&m.surface) {
        return wrong("surface", format!("there is no surface {}", m.surface));
    }
    for (key, texture) in [("diffuse_texture", m.diffuse_texture), ("cutout_texture", m.cutout_texture)] {
        if texture != NO_TEXTURE && texture as usize >= textures {
            return wrong(key, format!("there is no texture {texture}; there are {textures}"));
        }
    }
    Ok(())
}

fn bounds(tree: &KdTree) -> Checked {
    // The builder widens the box of the corners a little.
    let (lo, hi) = (&tree.bounds_min, &tree.bounds_max);
    let ordered = lo.iter().zip(hi).all(|(lo, hi)| lo < hi);
    if within(lo, 2.0 * MAX_COORDINATE) && within(hi, 2.0 * MAX_COORDINATE) && ordered {
        return Ok(());
    }
    wrong("bounds", format!("{lo:?} to {hi:?} is no box"))
}

fn triangles(scene: &PreparedScene) -> Checked {
    let (lo, hi) = (&scene.tree.bounds_min, &scene.tree.bounds_max);
    let allowed: Vec<u32> = scene.materials.iter().map(|m| flags(m, scene.shading)).collect();
    for (i, (t, s)) in scene.triangles.iter().zip(&scene.triangle_shading).enumerate() {
        let outside = |c: &&[f32; 4]| !(0..3).all(|axis| c[axis] > lo[axis] && c[axis] < hi[axis]);
        if let Some(corner) = t.corners.iter().find(outside) {
            return wrong(format!("triangles[{i}]"), format!("its corner {:?} is not in the box", &corner[..3]));
        }
        if !within(&[t.corners[1][3], t.corners[2][3]], 1.0) {
            return wrong(format!("triangles[{i}]"), "the slopes of its plane are not at most 1");
        }
        if !within(&s.texcoords, MAX_TEXCOORD) {
            let message = format!("{:?} are not finite or beyond {MAX_TEXCOORD:e}", s.texcoords);
            return wrong(format!("triangles[{i}].texcoords"), message);
        }
        let Some(&material) = scene.object_materials.get(s.object as usize) else {
            let message = format!("there is no object {}; there are {}", s.object, scene.object_materials.len());
            return wrong(format!("triangles[{i}].object"), message);
        };
        if s.material != material {
            let message = format!("material {} where its object has {material}", s.material);
            return wrong(format!("triangles[{i}].material"), message);
        }
        let (bits, right) = (t.corners[0][3].to_bits(), allowed[material as usize]);
        let optional = if scene.shading == Shading::Full { TRIANGLE_ONE_SIDED } else { 0 };
        let (found, axis) = (bits & !(!0 << TRIANGLE_AXIS_SHIFT), bits >> TRIANGLE_AXIS_SHIFT);
        if axis > 2 {
            return wrong(format!("triangles[{i}]"), format!("its plane has no axis {axis}"));
        }
        if found & !optional != right {
            return wrong(format!("triangles[{i}].flags"), format!("{found:#x} where its material gives {right:#x}"));
        }
    }
    Ok(())
}

/// What traversal must know of a triangle of this material.
fn flags(m: &layout::Material, shading: Shading) -> u32 {
    if shading == Shading::Anchor {
        return 0;
    }
    let cutout = if m.cutout_texture != NO_TEXTURE { TRIANGLE_CUTOUT } else { 0 };
    let glass = matches!(m.surface, SURFACE_GLASS | SURFACE_THIN_GLASS);
    cutout | if glass { TRIANGLE_GLASS } else { 0 }
}

/// A node that is still to be looked at.
#[derive(Clone, Copy)]
struct Pending {
    node: usize,
    depth: usize,
    lo: [f32; 3],
    hi: [f32; 3],
}

/// Each node has one parent before it, planes cut their cells, no leaf is too deep, and leaves share the entries out.
fn tree(tree: &KdTree, triangles: usize) -> Checked {
    let (nodes, entries) = (&tree.nodes, &tree.leaf_triangles);
    if nodes.len() < 2 || nodes.len() % 2 != 0 || nodes.len() > 1 << 30 {
        return wrong("nodes", format!("{} nodes; a tree has a root and pairs", nodes.len()));
    }
    // Bit i: the pair at 2 i has a parent. The first pair is the root and a node that is never used.
    let mut has_parent = vec![0u64; nodes.len().div_ceil(128)];
    let mut pairs = 1;
    let mut entries_of_leaves = 0u64;
    let mut pending = Vec::with_capacity(MAX_DEPTH + 1);
    pending.push(Pending { node: 0, depth: 0, lo: tree.bounds_min, hi: tree.bounds_max });
    while let Some(at) = pending.pop() {
        let node = nodes[at.node];
        let place = || format!("nodes[{}]", at.node);
        if node.is_leaf() {
            let (start, count) = (node.split_or_first as usize, node.payload() as usize);
            let Some(ids) = start.checked_add(count).and_then(|end| entries.get(start..end)) else {
                let message = format!("{count} entries from {start} on; there are {}", entries.len());
                return wrong(place(), message);
            };
            if !ids.is_sorted_by(|a, b| a < b) || ids.last().is_some_and(|&id| id as usize >= triangles) {
                return wrong(place(), format!("its triangles do not ascend, or are not below {triangles}"));
            }
            entries_of_leaves += count as u64;
            continue;
        }
        let (axis, split, child) = (node.axis() as usize, node.split(), node.payload() as usize);
        if !(split > at.lo[axis] && split < at.hi[axis]) {
            let message = format!("the plane at {split} is not between {} and {}", at.lo[axis], at.hi[axis]);
            return wrong(place(), message);
        }
        if child % 2 != 0 || child <= at.node || child + 1 >= nodes.len() {
            let message = format!("its children at {child} are no pair behind it among {} nodes", nodes.len());
            return wrong(place(), message);
        }
        if at.depth >= MAX_DEPTH {
            return wrong(place(), format!("its children are deeper than {MAX_DEPTH}"));
        }
        let (word, bit) = (child / 128, 1u64 << (child / 2 % 64));
        if has_parent[word] & bit != 0 {
            return wrong(place(), format!("the nodes at {child} have two parents"));
        }
        has_parent[word] |= bit;
        pairs += 1;
        let (mut lower, mut upper) = (at, at);
        (lower.node, upper.node) = (child, child + 1);
        (lower.depth, upper.depth) = (at.depth + 1, at.depth + 1);
        (lower.hi[axis], upper.lo[axis]) = (split, split);
        pending.extend([upper, lower]);
    }
    if 2 * pairs != nodes.len() {
        return wrong("nodes", format!("{} of {} belong to the tree", 2 * pairs, nodes.len()));
    }
    if entries_of_leaves != entries.len() as u64 {
        return wrong("leaf_triangles", format!("leaves have {entries_of_leaves} of {} entries", entries.len()));
    }
    Ok(())
}
