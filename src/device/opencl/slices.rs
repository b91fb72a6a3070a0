// SPDX-License-Identifier: MIT OR Apache-2.0
//! Cutting a launch into slices, and how large a slice may be.
//!
//! A phone's display waits for the GPU between enqueues only, and its watchdog kills what takes seconds. So a launch is
//! cut along whole work-groups, and the size of a slice follows what earlier slices of the same stage took.

/// One slice of a launch, in work-items.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Slice {
    /// The global work offset.
    pub offset: [usize; 2],
    /// The global work size: whole work-groups.
    pub size: [usize; 2],
}

impl Slice {
    /// The number of work-items.
    pub fn items(&self) -> u64 {
        (self.size[0] as u64).saturating_mul(self.size[1] as u64)
    }
}

/// Walks over a launch slice by slice: rows of work-groups, or parts of one row where a row is too much.
#[derive(Debug)]
pub(super) struct Slicer {
    local: [usize; 2],
    groups: [usize; 2],
    next: [usize; 2],
}

impl Slicer {
    /// A launch of `groups` work-groups of `local` work-items.
    pub fn new(groups: [usize; 2], local: [usize; 2]) -> Self {
        Slicer { local, groups, next: [0, 0] }
    }

    /// The share of the launch that has been cut off.
    pub fn share_cut(&self) -> f32 {
        let [columns, rows] = self.groups.map(|groups| groups.max(1) as f32);
        (self.next[1] as f32 + self.next[0] as f32 / columns) / rows
    }

    /// The next slice, of at most `most` work-items or one work-group if that has more; `None` at the end.
    pub fn next(&mut self, most: u64) -> Option<Slice> {
        let [columns, rows] = self.groups;
        let [column, row] = self.next;
        if row >= rows || columns == 0 {
            return None;
        }
        let group_items = (self.local[0] as u64).saturating_mul(self.local[1] as u64).max(1);
        let row_items = group_items.saturating_mul(columns as u64);
        let (count, place) = if column == 0 && row_items <= most {
            let count = at_most(most / row_items, rows - row);
            self.next = [0, row + count];
            ([columns, count], [0, row])
        } else {
            let count = at_most((most / group_items).max(1), columns - column);
            self.next = if column + count == columns { [0, row + 1] } else { [column + count, row] };
            ([count, 1], [column, row])
        };
        let scale = |groups: [usize; 2]| [groups[0] * self.local[0], groups[1] * self.local[1]];
        Some(Slice { offset: scale(place), size: scale(count) })
    }
}

fn at_most(value: u64, most: usize) -> usize {
    usize::try_from(value).map_or(most, |value| value.min(most))
}

/// The sizes of slices, per stage.
#[derive(Debug)]
pub(super) struct Planner {
    /// The duration to aim at, in milliseconds; `None`: slices of a fixed size.
    target_ms: Option<f64>,
    /// A fixed size for every stage, for tests.
    forced: Option<u64>,
    stages: Vec<Stage>,
}

#[derive(Debug)]
struct Stage {
    label: &'static str,
    items: u64,
    measured: bool,
    /// What a work-item took in the last slice.
    item_ms: f64,
}

/// Where a stage starts: 256 work-groups of 64, a few milliseconds on the slowest phone.
const FIRST_ITEMS: u64 = 16 * 1024;
/// A single work-group of the smallest device.
const FLOOR_ITEMS: u64 = 64;
/// A picture of 2048x2048: beyond, launches no longer matter.
const CEILING_ITEMS: u64 = 4 << 20;

impl Planner {
    pub fn new(target_ms: Option<f64>, forced: Option<u64>) -> Self {
        Planner { target_ms, forced, stages: Vec::new() }
    }

    /// The duration that slices aim at, in milliseconds.
    pub fn target_ms(&self) -> Option<f64> {
        self.target_ms
    }

    /// Forgets everything learned.
    pub fn forget(&mut self) {
        self.stages.clear();
    }

    /// The most work-items of the next slice of a stage.
    pub fn items(&self, label: &'static str) -> u64 {
        if let Some(items) = self.forced {
            return items.max(1);
        }
        match self.target_ms {
            None => CEILING_ITEMS,
            Some(_) => self.stages.iter().find(|stage| stage.label == label).map_or(FIRST_ITEMS, |stage| stage.items),
        }
    }

    /// How long a slice of a stage will take, as far as is known, in milliseconds.
    pub fn expected_ms(&self, label: &'static str, items: u64) -> f64 {
        let stage = self.stages.iter().find(|stage| stage.label == label);
        stage.map_or(0.0, |stage| stage.item_ms * items as f64)
    }

    /// How much work may lie in the queue when a slice is added to it, in milliseconds: one slice, so that the device
    /// always has the next one, and whoever cancels waits for two at most.
    pub fn queued_ms(&self) -> f64 {
        self.target_ms.unwrap_or(f64::INFINITY)
    }

    /// Whether a slice of the stage should be waited for and measured before more follow.
    pub fn wants_measure(&self, label: &'static str) -> bool {
        self.forced.is_none()
            && self.target_ms.is_some()
            && !self.stages.iter().any(|stage| stage.label == label && stage.measured)
    }

