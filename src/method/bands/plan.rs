// SPDX-License-Identifier: MIT OR Apache-2.0
//! How many rows of a frame are in device memory at once.

use std::ops::Range;

use super::FrameBudget;
use crate::device::frame_memory::FrameSizes;
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::{FrameParams, PLANE_COUNT};

/// A frame cut into bands of whole rows of blocks.
#[derive(Debug, Clone)]
pub struct Plan {
    frame: FrameParams,
    /// Rows of a band, a multiple of the block unless the frame is one band.
    rows: u32,
    /// Buffers that hold any window of the plan.
    pub sizes: FrameSizes,
}

impl Plan {
    /// The fewest bands of about equal height that `budget` and `most_rows` allow.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] if not even one row of blocks fits.
    pub fn new(frame: &FrameParams, budget: &FrameBudget, most_rows: Option<u32>) -> Result<Plan> {
        let fits = |rows: u32| budget.sizes(&widest(frame, rows)).filter(|sizes| budget.holds(sizes));
        let height = frame.height;
        let most_rows = most_rows.unwrap_or(height).clamp(1, height);
        if most_rows == height
            && let Some(sizes) = fits(height)
        {
            return Ok(Plan { frame: *frame, rows: height, sizes });
        }
        let block_rows = height.div_ceil(frame.block);
        // The most rows of blocks that fit: between `low`, which does, and `high`, which does not.
        let (mut low, mut high) = (0, (most_rows / frame.block).clamp(1, block_rows) + 1);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if fits(middle * frame.block).is_some() { low = middle } else { high = middle }
        }
        if low == 0 {
            return Err(budget.too_small(&widest(frame, frame.block)));
        }
        let bands = block_rows.div_ceil(low);
        let rows = block_rows.div_ceil(bands) * frame.block;
        let sizes = fits(rows).ok_or_else(|| budget.too_small(&widest(frame, rows)))?;
        Ok(Plan { frame: *frame, rows, sizes })
    }

    /// Whether the whole frame is in memory at once.
    pub fn is_one_band(&self) -> bool {
        self.rows >= self.frame.height
    }

    /// Rows of a band.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// The bands' rows, from the top.
    pub fn bands(&self) -> impl Iterator<Item = Range<u32>> {
        let (rows, height) = (self.rows, self.frame.height);
        (0..height.div_ceil(rows)).map(move |band| band * rows..((band + 1) * rows).min(height))
    }

    /// The frame's parameters for drawing the rows `interior`, which begin at a multiple of the block.
    pub fn window(&self, interior: Range<u32>) -> FrameParams {
        window(&self.frame, interior)
    }
}

/// A band of `rows` rows with all the context that it can have.
fn widest(frame: &FrameParams, rows: u32) -> FrameParams {
    if rows >= frame.height { window(frame, 0..frame.height) } else { tall(frame, rows) }
}

fn tall(frame: &FrameParams, rows: u32) -> FrameParams {
    let context = if frame.block > 1 { 2 * frame.block + 1 } else { 0 };
    with_window(frame, 0..rows + context, 0..rows)
}

fn window(frame: &FrameParams, interior: Range<u32>) -> FrameParams {
    if frame.block == 1 {
        return with_window(frame, interior.clone(), interior);
    }
    // Post-correction looks at the row above and at two below; those are interpolated from a row of blocks above, and
    // from one below with the base pixels that follow.
    let begin = interior.start.saturating_sub(frame.block);
    let end = (interior.end + frame.block + 1).min(frame.height);
    with_window(frame, begin..end, interior)
}

fn with_window(frame: &FrameParams, rows: Range<u32>, interior: Range<u32>) -> FrameParams {
    let phase_height = (rows.end - rows.start).div_ceil(frame.block);
    FrameParams {
        phase_height,
        plane_pitch: frame.block * frame.block * frame.phase_width * phase_height,
        window_begin: rows.start,
        window_end: rows.end,
        interior_begin: interior.start,
        interior_end: interior.end,
        ..*frame
    }
}

impl FrameBudget {
    /// The buffers of a window; `None` if they are beyond any address space.
    fn sizes(&self, frame: &FrameParams) -> Option<FrameSizes> {
        // Kernels address planes with 32 bits.
        let rows = u64::from(frame.window_end - frame.window_begin).next_multiple_of(u64::from(frame.block));
        let pitch = u64::from(frame.phase_width) * u64::from(frame.block) * rows;
        if pitch * u64::from(PLANE_COUNT) > u64::from(u32::MAX) {
            return None;
        }
        FrameSizes::new(frame, self.attributes, self.counters, self.scan_group)
    }

    fn holds(&self, sizes: &FrameSizes) -> bool {
        sizes.bytes().saturating_add(self.scene_bytes) <= self.total_bytes
            && sizes.largest_bytes() <= self.allocation_bytes
    }

