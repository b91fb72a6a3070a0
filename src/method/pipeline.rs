// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame, step by step, as the paper tells it. The same sequence drives every back end. A frame that does not fit into
//! memory is drawn window by window ([`crate::method::bands`]).

use crate::device::backend::{Backend, FrameBuffer, most_listed_pixels};
use crate::device::stage::{Kernel, Stage};
use crate::device::twin::pack::grid_items;
use crate::error::Result;
use crate::layout::*;
use crate::method::options::{Correction, RenderOptions};

/// How many pixels of a frame went which way.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PixelCounts {
    /// Traced in step1.
    pub base: u64,
    /// Traced in step2c and step3c.
    pub traced: u64,
    /// Rebuilt from their references, and left so.
    pub interpolated: u64,
    /// Traced in step4, changed or confirmed.
    pub corrected: u64,
}

impl PixelCounts {
    /// The counts of an adaptive frame's interior rows, of which so many pixels were traced and corrected.
    pub fn new(frame: &FrameParams, traced: u64, corrected: u64) -> Self {
        let rows = frame.interior_end - frame.interior_begin;
        let base = u64::from(frame.phase_width) * u64::from(rows.div_ceil(frame.block));
        let pixels = u64::from(frame.width) * u64::from(rows);
        PixelCounts { base, traced, corrected, interpolated: pixels - base - traced - corrected }
    }

    /// Adds the counts of another window.
    pub fn add(&mut self, other: &PixelCounts) {
        self.base += other.base;
        self.traced += other.traced;
        self.interpolated += other.interpolated;
        self.corrected += other.corrected;
    }
}

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

/// A packing: the stage, and the kernels that count and scatter its items.
struct Packing {
    stage: Stage,
    count: Kernel,
    scatter: Kernel,
}

/// Traces every pixel of a window: step1 at stride 1, by the same kernel. `store` keeps the attributes of all pixels.
///
/// # Errors
/// Whatever the back end reports.
pub fn full_frame(backend: &mut dyn Backend, frame: &FrameParams, store: bool) -> Result<PixelCounts> {
    let flags = if store { STEP_STORE } else { 0 };
    let step = StepParams { flags, pixel_class: CLASS_BASE, ..grid(frame, (0, 0), (1, 1)) };
    backend.run(Stage::Step1, Kernel::Trace, &step)?;
    Ok(PixelCounts::new(frame, 0, 0))
}

/// The method on a frame that is one window.
///
/// # Errors
/// Whatever the back end reports.
pub fn adaptive_frame(
    backend: &mut dyn Backend,
    frame: &FrameParams,
    options: &RenderOptions,
    extent: f32,
) -> Result<PixelCounts> {
    let listed = adaptive_window(backend, frame, options, extent, &Given::default())?;
    let (traced, corrected) = (listed.traced().len() as u64, listed.corrected().len() as u64);
    Ok(PixelCounts::new(frame, traced, corrected))
}

/// The method: trace the base pixels, rebuild or trace the others, correct.
///
/// # Errors
/// Whatever the back end reports.
pub fn adaptive_window(
    backend: &mut dyn Backend,
    frame: &FrameParams,
    options: &RenderOptions,
    extent: f32,
    given: &Given,
) -> Result<Listed> {
    let block = frame.block;
    let base = grid(frame, (0, 0), (block, block));
    let base = StepParams { flags: STEP_STORE, pixel_class: CLASS_BASE, ..base };
    backend.run(Stage::Step1, Kernel::Trace, &base)?;

    let given = list_given(backend, given)?;
    let mut listed = given.len();
    let mut stride = block;
    while stride >= 2 {
        for class in adaptive_grids(frame, stride, options, extent) {
            backend.run(class.stages.check, Kernel::Check, &class.params)?;
            let count = pack_grid(backend, &class, listed)?;
            let list = StepParams { list_offset: listed, item_count: count, pixel_class: CLASS_TRACED, ..class.params };
            trace_list(backend, class.stages.trace, &list)?;
            listed += count;
        }
        stride /= 2;
    }

    let corrected = correct(backend, frame, options, &given, listed)?;
    Ok(Listed { given, traced_end: listed, corrected_end: listed + corrected })
}

/// What post-correction already knows of a window when it is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given<'a> {
    /// Pixels of the window that had their correction rays before, when it was drawn for the first time: now only
    /// `fired` spreads. `None` when this is the first time.
    pub settled: Option<&'a [u32]>,
    /// Pixels of the interior at which pixels of other windows fire.
    pub fired: &'a [u32],
}

/// The pixel addresses that drawing a window left in the list, in this order.
#[derive(Debug, Clone, Copy)]
pub struct Listed {
    given: GivenList,
    traced_end: u32,
    corrected_end: u32,
}