    /// Learns that a slice of `items` work-items took `ms`.
    pub fn learn(&mut self, label: &'static str, items: u64, ms: f64) {
        let (Some(target), None) = (self.target_ms, self.forced) else { return };
        let stage = match self.stages.iter_mut().position(|stage| stage.label == label) {
            Some(index) => &mut self.stages[index],
            None => {
                self.stages.push(Stage { label, items: FIRST_ITEMS, measured: false, item_ms: 0.0 });
                let last = self.stages.len() - 1;
                &mut self.stages[last]
            }
        };
        let first = !std::mem::replace(&mut stage.measured, true);
        stage.item_ms = ms / items.max(1) as f64;
        let fits = items as f64 * target / ms.max(1e-3);
        let wanted = if ms > target {
            // Too long: shrink at once, whatever the slice's size was.
            fits.min(stage.items as f64)
        } else if items * 2 >= stage.items || first {
            // A short rest of a picture says little, so only slices of about full size make it grow.
            fits.min(stage.items as f64 * 4.0)
        } else {
            return;
        };
        stage.items = (wanted as u64).clamp(FLOOR_ITEMS, CEILING_ITEMS);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Every work-item of the launch exactly once.
    fn covers(groups: [usize; 2], local: [usize; 2], most: u64) -> Vec<Slice> {
        let width = groups[0] * local[0];
        let height = groups[1] * local[1];
        let mut seen = vec![0u32; width * height];
        let mut slicer = Slicer::new(groups, local);
        let mut slices = Vec::new();
        while let Some(slice) = slicer.next(most) {
            assert!(slice.items() <= most.max((local[0] * local[1]) as u64), "{slice:?}");
            for y in slice.offset[1]..slice.offset[1] + slice.size[1] {
                for x in slice.offset[0]..slice.offset[0] + slice.size[0] {
                    seen[y * width + x] += 1;
                }
            }
            slices.push(slice);
        }
        assert!(seen.iter().all(|&count| count == 1), "{groups:?} {local:?} {most}");
        slices
    }

    #[test]
    fn slices_cover_a_launch_exactly_once() {
        for groups in [[1, 1], [7, 1], [1, 9], [5, 6], [16, 3]] {
            for local in [[1, 1], [8, 8], [64, 1], [3, 5]] {
                for most in [1, 64, 100, 320, 1000, u64::MAX] {
                    covers(groups, local, most);
                }
            }
        }
        assert_eq!(covers([4, 4], [8, 8], u64::MAX).len(), 1);
        assert_eq!(covers([4, 4], [8, 8], 512).len(), 2);
        assert_eq!(covers([4, 4], [8, 8], 1).len(), 16);
        assert!(covers([0, 4], [8, 8], 64).is_empty());
    }

    #[test]
    fn a_stage_grows_towards_the_target_and_shrinks_at_once() {
        let mut planner = Planner::new(Some(20.0), None);
        assert!(planner.wants_measure("step1"));
        assert_eq!(planner.items("step1"), FIRST_ITEMS);
        planner.learn("step1", FIRST_ITEMS, 1.0);
        assert!(!planner.wants_measure("step1") && planner.wants_measure("step2a"));
        assert_eq!(planner.items("step1"), FIRST_ITEMS * 4);
        planner.learn("step1", FIRST_ITEMS * 4, 40.0);
        assert_eq!(planner.items("step1"), FIRST_ITEMS * 2);
        planner.learn("step1", 64, 0.001);
        assert_eq!(planner.items("step1"), FIRST_ITEMS * 2, "a short rest teaches nothing");
        planner.learn("step1", 64, 1e9);
        assert_eq!(planner.items("step1"), FLOOR_ITEMS);
        for _ in 0..100 {
            let items = planner.items("step1");
            planner.learn("step1", items, 0.0);
        }
        assert_eq!(planner.items("step1"), CEILING_ITEMS);
        assert_eq!(planner.items("step2a"), FIRST_ITEMS, "stages do not mix");
    }

    #[test]
    fn what_lies_in_the_queue_is_known_from_the_last_slice() {
        let mut planner = Planner::new(Some(20.0), None);
        assert_eq!(planner.expected_ms("step1", 1000), 0.0, "not measured yet");
        planner.learn("step1", 1000, 5.0);
        planner.learn("step2a", 1000, 1.0);
        assert!((planner.expected_ms("step1", 400) - 2.0).abs() < 1e-9);
        assert_eq!(planner.queued_ms(), 20.0);
        assert_eq!(Planner::new(None, None).queued_ms(), f64::INFINITY);
    }

    #[test]
    fn fixed_sizes_stay() {
        let mut planner = Planner::new(Some(20.0), Some(100));
        planner.learn("step1", 100, 1e6);
        assert_eq!(planner.items("step1"), 100);
        assert!(!planner.wants_measure("step1"));
        assert_eq!(Planner::new(None, None).items("step1"), CEILING_ITEMS);
    }
}
