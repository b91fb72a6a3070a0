// SPDX-License-Identifier: MIT OR Apache-2.0
//! Launching kernels: every limit is checked before anything is enqueued, then the launch goes out slice by slice.

use std::ffi::c_void;

use opencl3::command_queue::{enqueue_nd_range_kernel, flush};
use opencl3::kernel::set_kernel_arg;

use super::buffer::AnyBuffer;
use super::codes::{self, check};
use super::context::{Context, State, lock};
use super::handle::Handle;
use super::program::Kernel;
use super::slices::Slicer;
use super::timing::Wait;
use crate::Result;

/// One kernel argument.
#[derive(Clone, Copy)]
pub enum Arg<'a> {
    /// A pointer to global memory, or to constant memory where the kernel's source says so.
    Buffer(&'a dyn AnyBuffer),
    /// A scalar or struct by value: its bytes.
    Value(&'a [u8]),
    /// A pointer to this many bytes of local memory.
    Local(usize),
}

impl<'a> Arg<'a> {
    /// A by-value argument.
    pub fn value<T: bytemuck::Pod>(value: &'a T) -> Self {
        Arg::Value(bytemuck::bytes_of(value))
    }
}

/// One launch of a kernel.
pub struct DeviceLaunch<'a> {
    /// The stage and the kernel: the label of its time, its slices and its errors.
    pub label: &'static str,
    /// What runs.
    pub kernel: &'a Kernel,
    /// Its arguments, in order.
    pub args: &'a [Arg<'a>],
    /// Work-items along x and y. With `local`, rounded up to whole work-groups: kernels must skip the surplus.
    pub global: [usize; 2],
    /// The shape of a work-group; `None`: the device's choice, and `global` is exact.
    pub local: Option<[usize; 2]>,
    /// Whether the kernel waits at barriers: such kernels may have to run in smaller work-groups.
    pub barrier: bool,
}

impl Context {
    /// The largest work-group for `kernel` within all limits that one gets from `wanted` by halving sides.
    pub fn fit_work_group(&self, kernel: &Kernel, wanted: [usize; 2], barrier: bool) -> [usize; 2] {
        self.limits().fit_work_group(wanted, kernel.work_group_size(), barrier)
    }

    /// Enqueues a launch, cut into slices, and returns without waiting for its end. The first slice of a stage is waited
    /// for and measured, and no more than about one slice lies in the queue when another one is added.
    ///
    /// Kernels find their place by `get_global_id`, which includes a slice's offset; `get_group_id` and
    /// `get_global_size` are those of the slice.
    pub fn launch(&self, launch: &DeviceLaunch) -> Result<()> {
        let label = launch.label;
        if launch.global.contains(&0) {
            // Some drivers end the process where OpenCL asks for an error.
            return Ok(());
        }
        let plan = self.plan(launch)?;
        let mut slicer = Slicer::new(plan.groups, plan.step);
        let local = plan.local.map(|[width, height]| [width, height, 1]);
        // PoCL compiles a kernel once for launches that begin at zero and once for others: with an offset along an axis
        // that no kernel looks at, the first slice is like the others, and kernels are compiled once.
        let aside = usize::from(self.is_cpu());
        // It also compiles a kernel anew for launches that are wider than 16 bits count.
        let most = if self.is_cpu() { u64::from(u16::MAX) } else { u64::MAX };
        let state = &mut *lock(&self.state);
        state.timing.harvest(&mut state.planner, Wait::No)?;
        set_args(launch)?;
        while let Some(slice) = slicer.next(state.planner.items(label).min(most)) {
            let queued_ms = state.planner.queued_ms();
            state.timing.harvest(&mut state.planner, Wait::UntilBelow(queued_ms))?;
            state.check_monitor()?;
            state.enqueues += 1;
            if let Some(code) = self.strike(state) {
                return Err(codes::error(format!("clEnqueueNDRangeKernel of `{label}`"), code));
            }
            let offset = [slice.offset[0], slice.offset[1], aside];
            let size = [slice.size[0], slice.size[1], 1];
            // SAFETY: all arguments are set to live objects of this context and stay alive until the call has retained
            // them; the arrays have the three entries that the dimension says. What the kernel does within its buffers is
            // the kernel's: its source is part of this crate.
            let event = unsafe {
                enqueue_nd_range_kernel(
                    self.shared.queue.raw(),
                    launch.kernel.raw(),
                    3,
                    offset.as_ptr(),
                    size.as_ptr(),
                    local.as_ref().map_or(std::ptr::null(), |local| local.as_ptr()),
                    0,
                    std::ptr::null(),
                )
            };
            let event = Handle::event(check_launch(label, event)?);
            let divisible = slice.size[0] > plan.step[0] || slice.size[1] > plan.step[1];
            let expected_ms = state.planner.expected_ms(label, slice.items());
            state.timing.push(label, event, slice.items(), divisible, expected_ms);
            check("clFlush", flush(self.shared.queue.raw()))?;
            let measure = if state.planner.wants_measure(label) { Wait::ForAll } else { Wait::No };
            state.timing.harvest(&mut state.planner, measure)?;
            state.monitor.tell(slicer.share_cut());
        }
        Ok(())
    }

