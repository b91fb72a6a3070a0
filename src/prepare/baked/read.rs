// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reading baked scenes: straight into the arrays, with the checksum on the way.

use std::io::{self, Read};

use bytemuck::{Pod, Zeroable};

use super::{Head, LightWords, MAGIC, PREFIX_BYTES, VERSION, to_little_endian, validate};
use crate::layout::{self, Texture, Triangle, TriangleShading};
use crate::monitor::Monitor;
use crate::prepare::kdtree::{KdNode, KdTree};
use crate::prepare::{PreparedScene, Shading};
use crate::scene::{Camera, Light, View};
use crate::{Error, Result, memory};

/// Bytes that are read at once: few enough to stay in a processor's cache until they are summed up.
const BYTES_AT_ONCE: usize = 1 << 18;

/// Reads a scene from the next `length` bytes of `reader`; `place` is what messages name.
pub(super) fn read(reader: &mut dyn Read, length: u64, place: &str, monitor: &Monitor) -> Result<PreparedScene> {
    monitor.restart();
    let mut input =
        Input { reader, length, done: 0, sum: crc32fast::Hasher::new(), place, part: monitor.part("load", 0.0, 1.0) };
    let checksum = input.prefix()?;
    let head: Head = input.array("the head", 1)?.first().copied().unwrap_or(Head::zeroed());
    if total_bytes(&head) != Some(length) {
        return Err(input.damaged(format!("its counts do not come to its {length} bytes")));
    }
    let shading = match head.shading {
        0 => Shading::Full,
        1 => Shading::Anchor,
        other => return Err(input.damaged(format!("there is no shading {other}"))),
    };
    let count = |count: u32| count as usize;
    let lights: Vec<LightWords> = input.array("the lights", count(head.lights))?;
    let nodes: Vec<KdNode> = input.array("the kd-tree", count(head.nodes))?;
    let leaf_triangles: Vec<u32> = input.array("the kd-tree", count(head.leaf_triangles))?;
    let triangles: Vec<Triangle> = input.array("the triangles", count(head.triangles))?;
    let triangle_shading: Vec<TriangleShading> = input.array("the triangles", count(head.triangles))?;
    let materials: Vec<layout::Material> = input.array("the materials", count(head.materials))?;
    let object_materials: Vec<u32> = input.array("the objects", count(head.objects))?;
    let textures: Vec<Texture> = input.array("the textures", count(head.textures))?;
    let texels: Vec<u32> = input.array("the textures", count(head.texels))?;
    let name_lengths: Vec<u32> = input.array("the names", count(head.objects))?;
    let name = input.text("the name", head.name_bytes)?;
    let names = input.text("the names of objects", head.object_name_bytes)?;
    if input.sum.clone().finalize() != checksum {
        return Err(input.damaged("its checksum is wrong".into()));
    }
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).map_err(|_| input.wrong("its names are no UTF-8".into()));
    let (name, names) = (text(name)?, text(names)?);
    let object_names = cut(&names, &name_lengths);
    let object_names =
        object_names.ok_or_else(|| input.wrong("its names do not have the lengths that it says".into()))?;
    let light = |&[px, py, pz, ix, iy, iz]: &LightWords| Light {
        position: [px, py, pz].into(),
        intensity: [ix, iy, iz].into(),
    };
    let scene = PreparedScene {
        name,
        view: View {
            camera: Camera {
                eye: head.eye.into(),
                look_at: head.look_at.into(),
                up: head.up.into(),
                fov_y_degrees: head.fov_y_degrees,
            },
            lights: lights.iter().map(light).collect(),
            ambient: head.ambient.into(),
            background: head.background.into(),
            extent: head.extent,
        },
        kdtree_ms: 0.0,
        tree: KdTree { nodes, leaf_triangles, bounds_min: head.bounds_min, bounds_max: head.bounds_max },
        triangles,
        triangle_shading,
        materials,
        object_materials,
        object_names,
        textures,
        texels,
        tables: layout::tables(),
        shading,
        epsilon: head.epsilon,
        origin: head.origin.map(|[low, high]| f64::from_bits(u64::from(high) << 32 | u64::from(low))).into(),
    };
    monitor.check()?;
    validate::validate(&scene, place)?;
    input.part.tell(1.0);
    Ok(scene)
}

