// SPDX-License-Identifier: MIT OR Apache-2.0
//! Android's Bitmap and Surface as targets: what locks and unlocks them. What is copied, and how, is in `picture.rs`.

use std::mem::MaybeUninit;

use jni::Env;
use jni::objects::JObject;
use ndk::bitmap::{Bitmap, BitmapFormat};
use ndk::hardware_buffer_format::HardwareBufferFormat;
use ndk::native_window::NativeWindow;

use crate::failure::Failure;
use crate::picture::{Canvas, Format, Target, canvas_bytes};

fn lost(what: &str) -> Failure {
    Failure::Target(what.to_owned())
}

/// A `Bitmap`, for the duration of a native method that was given it.
pub struct BitmapTarget {
    bitmap: Bitmap,
}

impl BitmapTarget {
    /// The Bitmap `object`, which must not be null.
    ///
    /// # Errors
    /// A null object.
    pub fn new(env: &Env<'_>, object: &JObject<'_>) -> Result<Self, Failure> {
        if object.is_null() {
            return Err(jni::errors::Error::NullPtr("bitmap").into());
        }
        // SAFETY: the environment is this thread's, and the reference is alive as long as the native method runs, which
        // this value does not outlive. `ndk` and `jni` name one C type by two versions of its Rust binding.
        let bitmap = unsafe { Bitmap::from_jni(env.get_raw().cast(), object.as_raw().cast()) };
        Ok(BitmapTarget { bitmap })
    }

    /// Width and height in pixels.
    ///
    /// # Errors
    /// An object that is no Bitmap, or one that was recycled.
    pub fn size(&self) -> Result<(u32, u32), Failure> {
        let info = self.bitmap.info().map_err(|error| lost(&format!("the Bitmap cannot be read: {error}")))?;
        Ok((info.width(), info.height()))
    }
}

/// Unlocks a Bitmap when it goes.
struct BitmapLock<'a>(&'a Bitmap);

impl Drop for BitmapLock<'_> {
    fn drop(&mut self) {
        if let Err(error) = self.0.unlock_pixels() {
            log::warn!("a Bitmap could not be unlocked: {error}");
        }
    }
}

impl Target for BitmapTarget {
    fn with_canvas(&mut self, draw: &mut dyn FnMut(&mut Canvas<'_>) -> Result<(), Failure>) -> Result<(), Failure> {
        let info = self.bitmap.info().map_err(|error| lost(&format!("the Bitmap cannot be read: {error}")))?;
        let format = match info.format() {
            BitmapFormat::RGBA_8888 => Format::Rgba8888,
            BitmapFormat::RGB_565 => Format::Rgb565,
            other => return Err(lost(&format!("a Bitmap must be ARGB_8888 or RGB_565, this one is {other:?}"))),
        };
        let (width, height, stride_bytes) = (info.width() as usize, info.height() as usize, info.stride() as usize);
        let length = canvas_bytes(width, height, stride_bytes, format)
            .ok_or_else(|| lost("the Bitmap's rows overlap: is it one that the GPU holds?"))?;
        let address =
            self.bitmap.lock_pixels().map_err(|error| lost(&format!("the Bitmap cannot be locked: {error}")))?;
        let _lock = BitmapLock(&self.bitmap);
        if address.is_null() {
            return Err(lost("the Bitmap has no memory"));
        }
        // SAFETY: a locked Bitmap's memory has its height times its stride, does not move until it is unlocked, which
        // happens after `bytes` is gone, and is initialised. Nobody of Rust has another reference to it.
        let bytes = unsafe { std::slice::from_raw_parts_mut(address.cast::<u8>(), length) };
        draw(&mut Canvas { width, height, stride_bytes, format, bytes })
    }
}

/// A `Surface`. It is held, so that Android does not free it while a frame is drawn; that it may be taken from the screen
/// at any time makes locking it an error, not a crash.
pub struct SurfaceTarget {
    window: NativeWindow,
    size: (u32, u32),
}

impl SurfaceTarget {
    /// The Surface `object`.
    ///
    /// # Errors
    /// A null object; a Surface that was released.
    pub fn new(env: &Env<'_>, object: &JObject<'_>) -> Result<Self, Failure> {
        if object.is_null() {
            return Err(jni::errors::Error::NullPtr("surface").into());
        }
        // SAFETY: the environment is this thread's and the reference is alive; Java passes nothing but Surfaces.
        let window = unsafe { NativeWindow::from_surface(env.get_raw().cast(), object.as_raw().cast()) };
        let window = window.ok_or_else(|| lost("the Surface was released"))?;
        let side = |length: i32| u32::try_from(length).unwrap_or(0);
        let size = (side(window.width()), side(window.height()));
        Ok(SurfaceTarget { window, size })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// From here on its buffers have this size, which Android scales to the Surface's.
    ///
    /// # Errors
    /// A Surface that is lost.
    pub fn set_size(&mut self, width: u32, height: u32) -> Result<(), Failure> {
        use HardwareBufferFormat::{R5G6B5_UNORM, R8G8B8A8_UNORM, R8G8B8X8_UNORM};
        let format = match self.window.format() {
            format @ (R8G8B8A8_UNORM | R8G8B8X8_UNORM | R5G6B5_UNORM) => format,
            _ => R8G8B8A8_UNORM,
        };
        self.window
            .set_buffers_geometry(width as i32, height as i32, Some(format))
            .map_err(|error| lost(&format!("the Surface does not take pictures of {width}x{height}: {error}")))
    }
}

/// Unlocks and shows a window's buffer when it goes. `ndk`'s own guard panics where a window was lost meanwhile.
struct WindowLock<'a>(&'a NativeWindow);

impl Drop for WindowLock<'_> {
    fn drop(&mut self) {
        // SAFETY: the window is alive and this thread has locked it, once.
        let status = unsafe { ndk_sys::ANativeWindow_unlockAndPost(self.0.ptr().as_ptr()) };
        if status != 0 {
            log::warn!("a Surface was lost before its picture could be shown ({status})");
        }
    }
}

