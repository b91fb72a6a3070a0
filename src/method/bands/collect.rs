// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the host keeps of a frame's windows: colours, planes, sums of counters.

use std::collections::BTreeMap;

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameHandle};
use crate::device::queue::Queue;
use crate::error::Result;
use crate::layout::*;
use crate::memory;
use crate::method::counts::{Keep, RayCounts, WorkCounts};
use crate::method::options::Test;

/// Rays, work and failed tests, summed over windows.
#[derive(Debug, Clone, Copy, Default)]
pub struct CounterSums {
    /// Every counter (`COUNTER_*`).
    pub counters: [u64; COUNTER_COUNT as usize],
    /// Rays from the eye.
    pub primary: u64,
    /// Traversal work of base, traced and corrected pixels.
    pub work_by_class: [u64; 3],
    /// Failed tests, in the order of [`Test::ALL`].
    pub failed_tests: [u64; 7],
}

impl CounterSums {
    /// The rays by kind.
    pub fn rays(&self) -> RayCounts {
        RayCounts {
            primary: self.primary,
            shadow: self.counters[COUNTER_SHADOW_RAYS as usize],
            reflection: self.counters[COUNTER_REFLECTION_RAYS as usize],
            refraction: self.counters[COUNTER_REFRACTION_RAYS as usize],
        }
    }

    /// The work.
    pub fn work(&self) -> WorkCounts {
        WorkCounts {
            traversal_steps: self.counters[COUNTER_TRAVERSAL_STEPS as usize],
            triangle_tests: self.counters[COUNTER_TRIANGLE_TESTS as usize],
            shaded_pixels: self.counters[COUNTER_SHADED as usize],
        }
    }
}

/// Which pixels of a window are new to the host.
#[derive(Debug, Clone, Copy)]
pub enum NewPixels<'a> {
    /// The interior: the window was drawn for the first time.
    Interior,
    /// These: the window was drawn again to trace them.
    Listed(&'a [u32]),
}

/// A frame's samples and planes on the host, row-major over the whole frame.
#[derive(Debug, Default)]
pub struct Collected {
    width: u32,
    /// The colour of every sample.
    pub colors: Vec<u32>,
    /// Planes by number: attribute planes, then counter planes from [`PLANE_COUNT`] on.
    pub planes: BTreeMap<u32, Vec<u32>>,
}

impl Collected {
    /// Room for the colours of a frame, and for the planes of `keep`.
    ///
    /// # Errors
    /// [`crate::Error::OutOfMemory`].
    pub fn new(frame: &FrameParams, keep: Keep) -> Result<Self> {
        let samples = frame.width as usize * frame.height as usize;
        let planes = (0..PLANE_COUNT + COUNTER_COUNT).filter(|&plane| keep.has(plane));
        let room = || memory::filled("the samples of the frame", samples, 0);
        let planes = planes.map(|plane| Ok((plane, room()?))).collect::<Result<_>>()?;
        Ok(Collected { width: frame.width, colors: room()?, planes })
    }

    /// Takes over a window that has just been drawn.
    ///
    /// # Errors
    /// A failing read.
    pub fn take(&mut self, queue: &mut Queue, new: NewPixels) -> Result<()> {
        let frame = *queue.params();
        let rows = frame.interior_begin..frame.interior_end;
        let words = queue.read(FrameBuffer::Color, window_words(&frame, rows.clone()))?;
        if words.len() == self.colors.len() {
            self.colors = words;
        } else {
            let first = color_index(&frame, 0, rows.start);
            copy(&mut self.colors, self.width, &frame, new, |x, y| words[(color_index(&frame, x, y) - first) as usize]);
        }
        for (&plane, target) in &mut self.planes {
            queue.check()?;
            let words = read_plane(queue, plane)?;
            copy(target, self.width, &frame, new, |x, y| words[plane_index(&frame, x, y) as usize]);
        }
        Ok(())
    }
}

