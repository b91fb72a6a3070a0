// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a frame may be asked for.

mod checks;
mod correction;
mod preset;
mod steps;

pub use checks::{Checks, GcolSpace, Test, TestSet, TextureRule, Tolerances};
pub use correction::{Compared, Correction, Spread};
pub use preset::{Interpolation, Method, Preset};

use crate::error::{Error, Result, Setting};
use crate::method::camera::{MAX_SAMPLE_SIDE, MAX_SIDE};
use crate::names::named;

/// Which pixels get rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// Every pixel.
    Full,
    /// The method: base pixels, and those whose checks fail.
    #[default]
    Adaptive,
}

named!(Mode of Mode { Full = "full", Adaptive = "adaptive" });

/// Most secondary rays that a chain may be allowed.
pub const MAX_DEPTH: u32 = 64;

/// Everything that decides how a frame is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels, 1 to [`MAX_SIDE`].
    pub width: u32,
    /// Height in pixels, likewise.
    pub height: u32,
    /// Samples per pixel and axis: 1, 2 or 4. The method works on the grid of samples; pixels are means of theirs.
    pub samples: u32,
    /// Which pixels get rays.
    pub mode: Mode,
    /// Most secondary rays in a chain, 0 to [`MAX_DEPTH`]; straight ones through panes of thin glass do not count.
    pub depth: u32,
    /// How adaptive frames are drawn.
    pub method: Method,
    /// For tests: most rows of samples that are in device memory at once; `None`: as many as the budget allows. The
    /// picture does not depend on it.
    #[doc(hidden)]
    pub band_rows: Option<u32>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions {
            width: 1024,
            height: 1024,
            samples: 1,
            mode: Mode::default(),
            depth: 4,
            method: Method::default(),
            band_rows: None,
        }
    }
}

impl RenderOptions {
    /// Width and height of the frame in samples.
    pub fn sample_size(&self) -> (u32, u32) {
        (self.width.saturating_mul(self.samples), self.height.saturating_mul(self.samples))
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] with the setting, its value and the range.
    pub fn validate(&self) -> Result<()> {
        let size = format!("{}x{}", self.width, self.height);
        if !(1..=MAX_SIDE).contains(&self.width) || !(1..=MAX_SIDE).contains(&self.height) {
            return Err(Error::option(Setting::Size, size, format!("1 to {MAX_SIDE} pixels each way")));
        }
        if !matches!(self.samples, 1 | 2 | 4) {
            return Err(Error::option(Setting::Samples, self.samples, "1, 2 or 4"));
        }
        let (width, height) = self.sample_size();
        if width > MAX_SAMPLE_SIDE || height > MAX_SAMPLE_SIDE {
            let most = MAX_SAMPLE_SIDE / self.width.max(self.height);
            return Err(Error::option(Setting::Samples, self.samples, format!("1 to {most} for {size} pixels")));
        }
        if self.depth > MAX_DEPTH {
            return Err(Error::option(Setting::Depth, self.depth, format!("0 to {MAX_DEPTH}")));
        }
        self.method.validate()
    }
}
