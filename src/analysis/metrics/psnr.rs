// SPDX-License-Identifier: MIT OR Apache-2.0
//! Peak signal-to-noise ratio.

use super::Rgb8;
use crate::{Error, Result};

/// PSNR in dB: on 8-bit sRGB values, the squared errors of the three channels pooled, peak 255.
///
/// `None` if the pictures are equal (the ratio is infinite). Alpha does not count. The sum is exact in integers, so the
/// result is the same everywhere.
///
/// # Errors
/// [`Error::InvalidArgument`] if the sizes differ.
pub fn psnr(reference: Rgb8, test: Rgb8) -> Result<Option<f64>> {
    reference.same_size(test)?;
    let pairs = reference.pixels().iter().zip(test.pixels());
    Ok(decibels(pairs.map(|(&a, &b)| squared_error(a, b)).sum(), reference.pixels().len()))
}

/// PSNR in dB over the pixels where `mask` is true, such as the interpolated ones.
///
/// `None` if those pixels are equal, or if there are none.
///
/// # Errors
/// [`Error::InvalidArgument`] if the sizes differ.
pub fn psnr_masked(reference: Rgb8, test: Rgb8, mask: &[bool]) -> Result<Option<f64>> {
    reference.same_size(test)?;
    let count = reference.pixels().len();
    if mask.len() != count {
        return Err(Error::argument("mask", format!("{} values for pictures of {count} pixels", mask.len())));
    }
    let (mut sum, mut chosen) = (0u64, 0usize);
    for ((&a, &b), _) in reference.pixels().iter().zip(test.pixels()).zip(mask).filter(|&(_, &m)| m) {
        sum += squared_error(a, b);
        chosen += 1;
    }
    Ok(decibels(sum, chosen))
}

/// The squared difference of two pixels, summed over red, green and blue.
fn squared_error(a: u32, b: u32) -> u64 {
    let (a, b) = (a.to_le_bytes(), b.to_le_bytes());
    (0..3).map(|c| u64::from(a[c].abs_diff(b[c])).pow(2)).sum()
}

fn decibels(sum: u64, pixels: usize) -> Option<f64> {
    if sum == 0 {
        return None;
    }
    let mean = sum as f64 / (pixels as f64 * 3.0);
    Some(10.0 * (255.0 * 255.0 / mean).log10())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::known;
    use super::*;

    #[test]
    fn psnr_is_that_of_scikit_image() {
        known::for_each_pair(|pair, reference, test| {
            let ours = psnr(reference, test).unwrap().unwrap();
            assert!((ours - pair.psnr_db).abs() < 1e-9, "{}: {ours} dB, not {}", pair.name, pair.psnr_db);
        });
    }

    #[test]
    fn equal_pictures_have_none_and_one_step_is_48_db() {
        let (a, b) = ([0x0010_2030; 4], [0xff11_2131; 4]);
        let view = |p| Rgb8::new(2, 2, p).unwrap();
        assert_eq!(psnr(view(&a), view(&a)).unwrap(), None);
        assert_eq!(psnr(view(&a), view(&[0x5510_2030; 4])).unwrap(), None, "alpha counted");
        // Every channel off by one: 20 log10(255).
        let one = psnr(view(&a), view(&b)).unwrap().unwrap();
        assert!((one - 48.130_803_608_679_1).abs() < 1e-12, "{one}");
        // Black against white is 0 dB.
        assert_eq!(psnr(view(&[0; 4]), view(&[0x00ff_ffff; 4])).unwrap(), Some(0.0));
    }

    #[test]
    fn a_mask_counts_its_pixels_only() {
        let reference = [0x0000_0000, 0x0010_1010, 0x0020_2020, 0x0030_3030];
        let test = [0x00ff_ffff, 0x0011_1111, 0x0020_2020, 0x0030_3030];
        let (r, t) = (Rgb8::new(2, 2, &reference).unwrap(), Rgb8::new(2, 2, &test).unwrap());
        let masked = |mask: [bool; 4]| psnr_masked(r, t, &mask).unwrap();
        assert_eq!(masked([true; 4]), psnr(r, t).unwrap());
        assert_eq!(masked([true, false, false, false]), Some(0.0));
        assert!((masked([false, true, false, false]).unwrap() - 48.130_803_608_679_1).abs() < 1e-12);
        // Two pixels, one of them right: half the mean error, 3.01 dB more.
        assert!((masked([false, true, true, false]).unwrap() - 51.141_103_565_318_9).abs() < 1e-9);
        assert_eq!(masked([false, false, true, true]), None);
        assert_eq!(masked([false; 4]), None);
        assert!(psnr_masked(r, t, &[true; 3]).is_err());
    }
}