    fn too_small(&self, frame: &FrameParams) -> Error {
        let rows = frame.interior_end - frame.interior_begin;
        let wanted = self.sizes(frame).map_or(u64::MAX, |sizes| sizes.bytes());
        Error::LimitExceeded {
            what: format!("a band of {rows} rows of {} samples", frame.width),
            limit: Setting::MemoryBudget.path().into(),
            wanted: format!(
                "{} KiB beside the scene's {} KiB",
                wanted.div_ceil(1 << 10),
                self.scene_bytes.div_ceil(1 << 10)
            ),
            allowed: match self.allocation_bytes {
                u64::MAX => format!("{} KiB in all", self.total_bytes >> 10),
                most => format!("{} KiB in all, {} KiB in one buffer", self.total_bytes >> 10, most >> 10),
            },
            remedies: &[Remedy::LargerBudget, Remedy::FewerSamples, Remedy::SmallerPicture],
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::layout::{color_index, plane_index};
    use crate::method::camera::{MAX_SAMPLE_SIDE, frame_inputs};
    use crate::method::options::RenderOptions;
    use crate::prepare::{PreparedScene, Shading};
    use crate::scene::builtin;

    /// Random numbers that like powers of two, their neighbours, and both ends.
    struct Random(u64);

    impl Random {
        fn bits(&mut self) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            self.0 >> 24
        }

        fn side(&mut self, most: u32) -> u32 {
            let near = (1 << (self.bits() % 17)) as u32;
            let any = (self.bits() % u64::from(most)) as u32 + 1;
            let side =
                [near.saturating_sub(1), near, near + 1, most, most - 1, any, any, any][self.bits() as usize % 8];
            side.clamp(1, most)
        }
    }

    /// What must hold of a window that kernels are launched for, in whole numbers without end.
    fn check(frame: &FrameParams, sizes: &FrameSizes, attributes: bool, counters: bool) {
        let (rows, block) = (u64::from(frame.window_end - frame.window_begin), u64::from(frame.block));
        let pixels = u64::from(frame.width) * rows;
        let pitch = u64::from(frame.width).next_multiple_of(block) * rows.next_multiple_of(block);
        assert_eq!(u64::from(frame.plane_pitch), pitch);
        // Plane addresses, lists of both halves and of four directions are 32-bit numbers.
        assert!(pitch * u64::from(PLANE_COUNT) <= u64::from(u32::MAX));
        assert!(5 * pixels <= u64::from(u32::MAX));
        let have = |words: usize, at_least: u64| {
            assert!(words as u64 >= at_least, "{words} words, not {at_least}: {frame:?}");
            assert!(words.checked_mul(4).is_some_and(|bytes| isize::try_from(bytes).is_ok()), "{words} words");
        };
        have(sizes.color, pixels);
        have(sizes.attributes, if attributes { pitch * u64::from(PLANE_COUNT) } else { 0 });
        have(sizes.counters, if counters { pitch } else { 0 });
        have(sizes.list, if attributes { pixels } else { 0 });
        have(sizes.masks, if attributes { (5 * pixels).div_ceil(32) } else { 0 });
        have(sizes.sums, sizes.masks as u64 + 1);
        for (x, y) in [(0, frame.window_begin), (frame.width - 1, frame.window_begin), (0, frame.window_end - 1)]
            .into_iter()
            .chain([(frame.width - 1, frame.window_end - 1)])
        {
            assert!(plane_index(frame, x, y) < frame.plane_pitch);
            assert!(u64::from(color_index(frame, x, y)) < pixels);
        }
    }

    /// On 32-bit machines, where the long tests run this too, an overflow of `usize` is a panic.
    #[test]
    fn no_size_of_any_frame_overflows() {
        let scene = builtin::to_scene("wall").unwrap();
        let scene = PreparedScene::new(&scene, Shading::Full, &crate::Monitor::default()).unwrap();
        let mut random = Random(2016);
        let (mut planned, mut refused, mut cut) = (0, 0, 0);
        for round in 0..4000 {
            let samples = [1, 2, 4][random.bits() as usize % 3];
            let most = (MAX_SAMPLE_SIDE / samples).min(crate::method::camera::MAX_SIDE);
            let (width, height) = if round == 0 { (most, most) } else { (random.side(most), random.side(most)) };
            let options = RenderOptions { width, height, samples, ..RenderOptions::default() };
            options.validate().unwrap();
            let (width, height) = options.sample_size();
            let block = [1, 2, 4][random.bits() as usize % 3];
            let frame = frame_inputs(scene.view(), &scene, width, height, block, 4).params;
            let limit = |random: &mut Random| [u64::MAX, u64::MAX, random.bits(), random.bits() >> 16][round % 4];
            let budget = FrameBudget {
                total_bytes: limit(&mut random),
                allocation_bytes: limit(&mut random),
                scene_bytes: random.bits() % 1000,
                attributes: block > 1 || round % 2 == 0,
                counters: round % 3 == 0,
                scan_group: 2 << (random.bits() % 9),
            };
            let most_rows = (round % 5 == 0).then(|| random.side(height));
            let Ok(plan) = Plan::new(&frame, &budget, most_rows) else {
                refused += 1;
                continue;
            };
            planned += 1;
            cut += usize::from(!plan.is_one_band());
            assert!(budget.holds(&plan.sizes));
            let count = plan.bands().count();
            let mut at = 0;
            for (band, rows) in plan.bands().enumerate() {
                assert!(rows.start == at && rows.start < rows.end && rows.start % block == 0, "{rows:?}");
                at = rows.end;
                if band < 3 || band + 3 > count {
                    check(&plan.window(rows), &plan.sizes, budget.attributes, budget.counters);
                }
            }
            assert_eq!(at, height);
        }
        // A refusal names the memory that there is for everything, also where the scene alone is larger.
        let (total_bytes, scene_bytes) = (100 << 10, 300 << 10);
        let (attributes, counters, scan_group) = (true, false, 64);
        let budget =
            FrameBudget { total_bytes, allocation_bytes: u64::MAX, scene_bytes, attributes, counters, scan_group };
        let frame = frame_inputs(scene.view(), &scene, 16, 16, 2, 4).params;
        let refusal = Plan::new(&frame, &budget, None).unwrap_err().to_string();
        assert!(refusal.contains("scene's 300 KiB") && refusal.contains("allows 100 KiB in all"), "{refusal}");
        println!("{planned} frames planned, {cut} of them in bands, {refused} refused");
        assert!(planned > 1000 && refused > 100 && cut > 200);
    }
}
