// SPDX-License-Identifier: MIT OR Apache-2.0
//! Copies a picture into the memory of a Bitmap or a window, row by row, whatever its stride and format.
//!
//! What is here knows nothing of Android, so that the desktop's tests reach it; `android.rs` locks the real things.

use crate::failure::Failure;

/// How pixels lie in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
// Beside Android, only tests have targets of the other formats.
#[cfg_attr(not(target_os = "android"), allow(dead_code))]
pub enum Format {
    /// Four bytes: red, green, blue, alpha.
    Rgba8888,
    /// Four bytes: red, green, blue, and one that nobody reads.
    Rgbx8888,
    /// Two bytes, a little-endian word: five bits of red at the top, six of green, five of blue.
    Rgb565,
}

impl Format {
    /// Bytes of a pixel.
    pub const fn bytes(self) -> usize {
        match self {
            Format::Rgba8888 | Format::Rgbx8888 => 4,
            Format::Rgb565 => 2,
        }
    }
}

/// A picture: sRGB words with red in the lowest byte, rows from the top.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// A word a pixel.
    pub pixels: &'a [u32],
}

/// Locked memory to draw into. Nothing beyond its rows is written: neither the rest of a stride nor what lies behind.
pub struct Canvas<'a> {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Bytes from a row to the next one, at least those of its pixels.
    pub stride_bytes: usize,
    /// How pixels lie in it.
    pub format: Format,
    /// The rows.
    pub bytes: &'a mut [u8],
}

/// Bytes that a canvas takes: of the last row only what its pixels take. `None` if that is no number, or a row is longer
/// than its stride.
pub fn canvas_bytes(width: usize, height: usize, stride_bytes: usize, format: Format) -> Option<usize> {
    let row = width.checked_mul(format.bytes())?;
    if row > stride_bytes {
        return None;
    }
    match height {
        0 => Some(0),
        _ => stride_bytes.checked_mul(height - 1)?.checked_add(row),
    }
}

impl Canvas<'_> {
    /// Copies as much of `picture` as fits, from the upper left; what it does not cover becomes black.
    ///
    /// # Errors
    /// A picture or a canvas whose memory does not fit its size.
    pub fn show(&mut self, picture: Picture<'_>) -> Result<(), Failure> {
        let fits = canvas_bytes(self.width, self.height, self.stride_bytes, self.format)
            .is_some_and(|bytes| bytes <= self.bytes.len());
        if !fits || picture.width.checked_mul(picture.height) != Some(picture.pixels.len()) {
            return Err(Failure::Target("the memory of the target does not fit its size".to_owned()));
        }
        if self.width == 0 || self.height == 0 {
            return Ok(());
        }
        let row_bytes = self.width * self.format.bytes();
        let covered = picture.width.min(self.width);
        for (y, row) in self.bytes.chunks_mut(self.stride_bytes).take(self.height).enumerate() {
            let row = &mut row[..row_bytes];
            let from = if y < picture.height { &picture.pixels[y * picture.width..][..covered] } else { &[] };
            match self.format {
                Format::Rgba8888 | Format::Rgbx8888 => fill(row, from, |pixel| pixel.to_le_bytes(), [0, 0, 0, 255]),
                Format::Rgb565 => fill(row, from, rgb565, [0, 0]),
            }
        }
        Ok(())
    }
}

/// Writes pixels and then black.
fn fill<const N: usize>(row: &mut [u8], pixels: &[u32], bytes: impl Fn(u32) -> [u8; N], black: [u8; N]) {
    let mut from = pixels.iter();
    for to in row.chunks_exact_mut(N) {
        to.copy_from_slice(&from.next().map_or(black, |&pixel| bytes(pixel)));
    }
}

/// The nearest of the colours that 16 bits can say.
fn rgb565(pixel: u32) -> [u8; 2] {
    let [red, green, blue, _] = pixel.to_le_bytes().map(u32::from);
    let nearest = |value: u32, most: u32| (value * most + 127) / 255;
    (((nearest(red, 31) << 11) | (nearest(green, 63) << 5) | nearest(blue, 31)) as u16).to_le_bytes()
}

