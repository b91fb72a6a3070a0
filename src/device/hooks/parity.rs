// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hook on the CPU twin that runs each of its launches once more, on a device fed the twin's own inputs, and compares
//! all buffers word by word.

use std::sync::Arc;

use crate::device::executor::Executor;
use crate::device::frame_memory::{FrameBuffer, FrameHandle};
use crate::device::launch::{Launch, SceneHandle};
use crate::device::queue::Hook;
use crate::device::stage::{Kernel, Stage};
use crate::error::{Error, Result};
use crate::layout::PLANE_GCOL_B;
use crate::prepare::PreparedScene;

/// How far a float may be off, absolutely and relatively, before it counts as wrong on a device that rounds otherwise.
const FLOAT_TOLERANCE: f32 = 2.0e-3;

/// What one kernel's launches came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KernelParity {
    /// The stage that launched it.
    pub stage: Stage,
    /// The kernel.
    pub kernel: Kernel,
    /// Words compared.
    pub words: u64,
    /// Words whose bits differ.
    pub different: u64,
    /// Words that differ by more than rounding explains: floats beyond the tolerance, colours by more than 2/255 in a
    /// channel, anything else at all.
    pub wrong: u64,
    /// Where the first difference was: buffer, word, twin's value, device's value.
    pub first: Option<(FrameBuffer, usize, u32, u32)>,
}

/// Compares a device with the executor whose launches it observes: a twin that imitates the device.
pub struct Parity<'a> {
    device: &'a mut dyn Executor,
    scene: SceneHandle,
    frame: Option<FrameHandle>,
    only: Option<(Stage, Kernel)>,
    /// Results so far, one per stage and kernel that was launched, in order of first launch.
    pub results: Vec<KernelParity>,
}

impl<'a> Parity<'a> {
    /// Uploads the scene, whose launches are to be observed, to `device` as well.
    ///
    /// # Errors
    /// A limit of the device or its profile, or a failing call.
    pub fn new(device: &'a mut dyn Executor, scene: &Arc<PreparedScene>) -> Result<Self> {
        let scene = device.upload(scene)?;
        Ok(Parity { device, scene, frame: None, only: None, results: Vec::new() })
    }

    /// Compares the launches of `kernel` by `stage` alone; the device builds no other program.
    pub fn only(self, stage: Stage, kernel: Kernel) -> Self {
        Parity { only: Some((stage, kernel)), ..self }
    }

    fn observes(&self, launch: &Launch) -> bool {
        self.only.is_none_or(|only| only == (launch.stage, launch.kernel))
    }
}

// Written so that NaN is wrong.
#[allow(clippy::neg_cmp_op_on_partial_ord)]
fn is_wrong(plane_pitch: usize, buffer: FrameBuffer, at: usize, a: u32, b: u32) -> bool {
    match buffer {
        FrameBuffer::Attributes if at / plane_pitch <= PLANE_GCOL_B as usize => {
            let (a, b) = (f32::from_bits(a), f32::from_bits(b));
            !((a - b).abs() <= FLOAT_TOLERANCE * (1.0 + a.abs()))
        }
        FrameBuffer::Color => a.to_le_bytes().iter().zip(b.to_le_bytes()).any(|(&x, y)| x.abs_diff(y) > 2),
        // A ray that grazes a cell's border may take another step.
        FrameBuffer::Counters => a.abs_diff(b) > 8 + a / 4,
        _ => true,
    }
}

impl Hook for Parity<'_> {
    fn begin(&mut self, _: &mut dyn Executor, frame: &FrameHandle) -> Result<()> {
        match &mut self.frame {
            Some(own) if own.sizes() == frame.sizes() => self.device.begin(own, frame.inputs()),
            own => {
                *own = None;
                *own = Some(self.device.allocate(frame.inputs(), frame.sizes())?);
                Ok(())
            }
        }
    }

    fn before(&mut self, twin: &mut dyn Executor, launch: &Launch) -> Result<()> {
        if !self.observes(launch) {
            return Ok(());
        }
        let own = self.frame.as_ref().ok_or(Error::ForeignHandle { what: "frame" })?;
        for buffer in FrameBuffer::ALL {
            let words = twin.read(launch.frame, buffer, 0..launch.frame.sizes().of(buffer))?;
            self.device.write(own, buffer, &words)?;
        }
        Ok(())
    }

    fn after(&mut self, twin: &mut dyn Executor, launch: &Launch) -> Result<()> {
        if !self.observes(launch) {
            return Ok(());
        }
        let own = self.frame.as_ref().ok_or(Error::ForeignHandle { what: "frame" })?;
        self.device.run(&Launch { scene: &self.scene, frame: own, ..*launch })?;
        let Launch { stage, kernel, .. } = *launch;
        let mut result = KernelParity { stage, kernel, words: 0, different: 0, wrong: 0, first: None };
        let plane_pitch = launch.frame.params().plane_pitch.max(1) as usize;
        for buffer in FrameBuffer::ALL {
            let all = 0..launch.frame.sizes().of(buffer);
            let expected = twin.read(launch.frame, buffer, all.clone())?;
            let actual = self.device.read(own, buffer, all)?;
            result.words += expected.len() as u64;
            for (at, (&a, &b)) in expected.iter().zip(&actual).enumerate() {
                if a != b {
                    result.different += 1;
                    result.wrong += u64::from(is_wrong(plane_pitch, buffer, at, a, b));
                    result.first = result.first.or(Some((buffer, at, a, b)));
                }
            }
        }
        match self.results.iter_mut().find(|r| (r.stage, r.kernel) == (stage, kernel)) {
            Some(sum) => {
                sum.words += result.words;
                sum.different += result.different;
                sum.wrong += result.wrong;
                sum.first = sum.first.or(result.first);
            }
            None => self.results.push(result),
        }
        Ok(())
    }
}
