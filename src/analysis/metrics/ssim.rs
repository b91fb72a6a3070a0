// SPDX-License-Identifier: MIT OR Apache-2.0
//! Structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to
//! structural similarity", IEEE Transactions on Image Processing 13(4), 2004.
//!
//! The paper's own form: Gaussian window of 11x11 taps, sigma 1.5, K1 = 0.01, K2 = 0.03, range 255, on the luma
//! 0.299 R + 0.587 G + 0.114 B of the 8-bit values (not rounded), averaged over the positions where the whole window
//! lies in the picture. scikit-image gives the same with `gaussian_weights=True, sigma=1.5,
//! use_sample_covariance=False, data_range=255`. Along a side shorter than the window every position counts, with the
//! window cut at the border and scaled back to sum 1.

use rayon::prelude::*;

use super::Rgb8;
use crate::Result;

const RADIUS: usize = 5;
const SIGMA: f64 = 1.5;
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// Mean SSIM, from -1 to 1; 1 for equal pictures.
///
/// # Errors
/// [`crate::Error::InvalidArgument`] if the sizes differ.
pub fn ssim(reference: Rgb8, test: Rgb8) -> Result<f64> {
    reference.same_size(test)?;
    let columns = windows(reference.width() as usize);
    let rows = windows(reference.height() as usize);
    // Rows are summed in parallel, then added up in order: the same sum for any number of threads.
    let sums: Vec<f64> = rows.par_iter().map(|row| row_sum(reference, test, row, &columns)).collect();
    Ok(sums.iter().sum::<f64>() / (rows.len() as f64 * columns.len() as f64))
}

/// The part of a window that lies in the picture along one side.
struct Window {
    first: usize,
    weights: Vec<f64>,
}

/// The windows of all positions that count along a side of `length` pixels.
fn windows(length: usize) -> Vec<Window> {
    let centres = if length > 2 * RADIUS { RADIUS..length - RADIUS } else { 0..length };
    let at = |centre: usize| {
        let first = centre.saturating_sub(RADIUS);
        let taps = first..(centre + RADIUS + 1).min(length);
        let bell: Vec<f64> = taps.map(|x| (-0.5 * (x.abs_diff(centre) as f64 / SIGMA).powi(2)).exp()).collect();
        let sum: f64 = bell.iter().sum();
        Window { first, weights: bell.iter().map(|w| w / sum).collect() }
    };
    centres.map(at).collect()
}

/// The sum of SSIM over the positions of one row of windows.
fn row_sum(reference: Rgb8, test: Rgb8, row: &Window, columns: &[Window]) -> f64 {
    // Weighted down the columns: a, b, a^2, b^2, ab.
    let mut moments = vec![[0.0f64; 5]; reference.width() as usize];
    for (y, &weight) in (row.first..).zip(&row.weights) {
        for ((m, &a), &b) in moments.iter_mut().zip(reference.row(y)).zip(test.row(y)) {
            let (a, b) = (luma(a), luma(b));
            for (sum, value) in m.iter_mut().zip([a, b, a * a, b * b, a * b]) {
                *sum += weight * value;
            }
        }
    }
    columns.iter().map(|window| similarity(&moments[window.first..], &window.weights)).sum()
}

fn similarity(moments: &[[f64; 5]], weights: &[f64]) -> f64 {
    let mut mean = [0.0f64; 5];
    for (m, &weight) in moments.iter().zip(weights) {
        for (sum, value) in mean.iter_mut().zip(m) {
            *sum += weight * value;
        }
    }
    let [a, b, aa, bb, ab] = mean;
    let (variance_a, variance_b, covariance) = (aa - a * a, bb - b * b, ab - a * b);
    (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (variance_a + variance_b + C2))
}

fn luma(pixel: u32) -> f64 {
    let [red, green, blue, _] = pixel.to_le_bytes();
    0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::known;
    use super::*;

    #[test]
    fn ssim_is_that_of_scikit_image() {
        known::for_each_pair(|pair, reference, test| {
            let ours = ssim(reference, test).unwrap();
            assert!((ours - pair.ssim).abs() < 1e-9, "{}: {ours}, not {}", pair.name, pair.ssim);
        });
    }

    #[test]
    fn equal_pictures_have_exactly_one_at_any_size() {
        for (width, height) in [(1, 1), (1, 40), (3, 2), (10, 11), (11, 11), (12, 30), (40, 5)] {
            let pixels: Vec<u32> = (0..width * height).map(|i: u32| i.wrapping_mul(2_654_435_761)).collect();
            let view = Rgb8::new(width, height, &pixels).unwrap();
            assert_eq!(ssim(view, view).unwrap(), 1.0, "{width}x{height}");
            // Negative control: the same pixels shuffled.
            let shuffled: Vec<u32> = pixels.iter().map(|p| p.rotate_left(13)).collect();
            assert!(width * height == 1 || ssim(view, Rgb8::new(width, height, &shuffled).unwrap()).unwrap() < 0.95);
        }
    }

    #[test]
    fn flat_pictures_follow_the_luminance_term_alone() {
        let (a, b) = (vec![0x0064_6464; 8 * 20], vec![0x0096_9696; 8 * 20]);
        let ours = ssim(Rgb8::new(8, 20, &a).unwrap(), Rgb8::new(8, 20, &b).unwrap()).unwrap();
        let expected = (2.0 * 100.0 * 150.0 + C1) / (100.0 * 100.0 + 150.0 * 150.0 + C1);
        assert!((ours - expected).abs() < 1e-9, "{ours} {expected}");
    }

    #[test]
    fn colour_without_luma_does_not_count() {
        // 0.587 R = 0.299 G exchanges nothing in luma: SSIM is blind to hue, FLIP is there for it.
        let (a, b) = (vec![0x0000_00c8; 400], vec![0x0000_6600; 400]);
        let ours = ssim(Rgb8::new(20, 20, &a).unwrap(), Rgb8::new(20, 20, &b).unwrap()).unwrap();
        assert!(ours > 0.9999, "{ours}");
    }
}
