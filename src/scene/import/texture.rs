// SPDX-License-Identifier: MIT OR Apache-2.0
//! Textures from PNG and JPEG files. Sizes are read from headers and checked before any texel is allocated.

use std::collections::HashMap;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use image::{ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::LoadOptions;
use super::find::{Finder, Found};
use super::notices::Notices;
use crate::error::Remedy;
use crate::monitor::Monitor;
use crate::scene::{MAX_TEXTURE_SIDE, Texture};
use crate::{Error, Result};

/// Largest picture file.
const MAX_PICTURE_BYTES: u64 = 256 << 20;

/// What a picture is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Role {
    /// `map_Kd`: texels as they are.
    Colour,
    /// `map_d`: opacity in alpha, from the picture's alpha channel if any of it is below 1, else from its luminance.
    Mask,
}

/// What an alpha channel looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    /// There is none, or all of it is 1.
    None,
    /// Holes in something solid: some of it clear, some solid, less than a quarter in between.
    Mask,
    /// Something else: gloss, height, a soft veil, or 0 all over.
    Other,
}

impl Alpha {
    fn of(texels: &[u32]) -> Self {
        let (mut clear, mut between, mut below_one) = (0u64, 0u64, 0u64);
        for alpha in texels.iter().map(|t| t >> 24) {
            clear += u64::from(alpha < 128);
            between += u64::from((26..230).contains(&alpha));
            below_one += u64::from(alpha < 255);
        }
        let all = texels.len() as u64;
        match () {
            () if below_one == 0 => Alpha::None,
            () if clear > 0 && clear < all && between * 4 < all => Alpha::Mask,
            () => Alpha::Other,
        }
    }
}

/// The textures of a scene; each file is read once for each role.
pub(super) struct Textures<'a> {
    pub textures: Vec<Texture>,
    /// Names of files that could not be found or read.
    pub missing: Vec<String>,
    /// What was missing, and what was taken from elsewhere.
    notices: Notices,
    finder: Finder<'a>,
    known: HashMap<(PathBuf, Role), Option<u32>>,
    alphas: HashMap<u32, Alpha>,
    total_bytes: u64,
    max_bytes: u64,
    monitor: &'a Monitor,
}

impl<'a> Textures<'a> {
    /// No textures yet; loading ends when `monitor` says so.
    pub(super) fn new(finder: Finder<'a>, options: &LoadOptions, monitor: &'a Monitor) -> Self {
        Textures {
            textures: Vec::new(),
            missing: Vec::new(),
            notices: Notices::default(),
            finder,
            known: HashMap::new(),
            alphas: HashMap::new(),
            total_bytes: 0,
            max_bytes: options.max_texture_bytes,
            monitor,
        }
    }

    /// What there is to tell since this was asked last.
    pub(super) fn take_warnings(&mut self) -> Vec<String> {
        self.notices.take("more textures are missing, damaged or lie elsewhere")
    }

    /// The index of the texture `name`, written by a file in `folder`; `None` and a warning if there is no such picture.
    pub(super) fn load(&mut self, folder: &Path, name: &str, role: Role) -> Result<Option<u32>> {
        let written = (folder.join(name), role);
        if let Some(&known) = self.known.get(&written) {
            return Ok(known);
        }
        self.monitor.check()?;
        let (path, lacks) = match self.finder.find(folder, name)? {
            Found::There(path) => (path, None),
            Found::Elsewhere(path) => {
                let (at, taken) = (written.0.display(), path.display());
                self.notices.push(format!("{at}: texture not found there; {taken} is used"));
                (path, None)
            }
            Found::Forbidden => {
                (written.0.clone(), Some("texture lies outside the scene's folder and may not be read".to_owned()))
            }
            Found::Nowhere => (written.0.clone(), Some("texture not found".to_owned())),
        };
        let place = (path, role);
        // By another name it may be known already.
        let known = if lacks.is_none() { self.known.get(&place).copied() } else { None };
        let index = match known {
            Some(known) => known,
            None => self.load_found(&place.0, name, role, lacks)?,
        };
        self.known.insert(place, index);
        self.known.insert(written, index);
        Ok(index)
    }

