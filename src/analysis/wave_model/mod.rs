// SPDX-License-Identifier: MIT OR Apache-2.0
//! What lock step costs: a GPU's wave of lanes takes as long as its slowest lane.
//!
//! From what each work-item did, in launch order, the model adds up for waves of 32, 64 and 128 lanes the cost of the
//! slowest lane of each wave. It knows nothing of clocks or caches; what it compares are sums of the same kind. The
//! weights and what they rest on are in docs/wave-model.md. The unit is a traversal step of one lane.
//!
//! There are two sums. In *lock step by loop* the lanes of a wave wait for each other after each loop through the kd-tree
//! and each point that is shaded, as the programs are: the slowest lane counts at each place of the program. In *lock step
//! by item* they wait only at the end of the item, which no GPU offers; it is what a program could come to at best that
//! lets lanes run ahead.

mod frame;
mod loops;

use std::collections::BTreeMap;

use frame::{Before, FrameItems, Left, OneWindow};
pub use loops::{Loops, Place};

use crate::device::hooks::recording::{RecordedLaunch, Recording};
use crate::device::queue::Hook;
use crate::device::stage::{Kernel, Stage};
use crate::error::Result;
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

/// What one lane does in a pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// All of it.
    pub cost: f64,
    /// What of it falls into loops, place by place; the rest falls to one more place.
    pub loops: Loops,
}

impl Lane {
    /// A lane that waits for no other on its way.
    pub fn of(cost: f64) -> Self {
        Lane { cost, loops: Loops::default() }
    }

    /// What falls into no loop.
    fn rest(&self) -> f64 {
        self.cost - self.loops.iter().map(|(_, cost)| cost).sum::<f64>()
    }
}

/// One launch: what each lane costs, in launch order.
#[derive(Debug, Clone, PartialEq)]
pub struct LaunchCost {
    /// The stage that it belongs to.
    pub stage: Stage,
    /// The lanes. All wait for each other between passes: one pass, but for the rounds of `correct_tail`. Lanes that have
    /// no work cost 0 but take part.
    pub passes: Vec<Vec<Lane>>,
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
    /// For each size of [`WAVES`] the lanes of a wave times its slowest lane, summed over waves.
    pub by_item: [f64; 3],
    /// The same with the slowest lane of each place, summed over places and waves.
    pub by_loop: [f64; 3],
}

/// Where lanes of a wave wait for each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LockStep {
    /// After each loop: what whole ray trees in one kernel pay.
    ByLoop,
    /// At the end of the item.
    ByItem,
}

impl LockStep {
    /// Both, the one that kernels pay first.
    pub const ALL: [LockStep; 2] = [LockStep::ByLoop, LockStep::ByItem];

    /// What outputs call it.
    pub fn name(self) -> &'static str {
        match self {
            LockStep::ByLoop => "by loop",
            LockStep::ByItem => "by item",
        }
    }
}

impl StageCost {
    /// Steps of all waves, for [`WAVES`]`[wave]`.
    pub fn waves(&self, lock_step: LockStep, wave: usize) -> f64 {
        match lock_step {
            LockStep::ByLoop => self.by_loop[wave],
            LockStep::ByItem => self.by_item[wave],
        }
    }

    /// What lock step costs over what the lanes need: 1 if all lanes of a wave are alike.
    pub fn divergence(&self, lock_step: LockStep, wave: usize) -> f64 {
        if self.lanes > 0.0 { self.waves(lock_step, wave) / self.lanes } else { 1.0 }
    }

