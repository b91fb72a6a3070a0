// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far a picture is from its reference: PSNR, SSIM, FLIP, the difference picture, wrong attributes.
//!
//! Everything here gives the same numbers for any number of threads, works from 1x1 pixels up, and refuses pictures of
//! different sizes. Alpha never counts.

pub mod attributes;
pub mod difference;
pub mod flip;
#[cfg(test)]
mod known;
pub mod psnr;
pub mod ssim;

use serde::Serialize;

use crate::{Error, Result};
pub use attributes::{WrongPixels, wrong_pixels};
pub use difference::{CUSTOMARY_GAIN, difference_picture};
pub use flip::{Flip, flip, flip_map};
pub use psnr::{psnr, psnr_masked};
pub use ssim::ssim;

/// A borrowed picture of 8-bit sRGB pixels, row by row from the top; a word holds red in its lowest byte, then green,
/// blue and alpha.
#[derive(Clone, Copy, Debug)]
pub struct Rgb8<'a> {
    width: u32,
    height: u32,
    pixels: &'a [u32],
}

impl<'a> Rgb8<'a> {
    /// A view of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if a side is 0 or `pixels` has another length.
    pub fn new(width: u32, height: u32, pixels: &'a [u32]) -> Result<Self> {
        if width == 0 || height == 0 || pixels.len() as u64 != u64::from(width) * u64::from(height) {
            let message = format!("{} pixels for {width}x{height}; each side must be at least 1", pixels.len());
            return Err(Error::argument("picture", message));
        }
        Ok(Rgb8 { width, height, pixels })
    }

    /// Pixels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> &'a [u32] {
        self.pixels
    }

    /// The pixels of row `y`, which must be below the height.
    fn row(&self, y: usize) -> &'a [u32] {
        let width = self.width as usize;
        &self.pixels[y * width..(y + 1) * width]
    }

    /// An error that names both sizes unless they are equal.
    fn same_size(&self, test: Rgb8) -> Result<()> {
        if (self.width, self.height) == (test.width, test.height) {
            return Ok(());
        }
        let sizes = format!("{}x{} pixels, the test {}x{}", self.width, self.height, test.width, test.height);
        Err(Error::argument("picture sizes", format!("the reference has {sizes}; only pictures of one size compare")))
    }
}

/// The quality of a picture beside its reference. Its fields are the keys of the JSON reports.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// PSNR in dB over all pixels; none if the pictures are equal.
    pub psnr_db: Option<f64>,
    /// PSNR in dB over the interpolated pixels only; none if those are equal, absent or unknown.
    pub psnr_interpolated_db: Option<f64>,
    /// Mean SSIM of the luma, at most 1 (equal).
    pub ssim: f64,
    /// Mean FLIP error, 0 (equal) to 1.
    pub flip_mean: f64,
    /// The FLIP error that 99 % of the pixels do not exceed, 0 to 1.
    pub flip_p99: f64,
}

/// All measures of two pictures; which pixels were interpolated is unknown.
///
/// # Errors
/// [`Error::InvalidArgument`] if the sizes differ.
pub fn compare(reference: Rgb8, test: Rgb8) -> Result<Quality> {
    let flip = flip(reference, test)?;
    Ok(Quality {
        psnr_db: psnr(reference, test)?,
        psnr_interpolated_db: None,
        ssim: ssim(reference, test)?,
        flip_mean: flip.mean,
        flip_p99: flip.p99,
    })
}

/// All measures of two pictures, with the PSNR of the pixels that `interpolated` marks.
///
/// # Errors
/// [`Error::InvalidArgument`] if the sizes differ.
pub fn compare_interpolated(reference: Rgb8, test: Rgb8, interpolated: &[bool]) -> Result<Quality> {
    let psnr_interpolated_db = psnr_masked(reference, test, interpolated)?;
    Ok(Quality { psnr_interpolated_db, ..compare(reference, test)? })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn equal_pictures_are_perfect() {
        let picture = known::noise(30, 20, 1);
        let quality = compare(picture.view(), picture.view()).unwrap();
        let perfect = Quality { psnr_db: None, psnr_interpolated_db: None, ssim: 1.0, flip_mean: 0.0, flip_p99: 0.0 };
        assert_eq!(quality, perfect);
        let json = serde_json::to_string(&quality).unwrap();
        let keys = r#"{"psnr_db":null,"psnr_interpolated_db":null,"ssim":1.0,"flip_mean":0.0,"flip_p99":0.0}"#;
        assert_eq!(json, keys);
    }

    #[test]
    fn all_measures_are_those_of_their_modules() {
        known::for_each_pair(|pair, reference, test| {
            let quality = compare(reference, test).unwrap();
            assert!((quality.psnr_db.unwrap() - pair.psnr_db).abs() < 1e-9, "{}", pair.name);
            assert!((quality.ssim - pair.ssim).abs() < 1e-9, "{}", pair.name);
            assert!((quality.flip_mean - pair.flip_mean).abs() < 1e-5, "{}", pair.name);
            assert_eq!(quality.psnr_interpolated_db, None);
            let all = vec![true; reference.pixels().len()];
            let with_mask = compare_interpolated(reference, test, &all).unwrap();
            assert_eq!(with_mask, Quality { psnr_interpolated_db: quality.psnr_db, ..quality });
        });
    }

    #[test]
    fn every_small_size_works() {
        for (width, height) in [(1, 1), (1, 9), (9, 1), (2, 2), (11, 1), (4, 33), (12, 12)] {
            let (a, b) = (known::noise(width, height, 1), known::noise(width, height, 2));
            let quality = compare(a.view(), b.view()).unwrap();
            assert!(quality.psnr_db.unwrap() > 0.0 && quality.ssim < 1.0, "{width}x{height}: {quality:?}");
            assert!(quality.flip_mean > 0.0 && quality.flip_mean <= quality.flip_p99, "{width}x{height}: {quality:?}");
        }
    }

    #[test]
    fn pictures_of_two_sizes_are_refused_by_name() {
        // Equal counts of pixels: only the sides differ.
        let (a, b) = (known::noise(6, 4, 1), known::noise(4, 6, 1));
        let message = compare(a.view(), b.view()).unwrap_err().to_string();
        assert!(message.contains("6x4") && message.contains("4x6"), "{message}");
        assert!(compare_interpolated(a.view(), a.view(), &[true]).is_err());
    }

    #[test]
    fn views_check_their_pixels() {
        assert!(Rgb8::new(2, 2, &[0; 4]).is_ok());
        for (width, height, pixels) in
            [(2, 2, &[0; 3][..]), (2, 2, &[0; 5]), (0, 0, &[]), (0, 3, &[]), (u32::MAX, 2, &[])]
        {
            assert!(Rgb8::new(width, height, pixels).is_err(), "{width}x{height}");
        }
    }
}