    /// Loads the picture at `path`, unless it is known what it `lacks`.
    fn load_found(&mut self, path: &Path, name: &str, role: Role, lacks: Option<String>) -> Result<Option<u32>> {
        let decoded = match lacks {
            Some(lacks) => Err(lacks),
            None => self.decode(path, name, role)?,
        };
        match decoded {
            Ok(texture) => {
                self.textures.push(texture);
                Ok(Some((self.textures.len() - 1) as u32))
            }
            Err(lacks) => {
                let instead = match role {
                    Role::Colour => "the plain colour is drawn",
                    Role::Mask => "nothing is cut out",
                };
                self.notices.push(format!("{}: {lacks}; {instead}", path.display()));
                // The same name with another role follows at once, if at all.
                if self.missing.last().is_none_or(|m| m != name) {
                    self.missing.push(name.to_string());
                }
                Ok(None)
            }
        }
    }

    /// What a texture's alpha channel looks like; looked at once for each.
    pub(super) fn alpha(&mut self, index: u32) -> Alpha {
        let texels = &self.textures[index as usize].texels;
        *self.alphas.entry(index).or_insert_with(|| Alpha::of(texels))
    }

    /// Decodes a picture; the inner error says what is wrong with it.
    fn decode(&mut self, path: &Path, name: &str, role: Role) -> Result<std::result::Result<Texture, String>> {
        let bytes = self.finder.source().read(path, MAX_PICTURE_BYTES)?;
        let format = match image::guess_format(&bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ if bytes.is_empty() => return Ok(Err("file is empty; not a PNG or JPEG picture".into())),
            _ => return Ok(Err("neither PNG nor JPEG; convert it to PNG".into())),
        };
        let broken = |e: &dyn std::fmt::Display| {
            // Some decoders' messages have line ends.
            let why = e.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            Ok(Err(format!("picture is damaged or cut short ({why}); export it again")))
        };
        // The PNG decoder refuses absurd sizes without naming them.
        if let (ImageFormat::Png, Some(size)) = (format, png_size(&bytes)) {
            self.check_size(path, size)?;
        }
        let watched = Watched { bytes: Cursor::new(&bytes), monitor: self.monitor };
        let mut reader = ImageReader::with_format(BufReader::new(watched), format);
        // Sizes are ours to check, with the numbers in the message.
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(2 * self.max_bytes.max(1 << 20));
        reader.limits(limits);
        let decoder = match reader.into_decoder() {
            Ok(decoder) => decoder,
            Err(e) => {
                self.monitor.check()?;
                return broken(&e);
            }
        };
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return broken(&format_args!("size {width}x{height} is empty"));
        }
        let total = self.check_size(path, (width, height))?;
        // Its decoder makes grey of what is missing.
        if format == ImageFormat::Jpeg && !jpeg_is_whole(&bytes) {
            return broken(&"the JPEG data has no end");
        }
        let decoded = decode_rgba(decoder, path)?;
        self.monitor.check()?;
        let (mut texels, has_alpha) = match decoded {
            Ok(decoded) => decoded,
            Err(e) => return broken(&e),
        };
        if role == Role::Mask && !(has_alpha && texels.iter().any(|t| t >> 24 < 255)) {
            for texel in &mut texels {
                let [r, g, b, _] = texel.to_le_bytes();
                *texel = u32::from_le_bytes([r, g, b, luminance(r, g, b)]);
            }
        }
        self.total_bytes = total;
        Ok(Ok(Texture { name: name.to_string(), width, height, texels }))
    }

    /// Checks a picture against the limits; the bytes of all texels with its own.
    fn check_size(&self, path: &Path, (width, height): (u32, u32)) -> Result<u64> {
        let over = |limit: &str, wanted: String, allowed: String| {
            Err(Error::LimitExceeded {
                what: format!("{}", path.display()),
                limit: limit.into(),
                wanted,
                allowed,
                remedies: &[Remedy::ScaledPictures],
            })
        };
        if width > MAX_TEXTURE_SIDE || height > MAX_TEXTURE_SIDE {
            return over("texture side", format!("{width}x{height} texels"), format!("{MAX_TEXTURE_SIDE} texels"));
        }
        let total = self.total_bytes + u64::from(width) * u64::from(height) * 4;
        if total > self.max_bytes {
            let wanted = format!("{width}x{height} texels, {} MiB with those before it", total.div_ceil(1 << 20));
            return over("texture memory", wanted, format!("{} MiB", self.max_bytes >> 20));
        }
        Ok(total)
    }
}

/// Bytes that cannot be read any more once the work is cancelled: that is how a decoder is stopped.
struct Watched<'a> {
    bytes: Cursor<&'a [u8]>,
    monitor: &'a Monitor,
}

impl Read for Watched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.monitor.check().map_err(io::Error::other)?;
        self.bytes.read(buffer)
    }
}

