// SPDX-License-Identifier: MIT OR Apache-2.0
//! What lock step costs: a GPU's wave of lanes takes as long as its slowest lane.
//!
//! From what each work-item did, in launch order, the model adds up for waves of 32, 64 and 128 lanes the cost of the
//! slowest lane of each wave. It knows nothing of clocks or caches; what it compares are sums of the same kind. The
//! weights and what they rest on are in docs/wave-model.md. The unit is a traversal step of one lane.

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameHandle};
use crate::device::hooks::recording::{RecordedLaunch, Recording};
use crate::device::queue::Hook;
use crate::device::stage::{Kernel, Stage};
use crate::error::{Error, Remedy, Result, Setting};
use crate::layout::*;
use crate::method::counts::Keep;
use crate::method::options::{Mode, RenderOptions};
use crate::render::renderer::Renderer;

/// Lanes of the waves that are modelled.
pub const WAVES: [usize; 3] = [32, 64, 128];
/// A ray-triangle test: about as many instructions as a step, and six times its bytes, mostly from a cache.
pub const TRIANGLE_TEST: f64 = 1.5;
/// A shaded point: texture, highlight, lights. Makes all checks of a frame cost what the paper measured.
pub const SHADED_POINT: f64 = 16.0;
/// Bytes of global memory that take as long as a step where all lanes read or write side by side.
pub const BYTES_PER_STEP: f64 = 40.0;
/// A launch among others in the queue: 0.04 ms, in steps of 4 ns.
pub const LAUNCH: f64 = 10_000.0;
/// A wait of the host for the count of a packing: 0.3 ms, the latency of a launch on an Adreno 530.
pub const ROUND_TRIP: f64 = 75_000.0;
/// Side of the square work-groups of grid launches, in work-items.
const GROUP_SIDE: u32 = 8;

/// Attributes, class and claim of a sample, in bytes.
const ATTRIBUTE_BYTES: f64 = 4.0 * PLANE_COUNT as f64;
const COLOR_BYTES: f64 = 4.0;
const LIST_BYTES: f64 = 4.0;

/// One launch: what each lane costs, in launch order.
#[derive(Debug, Clone, PartialEq)]
pub struct LaunchCost {
    /// The stage that it belongs to.
    pub stage: Stage,
    /// Costs of the lanes. All wait for each other between passes: one pass, but for the rounds of `correct_tail`. Lanes
    /// that have no work cost 0 but take part.
    pub passes: Vec<Vec<f64>>,
    /// Whether the host waits for what it finds.
    pub waits: bool,
}

/// What a stage costs in waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageCost {
    /// The stage.
    pub stage: Stage,
    /// How many launches it took.
    pub launches: u32,
    /// How often the host waited for a count.
    pub round_trips: u32,
    /// The sum over all lanes.
    pub lanes: f64,
    /// For each size of [`WAVES`]: lanes of a wave times its slowest lane, summed over waves.
    pub waves: [f64; 3],
}

impl StageCost {
    /// What lock step costs over what the lanes need: 1 if all lanes of a wave are alike.
    pub fn divergence(&self, wave: usize) -> f64 {
        if self.lanes > 0.0 { self.waves[wave] / self.lanes } else { 1.0 }
    }

    /// The stage's cost with its launches, for [`WAVES`]`[wave]`.
    pub fn cost(&self, wave: usize) -> f64 {
        self.waves[wave] + f64::from(self.launches) * LAUNCH + f64::from(self.round_trips) * ROUND_TRIP
    }
}

/// The model of a full and an adaptive frame.
#[derive(Debug, Clone, PartialEq)]
pub struct WaveModel {
    /// Full tracing: `step1` alone.
    pub full: Vec<StageCost>,
    /// The adaptive frame, by stage.
    pub adaptive: Vec<StageCost>,
}

impl WaveModel {
    /// Full over adaptive cost for [`WAVES`]`[wave]`.
    pub fn speedup(&self, wave: usize) -> f64 {
        let cost = |stages: &[StageCost]| stages.iter().map(|stage| stage.cost(wave)).sum::<f64>();
        cost(&self.full) / cost(&self.adaptive)
    }
}

