// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drawing one frame on a back end, and what stays of the frame drawn last.

use std::time::Instant;

use super::renderer::DEFAULT_BUDGET_BYTES;
use crate::device::backend::{Backend, FrameBuffer};
use crate::device::hooks::progress::WatchedBackend;
use crate::device::stage::Stage;
use crate::error::Result;
use crate::layout::*;
use crate::method::bands::{self, Collected, CounterSums, Plan, Room};
use crate::method::camera::frame_params;
use crate::method::frame::{Frame, FrameStats, Keep};
use crate::method::options::{Mode, RenderOptions};
use crate::method::pipeline;
use crate::monitor::Monitor;
use crate::prepare::scene_buffers::SceneBuffers;
use crate::render::resolve::resolve;
use crate::scene::View;

/// What small buffers beside the scene's arrays and the frame's may take, such as the frame's parameters.
const SMALL_BUFFERS_BYTES: u64 = 64 << 10;

/// A frame that is wanted.
pub(super) struct Job<'a> {
    pub options: &'a RenderOptions,
    pub keep: Keep,
    pub view: &'a View,
    pub buffers: &'a SceneBuffers,
    pub memory_budget_bytes: Option<u64>,
    pub monitor: &'a Monitor,
}

/// The frame drawn last, as far as its planes can be read.
pub(super) struct LastFrame {
    pub keep: Keep,
    pub planes: Planes,
}

/// Where planes are.
pub(super) enum Planes {
    /// In the device's buffers: the frame was one window.
    OnDevice(FrameParams),
    /// On the host.
    Collected(Collected),
}

impl Job<'_> {
    fn is_full(&self) -> bool {
        self.options.mode == Mode::Full
    }

    pub fn params(&self) -> FrameParams {
        let block = if self.is_full() { 1 } else { self.options.method.block };
        let (width, height) = self.options.sample_size();
        frame_params(self.view, self.buffers, width, height, block, self.options.depth)
    }

    /// How the frame is cut to fit into what the device, its profile and the budget leave for its buffers.
    pub fn plan(&self, backend: &mut dyn Backend, params: &FrameParams) -> Result<Plan> {
        let limits = backend.memory_limits();
        let scene_bytes = self.buffers.bytes() + SMALL_BUFFERS_BYTES;
        let budget = self.memory_budget_bytes.unwrap_or(DEFAULT_BUDGET_BYTES).min(usize::MAX as u64 / 2);
        let room = Room {
            total_bytes: budget.min(limits.total_bytes),
            allocation_bytes: limits.allocation_bytes,
            scene_bytes,
            attributes: self.keep.attributes() || !self.is_full(),
            counters: self.keep.counters,
            scan_group: backend.scan_group(),
        };
        Plan::new(params, &room, self.options.band_rows)
    }

    /// Draws the frame.
    pub fn draw(&self, backend: &mut dyn Backend) -> Result<(Frame, Planes)> {
        let (options, keep) = (self.options, self.keep);
        let params = self.params();
        let plan = self.plan(backend, &params)?;
        backend.take_timings()?;
        let backend = &mut WatchedBackend::new(backend, self.monitor);
        let started = Instant::now();
        let (counts, samples, planes) = if plan.is_one_window() {
            backend.begin(&params, &plan.sizes)?;
            let counts = if self.is_full() {
                pipeline::full_frame(backend, &params, keep.attributes())?
            } else {
                pipeline::adaptive_frame(backend, &params, options, self.view.extent)?
            };
            (counts, backend.read(FrameBuffer::Color, 0..plan.sizes.color)?, Planes::OnDevice(params))
        } else {
            let (counts, mut collected) = bands::draw(backend, &plan, options, self.view.extent, keep)?;
            (counts, std::mem::take(&mut collected.colors), Planes::Collected(collected))
        };
        let pixels = match options.samples {
            1 => samples,
            samples_per_axis => resolve(&samples, options.width, options.height, samples_per_axis, self.monitor)?,
        };
        let frame_ms = started.elapsed().as_secs_f64() * 1e3;
        let mut stages_ms = [0.0; Stage::ALL.len()];
        for (stage, ms) in backend.take_timings()? {
            stages_ms[stage as usize] += ms;
        }
        let mut stats = FrameStats { frame_ms, stages_ms, pixels: counts, ..FrameStats::default() };
        if keep.counters {
            let sums = match &planes {
                Planes::OnDevice(params) => {
                    let primary = counts.base + counts.traced + counts.corrected;
                    let mut sums = CounterSums { primary, ..CounterSums::default() };
                    bands::sum_counters(backend, params, &mut sums, true)?;
                    sums
                }
                Planes::Collected(collected) => collected.sums,
            };
            (stats.rays, stats.work) = (Some(sums.rays()), Some(sums.work()));
            stats.work_by_class = Some(sums.work_by_class);
            stats.failed_tests = (!self.is_full()).then_some(sums.failed_tests);
        }
        backend.monitor().check()?;
        backend.finished();
        Ok((Frame { width: options.width, height: options.height, pixels, stats }, planes))
    }
}

impl LastFrame {
    /// An attribute plane, or from [`PLANE_COUNT`] on a counter plane, row-major; `None` if it was not kept.
    pub fn plane(&self, backend: &mut dyn Backend, plane: u32) -> Result<Option<Vec<u32>>> {
        match &self.planes {
            _ if !self.keep.has(plane) => Ok(None),
            Planes::OnDevice(params) => {
                let words = bands::read_plane(backend, params, plane)?;
                let pixels = (0..params.height).flat_map(|y| (0..params.width).map(move |x| (x, y)));
                Ok(Some(pixels.map(|(x, y)| words[plane_index(params, x, y) as usize]).collect()))
            }
            Planes::Collected(collected) => Ok(collected.planes.get(&plane).cloned()),
        }
    }

    /// Copies the kept planes to the host, because the device's buffers are about to be used for another frame, which
    /// may not be finished.
    pub fn rescue(&mut self, backend: &mut dyn Backend, monitor: &Monitor) -> Result<()> {
        let Planes::OnDevice(params) = &self.planes else { return Ok(()) };
        let mut collected = Collected::without_colors(params);
        for plane in (0..PLANE_COUNT + COUNTER_COUNT).filter(|&plane| self.keep.has(plane)) {
            monitor.check()?;
            if let Some(words) = self.plane(backend, plane)? {
                collected.planes.insert(plane, words);
            }
        }
        self.planes = Planes::Collected(collected);
        Ok(())
    }
}
