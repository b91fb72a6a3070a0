// SPDX-License-Identifier: MIT OR Apache-2.0
//! Baked scenes: a [`PreparedScene`] as one file, which is read straight into the arrays that kernels want.
//!
//! Everything is little-endian, in words of four bytes except the text at the end:
//!
//! | bytes | what |
//! |---|---|
//! | 16 | `rarefy baked\r\n\x1a\n` |
//! | 4 | [`VERSION`] |
//! | 4 | CRC-32 (IEEE) of everything that follows |
//! | 8 | length of the whole file in bytes |
//! | [`Head`] | counts, shading, view, box of the kd-tree |
//! | arrays | lights, nodes, leaf entries, triangles twice, materials, objects' materials, textures, texels, lengths of names |
//! | text | the scene's name, then those of objects, UTF-8 |
//!
//! Texels are kept as they are, four bytes each: a picture format would make the file smaller, but reading it would take
//! longer and need both forms at once. What can be computed from nothing (the sRGB tables) is not in the file.
//!
//! A file that is read is somebody else's: after the checksum every rule that the builder keeps and kernels rely on is
//! checked again ([`validate`]).

mod read;
mod validate;
mod write;

use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use bytemuck::{Pod, Zeroable};

use super::PreparedScene;
use crate::monitor::Monitor;
use crate::{Error, Result, files};

/// How every baked file begins. The line ends show at once if somebody treated it as text.
const MAGIC: &[u8; 16] = b"rarefy baked\r\n\x1a\n";

/// Version of the format, and of the meaning of its arrays: another layout of nodes or structs is another version.
const VERSION: u32 = 3;

/// Magic, version, checksum, length.
const PREFIX_BYTES: u64 = 32;

/// What messages call a scene that comes from no file of its own.
const NAMELESS: &str = "baked scene";

/// What has a fixed size: counts of the arrays, and numbers.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
struct Head {
    /// 0 full, 1 anchor.
    shading: u32,
    lights: u32,
    nodes: u32,
    leaf_triangles: u32,
    triangles: u32,
    materials: u32,
    objects: u32,
    textures: u32,
    texels: u32,
    name_bytes: u32,
    object_name_bytes: u32,
    eye: [f32; 3],
    look_at: [f32; 3],
    up: [f32; 3],
    fov_y_degrees: f32,
    ambient: [f32; 3],
    background: [f32; 3],
    extent: f32,
    epsilon: f32,
    bounds_min: [f32; 3],
    bounds_max: [f32; 3],
    /// Three doubles, the low word of each first.
    origin: [[u32; 2]; 3],
}
const _: () = assert!(size_of::<Head>() == 164);

/// A light: position and intensity.
type LightWords = [f32; 6];

impl PreparedScene {
    /// The version of the format that is written and read here.
    pub const BAKED_VERSION: u32 = VERSION;

    /// Whether a file that begins with these bytes (16 tell) is a baked scene, of whatever version.
    pub fn is_baked(first_bytes: &[u8]) -> bool {
        first_bytes.starts_with(MAGIC)
    }

    /// Whether the file at `path` can be read and begins like a baked scene.
    #[doc(hidden)]
    pub fn is_baked_file(path: &Path) -> bool {
        let mut first = [0; MAGIC.len()];
        files::open(path, u64::MAX).is_ok_and(|mut file| file.read_exact(&mut first).is_ok() && Self::is_baked(&first))
    }

    /// Writes this scene as a baked file: view, names and everything that kernels read, shaded as it was prepared.
    /// The same scene gives the same bytes.
    ///
    /// # Errors
    /// [`Error::Io`] if the writer fails; [`Error::LimitExceeded`] if there are more names than 32 bits count.
    pub fn bake(&self, writer: &mut dyn Write) -> Result<()> {
        write::Plan::new(self)?.write(writer).map_err(|e| Error::io(NAMELESS, e))
    }

    /// As [`PreparedScene::bake`], into a file, which is there whole or not at all.
    ///
    /// # Errors
    /// As for [`PreparedScene::bake`].
    pub fn bake_to(&self, path: &Path) -> Result<()> {
        let plan = write::Plan::new(self)?;
        files::write_whole_by(path, &mut |writer| plan.write(writer))
    }

    /// The scene that [`PreparedScene::bake`] wrote into `bytes`. They are copied: for the least memory read from a
    /// file.
    ///
    /// # Errors
    /// [`Error::InvalidScene`] with the place of what is wrong: no baked scene, another version, damaged, cut off, or
    /// against a rule of scenes. [`Error::OutOfMemory`]; [`Error::Cancelled`].
    pub fn from_baked(bytes: &[u8], monitor: &Monitor) -> Result<Self> {
        read::read(&mut &*bytes, bytes.len() as u64, NAMELESS, monitor)
    }

    /// The scene of a baked file. Beside its arrays, which are as large as the file, little memory is needed.
    ///
    /// # Errors
    /// As for [`PreparedScene::from_baked`], and [`Error::Io`].
    pub fn from_baked_file(path: &Path, monitor: &Monitor) -> Result<Self> {
        let mut file = files::open(path, u64::MAX)?;
        let length = file.length();
        read::read(&mut file, length, &path.display().to_string(), monitor)
    }

    /// The scene of a baked file that is `length` bytes at `offset` of a larger one: an asset that lies uncompressed in
    /// an APK. Nothing else of the larger file is read.
    ///
    /// # Errors
    /// As for [`PreparedScene::from_baked_file`].
    pub fn from_baked_part(file: &mut (impl Read + Seek), offset: u64, length: u64, monitor: &Monitor) -> Result<Self> {
        file.seek(SeekFrom::Start(offset)).map_err(|e| Error::io(NAMELESS, e))?;
        read::read(file, length, NAMELESS, monitor)
    }
}

/// The words of a slice as the file has them, and back.
fn to_little_endian(words: &mut [u32]) {
    if cfg!(target_endian = "big") {
        words.iter_mut().for_each(|word| *word = word.to_le());
    }
}