    /// The stage's cost with its launches, for [`WAVES`]`[wave]`.
    pub fn cost(&self, lock_step: LockStep, wave: usize) -> f64 {
        self.waves(lock_step, wave) + f64::from(self.launches) * LAUNCH + f64::from(self.round_trips) * ROUND_TRIP
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
    pub fn speedup(&self, lock_step: LockStep, wave: usize) -> f64 {
        let cost = |stages: &[StageCost]| stages.iter().map(|stage| stage.cost(lock_step, wave)).sum::<f64>();
        cost(&self.full) / cost(&self.adaptive)
    }
}

/// Adds up launches by stage, in the order of [`Stage::ALL`]; stages without launches are left out.
pub fn stage_costs(launches: &[LaunchCost]) -> Vec<StageCost> {
    let of_stage = |stage: Stage| {
        let mut cost =
            StageCost { stage, launches: 0, round_trips: 0, lanes: 0.0, by_item: [0.0; 3], by_loop: [0.0; 3] };
        for launch in launches.iter().filter(|launch| launch.stage == stage) {
            cost.launches += 1;
            cost.round_trips += u32::from(launch.waits);
            for pass in &launch.passes {
                cost.lanes += pass.iter().map(|lane| lane.cost).sum::<f64>();
                for (at, wave) in WAVES.into_iter().enumerate() {
                    let sum =
                        |of: fn(&[Lane]) -> f64| pass.chunks(wave).map(|lanes| of(lanes) * wave as f64).sum::<f64>();
                    cost.by_item[at] += sum(slowest_item);
                    cost.by_loop[at] += sum(slowest_loops);
                }
            }
        }
        cost
    };
    Stage::ALL.into_iter().map(of_stage).filter(|cost| cost.launches > 0).collect()
}

fn slowest_item(lanes: &[Lane]) -> f64 {
    lanes.iter().map(|lane| lane.cost).fold(0.0, f64::max)
}

fn slowest_loops(lanes: &[Lane]) -> f64 {
    let mut slowest: BTreeMap<Place, f64> = BTreeMap::new();
    for &(place, cost) in lanes.iter().flat_map(|lane| &lane.loops) {
        let most = slowest.entry(place).or_default();
        *most = cost.max(*most);
    }
    slowest.values().sum::<f64>() + lanes.iter().map(Lane::rest).fold(0.0, f64::max)
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
    let (mut recording, mut one_window, mut before) = (Recording::default(), OneWindow, Before::default());
    let mut observers: [&mut dyn Hook; 3] = [&mut one_window, &mut before, &mut recording];
    let (_, left) = renderer.render_observed(&options, Keep::COUNTERS, &mut observers, &mut Left::read)?;
    let items = FrameItems::new(before, left)?;
    let cost = |launch: &RecordedLaunch| {
        // Tracing again takes as long as the frame took.
        renderer.monitor().check()?;
        Ok(LaunchCost {
            stage: launch.stage,
            passes: items.passes(launch),
            waits: matches!(launch.kernel, Kernel::PackCount | Kernel::CorrectCount | Kernel::CorrectTail),
        })
    };
    recording.launches.iter().map(cost).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::twin::scene_args::Part;

    fn launch(stage: Stage, lanes: Vec<f64>) -> LaunchCost {
        LaunchCost { stage, passes: vec![lanes.into_iter().map(Lane::of).collect()], waits: false }
    }

    const BY_ITEM: LockStep = LockStep::ByItem;

    #[test]
    fn a_wave_pays_for_its_slowest_lane() {
        // 32 lanes of 1 and 32 of 3: no divergence in waves of 32, half idle in waves of 64, three quarters in 128.
        let lanes = [vec![1.0; 32], vec![3.0; 32]].concat();
        let costs = stage_costs(&[launch(Stage::Step1, lanes)]);
        assert_eq!(costs.len(), 1);
        assert_eq!((costs[0].lanes, costs[0].by_item), (128.0, [128.0, 192.0, 384.0]));
        assert_eq!(costs[0].divergence(BY_ITEM, 0), 1.0);
        assert_eq!(costs[0].divergence(BY_ITEM, 1), 1.5);
        assert_eq!(costs[0].cost(BY_ITEM, 0), 128.0 + LAUNCH);
    }

    #[test]
    fn lanes_wait_for_each_other_at_each_place_of_the_program() {
        let place = |ray, part| Place { chain: 0, ray, part };
        let lane = |loops: &[(Place, f64)], rest: f64| Lane {
            cost: loops.iter().map(|(_, cost)| cost).sum::<f64>() + rest,
            loops: loops.into(),
        };
        // One lane is slow in its first loop, another in its second: equally slow items, which wait for each other twice.
        let (first, second) = (place(0, Part::ClosestHit), place(0, Part::ShadowRay(3)));
        let lanes = vec![lane(&[(first, 9.0), (second, 1.0)], 2.0), lane(&[(first, 1.0), (second, 9.0)], 2.0)];
        let cost = stage_costs(&[LaunchCost { stage: Stage::Step1, passes: vec![lanes], waits: false }]);
        assert_eq!((cost[0].lanes, cost[0].by_item[0], cost[0].by_loop[0]), (24.0, 32.0 * 12.0, 32.0 * 20.0));
        // The same loop of another ray is another place; lanes that are elsewhere wait.
        let (mirror, other) = (place(1, Part::ClosestHit), place(2, Part::ClosestHit));
        let lanes = vec![lane(&[(mirror, 5.0)], 0.0), lane(&[(other, 5.0)], 0.0), Lane::of(3.0)];
        let cost = stage_costs(&[LaunchCost { stage: Stage::Step1, passes: vec![lanes], waits: false }]);
        assert_eq!((cost[0].by_item[0], cost[0].by_loop[0]), (32.0 * 5.0, 32.0 * 13.0));
        // Without loops both are one.
        let plain = stage_costs(&[launch(Stage::Step4, vec![1.0, 4.0, 2.0])]);
        assert_eq!(plain[0].by_item, plain[0].by_loop);
    }

    #[test]
    fn the_order_of_lanes_matters_and_waves_do_not_span_launches() {
        let sorted = [vec![1.0; 64], vec![5.0; 64]].concat();
        let mixed: Vec<f64> = (0..128).map(|i| if i % 2 == 0 { 1.0 } else { 5.0 }).collect();
        let wave_of_64 = |lanes: Vec<f64>| stage_costs(&[launch(Stage::Step2c, lanes)])[0].by_item[1];
        assert_eq!(wave_of_64(sorted), 384.0);
        assert_eq!(wave_of_64(mixed), 640.0);
        let two = [launch(Stage::Step4, vec![2.0; 10]), launch(Stage::Step4, vec![1.0; 10])];
        let costs = stage_costs(&two);
        assert_eq!((costs[0].launches, costs[0].by_item[0]), (2, 96.0));
        let waiting = LaunchCost { waits: true, ..launch(Stage::Step4, vec![0.0]) };
        assert_eq!(stage_costs(&[waiting])[0].cost(BY_ITEM, 0), LAUNCH + ROUND_TRIP);
    }

    #[test]
    fn the_speedup_is_full_over_adaptive() {
        let full = stage_costs(&[launch(Stage::Step1, vec![1e6; 64])]);
        let adaptive = stage_costs(&[launch(Stage::Step1, vec![1e6; 32])]);
        let model = WaveModel { full, adaptive };
        assert!((model.speedup(BY_ITEM, 0) - 2.0).abs() < 0.01, "{}", model.speedup(BY_ITEM, 0));
        // One half-empty wave of 64 is as slow as a full one.
        assert!((model.speedup(BY_ITEM, 1) - 1.0).abs() < 0.01);
    }
}