/// Adds up launches by stage, in the order of [`Stage::ALL`]; stages without launches are left out.
pub fn stage_costs(launches: &[LaunchCost]) -> Vec<StageCost> {
    let of_stage = |stage: Stage| {
        let mut cost = StageCost { stage, launches: 0, round_trips: 0, lanes: 0.0, waves: [0.0; 3] };
        for launch in launches.iter().filter(|launch| launch.stage == stage) {
            cost.launches += 1;
            cost.round_trips += u32::from(launch.waits);
            for pass in &launch.passes {
                cost.lanes += pass.iter().sum::<f64>();
                for (sum, wave) in cost.waves.iter_mut().zip(WAVES) {
                    *sum += pass.chunks(wave).map(|lanes| slowest(lanes) * wave as f64).sum::<f64>();
                }
            }
        }
        cost
    };
    Stage::ALL.into_iter().map(of_stage).filter(|cost| cost.launches > 0).collect()
}

fn slowest(lanes: &[f64]) -> f64 {
    lanes.iter().copied().fold(0.0, f64::max)
}

/// Models full and adaptive frames of `options` in lock-step waves.
///
/// # Errors
/// Whatever drawing reports; a frame that does not fit into memory at once.
pub fn wave_model(renderer: &mut Renderer, options: &RenderOptions) -> Result<WaveModel> {
    let mut stages = |mode| -> Result<Vec<StageCost>> {
        Ok(stage_costs(&launch_costs(renderer, &RenderOptions { mode, ..options.clone() })?))
    };
    Ok(WaveModel { full: stages(Mode::Full)?, adaptive: stages(Mode::Adaptive)? })
}

/// Draws a frame with counters and returns what each of its launches costs, lane by lane.
///
/// # Errors
/// As for [`wave_model`].
pub fn launch_costs(renderer: &mut Renderer, options: &RenderOptions) -> Result<Vec<LaunchCost>> {
    let options = RenderOptions { band_rows: None, ..options.clone() };
    let (mut recording, mut one_window) = (Recording::default(), OneWindow);
    let mut observers: [&mut dyn Hook; 2] = [&mut one_window, &mut recording];
    let (_, items) = renderer.render_observed(&options, Keep::COUNTERS, &mut observers, &mut FrameItems::read)?;
    let cost = |launch: &RecordedLaunch| LaunchCost {
        stage: launch.stage,
        passes: items.passes(launch),
        waits: matches!(launch.kernel, Kernel::PackCount | Kernel::CorrectCount | Kernel::CorrectTail),
    };
    Ok(recording.launches.iter().map(cost).collect())
}

/// Refuses frames in bands: what their windows cost is not read.
struct OneWindow;

impl Hook for OneWindow {
    fn begin(&mut self, _: &mut dyn Executor, frame: &FrameHandle) -> Result<()> {
        let FrameParams { height, window_begin, window_end, .. } = *frame.params();
        if (window_begin, window_end) == (0, height) {
            return Ok(());
        }
        Err(Error::LimitExceeded {
            what: "the wave model".into(),
            limit: Setting::MemoryBudget.path().into(),
            wanted: format!("all {height} rows of samples in memory"),
            allowed: format!("{} rows", window_end - window_begin),
            remedies: &[Remedy::SmallerPicture, Remedy::LargerBudget],
        })
    }
}

/// What a frame left on the device.
struct FrameItems {
    frame: FrameParams,
    /// Traversal steps, triangle tests, shaded points.
    counters: Vec<Vec<u32>>,
    classes: Vec<u32>,
    list: Vec<u32>,
}

