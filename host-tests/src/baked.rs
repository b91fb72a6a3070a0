// SPDX-License-Identifier: MIT OR Apache-2.0
//! A small baked scene, where its parts lie, and its checksum: for tests that change some of it.

use glam::{Vec2, Vec3};
use rarefy::internal::math::pack_normal;
use rarefy::internal::scene::{Light, Material, Object, Scene, SceneParts, Surface, Texture};
use rarefy::{Monitor, PreparedScene, Shading};

/// Some triangles of all kinds of materials, so small that each of its bytes can be changed in turn.
///
/// # Panics
/// If it is no scene.
pub fn tiny() -> PreparedScene {
    let mut parts = SceneParts { name: "tiny".into(), ..SceneParts::default() };
    let material = |surface, cutout| Material {
        surface,
        specular: Vec3::splat(0.5),
        diffuse_texture: Some(0),
        cutout_texture: cutout,
        ..Material::default()
    };
    parts.materials = vec![
        material(Surface::Opaque, None),
        material(Surface::Mirror, None),
        material(Surface::Glass, None),
        material(Surface::Opaque, Some(1)),
    ];
    parts.textures = vec![texture("a.png", 2, 1), texture("b.png", 2, 2)];
    for i in 0..8u32 {
        // The last two cross, so that they share a leaf.
        let place = i.min(6);
        let at = Vec3::new((place % 4) as f32 * 3.0, (place / 4) as f32 * 2.0, (place * place % 5) as f32);
        let first = parts.positions.len() as u32;
        parts.positions.extend([at, at + Vec3::X, at + Vec3::new(0.3, 1.0, 0.1 * i as f32)]);
        parts.triangles.push([first, first + 1, first + 2]);
        parts.corner_normals.push([pack_normal(Vec3::Z); 3]);
        parts.corner_texcoords.push([Vec2::ZERO, Vec2::X, Vec2::Y]);
        parts.triangle_objects.push(i % 4);
    }
    parts.objects = (0..4).map(|i| Object { name: format!("object {i}"), material: i }).collect();
    parts.view.camera.eye = Vec3::new(5.0, 2.0, 20.0);
    parts.view.camera.look_at = Vec3::new(5.0, 2.0, 0.0);
    parts.view.extent = 12.0;
    parts.view.lights = vec![Light { position: Vec3::new(5.0, 9.0, 9.0), intensity: Vec3::splat(90.0) }];
    PreparedScene::new(&Scene::new(parts).unwrap(), Shading::Full, &Monitor::default()).unwrap()
}

fn texture(name: &str, width: u32, height: u32) -> Texture {
    let texels = (0..width * height).map(|i| if i % 2 == 0 { 0xff80_40ff } else { 0x0020_ff10 }).collect();
    Texture { name: name.into(), width, height, texels }
}

/// The parts of a baked file behind its prefix, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // named as in src/prepare/baked/mod.rs
pub enum Part {
    Head,
    Lights,
    Nodes,
    LeafTriangles,
    Triangles,
    TriangleShading,
    Materials,
    ObjectMaterials,
    Textures,
    Texels,
    NameLengths,
}

/// Words of the head.
#[allow(missing_docs)] // named as in src/prepare/baked/mod.rs
pub struct Field;

#[allow(missing_docs)]
impl Field {
    pub const SHADING: usize = 0;
    pub const LIGHTS: usize = 1;
    pub const EYE: usize = 11;
    pub const FOV: usize = 20;
    pub const AMBIENT: usize = 21;
    pub const EXTENT: usize = 27;
    pub const EPSILON: usize = 28;
    pub const BOUNDS: usize = 29;
    pub const ORIGIN: usize = 35;
}

/// Where an array lies in a file.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// Bytes of an element.
    pub element: usize,
    /// Elements.
    pub count: usize,
}

impl Span {
    /// Where word `field` of element `index` lies.
    ///
    /// # Panics
    /// If there is none.
    pub fn word(&self, index: usize, field: usize) -> usize {
        assert!(index < self.count && 4 * field < self.element, "no word {field} of {index} in {self:?}");
        self.start + index * self.element + 4 * field
    }
}

/// Where magic, version and checksum end, which the checksum does not cover.
const SUMMED_FROM: usize = 24;

/// Where the parts of a sound file lie, by [`Part`].
pub fn parts(bytes: &[u8]) -> Vec<Span> {
    const HEAD: usize = 32;
    let count = |word: usize| {
        let at = HEAD + 4 * word;
        u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]) as usize
    };
    let mut start = HEAD;
    [
        (164, 1),
        (24, count(1)),
        (8, count(2)),
        (4, count(3)),
        (48, count(4)),
        (48, count(4)),
        (96, count(5)),
        (4, count(6)),
        (16, count(7)),
        (4, count(8)),
        (4, count(6)),
    ]
    .into_iter()
    .map(|(element, count)| {
        let span = Span { start, element, count };
        start += element * count;
        span
    })
    .collect()
}

/// Makes length and checksum right, so that what lies behind them is looked at.
pub fn reseal(bytes: &mut [u8]) {
    if bytes.len() < 32 {
        return;
    }
    let length = bytes.len() as u64;
    bytes[SUMMED_FROM..32].copy_from_slice(&length.to_le_bytes());
    let sum = crc32fast::hash(&bytes[SUMMED_FROM..]);
    bytes[SUMMED_FROM - 4..SUMMED_FROM].copy_from_slice(&sum.to_le_bytes());
}