    /// The status that an enqueue fails with, if the device is lost or a fault is due.
    fn strike(&self, state: &mut State) -> Option<i32> {
        if state.lost {
            return Some(codes::INVALID_COMMAND_QUEUE);
        }
        let code = self.faults().strike();
        state.lost = code.is_some();
        code
    }

    /// Checks every limit and works out the launch in work-groups.
    fn plan(&self, launch: &DeviceLaunch) -> Result<Plan> {
        let label = launch.label;
        let what = format!("stage `{label}`");
        let limits = self.limits();
        let kernel = launch.kernel;
        if !kernel.belongs_to(self) {
            return Err(codes::error(format!("clEnqueueNDRangeKernel of `{label}`"), codes::INVALID_CONTEXT));
        }
        if launch.args.len() != kernel.arguments() {
            let call = format!(
                "clEnqueueNDRangeKernel of `{label}` with {} of {} arguments",
                launch.args.len(),
                kernel.arguments()
            );
            return Err(codes::error(call, codes::INVALID_KERNEL_ARGS));
        }
        let pointer_bytes = limits.address_bits / 8;
        let mut parameter_bytes = 0u64;
        let mut local_bytes = kernel.local_mem_bytes();
        let mut constants = Vec::new();
        for (index, arg) in launch.args.iter().enumerate() {
            parameter_bytes = parameter_bytes.saturating_add(match arg {
                Arg::Value(bytes) => bytes.len() as u64,
                Arg::Buffer(_) | Arg::Local(_) => pointer_bytes,
            });
            match arg {
                Arg::Buffer(buffer) if !buffer.belongs_to(self) => {
                    return Err(codes::error(format!("clSetKernelArg {index} of `{label}`"), codes::INVALID_CONTEXT));
                }
                Arg::Buffer(buffer) if kernel.is_constant(index) => constants.push(buffer.bytes()),
                Arg::Local(bytes) => local_bytes = local_bytes.saturating_add(*bytes as u64),
                _ => {}
            }
        }
        limits.check_parameters(&what, parameter_bytes)?;
        limits.check_local_memory(&what, local_bytes)?;
        limits.check_constants(&what, &constants)?;
        let cap = kernel.work_group_size();
        // Without a shape the device chooses; under a profile it might choose what the phone does not have.
        let local = launch.local.or_else(|| {
            let widest = limits.fit_work_group([64, 1], cap, launch.barrier)[0].min(launch.global[0]);
            self.profile_name()
                .map(|_| [(1..=widest).rev().find(|n| launch.global[0].is_multiple_of(*n)).unwrap_or(1), 1])
        });
        if let Some(local) = local {
            if local.contains(&0) {
                return Err(codes::error(format!("clEnqueueNDRangeKernel of `{label}`"), WORK_GROUP_SIZE));
            }
            limits.check_work_group(&what, local, cap, launch.barrier)?;
        }
        let step = local.unwrap_or([1, 1]);
        let mut groups = [0; 2];
        for axis in 0..2 {
            groups[axis] = launch.global[axis].div_ceil(step[axis]);
            let items = (groups[axis] as u64).saturating_mul(step[axis] as u64);
            limits.check_global(&what, items)?;
        }
        Ok(Plan { local, step, groups })
    }
}

/// `CL_INVALID_WORK_GROUP_SIZE`.
const WORK_GROUP_SIZE: i32 = -54;

struct Plan {
    local: Option<[usize; 2]>,
    /// The unit of slices: a work-group, or a work-item if the device chooses.
    step: [usize; 2],
    groups: [usize; 2],
}

fn set_args(launch: &DeviceLaunch) -> Result<()> {
    for (index, arg) in launch.args.iter().enumerate() {
        let raw;
        let (size, pointer): (usize, *const c_void) = match arg {
            Arg::Buffer(buffer) => {
                raw = buffer.raw();
                (size_of::<*mut c_void>(), (&raw const raw).cast())
            }
            Arg::Value(bytes) => (bytes.len(), bytes.as_ptr().cast()),
            Arg::Local(bytes) => (*bytes, std::ptr::null()),
        };
        let number = u32::try_from(index).unwrap_or(u32::MAX);
        // SAFETY: the pointer is to `size` readable bytes (or null for local memory) that the call copies; the caller
        // holds the context's lock, so that no other thread sets arguments of this kernel.
        let set = unsafe { set_kernel_arg(launch.kernel.raw(), number, size, pointer) };
        set.map_err(|code| codes::error(format!("clSetKernelArg {index} of `{}`", launch.label), code))?;
    }
    Ok(())
}

fn check_launch<T>(label: &str, result: std::result::Result<T, i32>) -> Result<T> {
    result.map_err(|code| codes::error(format!("clEnqueueNDRangeKernel of `{label}`"), code))
}
