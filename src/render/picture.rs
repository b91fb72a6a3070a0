// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pictures as files: PNG and JPEG in, PNG out.
//!
//! In memory a pixel is one word: red in the lowest byte, then green, blue and alpha, as the renderer writes it.

use std::io::{self, BufReader};
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageEncoder, ImageError, ImageReader, Limits};

use crate::error::Remedy;
use crate::{Error, Result, files};

/// The longest side, in pixels, of a picture that is read or written.
pub const MAX_SIDE: u32 = 16_384;

/// The most pixels of a picture that is read: 8192x8192. Comparing two such pictures takes 1 GiB.
pub const MAX_PIXELS: u64 = 1 << 26;

/// The largest picture file that is read: 16 bits in each of four channels of the largest picture need as much.
const MAX_FILE_BYTES: u64 = 8 * MAX_PIXELS;

/// What a decoder may hold beside the pixels.
const BESIDE_PIXELS_BYTES: u64 = 64 << 20;

/// Reads a PNG or JPEG file (told by its content, not its name) as `(width, height, pixels)`.
///
/// Grey becomes equal red, green and blue; 16-bit channels are rounded to 8; transparency is dropped, so that alpha is
/// 255 everywhere. Nothing is allocated for the pixels before the header's size is known to be at most [`MAX_SIDE`] on
/// each side and [`MAX_PIXELS`] in all.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, [`Error::Image`] if it is neither PNG nor JPEG or is damaged,
/// [`Error::LimitExceeded`] if it is too large.
pub fn read_rgb8(path: impl AsRef<Path>) -> Result<(u32, u32, Vec<u32>)> {
    let path = path.as_ref();
    let file = files::open(path, MAX_FILE_BYTES)?;
    let mut reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(|e| Error::io(path, e))?;
    // For what lies beside the pixels, such as colour profiles, which are packed and may be bombs.
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(BESIDE_PIXELS_BYTES);
    reader.limits(limits.clone());
    if reader.format().is_none() {
        return Err(broken(path, "this is neither a PNG nor a JPEG file"));
    }
    let mut decoder = reader.into_decoder().map_err(|e| decode_error(path, e))?;
    let (width, height) = decoder.dimensions();
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(too_large(path, format!("{width}x{height} pixels")));
    }
    let count = u64::from(width) * u64::from(height);
    if count > MAX_PIXELS {
        return Err(Error::LimitExceeded {
            what: path.display().to_string(),
            wanted: format!("{width}x{height}, {count} pixels"),
            limit: "pixels of a picture".to_owned(),
            allowed: format!("{MAX_PIXELS} pixels"),
            remedies: &[Remedy::ScaledPictures],
        });
    }
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    decoder.set_limits(limits).map_err(|e| decode_error(path, e))?;

    let color = decoder.color_type();
    let mut bytes: Vec<u8> = reserved(path, decoder.total_bytes())?;
    // The length fits usize, as `reserved` has checked.
    bytes.resize(decoder.total_bytes() as usize, 0);
    decoder.read_image(&mut bytes).map_err(|e| decode_error(path, e))?;
    let mut pixels: Vec<u32> = reserved(path, count)?;
    match color {
        ColorType::L8 => pixels.extend(bytes.iter().map(|&l| word(l, l, l))),
        ColorType::La8 => pixels.extend(bytes.chunks_exact(2).map(|c| word(c[0], c[0], c[0]))),
        ColorType::Rgb8 => pixels.extend(bytes.chunks_exact(3).map(|c| word(c[0], c[1], c[2]))),
        ColorType::Rgba8 => pixels.extend(bytes.chunks_exact(4).map(|c| word(c[0], c[1], c[2]))),
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
            let channels = usize::from(color.channel_count());
            let (green, blue) = if channels >= 3 { (1, 2) } else { (0, 0) };
            pixels.extend(bytes.chunks_exact(2 * channels).map(|c| {
                let byte = |i: usize| round_to_8(u16::from_ne_bytes([c[2 * i], c[2 * i + 1]]));
                word(byte(0), byte(green), byte(blue))
            }));
        }
        other => return Err(broken(path, format!("pixels of type {other:?} are not supported"))),
    }
    Ok((width, height, pixels))
}

