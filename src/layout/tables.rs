// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tables buffer: sRGB by table, so that all devices agree to the last bit.

use super::constants::SRGB_FIRST_BUCKET;

/// The tables buffer: 256 decoded sRGB bytes, 257 thresholds, and the guesses of the encoder.
pub fn tables() -> Vec<u32> {
    let decode = |value: f64| if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
    let mut words: Vec<u32> = (0..256).map(|byte| (decode(byte as f64 / 255.0) as f32).to_bits()).collect();
    // thresholds[i] is the least linear value that is shown as byte i or more.
    let thresholds: Vec<f32> =
        (0..=256).map(|byte| if byte == 0 { 0.0 } else { decode((byte as f64 - 0.5) / 255.0) as f32 }).collect();
    words.extend(thresholds.iter().map(|t| t.to_bits()));
    for bucket in SRGB_FIRST_BUCKET..=(1.0f32.to_bits() >> 16) {
        let least = f32::from_bits(bucket << 16);
        words.push(thresholds.iter().rposition(|&t| t <= least).unwrap_or(0).min(255) as u32);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{SRGB_LEAST, TABLE_SRGB_GUESS, TABLE_SRGB_THRESHOLD};

    #[test]
    fn the_srgb_encoder_needs_at_most_one_step_from_its_guess() {
        let words = tables();
        let threshold = |i: usize| f32::from_bits(words[TABLE_SRGB_THRESHOLD as usize + i]);
        assert!(SRGB_LEAST < threshold(1), "values below the first bucket must be black");
        for bucket in SRGB_FIRST_BUCKET..(1.0f32.to_bits() >> 16) {
            let guess = words[(TABLE_SRGB_GUESS + bucket - SRGB_FIRST_BUCKET) as usize] as usize;
            let last = f32::from_bits(((bucket + 1) << 16) - 1);
            assert!(threshold(guess) <= f32::from_bits(bucket << 16) || guess == 0);
            assert!(guess >= 254 || last < threshold(guess + 2), "bucket {bucket:#x} spans three bytes");
        }
    }
}