impl Seek for Watched<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// Texels with red in the lowest byte, and whether the picture has alpha.
type Texels = (Vec<u32>, bool);

/// Decodes into texels, in the same memory where channels have 8 bits; the inner error is the decoder's.
fn decode_rgba(decoder: impl ImageDecoder, path: &Path) -> Result<std::result::Result<Texels, ImageError>> {
    let too_large = || Error::Image {
        path: path.to_path_buf(),
        message: "not enough memory for a picture of this size; scale it down".into(),
    };
    let (width, height) = decoder.dimensions();
    let count = width as usize * height as usize;
    let mut texels: Vec<u32> = Vec::new();
    texels.try_reserve_exact(count).map_err(|_| too_large())?;
    texels.resize(count, 0);
    let color = decoder.color_type();
    let channels = usize::from(color.channel_count());
    let rgba = |c: &[u8]| match *c {
        [l] => [l, l, l, 255],
        [l, a] => [l, l, l, a],
        [r, g, b] => [r, g, b, 255],
        [r, g, b, a, ..] => [r, g, b, a],
        [] => [0; 4],
    };
    if usize::from(color.bytes_per_pixel()) == channels {
        // At the end of the texels' memory: texel i is written below the channels of all that follow.
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut texels);
        let first = count * (4 - channels);
        if let Err(e) = decoder.read_image(&mut bytes[first..]) {
            return Ok(Err(e));
        }
        for i in 0..count {
            let at = first + i * channels;
            let texel = rgba(&bytes[at..at + channels]);
            bytes[4 * i..4 * i + 4].copy_from_slice(&texel);
        }
    } else {
        // 16 bits a channel, in the machine's byte order.
        let size = usize::try_from(decoder.total_bytes()).map_err(|_| too_large())?;
        let mut bytes: Vec<u8> = Vec::new();
        bytes.try_reserve_exact(size).map_err(|_| too_large())?;
        bytes.resize(size, 0);
        if let Err(e) = decoder.read_image(&mut bytes) {
            return Ok(Err(e));
        }
        for (texel, c) in texels.iter_mut().zip(bytes.chunks_exact(2 * channels)) {
            let mut narrow = [0; 4];
            for (to, c) in narrow.iter_mut().zip(c.chunks_exact(2)) {
                *to = ((u32::from(u16::from_ne_bytes([c[0], c[1]])) + 128) / 257) as u8;
            }
            *texel = u32::from_ne_bytes(rgba(&narrow[..channels]));
        }
    }
    // In the order of bytes so far.
    texels.iter_mut().for_each(|t| *t = u32::from_le(*t));
    Ok(Ok((texels, color.has_alpha())))
}

/// Whether a JPEG file goes on to its end-of-image marker. (That of a preview within its header does not count.)
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    const RESTARTS: std::ops::RangeInclusive<u8> = 0xd0..=0xd7;
    let mut at = 2;
    loop {
        // The next marker; before it is the entropy-coded data of a scan, or filling.
        while bytes.get(at).is_some_and(|&b| b != 0xff) {
            at += 1;
        }
        match (bytes.get(at), bytes.get(at + 1)) {
            (Some(0xff), Some(0xff)) => at += 1,
            (Some(0xff), Some(0xd9)) => return true,
            // A stuffed byte of data, and markers without a segment.
            (Some(0xff), Some(0x00 | 0x01)) => at += 2,
            (Some(0xff), Some(marker)) if RESTARTS.contains(marker) => at += 2,
            (Some(0xff), Some(_)) => match bytes.get(at + 2..at + 4) {
                Some(&[high, low]) => at += 2 + usize::from(u16::from_be_bytes([high, low]).max(2)),
                _ => return false,
            },
            _ => return false,
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_is_told_from_other_alpha_channels() {
        let of = |alphas: &[u32]| Alpha::of(&alphas.iter().map(|a| a << 24).collect::<Vec<_>>());
        assert_eq!(of(&[255; 8]), Alpha::None);
        assert_eq!(of(&[0, 0, 255, 255]), Alpha::Mask);
        // An edge that is softened.
        assert_eq!(of(&[0, 0, 0, 0, 128, 255, 255, 255]), Alpha::Mask);
        // Nothing at all, a veil, gloss, a ramp.
        for other in [&[0, 0, 0, 0][..], &[254; 4], &[200, 210, 220, 255], &[0, 50, 100, 150, 200, 255]] {
            assert_eq!(of(other), Alpha::Other, "{other:?}");
        }
    }
}