fn copy(target: &mut [u32], width: u32, frame: &FrameParams, new: NewPixels, word: impl Fn(u32, u32) -> u32) {
    let mut put = |x: u32, y: u32| target[y as usize * width as usize + x as usize] = word(x, y);
    match new {
        NewPixels::Interior => {
            (frame.interior_begin..frame.interior_end).for_each(|y| (0..frame.width).for_each(|x| put(x, y)));
        }
        NewPixels::Listed(pixels) => pixels.iter().for_each(|&pixel| put(pixel & 0xffff, pixel >> 16)),
    }
}

/// Where rows of the window lie in the colour buffer.
fn window_words(frame: &FrameParams, rows: std::ops::Range<u32>) -> std::ops::Range<usize> {
    color_index(frame, 0, rows.start) as usize..color_index(frame, 0, rows.end) as usize
}

/// Where a plane of the window lies: an attribute plane, or from [`PLANE_COUNT`] on a counter plane.
fn plane_words(frame: &FrameParams, plane: u32) -> (FrameBuffer, std::ops::Range<usize>) {
    let pitch = frame.plane_pitch as usize;
    let (buffer, start) = match plane.checked_sub(PLANE_COUNT) {
        Some(counter) => (FrameBuffer::Counters, counter as usize * pitch),
        None => (FrameBuffer::Attributes, plane as usize * pitch),
    };
    (buffer, start..start + pitch)
}

/// An attribute plane, or from [`PLANE_COUNT`] on a counter plane, of the window in a queue's frame.
///
/// # Errors
/// A failing read.
pub fn read_plane(queue: &mut Queue, plane: u32) -> Result<Vec<u32>> {
    let (buffer, words) = plane_words(queue.params(), plane);
    queue.read(buffer, words)
}

/// A plane of a frame that is one window, row-major.
///
/// # Errors
/// A failing read.
pub fn read_frame_plane(executor: &mut dyn Executor, frame: &FrameHandle, plane: u32) -> Result<Vec<u32>> {
    let params = frame.params();
    let (buffer, words) = plane_words(params, plane);
    let words = executor.read(frame, buffer, words)?;
    let pixels = (0..params.height).flat_map(|y| (0..params.width).map(move |x| (x, y)));
    let mut plane = memory::with_room("a plane", params.width as usize * params.height as usize)?;
    plane.extend(pixels.map(|(x, y)| words[plane_index(params, x, y) as usize]));
    Ok(plane)
}

/// Adds up the counters of the window in a queue's frame. `first_time`: failed tests count, too.
///
/// # Errors
/// A failing read.
pub fn sum_counters(queue: &mut Queue, sums: &mut CounterSums, first_time: bool) -> Result<()> {
    let frame = &queue.params().clone();
    let classes = match frame.block {
        1 => None,
        _ => Some(read_plane(queue, PLANE_CLASS)?),
    };
    for counter in 0..COUNTER_COUNT {
        let words = read_plane(queue, PLANE_COUNT + counter)?;
        let is_traversal = matches!(counter, COUNTER_TRAVERSAL_STEPS | COUNTER_TRIANGLE_TESTS);
        for y in frame.window_begin..frame.window_end {
            queue.check()?;
            for x in 0..frame.width {
                let at = plane_index(frame, x, y) as usize;
                let count = u64::from(words[at]);
                sums.counters[counter as usize] += count;
                let class = classes.as_ref().map_or(CLASS_BASE, |classes| classes[at] & CLASS_MASK);
                if let (true, Some(slot)) = (is_traversal, class_slot(class)) {
                    sums.work_by_class[slot] += count;
                }
            }
        }
    }
    if let (true, Some(classes)) = (first_time, classes) {
        for y in frame.interior_begin..frame.interior_end {
            queue.check()?;
            for x in 0..frame.width {
                let class = classes[plane_index(frame, x, y) as usize];
                for (test, sum) in Test::ALL.into_iter().zip(&mut sums.failed_tests) {
                    *sum += u64::from(class & test.fail_bit() != 0);
                }
            }
        }
    }
    Ok(())
}

fn class_slot(class: u32) -> Option<usize> {
    match class {
        CLASS_BASE => Some(0),
        CLASS_TRACED => Some(1),
        CLASS_CORRECTED | CLASS_CONFIRMED => Some(2),
        _ => None,
    }
}
