// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where kernels run: the kernels and stages, the CPU twin, OpenCL devices and their profiles, hooks on launches.

pub mod backend;
pub mod hooks;
pub mod kernels;
pub mod launch_check;
pub mod opencl;
pub mod profiles;
pub mod stage;
pub mod twin;
