// SPDX-License-Identifier: MIT OR Apache-2.0
//! Device memory: typed buffers that count towards the context's memory.

use std::ffi::c_void;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

use bytemuck::Pod;
use opencl3::command_queue::{enqueue_copy_buffer, enqueue_fill_buffer, enqueue_read_buffer, enqueue_write_buffer};
use opencl3::memory::{CL_MEM_READ_WRITE, create_buffer};
use opencl3::types::CL_BLOCKING;

use super::codes;
use super::context::{Context, Shared};
use super::handle::Handle;
use crate::{Error, Result, memory};

/// Larger transfers go in parts, between which they can be cancelled.
const TRANSFER_BYTES: usize = 32 << 20;

/// Device memory for `len` values of type `T`. Released, and no longer counted, when dropped.
pub struct Buffer<T> {
    memory: Handle,
    shared: Arc<Shared>,
    label: &'static str,
    len: usize,
    bytes: u64,
    values: PhantomData<T>,
}

impl<T> Buffer<T> {
    /// The number of values.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no values. The device memory behind it still has room for one.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// What the buffer is for, as in error messages.
    pub fn label(&self) -> &'static str {
        self.label
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        self.shared.release(self.bytes);
    }
}

impl<T> std::fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Buffer `{}` of {} values, {} bytes", self.label, self.len, self.bytes)
    }
}

mod sealed {
    pub trait Sealed {}
    impl<T> Sealed for super::Buffer<T> {}
}

/// A [`Buffer`] of any type, as a kernel argument.
pub trait AnyBuffer: sealed::Sealed {
    /// The raw memory object, valid as long as `self` lives.
    #[doc(hidden)]
    fn raw(&self) -> *mut c_void;
    /// The size of the device memory, in bytes.
    fn bytes(&self) -> u64;
    /// Whether the buffer was made by this context.
    #[doc(hidden)]
    fn belongs_to(&self, context: &Context) -> bool;
}

impl<T> AnyBuffer for Buffer<T> {
    fn raw(&self) -> *mut c_void {
        self.memory.raw()
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn belongs_to(&self, context: &Context) -> bool {
        Arc::ptr_eq(&self.shared, &context.shared)
    }
}

impl Context {
    /// Allocates a buffer of `len` values; what it holds is undefined. A length of 0 allocates room for one.
    ///
    /// Fails with [`Error::LimitExceeded`] if the device (or the profile, or the memory budget) does not allow it.
    pub fn buffer<T: Pod>(&self, label: &'static str, len: usize) -> Result<Buffer<T>> {
        let what = format!("buffer `{label}`");
        let bytes = (len.max(1) as u64).saturating_mul(size_of::<T>().max(1) as u64);
        self.limits().check_alloc(&what, bytes)?;
        let size = usize::try_from(bytes).map_err(|_| Error::LimitExceeded {
            what: what.clone(),
            limit: "address space of this program".into(),
            wanted: format!("{bytes} bytes"),
            allowed: format!("{} bytes", usize::MAX),
            remedies: &[],
        })?;
        self.shared.reserve(&what, bytes)?;
        // SAFETY: the context is alive, and no host pointer is given.
        let memory = unsafe { create_buffer(self.shared.context.raw(), CL_MEM_READ_WRITE, size, std::ptr::null_mut()) };
        match memory {
            Ok(raw) => Ok(Buffer {
                memory: Handle::memory(raw),
                shared: self.shared.clone(),
                label,
                len,
                bytes,
                values: PhantomData,
            }),
            Err(code) => {
                self.shared.release(bytes);
                Err(codes::error(format!("clCreateBuffer for `{label}` ({bytes} bytes)"), code))
            }
        }
    }

    /// Allocates a buffer and fills it with `values`.
    pub fn buffer_from<T: Pod>(&self, label: &'static str, values: &[T]) -> Result<Buffer<T>> {
        let buffer = self.buffer(label, values.len())?;
        self.write(&buffer, 0, values)?;
        Ok(buffer)
    }

    /// Writes `values` into the buffer from index `start` on, and waits until they are there.
    pub fn write<T: Pod>(&self, buffer: &Buffer<T>, start: usize, values: &[T]) -> Result<()> {
        let offset = self.place("clEnqueueWriteBuffer", buffer, start, values.len())?;
        if values.is_empty() {
            return Ok(());
        }
        let all: &[u8] = bytemuck::cast_slice(values);
        for (number, bytes) in all.chunks(TRANSFER_BYTES).enumerate() {
            self.check_watch("clEnqueueWriteBuffer")?;
            // SAFETY: `place` checked that the range, of which `bytes` is a part, lies within the buffer; the call
            // blocks, so `bytes` outlives it.
            let event = unsafe {
                enqueue_write_buffer(
                    self.shared.queue.raw(),
                    buffer.memory.raw(),
                    CL_BLOCKING,
                    offset + number * TRANSFER_BYTES,
                    bytes.len(),
                    bytes.as_ptr().cast(),
                    0,
                    std::ptr::null(),
                )
            };
            self.done("clEnqueueWriteBuffer", buffer, event)?;
        }
        Ok(())
    }