/// Something that is locked, drawn into and unlocked, whatever happens in between.
pub trait Target {
    /// Locks it and gives its memory to `draw`. It is unlocked when this returns, by a panic too.
    ///
    /// # Errors
    /// What cannot be locked; what `draw` reports; what cannot be unlocked.
    fn with_canvas(&mut self, draw: &mut dyn FnMut(&mut Canvas<'_>) -> Result<(), Failure>) -> Result<(), Failure>;
}

/// Shows `picture` on `target`.
///
/// # Errors
/// As for [`Target::with_canvas`].
pub fn show(target: &mut dyn Target, picture: Picture<'_>) -> Result<(), Failure> {
    target.with_canvas(&mut |canvas| canvas.show(picture))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const UNTOUCHED: u8 = 0xa5;

    /// A window whose buffers have a stride and something behind them.
    struct FakeWindow {
        width: usize,
        height: usize,
        stride: usize,
        format: Format,
        bytes: Vec<u8>,
        locks: u32,
        unlocks: u32,
        lost: bool,
    }

    impl FakeWindow {
        fn new(width: usize, height: usize, stride: usize, format: Format) -> Self {
            let bytes = vec![UNTOUCHED; stride * format.bytes() * height + 64];
            FakeWindow { width, height, stride, format, bytes, locks: 0, unlocks: 0, lost: false }
        }

        fn pixel(&self, x: usize, y: usize) -> &[u8] {
            &self.bytes[(y * self.stride + x) * self.format.bytes()..][..self.format.bytes()]
        }
    }

    impl Target for FakeWindow {
        fn with_canvas(&mut self, draw: &mut dyn FnMut(&mut Canvas<'_>) -> Result<(), Failure>) -> Result<(), Failure> {
            if self.lost {
                return Err(Failure::Target("lost".into()));
            }
            self.locks += 1;
            struct Unlock<'a>(&'a mut u32);
            impl Drop for Unlock<'_> {
                fn drop(&mut self) {
                    *self.0 += 1;
                }
            }
            let _unlock = Unlock(&mut self.unlocks);
            let stride_bytes = self.stride * self.format.bytes();
            let length = canvas_bytes(self.width, self.height, stride_bytes, self.format).unwrap();
            let bytes = &mut self.bytes[..length];
            let (width, height, format) = (self.width, self.height, self.format);
            draw(&mut Canvas { width, height, stride_bytes, format, bytes })
        }
    }

    fn numbered(width: usize, height: usize) -> Vec<u32> {
        (0..(width * height) as u32).map(|i| i.wrapping_mul(0x9e37_79b9) | 0xff00_0000).collect()
    }

    #[test]
    fn a_stride_wider_than_the_picture_is_stepped_over() {
        // The well-known one of 1080 pixels.
        let (width, height, stride) = (1080, 5, 1088);
        let pixels = numbered(width, height);
        for format in [Format::Rgba8888, Format::Rgbx8888] {
            let mut window = FakeWindow::new(width, height, stride, format);
            show(&mut window, Picture { width, height, pixels: &pixels }).unwrap();
            for (x, y) in [(0, 0), (1079, 0), (0, 1), (541, 3), (1079, 4)] {
                assert_eq!(window.pixel(x, y), pixels[y * width + x].to_le_bytes(), "{x},{y}");
            }
            for (x, y) in [(1080, 0), (1087, 3), (1080, 4)] {
                assert!(window.pixel(x, y).iter().all(|&byte| byte == UNTOUCHED), "{x},{y}");
            }
            assert!(window.bytes[stride * 4 * height..].iter().all(|&byte| byte == UNTOUCHED));
            assert_eq!((window.locks, window.unlocks), (1, 1));
        }
    }

    #[test]
    fn sixteen_bits_hold_the_nearest_colour() {
        let word = |r: u32, g: u32, b: u32| u16::from_le_bytes(rgb565(r | g << 8 | b << 16 | 0xff00_0000));
        assert_eq!(word(0, 0, 0), 0);
        assert_eq!(word(255, 255, 255), 0xffff);
        assert_eq!((word(255, 0, 0), word(0, 255, 0), word(0, 0, 255)), (0xf800, 0x07e0, 0x001f));
        for value in 0..256u32 {
            let five = u32::from(word(value, 0, 0) >> 11);
            assert!((five * 255).abs_diff(value * 31) * 2 <= 255, "{value}");
        }
        let pixels = numbered(3, 2);
        let mut window = FakeWindow::new(3, 2, 4, Format::Rgb565);
        show(&mut window, Picture { width: 3, height: 2, pixels: &pixels }).unwrap();
        assert_eq!(window.pixel(2, 1), rgb565(pixels[5]));
        assert_eq!(window.pixel(3, 0), [UNTOUCHED; 2]);
    }

    #[test]
    fn a_window_of_another_size_shows_what_fits_and_black() {
        let pixels = numbered(4, 4);
        let mut window = FakeWindow::new(6, 2, 8, Format::Rgba8888);
        show(&mut window, Picture { width: 4, height: 4, pixels: &pixels }).unwrap();
        assert_eq!(window.pixel(3, 1), pixels[7].to_le_bytes());
        assert_eq!(window.pixel(4, 1), [0, 0, 0, 255]);
        let mut window = FakeWindow::new(2, 6, 2, Format::Rgb565);
        show(&mut window, Picture { width: 4, height: 4, pixels: &pixels }).unwrap();
        assert_eq!((window.pixel(1, 3), window.pixel(1, 4)), (&rgb565(pixels[13])[..], &[0u8, 0][..]));
        let mut window = FakeWindow::new(0, 0, 0, Format::Rgba8888);
        show(&mut window, Picture { width: 4, height: 4, pixels: &pixels }).unwrap();
    }

    #[test]
    fn whatever_happens_it_is_unlocked() {
        let mut window = FakeWindow::new(4, 4, 4, Format::Rgba8888);
        assert!(show(&mut window, Picture { width: 4, height: 4, pixels: &[0; 15] }).is_err());
        assert_eq!((window.locks, window.unlocks), (1, 1));
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            let _ = window.with_canvas(&mut |_| panic!("in the middle"));
        }));
        assert!(panicked.is_err());
        assert_eq!((window.locks, window.unlocks), (2, 2));
        window.lost = true;
        assert!(matches!(show(&mut window, Picture { width: 1, height: 1, pixels: &[0] }), Err(Failure::Target(_))));
        assert_eq!((window.locks, window.unlocks), (2, 2));
    }

    #[test]
    fn a_canvas_that_lies_about_its_memory_is_refused() {
        let pixels = numbered(2, 2);
        let mut bytes = [0u8; 16];
        for (width, height, stride_bytes) in [(2, 2, 7), (3, 2, 8), (2, 3, 8), (usize::MAX, 1, 8), (2, usize::MAX, 8)] {
            let mut canvas = Canvas { width, height, stride_bytes, format: Format::Rgba8888, bytes: &mut bytes };
            assert!(canvas.show(Picture { width: 2, height: 2, pixels: &pixels }).is_err(), "{width}x{height}");
        }
        assert_eq!(canvas_bytes(1080, 2, 4352, Format::Rgba8888), Some(4352 + 4320));
    }
}
