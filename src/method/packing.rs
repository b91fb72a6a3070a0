// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packing: count, scan and scatter put the pixels that need rays side by side in a frame's list, and the list is traced.

use crate::device::queue::Queue;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::*;

/// A packing: the stage, and the kernels that count and scatter its items.
pub(super) struct Packing {
    pub stage: Stage,
    pub count: Kernel,
    pub scatter: Kernel,
}

/// The list's first entries: the seeds.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeedRanges {
    pub settled: u32,
    pub fired: u32,
    pub first_time: bool,
}

impl SeedRanges {
    pub fn len(&self) -> u32 {
        self.settled + self.fired
    }
}

/// Packs the wanted ones of `item_count` items by count, scan and scatter; returns how many there are.
pub(super) fn pack(queue: &mut Queue, packing: &Packing, step: &StepParams) -> Result<u32> {
    if step.item_count == 0 {
        return Ok(0);
    }
    let step = StepParams { scan_group: queue.scan_group(), ..*step };
    queue.launch(packing.stage, packing.count, &step)?;
    let (mut level, mut sums_offset) = (step.item_count.div_ceil(32), 0);
    loop {
        queue.launch(packing.stage, Kernel::PackScan, &StepParams { item_count: level, sums_offset, ..step })?;
        sums_offset += level;
        level = level.div_ceil(step.scan_group);
        if level == 1 {
            break;
        }
    }
    let count = queue.read_sum(sums_offset)?;
    if count > 0 {
        let step = StepParams { list_end: step.list_offset + count, ..step };
        queue.launch(packing.stage, packing.scatter, &step)?;
    }
    Ok(count)
}

pub(super) fn trace_list(queue: &mut Queue, stage: Stage, step: &StepParams) -> Result<()> {
    if step.item_count == 0 { Ok(()) } else { queue.launch(stage, Kernel::Trace, step) }
}
