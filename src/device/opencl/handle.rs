// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ownership of one OpenCL object.

use std::ffi::c_void;

/// An OpenCL object that is released when dropped.
///
/// A failing release is logged, not raised: after a device was lost every release fails, and a panic in `drop` would
/// take the app down with it.
pub(crate) struct Handle {
    raw: *mut c_void,
    release: unsafe fn(*mut c_void) -> std::result::Result<(), i32>,
    call: &'static str,
}

// SAFETY: OpenCL 1.2 (appendix A.2) makes all calls thread-safe except `clSetKernelArg`, and the context sets kernel
// arguments only under its lock.
unsafe impl Send for Handle {}
// SAFETY: as above.
unsafe impl Sync for Handle {}

impl Handle {
    /// A context from `clCreateContext`, which the caller gives away.
    pub fn context(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::context::context::release_context, call: "clReleaseContext" }
    }

    /// A queue from `clCreateCommandQueue`, which the caller gives away.
    pub fn queue(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::command_queue::release_command_queue, call: "clReleaseCommandQueue" }
    }

    /// A memory object from `clCreateBuffer`, which the caller gives away.
    pub fn memory(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::memory::release_mem_object, call: "clReleaseMemObject" }
    }

    /// A program from `clCreateProgramWith...`, which the caller gives away.
    pub fn program(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::program::release_program, call: "clReleaseProgram" }
    }

    /// A kernel from `clCreateKernel`, which the caller gives away.
    pub fn kernel(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::kernel::release_kernel, call: "clReleaseKernel" }
    }

    /// An event from an enqueue, which the caller gives away.
    pub fn event(raw: *mut c_void) -> Self {
        Handle { raw, release: opencl3::event::release_event, call: "clReleaseEvent" }
    }

    /// The raw object, valid as long as `self` lives.
    pub fn raw(&self) -> *mut c_void {
        self.raw
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        if self.raw.is_null() {
            return;
        }
        // SAFETY: `raw` came from the matching create call, was owned by `self` alone, and is not used after this.
        if let Err(code) = unsafe { (self.release)(self.raw) } {
            log::warn!("{} failed: {} ({code})", self.call, super::codes::name(code));
        }
    }
}