impl FrameItems {
    fn read(executor: &mut dyn Executor, handle: &FrameHandle) -> Result<Self> {
        let frame = *handle.params();
        let pitch = frame.plane_pitch as usize;
        let mut plane = |buffer, plane: u32| {
            let at = plane as usize * pitch;
            executor.read(handle, buffer, at..at + pitch)
        };
        let counters = [COUNTER_TRAVERSAL_STEPS, COUNTER_TRIANGLE_TESTS, COUNTER_SHADED];
        let counters = counters.map(|counter| plane(FrameBuffer::Counters, counter));
        let counters = counters.into_iter().collect::<Result<_>>()?;
        let classes = if frame.block > 1 { plane(FrameBuffer::Attributes, PLANE_CLASS)? } else { Vec::new() };
        let list = executor.read(handle, FrameBuffer::List, 0..handle.sizes().list)?;
        Ok(FrameItems { frame, counters, classes, list })
    }

    fn passes(&self, launch: &RecordedLaunch) -> Vec<Vec<f64>> {
        if launch.kernel != Kernel::CorrectTail {
            return vec![self.lanes(launch.stage, launch.kernel, &launch.step)];
        }
        // Each round is a mark, which packs, too, and a trace.
        let (mut sources, mut begin, mut passes) = (launch.step.item_count / 4, launch.step.list_offset, Vec::new());
        for &end in &launch.round_ends {
            let round = StepParams { list_offset: begin, item_count: end - begin, ..launch.step };
            let mark = StepParams { item_count: 4 * sources, ..round };
            passes.push(self.lanes(launch.stage, Kernel::CorrectMark, &mark));
            passes.push(self.lanes(launch.stage, Kernel::Trace, &round));
            (sources, begin) = (end - begin, end);
        }
        passes
    }

    fn lanes(&self, stage: Stage, kernel: Kernel, step: &StepParams) -> Vec<f64> {
        let bytes = |bytes: f64| bytes / BYTES_PER_STEP;
        let alike = |count: u32, cost: f64| vec![cost; count as usize];
        match kernel {
            Kernel::Trace if stage == Stage::Step1 => self.grid_lanes(step, |x, y| self.traced(x, y)),
            Kernel::Check => self.grid_lanes(step, |x, y| self.checked(x, y)),
            Kernel::Trace => {
                let entries = &self.list[step.list_offset as usize..][..step.item_count as usize];
                entries.iter().map(|&pixel| self.traced(pixel & 0xffff, pixel >> 16) + bytes(LIST_BYTES)).collect()
            }
            // A source's and a neighbour's class; few go on to compare.
            Kernel::CorrectMark => alike(step.item_count, bytes(LIST_BYTES + 8.0)),
            // 32 class words, a mask and a sum; the scan reads and writes a sum; scatter writes few entries.
            Kernel::PackCount | Kernel::CorrectCount => alike(step.item_count.div_ceil(32), bytes(4.0 * 34.0)),
            Kernel::PackScan => alike(step.item_count, bytes(8.0)),
            Kernel::PackScatter | Kernel::CorrectScatter => alike(step.item_count.div_ceil(32), bytes(4.0 * 12.0)),
            Kernel::CorrectTail => unreachable!("its passes are those of other kernels"),
            // One lane a line: what it fires is not attributed to lines.
            Kernel::CorrectSweep => alike(step.item_count, bytes(16.0 * f64::from(self.frame.width))),
        }
    }

    /// Lanes of a grid launch: work-groups of 8x8 row by row, row-major within a group.
    fn grid_lanes(&self, step: &StepParams, cost: impl Fn(u32, u32) -> f64) -> Vec<f64> {
        let groups = (step.grid_width.div_ceil(GROUP_SIDE), step.grid_height.div_ceil(GROUP_SIDE));
        let mut lanes = Vec::with_capacity((groups.0 * groups.1 * GROUP_SIDE * GROUP_SIDE) as usize);
        for group in 0..groups.0 * groups.1 {
            let (left, top) = (group % groups.0 * GROUP_SIDE, group / groups.0 * GROUP_SIDE);
            for lane in 0..GROUP_SIDE * GROUP_SIDE {
                let (gx, gy) = (left + lane % GROUP_SIDE, top + lane / GROUP_SIDE);
                let (x, y) = grid_pixel(&self.frame, step, gx, gy);
                let inside = gx < step.grid_width && gy < step.grid_height && x < self.frame.width;
                lanes.push(if inside { cost(x, y) } else { 0.0 });
            }
        }
        lanes
    }

