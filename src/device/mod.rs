// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where kernels run: the kernels and stages, the CPU twin, OpenCL devices and their profiles, hooks on launches.

pub mod bounds;
pub mod cpu;
mod device_choice;
pub mod executor;
pub mod frame_memory;
pub mod hooks;
pub mod kernels;
pub mod launch;
pub mod launch_check;
pub mod open;
pub mod opencl;
pub mod profiles;
mod queries;
pub mod queue;
pub mod stage;
pub mod twin;