/// Writes pixels as an RGB PNG of 8 bits per channel, without alpha; equal pixels give equal bytes.
///
/// A missing or unwritable folder and a full disk leave no file, and an older file of that name as it was.
///
/// # Errors
/// [`Error::Image`] if the sizes do not fit together or are 0 or above [`MAX_SIDE`], [`Error::Io`] if the file cannot
/// be written.
pub fn write_png(path: impl AsRef<Path>, width: u32, height: u32, pixels: &[u32]) -> Result<()> {
    write(path.as_ref(), width, height, pixels, CompressionType::Fast)
}

/// As [`write_png`], for pictures that nobody waits for: masks take a sixteenth to a third of the room, drawn pictures 0.8
/// to 0.9 of it, and the writing some 0.2 s longer for a million pixels.
///
/// # Errors
/// As for [`write_png`].
pub fn write_small_png(path: impl AsRef<Path>, width: u32, height: u32, pixels: &[u32]) -> Result<()> {
    write(path.as_ref(), width, height, pixels, CompressionType::Default)
}

fn write(path: &Path, width: u32, height: u32, pixels: &[u32], compression: CompressionType) -> Result<()> {
    if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
        return Err(broken(path, format!("a picture of {width}x{height} pixels, sides are 1 to {MAX_SIDE}")));
    }
    let count = u64::from(width) * u64::from(height);
    if pixels.len() as u64 != count {
        return Err(broken(path, format!("{} pixels for a picture of {width}x{height}", pixels.len())));
    }
    let mut bytes: Vec<u8> = reserved(path, count * 3)?;
    for pixel in pixels {
        bytes.extend_from_slice(&pixel.to_le_bytes()[..3]);
    }
    let mut encoded = Vec::new();
    PngEncoder::new_with_quality(&mut encoded, compression, FilterType::Adaptive)
        .write_image(&bytes, width, height, ExtendedColorType::Rgb8)
        .map_err(|e| broken(path, e.to_string()))?;
    files::write_whole(path, &encoded)
}

/// An empty vector with room for `count` values, or an error where memory does not suffice.
fn reserved<T>(path: &Path, count: u64) -> Result<Vec<T>> {
    let mut values = Vec::new();
    let fits = usize::try_from(count).is_ok_and(|n| values.try_reserve_exact(n).is_ok());
    let bytes = count.saturating_mul(size_of::<T>() as u64);
    if fits { Ok(values) } else { Err(Error::OutOfMemory { what: path.display().to_string(), bytes }) }
}

fn word(red: u8, green: u8, blue: u8) -> u32 {
    u32::from_le_bytes([red, green, blue, 255])
}

/// The nearest 8-bit value of the same fraction of full scale.
fn round_to_8(value: u16) -> u8 {
    ((u32::from(value) * 255 + 32_767) / 65_535) as u8
}

fn broken(path: &Path, message: impl Into<String>) -> Error {
    Error::Image { path: path.to_path_buf(), message: message.into() }
}

fn too_large(path: &Path, wanted: String) -> Error {
    Error::LimitExceeded {
        what: path.display().to_string(),
        wanted,
        limit: "picture side".to_owned(),
        allowed: format!("{MAX_SIDE}x{MAX_SIDE} pixels"),
        remedies: &[Remedy::ScaledPictures],
    }
}