/// The length of the file that has this head; `None` if no length can be it.
fn total_bytes(head: &Head) -> Option<u64> {
    let arrays = [
        (head.lights, size_of::<LightWords>()),
        (head.nodes, size_of::<KdNode>()),
        (head.leaf_triangles, 4),
        (head.triangles, size_of::<Triangle>() + size_of::<TriangleShading>()),
        (head.materials, size_of::<layout::Material>()),
        // The material and the length of the name.
        (head.objects, 8),
        (head.textures, size_of::<Texture>()),
        (head.texels, 4),
        (head.name_bytes, 1),
        (head.object_name_bytes, 1),
    ];
    // A count has 32 bits and an element less than 256 bytes.
    let arrays: u64 = arrays.iter().map(|&(count, bytes)| u64::from(count) * bytes as u64).sum();
    (PREFIX_BYTES + size_of::<Head>() as u64).checked_add(arrays)
}

/// `text` in pieces of these lengths.
fn cut(text: &str, lengths: &[u32]) -> Option<Vec<String>> {
    let mut rest = text;
    let mut pieces = Vec::new();
    for &length in lengths {
        let (piece, after) = rest.split_at_checked(length as usize)?;
        pieces.push(piece.to_owned());
        rest = after;
    }
    rest.is_empty().then_some(pieces)
}

struct Input<'a> {
    reader: &'a mut dyn Read,
    length: u64,
    done: u64,
    sum: crc32fast::Hasher,
    place: &'a str,
    part: Monitor,
}

impl Input<'_> {
    fn wrong(&self, message: String) -> Error {
        Error::scene(self.place, message)
    }

    fn damaged(&self, message: String) -> Error {
        self.wrong(format!("this baked scene is damaged: {message}; bake it again"))
    }

    /// Reads magic, version, checksum and length, and returns the checksum.
    fn prefix(&mut self) -> Result<u32> {
        let mut prefix = [0u8; PREFIX_BYTES as usize];
        let known = usize::try_from(self.length).unwrap_or(usize::MAX).min(prefix.len());
        self.fill(&mut prefix[..known])?;
        let (magic, rest) = prefix.split_at(MAGIC.len());
        if magic != MAGIC {
            return Err(self.wrong("this is no baked scene: it does not begin as `rarefy bake` begins one".into()));
        }
        let word = |at: usize| u32::from_le_bytes([rest[at], rest[at + 1], rest[at + 2], rest[at + 3]]);
        let version = word(0);
        if known >= MAGIC.len() + 4 && version != VERSION {
            let message = format!(
                "this baked scene has version {version}, this Rarefy reads version {VERSION}; bake it again with this Rarefy"
            );
            return Err(self.wrong(message));
        }
        let said = u64::from(word(8)) | u64::from(word(12)) << 32;
        if known < prefix.len() || said != self.length {
            return Err(self.damaged(format!("it has {} bytes and should have {said}", self.length)));
        }
        self.sum = crc32fast::Hasher::new();
        self.sum.update(&rest[8..]);
        Ok(word(4))
    }

    /// Reads exactly these bytes.
    fn fill(&mut self, bytes: &mut [u8]) -> Result<()> {
        self.part.check()?;
        match self.reader.read_exact(bytes) {
            Ok(()) => {}
            Err(e) if e.kind() == io::ErrorKind::UnexpectedEof => {
                return Err(self.damaged(format!("it ends before its {} bytes", self.length)));
            }
            Err(e) => return Err(Error::io(self.place, e)),
        }
        self.sum.update(bytes);
        self.done = self.done.saturating_add(bytes.len() as u64);
        self.part.tell(self.done as f32 / self.length.max(1) as f32);
        Ok(())
    }

    /// Reads `count` values, a part at a time: memory that nobody gave data for is not touched.
    fn array<T: Pod>(&mut self, what: &str, count: usize) -> Result<Vec<T>> {
        let mut values: Vec<T> = memory::with_room(what, count)?;
        let at_once = (BYTES_AT_ONCE / size_of::<T>()).max(1);
        while values.len() < count {
            let from = values.len();
            values.resize(count.min(from + at_once), T::zeroed());
            self.fill(bytemuck::cast_slice_mut(&mut values[from..]))?;
            to_little_endian(bytemuck::cast_slice_mut(&mut values[from..]));
        }
        Ok(values)
    }

    fn text(&mut self, what: &str, bytes: u32) -> Result<Vec<u8>> {
        let count = bytes as usize;
        let mut text: Vec<u8> = memory::with_room(what, count)?;
        while text.len() < count {
            let from = text.len();
            text.resize(count.min(from + BYTES_AT_ONCE), 0);
            self.fill(&mut text[from..])?;
        }
        Ok(text)
    }
}