impl Listed {
    /// Traced in step2c and step3c.
    pub fn traced(&self) -> std::ops::Range<usize> {
        self.given.len() as usize..self.traced_end as usize
    }

    /// Fired at in step4, those of [`Given`] not included; outside of the interior they got no ray.
    pub fn corrected(&self) -> std::ops::Range<usize> {
        self.traced_end as usize..self.corrected_end as usize
    }
}

/// The list's first entries.
#[derive(Debug, Clone, Copy)]
struct GivenList {
    settled: u32,
    fired: u32,
    first_time: bool,
}

impl GivenList {
    fn len(&self) -> u32 {
        self.settled + self.fired
    }
}

fn list_given(backend: &mut dyn Backend, given: &Given) -> Result<GivenList> {
    let settled = given.settled.unwrap_or(&[]);
    if !settled.is_empty() || !given.fired.is_empty() {
        backend.write(FrameBuffer::List, &[settled, given.fired].concat())?;
    }
    Ok(GivenList {
        settled: settled.len() as u32,
        fired: given.fired.len() as u32,
        first_time: given.settled.is_none(),
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

/// The classes of adaptive pixels at one stride: A1 between two references in a row, A2 between two in a column; the odd
/// columns of A2 by themselves where they may also use what the even ones found.
fn adaptive_grids(frame: &FrameParams, stride: u32, options: &RenderOptions, extent: f32) -> Vec<AdaptiveGrid> {
    let half = stride / 2;
    let checks = |step| options.method.check_params(step, stride == 2, extent);
    let step2 = checks(StepParams { reference_dx: half, ..grid(frame, (half, 0), (stride, stride)) });
    let step3 = |left, width| checks(StepParams { reference_dy: half, ..grid(frame, (left, half), (width, stride)) });
    let a1 = AdaptiveGrid { stages: A1, params: step2 };
    let a2 = |params| AdaptiveGrid { stages: A2, params };
    if options.method.checks.second_pairs {
        let odd = step3(half, stride);
        let odd = StepParams { flags: odd.flags | STEP_OTHER_PAIRS, ..odd };
        vec![a1, a2(step3(0, stride)), a2(odd)]
    } else {
        vec![a1, a2(step3(0, half))]
    }
}

/// Packs the pixels of a class that wait for rays behind the `list_offset` entries that the list holds already.
fn pack_grid(backend: &mut dyn Backend, class: &AdaptiveGrid, list_offset: u32) -> Result<u32> {
    // Once for the pixels beside mirrors and glass, once for the others.
    let item_count = 2 * grid_items(&class.params);
    let packing = Packing { stage: class.stages.pack, count: Kernel::PackCount, scatter: Kernel::PackScatter };
    pack(backend, &packing, &StepParams { item_count, list_offset, ..class.params })
}

/// Packs the wanted ones of `item_count` items by count, scan and scatter; returns how many there are.
fn pack(backend: &mut dyn Backend, packing: &Packing, step: &StepParams) -> Result<u32> {
    if step.item_count == 0 {
        return Ok(0);
    }
    let step = StepParams { scan_group: backend.scan_group(), ..*step };
    backend.run(packing.stage, packing.count, &step)?;
    let (mut level, mut sums_offset) = (step.item_count.div_ceil(32), 0);
    loop {
        backend.run(packing.stage, Kernel::PackScan, &StepParams { item_count: level, sums_offset, ..step })?;
        sums_offset += level;
        level = level.div_ceil(step.scan_group);
        if level == 1 {
            break;
        }
    }
    let count = backend.read_sum(sums_offset)?;
    if count > 0 {
        let step = StepParams { list_end: step.list_offset + count, ..step };
        backend.run(packing.stage, packing.scatter, &step)?;
    }
    Ok(count)
}

fn trace_list(backend: &mut dyn Backend, stage: Stage, step: &StepParams) -> Result<()> {
    if step.item_count == 0 { Ok(()) } else { backend.run(stage, Kernel::Trace, step) }
}

/// step4: spreads from the pixels listed so far; returns how many more pixels it fired at.
fn correct(
    backend: &mut dyn Backend,
    frame: &FrameParams,
    options: &RenderOptions,
    given: &GivenList,
    listed: u32,
) -> Result<u32> {
    let Some(step) = options.method.correction_params() else { return Ok(0) };
    // A plan's windows are such that every list address is a 32-bit number.
    let step = StepParams { list_end: most_listed_pixels(frame) as u32, pixel_class: CLASS_CORRECTED, ..step };
    match options.method.correction {
        Correction::Off => Ok(0),
        Correction::Converged { bridges, .. } => correct_converged(backend, &step, bridges, given, listed),
        Correction::Sweeps(_) => correct_by_sweeps(backend, frame, &step),
    }
}

/// Rounds of mark, pack and trace, each from the pixels that the last one traced, until none is wanted.
fn correct_converged(
    backend: &mut dyn Backend,
    step: &StepParams,
    bridges: bool,
    given: &GivenList,
    listed: u32,
) -> Result<u32> {
    let settle = StepParams { item_count: given.settled, flags: step.flags | STEP_SETTLE, ..*step };
    trace_list(backend, Stage::Step4, &settle)?;
    let mut list_offset = listed;
    // Traced pixels come first: which edges and lines miss a neighbour, and where gaps are, is seen before any correction.
    if given.first_time {
        let first = StepParams { flags: step.flags | if bridges { STEP_BRIDGE } else { 0 }, ..*step };
        list_offset += fire_from(backend, &first, given.len(), listed - given.len(), list_offset)?;
    }
    if given.fired > 0 {
        let fire = StepParams { list_offset: given.settled, item_count: given.fired, ..*step };
        trace_list(backend, Stage::Step4, &fire)?;
        list_offset += fire_from(backend, step, given.settled, given.fired, list_offset)?;
    }
    let mut source_offset = listed;
    while list_offset > source_offset {
        let sources = list_offset - source_offset;
        let followed = if sources <= TAIL_SOURCES && backend.prefers_few_launches() {
            follow_tail(backend, step, source_offset, sources, list_offset)?
        } else {
            (source_offset, list_offset)
        };
        (source_offset, list_offset) = if followed != (source_offset, list_offset) {
            followed
        } else {
            (list_offset, list_offset + fire_from(backend, step, source_offset, sources, list_offset)?)
        };
    }
    Ok(list_offset - listed)
}

/// One round: the listed `sources` fire; what they hit is listed and traced. Returns how many pixels that is.
fn fire_from(
    backend: &mut dyn Backend,
    step: &StepParams,
    source_offset: u32,
    sources: u32,
    list_offset: u32,
) -> Result<u32> {
    if sources == 0 {
        return Ok(0);
    }
    let ways = if step.flags & STEP_BRIDGE != 0 { 5 } else { 4 };
    let round = StepParams { source_offset, list_offset, item_count: ways * sources, ..*step };
    backend.run(Stage::Step4, Kernel::CorrectMark, &round)?;
    let packing = Packing { stage: Stage::Step4, count: Kernel::CorrectCount, scatter: Kernel::CorrectScatter };
    let count = pack(backend, &packing, &round)?;
    trace_list(backend, Stage::Step4, &StepParams { item_count: count, ..round })?;
    Ok(count)
}

/// Rounds of few sources in one launch; returns where the next round's sources begin and end.
fn follow_tail(
    backend: &mut dyn Backend,
    step: &StepParams,
    source_offset: u32,
    sources: u32,
    list_offset: u32,
) -> Result<(u32, u32)> {
    let scan_group = backend.scan_group();
    let tail = StepParams { source_offset, list_offset, item_count: 4 * sources, scan_group, ..*step };
    backend.run(Stage::Step4, Kernel::CorrectTail, &tail)?;
    let sums = backend.read(FrameBuffer::Sums, 0..TAIL_SUM_ENDS as usize)?;
    let sum = |at: u32| sums.get(at as usize).copied().unwrap_or(list_offset);
    Ok((sum(TAIL_SUM_SOURCES), sum(TAIL_SUM_LIST)))
}

/// Each row there and back, then each column.
fn correct_by_sweeps(backend: &mut dyn Backend, frame: &FrameParams, step: &StepParams) -> Result<u32> {
    backend.run(Stage::Step4, Kernel::CorrectSweep, &StepParams { step_x: 1, item_count: frame.height, ..*step })?;
    backend.run(Stage::Step4, Kernel::CorrectSweep, &StepParams { step_y: 1, item_count: frame.width, ..*step })?;
    // A sweep lists nothing: its rays are counted from the classes.
    let pitch = frame.plane_pitch as usize;
    let at = PLANE_CLASS as usize * pitch;
    let classes = backend.read(FrameBuffer::Attributes, at..at + pitch)?;
    let pixels = (0..frame.height).flat_map(|y| (0..frame.width).map(move |x| (x, y)));
    let is_corrected = |class: u32| matches!(class & CLASS_MASK, CLASS_CORRECTED | CLASS_CONFIRMED);
    Ok(pixels.filter(|&(x, y)| is_corrected(classes[plane_index(frame, x, y) as usize])).count() as u32)
}
