// SPDX-License-Identifier: MIT OR Apache-2.0
//! Statistics as JSON objects: the same keys in every command. A figure that does not exist is `null`; JSON has neither
//! infinity nor NaN, which serde writes as `null` as well.

use serde::{Serialize, Serializer};

use crate::analysis::compare::Comparison;
use crate::analysis::wave_model::{LockStep, StageCost, WAVES, WaveModel};
use crate::device::executor::ExecutorInfo;
use crate::device::stage::Stage;
use crate::method::counts::{PixelCounts, RayCounts, WorkCounts};
use crate::method::fallback::does_not_pay;
use crate::method::options::{Mode, RenderOptions, Test};
use crate::render::frame::{Frame, FrameStats};
use crate::render::renderer::{BuildTimes, Renderer};

/// The statistics of one frame: what `rarefy render` writes.
#[derive(Debug, Serialize)]
pub struct RenderReport {
    #[serde(flatten)]
    head: Head,
    #[serde(skip_serializing_if = "Option::is_none")]
    full: Option<FrameReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    adaptive: Option<FrameReport>,
    ray_traced_ratio: f64,
    ray_traced_ratio_with_correction: f64,
    peak_device_bytes: u64,
}

/// A comparison: what `rarefy compare` writes.
#[derive(Debug, Serialize)]
pub struct CompareReport {
    #[serde(flatten)]
    head: Head,
    frames: u32,
    full: FrameReport,
    adaptive: FrameReport,
    ray_traced_ratio: f64,
    ray_traced_ratio_with_correction: f64,
    falls_back: bool,
    speedup: f64,
    work_speedup: f64,
    efficiency: f64,
    correction_work_ratio: f64,
    packed_ray_work_ratio: Option<f64>,
    psnr_db: Option<f64>,
    psnr_interpolated_db: Option<f64>,
    ssim: f64,
    flip_mean: f64,
    flip_p99: f64,
    wrong_object_pixels: u64,
    wrong_object_largest_cluster: u64,
    wrong_shadow_pixels: u64,
    peak_device_bytes: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    wave_model: Option<WaveReport>,
}

/// What was drawn, on what.
#[derive(Debug, Serialize)]
struct Head {
    scene: String,
    triangles: usize,
    width: u32,
    height: u32,
    samples_per_axis: u32,
    block: u32,
    device: DeviceReport,
    build: BuildTimes,
}

#[derive(Debug, Serialize)]
struct DeviceReport {
    #[serde(flatten)]
    info: ExecutorInfo,
    /// Rays per work-item.
    lanes: u32,
}

#[derive(Debug, Serialize)]
struct FrameReport {
    frame_ms: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    rays: Option<RayCounts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    work: Option<WorkCounts>,
    #[serde(flatten)]
    adaptive: Option<AdaptiveReport>,
}

/// What only adaptive frames have.
#[derive(Debug, Serialize)]
struct AdaptiveReport {
    pixels: PixelCounts,
    stages_ms: ByName<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    failed_tests: Option<ByName<u64>>,
    fell_back: bool,
}

/// The wave model's part of a comparison.
#[derive(Debug, Serialize)]
struct WaveReport {
    speedup_by_loop: ByName<f64>,
    speedup_by_item: ByName<f64>,
    full: ByName<StageReport>,
    adaptive: ByName<StageReport>,
}

#[derive(Debug, Serialize)]
struct StageReport {
    launches: u32,
    round_trips: u32,
    lane_steps: f64,
    /// Where lanes of a wave wait for each other after each loop.
    wave_steps_by_loop: ByName<f64>,
    divergence_by_loop: ByName<f64>,
    /// Where they wait at the end of an item.
    wave_steps_by_item: ByName<f64>,
    divergence_by_item: ByName<f64>,
}

/// Values by names that are data; an object in JSON, in this order.
#[derive(Debug)]
struct ByName<T>(Vec<(String, T)>);

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl<T> ByName<T> {
    fn new<N: ToString>(entries: impl IntoIterator<Item = (N, T)>) -> Self {
        ByName(entries.into_iter().map(|(name, value)| (name.to_string(), value)).collect())
    }
}

impl RenderReport {
    /// The report of a frame that `renderer` has just drawn of a scene that took `load_ms` to load.
    pub fn new(renderer: &mut Renderer, options: &RenderOptions, frame: &Frame, load_ms: f64) -> Self {
        let report = Some(FrameReport::new(&frame.stats, options.mode));
        let (full, adaptive) = if options.mode == Mode::Full { (report, None) } else { (None, report) };
        RenderReport {
            head: Head::new(renderer, options, load_ms),
            full,
            adaptive,
            ray_traced_ratio: frame.stats.ray_traced_ratio(),
            ray_traced_ratio_with_correction: frame.stats.ray_traced_ratio_with_correction(),
            peak_device_bytes: renderer.peak_device_bytes(),
        }
    }
}