    /// Reads the values of `range`, after everything enqueued before.
    pub fn read<T: Pod>(&self, buffer: &Buffer<T>, range: Range<usize>) -> Result<Vec<T>> {
        let count = range.end.saturating_sub(range.start);
        // Before the allocation, so that a wrong range is an error and not an exhausted memory.
        self.place("clEnqueueReadBuffer", buffer, range.start, count)?;
        let mut values = memory::filled("a copy of a buffer", count, T::zeroed())?;
        self.read_into(buffer, range.start, &mut values)?;
        Ok(values)
    }

    /// Reads as many values as `values` has from index `start` on, after everything enqueued before.
    pub fn read_into<T: Pod>(&self, buffer: &Buffer<T>, start: usize, values: &mut [T]) -> Result<()> {
        let offset = self.place("clEnqueueReadBuffer", buffer, start, values.len())?;
        if values.is_empty() {
            return Ok(());
        }
        let all: &mut [u8] = bytemuck::cast_slice_mut(values);
        for (number, bytes) in all.chunks_mut(TRANSFER_BYTES).enumerate() {
            self.check_watch("clEnqueueReadBuffer")?;
            // SAFETY: `place` checked that the range, of which `bytes` is a part, lies within the buffer; the call
            // blocks, so `bytes` outlives it.
            let event = unsafe {
                enqueue_read_buffer(
                    self.shared.queue.raw(),
                    buffer.memory.raw(),
                    CL_BLOCKING,
                    offset + number * TRANSFER_BYTES,
                    bytes.len(),
                    bytes.as_mut_ptr().cast(),
                    0,
                    std::ptr::null(),
                )
            };
            self.done("clEnqueueReadBuffer", buffer, event)?;
        }
        Ok(())
    }

    /// Sets every byte of the buffer to 0, in order with launches.
    pub fn fill_zero<T: Pod>(&self, buffer: &Buffer<T>) -> Result<()> {
        if buffer.bytes.is_multiple_of(4) { self.fill(buffer, 0) } else { self.fill_pattern(buffer, &[0u8]) }
    }

    /// Sets every 32-bit word of the buffer to `word`, in order with launches. The buffer's size must be a multiple of
    /// four bytes.
    pub fn fill<T: Pod>(&self, buffer: &Buffer<T>, word: u32) -> Result<()> {
        if !buffer.bytes.is_multiple_of(4) {
            return Err(codes::error(format!("clEnqueueFillBuffer for `{}`", buffer.label), codes::INVALID_VALUE));
        }
        self.fill_pattern(buffer, &word.to_ne_bytes())
    }

    fn fill_pattern<T: Pod>(&self, buffer: &Buffer<T>, pattern: &[u8]) -> Result<()> {
        self.place("clEnqueueFillBuffer", buffer, 0, 0)?;
        let size = usize::try_from(buffer.bytes).unwrap_or(usize::MAX);
        // SAFETY: offset and size are multiples of the pattern's length and lie within the buffer; the standard says
        // that the pattern is copied before the call returns.
        let event = unsafe {
            enqueue_fill_buffer(
                self.shared.queue.raw(),
                buffer.memory.raw(),
                pattern.as_ptr().cast(),
                pattern.len(),
                0,
                size,
                0,
                std::ptr::null(),
            )
        };
        self.done("clEnqueueFillBuffer", buffer, event)
    }

    /// Copies all of `from` to the start of `to`, in order with launches.
    pub fn copy<T: Pod>(&self, from: &Buffer<T>, to: &Buffer<T>) -> Result<()> {
        self.place("clEnqueueCopyBuffer", to, 0, from.len)?;
        self.place("clEnqueueCopyBuffer", from, 0, from.len)?;
        if from.is_empty() {
            return Ok(());
        }
        let size = usize::try_from(from.bytes).unwrap_or(usize::MAX);
        // SAFETY: both ranges were checked; the device refuses overlapping ones.
        let event = unsafe {
            enqueue_copy_buffer(
                self.shared.queue.raw(),
                from.memory.raw(),
                to.memory.raw(),
                0,
                0,
                size,
                0,
                std::ptr::null(),
            )
        };
        self.done("clEnqueueCopyBuffer", to, event)
    }

    /// The offset in bytes of `start`, if `count` values from there lie within the buffer and it is this context's.
    fn place<T>(&self, call: &str, buffer: &Buffer<T>, start: usize, count: usize) -> Result<usize> {
        if !buffer.belongs_to(self) {
            return Err(codes::error(format!("{call} for `{}`", buffer.label), codes::INVALID_CONTEXT));
        }
        match start.checked_add(count) {
            // Within the buffer, whose size in bytes fits `usize`.
            Some(end) if end <= buffer.len => Ok(start * size_of::<T>()),
            _ => Err(codes::error(
                format!(
                    "{call} of values {start}..{} of the {} of `{}`",
                    start.saturating_add(count),
                    buffer.len,
                    buffer.label
                ),
                codes::INVALID_VALUE,
            )),
        }
    }

    /// Releases the event of a transfer and maps its error.
    fn done<T>(&self, call: &str, buffer: &Buffer<T>, event: std::result::Result<*mut c_void, i32>) -> Result<()> {
        match event {
            Ok(event) => {
                drop(Handle::event(event));
                Ok(())
            }
            Err(code) => Err(codes::error(format!("{call} for `{}`", buffer.label), code)),
        }
    }
}
