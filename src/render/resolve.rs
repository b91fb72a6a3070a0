// SPDX-License-Identifier: MIT OR Apache-2.0
//! From samples to pixels: a box filter in linear light.

use rayon::prelude::*;

use crate::error::Result;
use crate::memory;
use crate::monitor::Monitor;

/// Linear light of an sRGB byte, 0 to 65535.
fn linear_table() -> [u32; 256] {
    std::array::from_fn(|byte| {
        let v = byte as f64 / 255.0;
        let linear = if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) };
        (linear * 65535.0).round() as u32
    })
}

/// The sRGB byte whose linear light is nearest to `linear` on the sRGB scale.
fn srgb_byte(linear: u32) -> u32 {
    let v = f64::from(linear) / 65535.0;
    let s = if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (s * 255.0).round() as u32
}

/// The picture of `width` by `height` pixels whose samples, `samples` in each direction of a pixel, are `words`
/// (sRGB words, row-major): each pixel is the mean of its samples in linear light.
///
/// # Errors
/// [`crate::Error::Cancelled`], [`crate::Error::OutOfMemory`].
pub fn resolve(words: &[u32], width: u32, height: u32, samples: u32, monitor: &Monitor) -> Result<Vec<u32>> {
    let linear = linear_table();
    let srgb: Vec<u8> = (0..=65535).map(|v| srgb_byte(v) as u8).collect();
    let (width, samples) = (width as usize, samples as usize);
    let row_words = width * samples;
    let count = (samples * samples) as u32;
    let mut pixels = memory::filled("the picture", width * height as usize, 0)?;
    pixels.par_chunks_mut(width.max(1)).enumerate().try_for_each(|(y, row)| {
        monitor.check()?;
        let block_rows = &words[y * samples * row_words..][..samples * row_words];
        for (x, pixel) in row.iter_mut().enumerate() {
            let mut sums = [0u32; 3];
            for sample_row in block_rows.chunks_exact(row_words) {
                for &word in &sample_row[x * samples..][..samples] {
                    let bytes = word.to_le_bytes();
                    for (sum, byte) in sums.iter_mut().zip(bytes) {
                        *sum += linear[usize::from(byte)];
                    }
                }
            }
            let [r, g, b] = sums.map(|sum| srgb[((sum + count / 2) / count) as usize]);
            *pixel = u32::from_le_bytes([r, g, b, 255]);
        }
        Ok(())
    })?;
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(byte: u32) -> u32 {
        (byte * 0x01_0101) | 0xff00_0000
    }

    #[test]
    fn equal_samples_stay_what_they_are() {
        for samples in [1, 2, 4] {
            let words: Vec<u32> =
                (0..256u32).flat_map(|byte| std::iter::repeat_n(grey(byte), (samples * samples) as usize)).collect();
            // One column of pixels would interleave its rows: each value fills one row of blocks of its own.
            let pixels = resolve(&words, 1, 256, samples, &Monitor::default()).unwrap();
            for (byte, pixel) in pixels.iter().enumerate() {
                assert_eq!(*pixel, grey(byte as u32));
            }
        }
    }

    #[test]
    fn black_and_white_meet_in_linear_light() {
        let words = [0xff00_0000, 0xffff_ffff, 0xffff_ffff, 0xff00_0000];
        // Half the light is 188 of 255, not 128.
        assert_eq!(resolve(&words, 1, 1, 2, &Monitor::default()).unwrap(), [0xffbc_bcbc]);
    }
}
