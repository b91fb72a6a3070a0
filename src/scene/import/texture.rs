// SPDX-License-Identifier: MIT OR Apache-2.0
//! Textures from PNG and JPEG files. Sizes are read from headers and checked before any texel is allocated.

use std::collections::HashMap;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use image::{ImageFormat, ImageReader, Limits};

use crate::files::{self, InputFile};
use crate::monitor::Monitor;
use crate::scene::{MAX_TEXTURE_SIDE, Texture};
use crate::{Error, Result};

/// Most bytes of texels in a scene.
pub(super) const MAX_TOTAL_BYTES: u64 = 256 << 20;

/// What a decoder may hold in memory, and the largest file: a picture of [`MAX_TOTAL_BYTES`] with 16 bits a channel.
const DECODER_BYTES: u64 = 2 * MAX_TOTAL_BYTES;

/// What a picture is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Role {
    /// `map_Kd`: texels as they are.
    Colour,
    /// `map_d`: opacity in alpha, from the picture's alpha channel if any of it is below 1, else from its luminance.
    Mask,
}

/// The textures of a scene; each file is read once for each role.
#[derive(Debug, Default)]
pub(super) struct Textures {
    pub textures: Vec<Texture>,
    /// Names of files that could not be found or have a format that is not read.
    pub missing: Vec<String>,
    pub warnings: Vec<String>,
    known: HashMap<(PathBuf, Role), Option<u32>>,
    total_bytes: u64,
    monitor: Monitor,
}

impl Textures {
    /// No textures yet; loading ends when `monitor` says so.
    pub(super) fn watched_by(monitor: &Monitor) -> Self {
        Textures { monitor: monitor.clone(), ..Textures::default() }
    }

    /// The index of the texture in `folder/name`; `None` and a warning if there is no such picture.
    pub(super) fn load(&mut self, folder: &Path, name: &str, role: Role) -> Result<Option<u32>> {
        let path = find(folder, name);
        let key = (path.clone().unwrap_or_else(|| folder.join(name)), role);
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let instead = match role {
            Role::Colour => "the plain colour is drawn",
            Role::Mask => "nothing is cut out",
        };
        let loaded = match &path {
            None => {
                self.warnings.push(format!("{}: texture not found; {instead}", key.0.display()));
                None
            }
            Some(path) => match self.decode(path, name, role)? {
                Some(texture) => Some(texture),
                None => {
                    let at = path.display();
                    self.warnings.push(format!("{at}: neither PNG nor JPEG; {instead}; convert it to PNG"));
                    None
                }
            },
        };
        let index = match loaded {
            Some(texture) => {
                self.textures.push(texture);
                Some((self.textures.len() - 1) as u32)
            }
            None => {
                if !self.missing.iter().any(|m| m == name) {
                    self.missing.push(name.to_string());
                }
                None
            }
        };
        self.known.insert(key, index);
        Ok(index)
    }

    /// Whether a texture has any texel that is not opaque.
    pub(super) fn has_holes(&self, index: u32) -> bool {
        self.textures[index as usize].texels.iter().any(|t| t >> 24 < 255)
    }

