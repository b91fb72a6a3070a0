// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frames that a renderer keeps alive: the one drawn last, as far as its planes are kept, and buffers for the next.

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameHandle, FrameInputs, FrameSizes};
use crate::error::Result;
use crate::layout::{COUNTER_COUNT, PLANE_COUNT};
use crate::memory;
use crate::method::bands::{Collected, read_frame_plane};
use crate::method::counts::Keep;

/// The frame drawn last, and buffers that wait for another one.
#[derive(Default)]
pub(super) struct Frames {
    last: Option<LastFrame>,
    spare: Option<FrameHandle>,
}

/// What can be read of the frame drawn last.
struct LastFrame {
    keep: Keep,
    planes: Planes,
}

/// Where the planes are.
enum Planes {
    /// In the device's memory.
    OnDevice(FrameHandle),
    /// On the host: the frame was drawn in bands, or gave way to a larger one.
    OnHost(Collected),
}

impl Frames {
    /// Buffers for a frame. The frame drawn last stays where it is if `room_bytes` hold both; else its planes go to the
    /// host.
    pub fn take(
        &mut self,
        executor: &mut dyn Executor,
        inputs: &FrameInputs,
        sizes: &FrameSizes,
        room_bytes: u64,
    ) -> Result<FrameHandle> {
        self.make_room(executor, sizes.bytes(), room_bytes)?;
        match self.spare.take() {
            Some(spare) if spare.sizes().hold(sizes) => Ok(spare),
            spare => {
                // Buffers that do not serve go first: both together may not fit.
                drop(spare);
                executor.allocate(inputs, sizes)
            }
        }
    }

    fn make_room(&mut self, executor: &mut dyn Executor, wanted_bytes: u64, room_bytes: u64) -> Result<()> {
        let Some(LastFrame { keep, planes }) = &mut self.last else { return Ok(()) };
        let Planes::OnDevice(frame) = planes else { return Ok(()) };
        let spare_bytes = self.spare.as_ref().map_or(0, |spare| spare.sizes().bytes());
        if frame.sizes().bytes() + wanted_bytes.max(spare_bytes) <= room_bytes {
            return Ok(());
        }
        let mut collected = Collected::default();
        for plane in (0..PLANE_COUNT + COUNTER_COUNT).filter(|&plane| keep.has(plane)) {
            executor.monitor().check()?;
            collected.planes.insert(plane, read_frame_plane(executor, frame, plane)?);
        }
        if let Planes::OnDevice(frame) = std::mem::replace(planes, Planes::OnHost(collected)) {
            self.spare = Some(frame);
        }
        Ok(())
    }

    /// Takes over a frame that was finished: `collected` holds the kept planes unless they are in `frame`.
    pub fn finished(&mut self, frame: FrameHandle, keep: Keep, collected: Option<Collected>) {
        let planes = match collected {
            Some(collected) => {
                self.spare = Some(frame);
                Planes::OnHost(collected)
            }
            None => Planes::OnDevice(frame),
        };
        if let Some(LastFrame { planes: Planes::OnDevice(frame), .. }) = self.last.replace(LastFrame { keep, planes }) {
            self.spare.get_or_insert(frame);
        }
    }

    /// Takes back the buffers of a frame that was not finished.
    pub fn unfinished(&mut self, frame: FrameHandle) {
        self.spare = Some(frame);
    }

    /// Forgets what was in the memory of a device that was lost.
    pub fn forget_device(&mut self) {
        self.spare = None;
        if self.last_mut().is_some() {
            self.last = None;
        }
    }

    /// A plane of the frame drawn last, row-major; `None` if it was not kept. Counter planes are numbered from
    /// [`PLANE_COUNT`] on.
    pub fn plane(&self, executor: &mut dyn Executor, plane: u32) -> Result<Option<Vec<u32>>> {
        match &self.last {
            Some(LastFrame { keep, planes }) if keep.has(plane) => match planes {
                Planes::OnDevice(frame) => read_frame_plane(executor, frame, plane).map(Some),
                Planes::OnHost(collected) => {
                    let kept = collected.planes.get(&plane);
                    kept.map(|words| memory::collected("a plane", words.iter().copied())).transpose()
                }
            },
            _ => Ok(None),
        }
    }

    /// The frame drawn last, if it is on the device.
    pub fn last_mut(&mut self) -> Option<&mut FrameHandle> {
        match &mut self.last {
            Some(LastFrame { planes: Planes::OnDevice(frame), .. }) => Some(frame),
            _ => None,
        }
    }
}
