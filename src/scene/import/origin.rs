// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes far from the origin, such as cities in map coordinates: where their own origin is put.
//!
//! Single precision has seven digits. A room of 20 m at 4,500,000 m would be left with steps of half a metre. So the
//! vertices are looked at in double precision before the file is read, and where they lie far away, a place in their
//! midst is taken off every position: of vertices, camera and lights, before they are rounded.

use std::path::Path;

use glam::DVec3;

use super::lines::{LONGEST_KEY, LogicalLines, MAX_OBJ_BYTES, keyword, lower_case, without_comment, words};
use super::source::Source;
use crate::Result;
use crate::monitor::Monitor;

/// A scene is far away along an axis where its middle lies more than this many times its size from 0: six of the 24 bits
/// of single precision would be lost. Anything nearer is left as it is, to the last bit.
const FAR_SIZES: f64 = 64.0;

/// Vertices that are looked at before it is asked whether the scene is far away at all.
const FIRST_LOOK: usize = 256;

/// Most vertices that are remembered, evenly spread over the file.
const MOST_SAMPLES: usize = 1 << 16;

/// Lines after which it is asked whether the work is to end.
const LINES_AT_ONCE: u64 = 1 << 14;

/// What is to be taken off all positions of the scene at `path`; 0 if it does not lie far away.
///
/// # Errors
/// [`crate::Error::Cancelled`]. A file that cannot be read is left for the reader to refuse.
pub(super) fn of(source: &Source, path: &Path, monitor: &Monitor) -> Result<DVec3> {
    let Ok(mut lines) = LogicalLines::open(source, path, MAX_OBJ_BYTES) else { return Ok(DVec3::ZERO) };
    let mut samples = Samples::default();
    let mut count = 0u64;
    while let Ok(Some((_, line))) = lines.next_line() {
        count += 1;
        if count.is_multiple_of(LINES_AT_ONCE) {
            monitor.check()?;
        }
        let (written, rest) = keyword(line);
        if lower_case(written, &mut [0; LONGEST_KEY]) != b"v" {
            continue;
        }
        let Some(position) = position(without_comment(rest)) else { continue };
        samples.add(position);
        if samples.seen >= FIRST_LOOK && samples.seen.is_power_of_two() && samples.origin() == DVec3::ZERO {
            return Ok(DVec3::ZERO);
        }
    }
    Ok(samples.origin())
}

/// The words behind a `v` with `origin` taken off, before they are rounded; `None` if they stay as they are.
pub(super) fn moved(text: &[u8], origin: DVec3) -> Option<String> {
    if origin == DVec3::ZERO {
        return None;
    }
    let p = (position(text)? - origin).as_vec3();
    Some(format!("{} {} {}", p.x, p.y, p.z))
}

/// The position in the words behind a `v`; `None` if it is none.
fn position(text: &[u8]) -> Option<DVec3> {
    let number = |word: &[u8]| std::str::from_utf8(word).ok()?.parse().ok().filter(|v: &f64| v.is_finite());
    let mut numbers = words(text);
    let mut next = || number(numbers.next()?);
    let position = DVec3::new(next()?, next()?, next()?);
    // A fourth number is a weight, unless colours follow.
    match (next(), next()) {
        (Some(weight), None) if weight != 0.0 => Some(position / weight),
        (Some(_), None) => None,
        _ => Some(position),
    }
}

/// Some of the vertices.
#[derive(Default)]
struct Samples {
    kept: Vec<DVec3>,
    seen: usize,
    /// Every `2^thinned`-th is kept.
    thinned: u32,
}

impl Samples {
    fn add(&mut self, position: DVec3) {
        if self.seen.is_multiple_of(1 << self.thinned) {
            if self.kept.len() == MOST_SAMPLES {
                let mut at = 0;
                self.kept.retain(|_| {
                    at += 1;
                    at % 2 == 1
                });
                self.thinned += 1;
            }
            self.kept.push(position);
        }
        self.seen += 1;
    }

    /// The middle of the box from the 1st to the 99th percentile along the axes where it is far away, in whole powers of
    /// two near its size, so that it has few digits.
    fn origin(&self) -> DVec3 {
        let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
        let Some(last) = self.kept.len().checked_sub(1) else { return DVec3::ZERO };
        for axis in 0..3 {
            let mut values: Vec<f64> = self.kept.iter().map(|p| p[axis]).collect();
            low[axis] = *values.select_nth_unstable_by(last / 100, f64::total_cmp).1;
            high[axis] = *values.select_nth_unstable_by(last - last / 100, f64::total_cmp).1;
        }
        let (middle, size) = ((low + high) * 0.5, (high - low).max_element());
        if size <= 0.0 {
            return DVec3::ZERO;
        }
        let unit = size.log2().floor().exp2();
        let far = |middle: f64| if middle.abs() > FAR_SIZES * size { (middle / unit).round() * unit } else { 0.0 };
        DVec3::new(far(middle.x), far(middle.y), far(middle.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin(positions: impl IntoIterator<Item = DVec3>) -> DVec3 {
        let mut samples = Samples::default();
        positions.into_iter().for_each(|p| samples.add(p));
        samples.origin()
    }

    #[test]
    fn only_what_is_far_along_an_axis_is_moved_along_it() {
        let room = |x: f64, z: f64| (0..300).map(move |i| DVec3::new(x + f64::from(i % 20), f64::from(i % 7), z + 3.0));
        assert_eq!(origin(room(0.0, 0.0)), DVec3::ZERO);
        assert_eq!(origin(room(1200.0, -1200.0)), DVec3::ZERO, "not yet");
        assert_eq!(origin(room(5000.0, 12.0)), DVec3::new(5008.0, 0.0, 0.0));
        assert_eq!(origin(room(-500_000.0, 4_500_000.0)), DVec3::new(-499_984.0, 0.0, 4_500_000.0));
        // One vertex left at 0 does not hold the others there, nor do so many that not all are kept.
        let stray = [DVec3::ZERO].into_iter().chain(room(85_000.0, 446_000.0));
        assert_eq!(origin(stray), DVec3::new(85_008.0, 0.0, 446_000.0));
        let many = (0..1000).flat_map(|_| room(85_000.0, 446_000.0));
        assert_eq!(origin(many), DVec3::new(85_008.0, 0.0, 446_000.0));
        assert_eq!(origin([]), DVec3::ZERO);
        assert_eq!(origin([DVec3::splat(1e6)]), DVec3::ZERO, "a point has no size");
    }

    #[test]
    fn positions_are_read_with_weights_and_colours() {
        assert_eq!(position(b"1 2 3"), Some(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(position(b"1 2 3 2"), Some(DVec3::new(0.5, 1.0, 1.5)));
        assert_eq!(position(b"1 2 3 0.5 0.5 0.5"), Some(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(position(b"1 2"), None);
        assert_eq!(position(b"1 2 nan"), None);
        assert_eq!(position(b"1 2 3 0"), None);
    }
}