    /// A pixel's ray tree and what it writes.
    fn traced(&self, x: u32, y: u32) -> f64 {
        let at = plane_index(&self.frame, x, y) as usize;
        let [steps, tests, shaded] = [0, 1, 2].map(|counter| f64::from(self.counters[counter][at]));
        let stored = if self.frame.block > 1 { ATTRIBUTE_BYTES } else { 0.0 };
        steps + TRIANGLE_TEST * tests + SHADED_POINT * shaded + (stored + COLOR_BYTES) / BYTES_PER_STEP
    }

    /// A check, and the interpolation where it passed: what correction traced later had been interpolated before.
    fn checked(&self, x: u32, y: u32) -> f64 {
        let read = 2.0 * (ATTRIBUTE_BYTES + COLOR_BYTES) / BYTES_PER_STEP;
        let at = plane_index(&self.frame, x, y) as usize;
        if matches!(self.classes[at] & CLASS_MASK, CLASS_INTERPOLATED | CLASS_CORRECTED | CLASS_CONFIRMED) {
            // Background is not shaded. What a correction ray left here counts as one point, too.
            let shaded = if self.counters[2][at] > 0 { SHADED_POINT } else { 0.0 };
            read + shaded + (ATTRIBUTE_BYTES + COLOR_BYTES) / BYTES_PER_STEP
        } else {
            read
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn launch(stage: Stage, lanes: Vec<f64>) -> LaunchCost {
        LaunchCost { stage, passes: vec![lanes], waits: false }
    }

    #[test]
    fn a_wave_pays_for_its_slowest_lane() {
        // 32 lanes of 1 and 32 of 3: no divergence in waves of 32, half idle in waves of 64, three quarters in 128.
        let lanes = [vec![1.0; 32], vec![3.0; 32]].concat();
        let costs = stage_costs(&[launch(Stage::Step1, lanes)]);
        assert_eq!(costs.len(), 1);
        assert_eq!((costs[0].lanes, costs[0].waves), (128.0, [128.0, 192.0, 384.0]));
        assert_eq!(costs[0].divergence(0), 1.0);
        assert_eq!(costs[0].divergence(1), 1.5);
        assert_eq!(costs[0].cost(0), 128.0 + LAUNCH);
    }

    #[test]
    fn the_order_of_lanes_matters_and_waves_do_not_span_launches() {
        let sorted = [vec![1.0; 64], vec![5.0; 64]].concat();
        let mixed: Vec<f64> = (0..128).map(|i| if i % 2 == 0 { 1.0 } else { 5.0 }).collect();
        let wave_of_64 = |lanes: Vec<f64>| stage_costs(&[launch(Stage::Step2c, lanes)])[0].waves[1];
        assert_eq!(wave_of_64(sorted), 384.0);
        assert_eq!(wave_of_64(mixed), 640.0);
        let two = [launch(Stage::Step4, vec![2.0; 10]), launch(Stage::Step4, vec![1.0; 10])];
        let costs = stage_costs(&two);
        assert_eq!((costs[0].launches, costs[0].waves[0]), (2, 96.0));
        let waiting = LaunchCost { waits: true, ..launch(Stage::Step4, vec![0.0]) };
        assert_eq!(stage_costs(&[waiting])[0].cost(0), LAUNCH + ROUND_TRIP);
    }

    #[test]
    fn the_speedup_is_full_over_adaptive() {
        let full = stage_costs(&[launch(Stage::Step1, vec![1e6; 64])]);
        let adaptive = stage_costs(&[launch(Stage::Step1, vec![1e6; 32])]);
        let model = WaveModel { full, adaptive };
        assert!((model.speedup(0) - 2.0).abs() < 0.01, "{}", model.speedup(0));
        // One half-empty wave of 64 is as slow as a full one.
        assert!((model.speedup(1) - 1.0).abs() < 0.01);
    }
}