fn decode_error(path: &Path, error: ImageError) -> Error {
    match error {
        // A file that ends early is damaged; that is not a failure of the system.
        ImageError::IoError(e) if e.kind() != io::ErrorKind::UnexpectedEof => Error::io(path, e),
        ImageError::IoError(_) => broken(path, "the file ends early"),
        // Where addresses have 32 bits the decoder itself refuses what they cannot reach.
        ImageError::Limits(_) => too_large(path, "more pixels than addresses reach".to_owned()),
        ImageError::Unsupported(e) => broken(path, format!("only PNG and JPEG are supported: {e}")),
        other => broken(path, other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::ffi::OsString;
    use std::fs;

    use super::*;

    fn pattern(width: u32, height: u32) -> Vec<u32> {
        (0..width * height).map(|i| i.wrapping_mul(2_654_435_761) | 0xff00_0000).collect()
    }

    fn names(folder: &Path) -> Vec<OsString> {
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name()).collect()
    }

    fn encode(path: &Path, width: u32, height: u32, bytes: &[u8], color: ExtendedColorType) {
        let mut out = Vec::new();
        PngEncoder::new(&mut out).write_image(bytes, width, height, color).unwrap();
        fs::write(path, out).unwrap();
    }

    #[test]
    fn a_written_png_reads_back_and_is_the_same_file_each_time() {
        let folder = tempfile::tempdir().unwrap();
        for (width, height) in [(1, 1), (1, 7), (13, 1), (37, 23)] {
            let pixels = pattern(width, height);
            let (a, b) = (folder.path().join("a.png"), folder.path().join("b.png"));
            write_png(&a, width, height, &pixels).unwrap();
            write_png(&b, width, height, &pixels).unwrap();
            assert_eq!(read_rgb8(&a).unwrap(), (width, height, pixels.clone()));
            assert_eq!(fs::read(&a).unwrap(), fs::read(&b).unwrap());
            write_small_png(&b, width, height, &pixels).unwrap();
            assert_eq!(read_rgb8(&b).unwrap(), (width, height, pixels.clone()));
            // Negative control: another picture gives another file.
            let mut other = pixels;
            other[0] ^= 1;
            write_png(&b, width, height, &other).unwrap();
            assert_ne!(fs::read(&a).unwrap(), fs::read(&b).unwrap());
        }
        assert_eq!(names(folder.path()).len(), 2, "temporary files stayed behind");
    }

    #[test]
    fn a_mask_is_small() {
        let folder = tempfile::tempdir().unwrap();
        let (fast, small) = (folder.path().join("fast.png"), folder.path().join("small.png"));
        // Blocks of 2 whose pixels are of four classes, one of them here and there.
        let pixels: Vec<u32> = (0..256 * 256u32)
            .map(|i| [0xff, 0xff00, 0xff_0000, if i % 7 < 3 { 0xff00 } else { 0 }][(i % 2 + i / 256 % 2 * 2) as usize])
            .collect();
        write_png(&fast, 256, 256, &pixels).unwrap();
        write_small_png(&small, 256, 256, &pixels).unwrap();
        let bytes = |path: &Path| fs::metadata(path).unwrap().len();
        assert!(2 * bytes(&small) < bytes(&fast), "{} and {} bytes", bytes(&small), bytes(&fast));
    }

    #[test]
    fn alpha_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write_png(&path, 2, 1, &[0x0003_0201, 0x8006_0504]).unwrap();
        assert_eq!(read_rgb8(&path).unwrap().2, [0xff03_0201, 0xff06_0504]);
        assert_eq!(fs::read(&path).unwrap()[25], 2, "the PNG's colour type is not RGB");
    }

    #[test]
    fn every_kind_of_png_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        encode(&path, 2, 1, &[7, 250], ExtendedColorType::L8);
        assert_eq!(read_rgb8(&path).unwrap().2, [0xff07_0707, 0xfffa_fafa]);
        encode(&path, 1, 1, &[7, 0], ExtendedColorType::La8);
        assert_eq!(read_rgb8(&path).unwrap().2, [0xff07_0707]);
        encode(&path, 1, 1, &[1, 2, 3, 4], ExtendedColorType::Rgba8);
        assert_eq!(read_rgb8(&path).unwrap().2, [0xff03_0201]);
        let deep: Vec<u8> = [257u16, 2 * 257 + 128, 65_535, 0].iter().flat_map(|v| v.to_ne_bytes()).collect();
        encode(&path, 1, 1, &deep, ExtendedColorType::Rgba16);
        assert_eq!(read_rgb8(&path).unwrap().2, [0xffff_0201]);
        encode(&path, 1, 1, &deep[2..4], ExtendedColorType::L16);
        assert_eq!(read_rgb8(&path).unwrap().2, [0xff02_0202]);
    }

    #[test]
    fn a_jpeg_is_read_whatever_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut out = Vec::new();
        let grey = vec![100u8; 16 * 8 * 3];
        image::codecs::jpeg::JpegEncoder::new_with_quality(&mut out, 95)
            .write_image(&grey, 16, 8, ExtendedColorType::Rgb8)
            .unwrap();
        fs::write(&path, out).unwrap();
        let (width, height, pixels) = read_rgb8(&path).unwrap();
        assert_eq!((width, height, pixels.len()), (16, 8, 128));
        assert!(pixels.iter().all(|p| p.to_le_bytes()[..3].iter().all(|&c| c.abs_diff(100) <= 2)), "{:x?}", pixels[0]);
    }

    #[test]
    fn bad_files_give_errors_that_name_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.png");
        let mut whole = Vec::new();
        PngEncoder::new(&mut whole).write_image(&[9; 48], 4, 4, ExtendedColorType::Rgb8).unwrap();
        let mut cases: Vec<Vec<u8>> = vec![Vec::new(), b"P6 1 1 255 abc".to_vec(), b"GIF89a......".to_vec()];
        cases.extend((8..whole.len() - 12).map(|n| whole[..n].to_vec()));
        cases.push(b"\xff\xd8\xff\xe0".to_vec());
        for case in cases {
            fs::write(&path, &case).unwrap();
            let message = read_rgb8(&path).unwrap_err().to_string();
            assert!(message.contains("bad.png"), "{message}");
        }
        // Negative control: the undamaged file is read.
        fs::write(&path, &whole).unwrap();
        read_rgb8(&path).unwrap();
        assert!(matches!(read_rgb8(folder.path().join("missing.png")), Err(Error::Io { .. })));
        assert!(read_rgb8(folder.path()).is_err());
    }

    #[test]
    fn a_giant_header_is_refused_before_anything_is_allocated() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("giant.png");
        // Only a signature and a header with a right checksum: anything that went on to the pixels would fail.
        for (width, height, too_large) in [(16_385u32, 1u32, true), (1, 2_000_000_000, true), (16_384, 1, false)] {
            let mut header = b"IHDR".to_vec();
            header.extend_from_slice(&width.to_be_bytes());
            header.extend_from_slice(&height.to_be_bytes());
            header.extend_from_slice(&[8, 2, 0, 0, 0]);
            let mut file = b"\x89PNG\r\n\x1a\n\0\0\0\x0d".to_vec();
            file.extend_from_slice(&header);
            file.extend_from_slice(&crc32(&header).to_be_bytes());
            file.extend_from_slice(b"\0\0\0\x01IDAT\0\0\0\0\0");
            fs::write(&path, &file).unwrap();
            let error = read_rgb8(&path).unwrap_err();
            assert_eq!(matches!(error, Error::LimitExceeded { .. }), too_large, "{width}x{height}: {error}");
        }
    }

    /// The checksum of PNG chunks, bit by bit.
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
        })
    }

    #[test]
    fn what_is_no_picture_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        for (width, height, count) in [(2, 2, 3), (0, 0, 0), (0, 5, 0), (16_385, 1, 16_385)] {
            assert!(write_png(folder.path().join("b.png"), width, height, &vec![0; count]).is_err());
        }
        assert!(names(folder.path()).is_empty());
    }
}
