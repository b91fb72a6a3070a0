// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which pixels had a correction ray: the record that makes a window of a drawn frame repairable.

use std::ops::Range;

use crate::error::Result;
use crate::memory;

/// A set of pixel addresses (x in the low half word, y in the high one): one bit a sample.
#[derive(Debug)]
pub struct FiredPixels {
    width: usize,
    words_per_row: usize,
    words: Vec<u64>,
}

impl FiredPixels {
    /// None yet, in a frame of `width` by `height` samples.
    ///
    /// # Errors
    /// [`crate::Error::OutOfMemory`].
    pub fn new(width: u32, height: u32) -> Result<Self> {
        let words_per_row = (width as usize).div_ceil(64);
        let words = memory::filled("a bit for each sample", words_per_row * height as usize, 0)?;
        Ok(FiredPixels { width: width as usize, words_per_row, words })
    }

    fn place(&self, pixel: u32) -> (usize, u64) {
        let (x, y) = ((pixel & 0xffff) as usize, (pixel >> 16) as usize);
        debug_assert!(x < self.width, "a pixel of the frame");
        (y * self.words_per_row + x / 64, 1 << (x % 64))
    }

    /// Adds a pixel; says whether it is new.
    pub fn insert(&mut self, pixel: u32) -> bool {
        let (word, bit) = self.place(pixel);
        let is_new = self.words[word] & bit == 0;
        self.words[word] |= bit;
        is_new
    }

    /// Whether the pixel is in the set.
    pub fn contains(&self, pixel: u32) -> bool {
        let (word, bit) = self.place(pixel);
        self.words[word] & bit != 0
    }

    /// The pixels of some rows, in the order of the picture.
    pub fn in_rows(&self, rows: Range<u32>) -> Vec<u32> {
        let mut pixels = Vec::new();
        for y in rows {
            let row = &self.words[y as usize * self.words_per_row..][..self.words_per_row];
            for (at, &word) in row.iter().enumerate() {
                let mut rest = word;
                while rest != 0 {
                    pixels.push((at as u32 * 64 + rest.trailing_zeros()) | y << 16);
                    rest &= rest - 1;
                }
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_was_inserted_is_found_again() {
        let mut fired = FiredPixels::new(130, 3).unwrap();
        let pixels = [0, 63, 64, 129, 1 << 16, 129 | 2 << 16];
        for pixel in pixels {
            assert!(!fired.contains(pixel));
            assert!(fired.insert(pixel) && !fired.insert(pixel));
            assert!(fired.contains(pixel));
        }
        assert!(!fired.contains(1));
        assert_eq!(fired.in_rows(0..3), pixels);
        assert_eq!(fired.in_rows(1..2), [1 << 16]);
    }
}
