// SPDX-License-Identifier: MIT OR Apache-2.0
//! A window of a frame, step by step, as the paper tells it: the same launches for every executor. A frame that fits into
//! memory is one window; [`super::bands`] draws those that do not.

use super::correction::{Fired, correct};
use super::packing::{Packing, SeedRanges, pack, trace_list};
use crate::device::frame_memory::FrameBuffer;
use crate::device::queue::Queue;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
use crate::layout::*;
use crate::method::options::RenderOptions;

/// A class of adaptive pixels: its grid, and where the two references of each pixel lie.
struct AdaptiveGrid {
    stages: AdaptiveStages,
    params: StepParams,
}

/// The stages that check, pack and trace a class of adaptive pixels.
#[derive(Clone, Copy)]
struct AdaptiveStages {
    check: Stage,
    pack: Stage,
    trace: Stage,
}

const A1: AdaptiveStages = AdaptiveStages { check: Stage::Step2a, pack: Stage::Step2b, trace: Stage::Step2c };
const A2: AdaptiveStages = AdaptiveStages { check: Stage::Step3a, pack: Stage::Step3b, trace: Stage::Step3c };

/// Traces every pixel of a window: step1 at stride 1, by the same kernel. `store` keeps the attributes of all pixels.
///
/// # Errors
/// Whatever the executor reports.
pub fn trace_window(queue: &mut Queue, store: bool) -> Result<()> {
    let flags = if store { StepFlags::STORE } else { StepFlags::empty() };
    let step = StepParams { flags, pixel_class: CLASS_BASE, ..grid(queue.params(), (0, 0), (1, 1)) };
    queue.launch(Stage::Step1, Kernel::Trace, &step)
}

/// The method: trace the base pixels, rebuild or trace the others, correct.
///
/// # Errors
/// Whatever the executor reports.
pub fn adaptive_window(
    queue: &mut Queue,
    options: &RenderOptions,
    extent: f32,
    seeds: &CorrectionSeeds,
) -> Result<ListRanges> {
    let frame = *queue.params();
    let shifted = options.method.shifted_rows;
    let base = grid(&frame, (0, 0), (frame.block, frame.block));
    let base = if shifted { shifted_rows(&frame, base) } else { base };
    let base = StepParams { flags: base.flags | StepFlags::STORE, pixel_class: CLASS_BASE, ..base };
    queue.launch(Stage::Step1, Kernel::Trace, &base)?;

    let seeds = list_seeds(queue, seeds)?;
    let mut listed = seeds.len();
    for class in adaptive_grids(&frame, options, extent) {
        queue.launch(class.stages.check, Kernel::Check, &class.params)?;
        let count = pack_grid(queue, &class, listed)?;
        let list = StepParams { list_offset: listed, item_count: count, pixel_class: CLASS_TRACED, ..class.params };
        trace_list(queue, class.stages.trace, &list)?;
        listed += count;
    }

    let fired = correct(queue, options, &seeds, listed)?;
    Ok(ListRanges { seeds, traced_end: listed, fired })
}

/// What post-correction already knows of a window when it is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub struct CorrectionSeeds<'a> {
    /// Pixels of the window that had their correction rays before, when it was drawn for the first time: now only
    /// `fired` spreads. `None` when this is the first time.
    pub settled: Option<&'a [u32]>,
    /// Pixels of the interior at which pixels of other windows fire.
    pub fired: &'a [u32],
}

/// The pixel addresses that drawing a window left in the list, in this order.
#[derive(Debug, Clone, Copy)]
pub struct ListRanges {
    seeds: SeedRanges,
    traced_end: u32,
    fired: Fired,
}

impl ListRanges {
    /// Traced in step2c and step3c.
    pub fn traced(&self) -> std::ops::Range<usize> {
        self.seeds.len() as usize..self.traced_end as usize
    }

    /// How many step4's probes were, and how many pixels they led to in their first round.
    pub fn probes(&self) -> (u64, u64) {
        (self.fired.probes.into(), self.fired.beside_probes.into())
    }

    /// Fired at in step4, those of [`CorrectionSeeds`] not included; outside of the interior they got no ray.
    pub fn corrected(&self) -> std::ops::Range<usize> {
        self.traced_end as usize..(self.traced_end + self.fired.all) as usize
    }
}

