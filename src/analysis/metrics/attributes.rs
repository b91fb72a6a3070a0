// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels whose attributes, not colours, are wrong: another object than full tracing sees, or another shadow.

use serde::Serialize;

use crate::{Error, Result, memory};

/// How many pixels are wrong, and how they lie together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct WrongPixels {
    /// Pixels whose value differs from the reference's.
    pub count: u64,
    /// Pixels in the largest group of wrong pixels that touch each other by a side or a corner (8-connected).
    pub largest_cluster: u64,
}

impl WrongPixels {
    /// The wrong part of `pixels` pixels, from 0 to 1; 0 of none.
    pub fn ratio(&self, pixels: u64) -> f64 {
        if pixels == 0 { 0.0 } else { self.count as f64 / pixels as f64 }
    }
}

/// Compares two planes of object ids, or of shadow flags: one word per pixel, row by row. A pixel is wrong if the words
/// differ in any bit.
///
/// # Errors
/// [`Error::InvalidArgument`] if a plane has not `width` x `height` values.
pub fn wrong_pixels(reference: &[u32], test: &[u32], width: u32, height: u32) -> Result<WrongPixels> {
    let count = u64::from(width) * u64::from(height);
    for (name, plane) in [("reference plane", reference), ("test plane", test)] {
        if plane.len() as u64 != count {
            return Err(Error::argument(name, format!("{} values for {width}x{height} pixels", plane.len())));
        }
    }
    let mut wrong = memory::collected("a mark for each pixel", reference.iter().zip(test).map(|(a, b)| a != b))?;
    let mut result = WrongPixels::default();
    let (width, height) = (width as usize, height as usize);
    let mut pending = Vec::new();
    for start in 0..wrong.len() {
        if !wrong[start] {
            continue;
        }
        // Each wrong pixel is unmarked when it is put on the list, so that it is counted once.
        wrong[start] = false;
        pending.push(start);
        let mut size = 0u64;
        while let Some(i) = pending.pop() {
            size += 1;
            let (x, y) = (i % width, i / width);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                let first = row * width + x.saturating_sub(1);
                let end = row * width + (x + 2).min(width);
                for (neighbour, mark) in (first..).zip(&mut wrong[first..end]) {
                    if std::mem::take(mark) {
                        pending.push(neighbour);
                    }
                }
            }
        }
        result.count += size;
        result.largest_cluster = result.largest_cluster.max(size);
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Compares a plane of zeros with one that has a 1 at each `#`.
    fn of(rows: &[&str]) -> WrongPixels {
        let test: Vec<u32> = rows.concat().bytes().map(|b| u32::from(b == b'#')).collect();
        let (width, height) = (rows[0].len() as u32, rows.len() as u32);
        let result = wrong_pixels(&vec![0; test.len()], &test, width, height).unwrap();
        assert_eq!(result, wrong_pixels(&test, &vec![0; test.len()], width, height).unwrap());
        result
    }

    #[test]
    fn equal_planes_have_no_wrong_pixel() {
        let plane = [1, 2, 3, 4, 5, 6];
        assert_eq!(wrong_pixels(&plane, &plane, 3, 2).unwrap(), WrongPixels::default());
        let mut other = plane;
        other[4] ^= 0x8000_0000;
        assert_eq!(wrong_pixels(&plane, &other, 3, 2).unwrap(), WrongPixels { count: 1, largest_cluster: 1 });
        assert_eq!(wrong_pixels(&[], &[], 0, 0).unwrap(), WrongPixels::default());
    }

    #[test]
    fn clusters_join_by_sides_and_corners() {
        assert_eq!(of(&["#....", "..##.", ".#...", "....#"]), WrongPixels { count: 5, largest_cluster: 3 });
        assert_eq!(of(&["#.#", ".#.", "#.#"]), WrongPixels { count: 5, largest_cluster: 5 });
        assert_eq!(of(&["###", "###"]), WrongPixels { count: 6, largest_cluster: 6 });
        // A ring that only joins up at its last pixel.
        assert_eq!(of(&["#####", "#...#", "#.#.#", "#...#", "#####"]), WrongPixels { count: 17, largest_cluster: 16 });
    }

    #[test]
    fn the_end_of_a_row_does_not_touch_the_start_of_the_next() {
        assert_eq!(of(&["...#", "#...", "...#", "#..."]), WrongPixels { count: 4, largest_cluster: 1 });
        assert_eq!(of(&["#", "#", ".", "#"]), WrongPixels { count: 3, largest_cluster: 2 });
    }

    #[test]
    fn planes_of_other_sizes_are_refused() {
        let message = wrong_pixels(&[0; 6], &[0; 5], 3, 2).unwrap_err().to_string();
        assert!(message.contains("test plane") && message.contains("3x2"), "{message}");
        assert!(wrong_pixels(&[0; 5], &[0; 6], 3, 2).is_err());
        assert!(wrong_pixels(&[0; 1], &[0; 1], u32::MAX, u32::MAX).is_err());
    }

    #[test]
    fn ratios_are_parts_of_the_picture() {
        assert_eq!(WrongPixels { count: 1, largest_cluster: 1 }.ratio(10_000), 1e-4);
        assert_eq!(WrongPixels::default().ratio(0), 0.0);
    }
}
