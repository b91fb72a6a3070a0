// SPDX-License-Identifier: MIT OR Apache-2.0
//! Post-correction (step4): spreads from traced pixels to interpolated neighbours that disagree.

use super::packing::{Packing, SeedRanges, pack, trace_list};
use crate::device::frame_memory::{FrameBuffer, most_listed_pixels};
use crate::device::queue::Queue;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::*;
use crate::method::options::{Correction, RenderOptions};

/// How many pixels step4 fired at in a window.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fired {
    /// All of them.
    pub all: u32,
    /// Those that were traced by chance.
    pub probes: u32,
    /// Neighbours of these that disagreed with what they found.
    pub beside_probes: u32,
}

/// step4: spreads from the pixels listed so far.
pub(super) fn correct(queue: &mut Queue, options: &RenderOptions, seeds: &SeedRanges, listed: u32) -> Result<Fired> {
    let Some(step) = options.method.correction_params() else { return Ok(Fired::default()) };
    // A plan's windows are such that every list address is a 32-bit number.
    let list_end = most_listed_pixels(queue.params()) as u32;
    let step = StepParams { list_end, pixel_class: CLASS_CORRECTED, ..step };
    match options.method.correction {
        Correction::Off => Ok(Fired::default()),
        Correction::Converged { bridges, probes, .. } => {
            correct_converged(queue, &step, bridges, probes, seeds, listed)
        }
        Correction::Sweeps(_) => Ok(Fired { all: correct_by_sweeps(queue, &step)?, ..Fired::default() }),
    }
}

/// Rounds of mark, pack and trace, each from the pixels that the last one traced, until none is wanted.
fn correct_converged(
    queue: &mut Queue,
    step: &StepParams,
    bridges: bool,
    probes: bool,
    seeds: &SeedRanges,
    listed: u32,
) -> Result<Fired> {
    let settle = StepParams { item_count: seeds.settled, flags: step.flags | StepFlags::SETTLE, ..*step };
    trace_list(queue, Stage::Step4, &settle)?;
    let mut list_offset = listed;
    // Traced pixels come first: which edges and lines miss a neighbour, and where gaps are, is seen before any correction.
    if seeds.first_time {
        let first =
            StepParams { flags: step.flags | if bridges { StepFlags::BRIDGE } else { StepFlags::empty() }, ..*step };
        list_offset += fire_from(queue, &first, seeds.len(), listed - seeds.len(), list_offset)?;
    }
    if seeds.fired > 0 {
        let fire = StepParams { list_offset: seeds.settled, item_count: seeds.fired, ..*step };
        trace_list(queue, Stage::Step4, &fire)?;
        list_offset += fire_from(queue, step, seeds.settled, seeds.fired, list_offset)?;
    }
    let mut fired = Fired::default();
    if probes && seeds.first_time {
        fired.probes = list_probes(queue, step, list_offset)?;
        trace_list(queue, Stage::Step4, &StepParams { item_count: fired.probes, list_offset, ..*step })?;
        // A round of their own tells what chance finds: an estimate of what nothing finds.
        let first_probe = list_offset;
        list_offset += fired.probes;
        fired.beside_probes = fire_from(queue, step, first_probe, fired.probes, list_offset)?;
        list_offset += fired.beside_probes;
    }
    let mut source_offset = listed;
    while list_offset > source_offset {
        let sources = list_offset - source_offset;
        let followed = if sources <= TAIL_SOURCES && queue.prefers_few_launches() {
            follow_tail(queue, step, source_offset, sources, list_offset)?
        } else {
            (source_offset, list_offset)
        };
        (source_offset, list_offset) = if followed != (source_offset, list_offset) {
            followed
        } else {
            (list_offset, list_offset + fire_from(queue, step, source_offset, sources, list_offset)?)
        };
    }
    Ok(Fired { all: list_offset - listed, ..fired })
}

/// Lists one interpolated pixel in each tile of the interior, to be traced for no reason: what no ray has met is found by
/// chance or not at all.
fn list_probes(queue: &mut Queue, step: &StepParams, list_offset: u32) -> Result<u32> {
    let frame = *queue.params();
    let first = frame.interior_begin / PROBE_TILE;
    let grid = StepParams {
        flags: step.flags | StepFlags::PROBES,
        origin_y: first,
        step_x: 1,
        step_y: 1,
        grid_width: frame.width.div_ceil(PROBE_TILE),
        grid_height: frame.interior_end.div_ceil(PROBE_TILE) - first,
        ..*step
    };
    let packing = Packing { stage: Stage::Step4, count: Kernel::PackCount, scatter: Kernel::PackScatter };
    // The first half of the items: there is no second order to go through.
    pack(queue, &packing, &StepParams { item_count: grid_items(&grid), list_offset, ..grid })
}

/// One round: the listed `sources` fire; what they hit is listed and traced. Returns how many pixels that is.
fn fire_from(queue: &mut Queue, step: &StepParams, source_offset: u32, sources: u32, list_offset: u32) -> Result<u32> {
    if sources == 0 {
        return Ok(0);
    }
    let ways = if step.flags.contains(StepFlags::BRIDGE) { 5 } else { 4 };
    let round = StepParams { source_offset, list_offset, item_count: ways * sources, ..*step };
    queue.launch(Stage::Step4, Kernel::CorrectMark, &round)?;
    let packing = Packing { stage: Stage::Step4, count: Kernel::CorrectCount, scatter: Kernel::CorrectScatter };
    let count = pack(queue, &packing, &round)?;
    trace_list(queue, Stage::Step4, &StepParams { item_count: count, ..round })?;
    Ok(count)
}

/// Rounds of few sources in one launch; returns where the next round's sources begin and end.
fn follow_tail(
    queue: &mut Queue,
    step: &StepParams,
    source_offset: u32,
    sources: u32,
    list_offset: u32,
) -> Result<(u32, u32)> {
    let scan_group = queue.scan_group();
    let tail = StepParams { source_offset, list_offset, item_count: 4 * sources, scan_group, ..*step };
    queue.launch(Stage::Step4, Kernel::CorrectTail, &tail)?;
    let sums = queue.read(FrameBuffer::Sums, 0..TAIL_SUM_ENDS as usize)?;
    let sum = |at: u32| sums.get(at as usize).copied().unwrap_or(list_offset);
    Ok((sum(TAIL_SUM_SOURCES), sum(TAIL_SUM_LIST)))
}

/// Each row there and back, then each column.
fn correct_by_sweeps(queue: &mut Queue, step: &StepParams) -> Result<u32> {
    let frame = *queue.params();
    queue.launch(Stage::Step4, Kernel::CorrectSweep, &StepParams { step_x: 1, item_count: frame.height, ..*step })?;
    queue.launch(Stage::Step4, Kernel::CorrectSweep, &StepParams { step_y: 1, item_count: frame.width, ..*step })?;
    // A sweep lists nothing: its rays are counted from the classes.
    let pitch = frame.plane_pitch as usize;
    let at = PLANE_CLASS as usize * pitch;
    let classes = queue.read(FrameBuffer::Attributes, at..at + pitch)?;
    let pixels = (0..frame.height).flat_map(|y| (0..frame.width).map(move |x| (x, y)));
    let is_corrected = |class: u32| matches!(class & CLASS_MASK, CLASS_CORRECTED | CLASS_CONFIRMED);
    Ok(pixels.filter(|&(x, y)| is_corrected(classes[plane_index(&frame, x, y) as usize])).count() as u32)
}