    /// Decodes a picture; `None` if it is of another format.
    fn decode(&mut self, path: &Path, name: &str, role: Role) -> Result<Option<Texture>> {
        let fail = |message: String| Error::Image { path: path.to_path_buf(), message };
        let mut head = [0u8; 32];
        let length = read_head(path, &mut head)?;
        let head = &head[..length];
        let format = match image::guess_format(head) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ if length == 0 => return Err(fail("file is empty; not a PNG or JPEG picture".into())),
            _ => return Ok(None),
        };
        let monitor = self.monitor.clone();
        let open = || -> Result<_> {
            let file = Watched { file: files::open(path, DECODER_BYTES)?, monitor: &monitor };
            let mut reader = ImageReader::with_format(BufReader::new(file), format);
            // Sizes are ours to check, with the numbers in the message.
            let mut limits = Limits::no_limits();
            limits.max_alloc = Some(DECODER_BYTES);
            reader.limits(limits);
            Ok(reader)
        };
        let broken = |e: image::ImageError| {
            // Some decoders' messages have line ends.
            let why = e.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            fail(format!("picture is damaged or cut short ({why}); export it again"))
        };
        // The PNG decoder refuses absurd sizes without naming them.
        let size = match (format, png_size(head)) {
            (ImageFormat::Png, Some(size)) => size,
            _ => open()?.into_dimensions().map_err(broken)?,
        };
        monitor.check()?;
        self.reserve(path, size)?;
        let decoded = open()?.decode();
        monitor.check()?;
        let picture = decoded.map_err(broken)?;
        let has_alpha = picture.color().has_alpha();
        let picture = picture.into_rgba8();
        let (width, height) = picture.dimensions();
        if (width, height) != size {
            return Err(fail("picture's size differs from its header".into()));
        }
        let bytes = picture.into_raw();
        let use_alpha = has_alpha && bytes.chunks_exact(4).any(|p| p[3] < 255);
        let texels = bytes
            .chunks_exact(4)
            .map(|p| {
                let alpha = if role == Role::Mask && !use_alpha { luminance(p[0], p[1], p[2]) } else { p[3] };
                u32::from_le_bytes([p[0], p[1], p[2], alpha])
            })
            .collect();
        Ok(Some(Texture { name: name.to_string(), width, height, texels }))
    }

    /// Counts a picture against the limits.
    fn reserve(&mut self, path: &Path, (width, height): (u32, u32)) -> Result<()> {
        if width == 0 || height == 0 {
            return Err(Error::Image { path: path.to_path_buf(), message: format!("size {width}x{height} is empty") });
        }
        let over = |limit: &str, wanted: String, allowed: String| {
            Err(Error::LimitExceeded {
                what: format!("{}", path.display()),
                limit: limit.into(),
                wanted,
                allowed,
                remedy: "scale the picture down".into(),
            })
        };
        if width > MAX_TEXTURE_SIDE || height > MAX_TEXTURE_SIDE {
            return over("texture side", format!("{width}x{height} texels"), format!("{MAX_TEXTURE_SIDE} texels"));
        }
        let bytes = u64::from(width) * u64::from(height) * 4;
        let total = self.total_bytes + bytes;
        if total > MAX_TOTAL_BYTES {
            let wanted = format!("{width}x{height} texels, {} MiB with those before it", total.div_ceil(1 << 20));
            return over("texture memory", wanted, format!("{} MiB", MAX_TOTAL_BYTES >> 20));
        }
        self.total_bytes = total;
        Ok(())
    }
}

/// A file that cannot be read any more once the work is cancelled: that is how a decoder is stopped.
struct Watched<'a> {
    file: InputFile,
    monitor: &'a Monitor,
}

impl Read for Watched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.monitor.check().map_err(io::Error::other)?;
        self.file.read(buffer)
    }
}

impl Seek for Watched<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// The file, as written or with slashes for backslashes.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    [folder.join(name), folder.join(name.replace('\\', "/"))].into_iter().find(|p| p.is_file())
}

fn read_head(path: &Path, head: &mut [u8]) -> Result<usize> {
    let mut bytes = Vec::new();
    let file = files::open(path, DECODER_BYTES)?;
    file.take(head.len() as u64).read_to_end(&mut bytes).map_err(|e| Error::io(path, e))?;
    head[..bytes.len()].copy_from_slice(&bytes);
    Ok(bytes.len())
}

/// Width and height from a PNG file's first bytes.
fn png_size(head: &[u8]) -> Option<(u32, u32)> {
    let word = |at: usize| Some(u32::from_be_bytes(head.get(at..at + 4)?.try_into().ok()?));
    if head.get(12..16)? != b"IHDR" {
        return None;
    }
    Some((word(16)?, word(20)?))
}

/// Rec. 709 weights on stored (not linear) values: masks are data, not light.
fn luminance(r: u8, g: u8, b: u8) -> u8 {
    ((54 * u32::from(r) + 183 * u32::from(g) + 19 * u32::from(b)) >> 8) as u8
}