impl CompareReport {
    /// The report of a comparison that `renderer` has just made, and of the wave model if there is one.
    pub fn new(
        renderer: &mut Renderer,
        options: &RenderOptions,
        comparison: &Comparison,
        waves: Option<&WaveModel>,
        load_ms: f64,
    ) -> Self {
        let quality = &comparison.quality;
        CompareReport {
            head: Head::new(renderer, options, load_ms),
            frames: comparison.frames,
            full: FrameReport::new(&comparison.full, Mode::Full),
            adaptive: FrameReport::new(&comparison.adaptive, Mode::Adaptive),
            ray_traced_ratio: comparison.adaptive.ray_traced_ratio(),
            ray_traced_ratio_with_correction: comparison.adaptive.ray_traced_ratio_with_correction(),
            falls_back: does_not_pay(&comparison.adaptive.pixels),
            speedup: comparison.speedup,
            work_speedup: comparison.work_speedup(),
            efficiency: comparison.efficiency(),
            correction_work_ratio: comparison.correction_work_ratio(),
            packed_ray_work_ratio: comparison.packed_ray_work_ratio,
            psnr_db: quality.psnr_db,
            psnr_interpolated_db: quality.psnr_interpolated_db,
            ssim: quality.ssim,
            flip_mean: quality.flip_mean,
            flip_p99: quality.flip_p99,
            wrong_object_pixels: comparison.wrong_object.count,
            wrong_object_largest_cluster: comparison.wrong_object.largest_cluster,
            wrong_shadow_pixels: comparison.wrong_shadow.count,
            peak_device_bytes: renderer.peak_device_bytes(),
            wave_model: waves.map(WaveReport::new),
        }
    }
}

impl Head {
    fn new(renderer: &mut Renderer, options: &RenderOptions, load_ms: f64) -> Self {
        Head {
            scene: renderer.name().to_owned(),
            triangles: renderer.triangle_count(),
            width: options.width,
            height: options.height,
            samples_per_axis: options.samples,
            block: options.method.block,
            device: DeviceReport { info: renderer.info(), lanes: 1 },
            build: BuildTimes { load_ms, ..renderer.build_times() },
        }
    }
}

impl FrameReport {
    fn new(stats: &FrameStats, mode: Mode) -> Self {
        let adaptive = || AdaptiveReport {
            pixels: stats.pixels,
            stages_ms: ByName::new(
                Stage::ALL
                    .map(|stage| (stage.name(), stats.stages_ms[stage as usize]))
                    .into_iter()
                    .chain([("other", stats.other_ms())]),
            ),
            failed_tests: stats
                .failed_tests
                .map(|failed| ByName::new(Test::ALL.into_iter().map(Test::name).zip(failed))),
            fell_back: stats.fell_back,
        };
        FrameReport {
            frame_ms: stats.frame_ms,
            rays: stats.rays,
            work: stats.work,
            adaptive: (mode == Mode::Adaptive).then(adaptive),
        }
    }
}

impl WaveReport {
    fn new(model: &WaveModel) -> Self {
        let by_wave =
            |value: &dyn Fn(usize) -> f64| ByName::new(WAVES.iter().enumerate().map(|(at, n)| (n, value(at))));
        let stages = |stages: &[StageCost]| {
            ByName::new(stages.iter().map(|cost| {
                let report = StageReport {
                    launches: cost.launches,
                    round_trips: cost.round_trips,
                    lane_steps: cost.lanes,
                    wave_steps_by_loop: by_wave(&|wave| cost.by_loop[wave]),
                    divergence_by_loop: by_wave(&|wave| cost.divergence(LockStep::ByLoop, wave)),
                    wave_steps_by_item: by_wave(&|wave| cost.by_item[wave]),
                    divergence_by_item: by_wave(&|wave| cost.divergence(LockStep::ByItem, wave)),
                };
                (cost.stage.name(), report)
            }))
        };
        WaveReport {
            speedup_by_loop: by_wave(&|wave| model.speedup(LockStep::ByLoop, wave)),
            speedup_by_item: by_wave(&|wave| model.speedup(LockStep::ByItem, wave)),
            full: stages(&model.full),
            adaptive: stages(&model.adaptive),
        }
    }
}
