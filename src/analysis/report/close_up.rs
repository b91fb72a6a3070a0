// SPDX-License-Identifier: MIT OR Apache-2.0
//! Close-ups: where correction changed a picture most, enlarged.

use std::path::Path;

use super::figures::Figures;
use super::measure::{PICTURES, file_stem};
use super::sections::Group;
use super::table::Picture;
use crate::error::Result;
use crate::render::picture::{read_rgb8, write_small_png};

/// Side of what is cut out, in pixels, where the picture has as many.
const SIDE: u32 = 56;
/// How many pixels across each pixel is shown with.
const ENLARGED: u32 = 5;

/// A picture in memory.
struct Pixels {
    width: u32,
    height: u32,
    words: Vec<u32>,
}

/// Cuts close-ups of `scene` from the pictures of two measurements in the report's `folder`: `corrected`, which has the full
/// picture too, and `uncorrected`. None if one of the pictures was not written.
///
/// # Errors
/// Files that cannot be read or written.
pub fn close_up(folder: &Path, scene: &str, uncorrected: &Figures, corrected: &Figures) -> Result<Option<Group>> {
    let wanted = [uncorrected.picture("adaptive"), corrected.picture("adaptive"), corrected.picture("full")];
    let [Some(before), Some(after), Some(full)] = wanted else { return Ok(None) };
    let read = |picture: &Picture| -> Result<Pixels> {
        let (width, height, words) = read_rgb8(folder.join(&picture.file))?;
        Ok(Pixels { width, height, words })
    };
    let [before, after, full] = [read(before)?, read(after)?, read(full)?];
    let corner = most_improved(&before, &after, &full);
    let mut pictures = Vec::new();
    for (kind, pixels, caption) in [
        ("before", &before, "before correction"),
        ("after", &after, "after correction"),
        ("full", &full, "full tracing"),
    ] {
        let file = format!("{PICTURES}/close-up-{}-{kind}.png", file_stem(scene));
        let (width, height, words) = pixels.enlarged(corner);
        write_small_png(folder.join(&file), width, height, &words)?;
        let caption = format!("{caption}, {SIDE}x{SIDE} pixels from {}, {}", corner.0, corner.1);
        pictures.push(Picture { file, width, height, alt: format!("{scene}, enlarged, {kind}"), caption });
    }
    Ok(Some(Group { title: scene.to_owned(), pictures }))
}

impl Pixels {
    /// The square at `corner`, each pixel shown with several.
    fn enlarged(&self, (left, top): (u32, u32)) -> (u32, u32, Vec<u32>) {
        let (width, height) = (SIDE.min(self.width - left), SIDE.min(self.height - top));
        let mut words = Vec::new();
        for y in 0..height * ENLARGED {
            let row = ((top + y / ENLARGED) * self.width + left) as usize;
            words.extend((0..width * ENLARGED).map(|x| self.words[row + (x / ENLARGED) as usize]));
        }
        (width * ENLARGED, height * ENLARGED, words)
    }
}

/// Squared distance of two colours.
fn distance(a: u32, b: u32) -> i64 {
    let (a, b) = (a.to_le_bytes(), b.to_le_bytes());
    (0..3).map(|c| i64::from(a[c].abs_diff(b[c])).pow(2)).sum()
}

/// The corner of the square in which correction took away most of the error; squares begin at every eighth pixel.
fn most_improved(before: &Pixels, after: &Pixels, full: &Pixels) -> (u32, u32) {
    let gain = |at: usize| distance(before.words[at], full.words[at]) - distance(after.words[at], full.words[at]);
    let last = |side: u32| side.saturating_sub(SIDE);
    let mut best = (i64::MIN, (0, 0));
    for top in (0..=last(full.height)).step_by(8) {
        for left in (0..=last(full.width)).step_by(8) {
            let rows = top..(top + SIDE).min(full.height);
            let sum = rows
                .flat_map(|y| (left..(left + SIDE).min(full.width)).map(move |x| (y * full.width + x) as usize))
                .map(gain)
                .sum::<i64>();
            if sum > best.0 {
                best = (sum, (left, top));
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_close_up_is_where_correction_helped() {
        let picture = |spots: &[(u32, u32)]| {
            let mut words = vec![0xff00_0000; 120 * 90];
            for (x, y) in spots {
                words[(y * 120 + x) as usize] = 0xffff_ffff;
            }
            Pixels { width: 120, height: 90, words }
        };
        // Both pictures lack the left spot, correction found the right one.
        let (before, after, full) = (picture(&[]), picture(&[(110, 80)]), picture(&[(110, 80), (3, 3)]));
        let (left, top) = most_improved(&before, &after, &full);
        assert!((55..=64).contains(&left) && (25..=34).contains(&top), "{left} {top}");
        let (width, height, words) = full.enlarged((left, top));
        assert_eq!((width, height), (SIDE * ENLARGED, SIDE * ENLARGED));
        assert_eq!(words.iter().filter(|&&w| w == 0xffff_ffff).count() as u32, ENLARGED * ENLARGED);
        // A picture smaller than a close-up is shown whole.
        let small = Pixels { width: 3, height: 2, words: vec![0; 6] };
        assert_eq!(small.enlarged((0, 0)).2.len() as u32, 6 * ENLARGED * ENLARGED);
    }
}