impl Target for SurfaceTarget {
    fn with_canvas(&mut self, draw: &mut dyn FnMut(&mut Canvas<'_>) -> Result<(), Failure>) -> Result<(), Failure> {
        let mut buffer = MaybeUninit::<ndk_sys::ANativeWindow_Buffer>::uninit();
        // SAFETY: the window is alive, the buffer is there to be written, and no part of it was named as changed.
        let status = unsafe {
            ndk_sys::ANativeWindow_lock(self.window.ptr().as_ptr(), buffer.as_mut_ptr(), std::ptr::null_mut())
        };
        if status != 0 {
            return Err(lost(&format!(
                "the Surface cannot be locked ({status}): it was lost, or another thread draws into it"
            )));
        }
        let _lock = WindowLock(&self.window);
        // SAFETY: locking succeeded, which fills the buffer.
        let buffer = unsafe { buffer.assume_init() };
        let format = match HardwareBufferFormat::from(buffer.format) {
            HardwareBufferFormat::R8G8B8A8_UNORM => Format::Rgba8888,
            HardwareBufferFormat::R8G8B8X8_UNORM => Format::Rgbx8888,
            HardwareBufferFormat::R5G6B5_UNORM => Format::Rgb565,
            other => {
                return Err(lost(&format!("the Surface's format {other:?} is none of RGBA_8888, RGBX_8888, RGB_565")));
            }
        };
        let side = |length: i32| usize::try_from(length).unwrap_or(0);
        let (width, height) = (side(buffer.width), side(buffer.height));
        let stride_bytes = side(buffer.stride).saturating_mul(format.bytes());
        let length = canvas_bytes(width, height, stride_bytes, format)
            .filter(|_| !buffer.bits.is_null())
            .ok_or_else(|| lost("the Surface's buffer has no memory"))?;
        // SAFETY: a locked buffer has its height times its stride in pixels of its format, stays until it is unlocked,
        // which happens after `bytes` is gone, and is memory of a graphics driver, for which no value is invalid.
        let bytes = unsafe { std::slice::from_raw_parts_mut(buffer.bits.cast::<u8>(), length) };
        draw(&mut Canvas { width, height, stride_bytes, format, bytes })
    }
}