fn list_seeds(queue: &mut Queue, seeds: &CorrectionSeeds) -> Result<SeedRanges> {
    let settled = seeds.settled.unwrap_or(&[]);
    if !settled.is_empty() || !seeds.fired.is_empty() {
        queue.write(FrameBuffer::List, &[settled, seeds.fired].concat())?;
    }
    Ok(SeedRanges {
        settled: settled.len() as u32,
        fired: seeds.fired.len() as u32,
        first_time: seeds.settled.is_none(),
    })
}

/// The grid of the pixels `origin + step * item` within the window, whose first row is a multiple of the block.
fn grid(frame: &FrameParams, origin: (u32, u32), step: (u32, u32)) -> StepParams {
    StepParams {
        origin_x: origin.0,
        origin_y: frame.window_begin + origin.1,
        step_x: step.0,
        step_y: step.1,
        grid_width: frame.width.saturating_sub(origin.0).div_ceil(step.0),
        grid_height: (frame.window_end - frame.window_begin).saturating_sub(origin.1).div_ceil(step.1),
        ..bytemuck::Zeroable::zeroed()
    }
}

/// `grid`, which begins at the left border, with its rows shifted against each other.
fn shifted_rows(frame: &FrameParams, grid: StepParams) -> StepParams {
    StepParams { flags: grid.flags | StepFlags::SHIFTED, grid_width: frame.width.div_ceil(grid.step_x), ..grid }
}

/// The classes of adaptive pixels, in their order: at each stride A1, between two references in a row, and A2, between two
/// in a column. Where rows are shifted, the rows of base pixels are filled at all strides before any others: only then
/// each of their pixels has one above or below.
fn adaptive_grids(frame: &FrameParams, options: &RenderOptions, extent: f32) -> Vec<AdaptiveGrid> {
    let strides: &[u32] = if frame.block == 4 { &[4, 2] } else { &[2] };
    let mut grids = Vec::new();
    if options.method.shifted_rows {
        grids.extend(strides.iter().map(|&stride| {
            let class = a1(frame, stride, frame.block, options, extent);
            AdaptiveGrid { params: shifted_rows(frame, class.params), ..class }
        }));
        grids.extend(strides.iter().flat_map(|&stride| a2(frame, stride, 1, options, extent)));
    } else {
        for &stride in strides {
            grids.push(a1(frame, stride, stride, options, extent));
            grids.extend(a2(frame, stride, stride / 2, options, extent));
        }
    }
    grids
}

/// The pixels midway between two in rows that lie `row_step` apart.
fn a1(frame: &FrameParams, stride: u32, row_step: u32, options: &RenderOptions, extent: f32) -> AdaptiveGrid {
    let half = stride / 2;
    let params = StepParams { reference_dx: half, ..grid(frame, (half, 0), (stride, row_step)) };
    AdaptiveGrid { stages: A1, params: options.method.check_params(params, stride == 2, extent) }
}

/// The pixels midway between two in columns that lie `column_step` apart; every second column by itself where its pixels may
/// also use what the others found.
fn a2(frame: &FrameParams, stride: u32, column_step: u32, options: &RenderOptions, extent: f32) -> Vec<AdaptiveGrid> {
    let half = stride / 2;
    let columns = |left, width| {
        let params = StepParams { reference_dy: half, ..grid(frame, (left, half), (width, stride)) };
        AdaptiveGrid { stages: A2, params: options.method.check_params(params, stride == 2, extent) }
    };
    if !options.method.checks.second_pairs {
        return vec![columns(0, column_step)];
    }
    let mut odd = columns(column_step, 2 * column_step);
    odd.params.flags |= StepFlags::OTHER_PAIRS;
    vec![columns(0, 2 * column_step), odd]
}

/// Packs the pixels of a class that wait for rays behind the `list_offset` entries that the list holds already.
fn pack_grid(queue: &mut Queue, class: &AdaptiveGrid, list_offset: u32) -> Result<u32> {
    // Once for the pixels beside mirrors and glass, once for the others.
    let item_count = 2 * grid_items(&class.params);
    let packing = Packing { stage: class.stages.pack, count: Kernel::PackCount, scatter: Kernel::PackScatter };
    pack(queue, &packing, &StepParams { item_count, list_offset, ..class.params })
}
