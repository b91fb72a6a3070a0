// SPDX-License-Identifier: MIT OR Apache-2.0
//! A back end that runs every launch twice, on the CPU twin and on a device fed the twin's own inputs, and compares all
//! buffers word by word. The pipeline drives it like any other.

use crate::device::backend::{Backend, BackendInfo, BufferSizes, FrameBuffer, MemoryLimits};
use crate::device::stage::{Kernel, Stage};
use crate::device::twin::executor::TwinBackend;
use crate::error::Result;
use crate::layout::{FrameParams, PLANE_GCOL_B, StepParams, Traversal};
use crate::monitor::Monitor;

/// All buffers of a frame.
const BUFFERS: [FrameBuffer; 6] = [
    FrameBuffer::Attributes,
    FrameBuffer::Counters,
    FrameBuffer::Color,
    FrameBuffer::List,
    FrameBuffer::Masks,
    FrameBuffer::Sums,
];

/// How far a float may be off, absolutely and relatively, before it counts as wrong on a device that rounds otherwise.
const FLOAT_TOLERANCE: f32 = 2.0e-3;

/// What a kernel's launches by one stage came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KernelParity {
    /// The stage.
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

/// Runs kernels on the twin and on `device`, and compares.
pub struct ParityBackend<'a> {
    twin: TwinBackend,
    device: &'a mut dyn Backend,
    sizes: Option<BufferSizes>,
    pitch: usize,
    only: Option<(Stage, Kernel)>,
    as_the_device_likes: bool,
    /// Results so far, one per stage and kernel that were launched, in order of first launch.
    pub results: Vec<KernelParity>,
}

impl<'a> ParityBackend<'a> {
    /// Compares `device` with `twin`; both must hold the same scene. The twin walks as the device does.
    pub fn new(mut twin: TwinBackend, device: &'a mut dyn Backend) -> Self {
        twin.walk_by(device.traversal());
        ParityBackend {
            twin,
            device,
            sizes: None,
            pitch: 1,
            only: None,
            as_the_device_likes: false,
            results: Vec::new(),
        }
    }

    /// Compares the launches of `kernel` by `stage` alone; the twin alone runs the others, and the device builds no other
    /// program.
    pub fn only(self, stage: Stage, kernel: Kernel) -> Self {
        ParityBackend { only: Some((stage, kernel)), ..self }
    }

    /// Leaves out `correct_tail` where the device's own frames do, so that it is not compiled for the comparison.
    pub fn as_the_device_likes(self) -> Self {
        ParityBackend { as_the_device_likes: true, ..self }
    }

    fn size(&self, buffer: FrameBuffer) -> usize {
        self.sizes.map_or(0, |s| match buffer {
            FrameBuffer::Attributes => s.attributes,
            FrameBuffer::Counters => s.counters,
            FrameBuffer::Color => s.color,
            FrameBuffer::List => s.list,
            FrameBuffer::Masks => s.masks,
            FrameBuffer::Sums => s.sums,
        })
    }

    // Written so that NaN is wrong.
    #[allow(clippy::neg_cmp_op_on_partial_ord)]
    fn is_wrong(&self, buffer: FrameBuffer, at: usize, a: u32, b: u32) -> bool {
        match buffer {
            FrameBuffer::Attributes if at / self.pitch <= PLANE_GCOL_B as usize => {
                let (a, b) = (f32::from_bits(a), f32::from_bits(b));
                !((a - b).abs() <= FLOAT_TOLERANCE * (1.0 + a.abs()))
            }
            FrameBuffer::Color => a.to_le_bytes().iter().zip(b.to_le_bytes()).any(|(&x, y)| x.abs_diff(y) > 2),
            // A ray that grazes a cell's border may take another step.
            FrameBuffer::Counters => a.abs_diff(b) > 8 + a / 4,
            _ => true,
        }
    }
}

impl Backend for ParityBackend<'_> {
    fn info(&self) -> BackendInfo {
        self.device.info()
    }

    fn scan_group(&self) -> u32 {
        self.device.scan_group()
    }

    fn memory_limits(&self) -> MemoryLimits {
        self.device.memory_limits()
    }

    fn prefers_few_launches(&self) -> bool {
        !self.as_the_device_likes || self.device.prefers_few_launches()
    }

    fn traversal(&self) -> Traversal {
        self.device.traversal()
    }

    fn begin(&mut self, frame: &FrameParams, sizes: &BufferSizes) -> Result<()> {
        self.sizes = Some(*sizes);
        self.pitch = frame.plane_pitch as usize;
        self.twin.begin(frame, sizes)?;
        self.device.begin(frame, sizes)
    }

    fn run(&mut self, stage: Stage, kernel: Kernel, step: &StepParams) -> Result<()> {
        if self.only.is_some_and(|only| only != (stage, kernel)) {
            return self.twin.run(stage, kernel, step);
        }
        for buffer in BUFFERS {
            let words = self.twin.read(buffer, 0..self.size(buffer))?;
            self.device.write(buffer, &words)?;
        }
        self.twin.run(stage, kernel, step)?;
        self.device.run(stage, kernel, step)?;
        let mut result = KernelParity { stage, kernel, words: 0, different: 0, wrong: 0, first: None };
        for buffer in BUFFERS {
            let expected = self.twin.read(buffer, 0..self.size(buffer))?;
            let actual = self.device.read(buffer, 0..self.size(buffer))?;
            result.words += expected.len() as u64;
            for (at, (&a, &b)) in expected.iter().zip(&actual).enumerate() {
                if a != b {
                    result.different += 1;
                    result.wrong += u64::from(self.is_wrong(buffer, at, a, b));
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

    fn read_sum(&mut self, at: u32) -> Result<u32> {
        self.twin.read_sum(at)
    }

    fn read(&mut self, buffer: FrameBuffer, range: std::ops::Range<usize>) -> Result<Vec<u32>> {
        self.twin.read(buffer, range)
    }

    fn write(&mut self, buffer: FrameBuffer, words: &[u32]) -> Result<()> {
        self.twin.write(buffer, words)
    }

    fn take_timings(&mut self) -> Result<Vec<(Stage, f64)>> {
        self.device.take_timings()
    }

    fn watch(&mut self, monitor: &Monitor) {
        self.device.watch(monitor);
    }

    fn monitor(&self) -> &Monitor {
        self.device.monitor()
    }

    fn peak_bytes(&self) -> u64 {
        self.device.peak_bytes()
    }
}
