// SPDX-License-Identifier: MIT OR Apache-2.0
//! The picture of what differs.

use super::Rgb8;
use crate::{Result, memory};

/// How much [`difference_picture`] amplifies by custom.
pub const CUSTOMARY_GAIN: u32 = 10;

/// The absolute difference of each 8-bit channel times `gain`, limited to 255; alpha is 255.
///
/// # Errors
/// [`crate::Error::InvalidArgument`] if the sizes differ.
pub fn difference_picture(reference: Rgb8, test: Rgb8, gain: u32) -> Result<Vec<u32>> {
    reference.same_size(test)?;
    let pixel = |(&a, &b): (&u32, &u32)| {
        let (a, b) = (a.to_le_bytes(), b.to_le_bytes());
        let channel = |c: usize| u32::from(a[c].abs_diff(b[c])).saturating_mul(gain).min(255) as u8;
        u32::from_le_bytes([channel(0), channel(1), channel(2), 255])
    };
    memory::collected("the difference of the pictures", reference.pixels().iter().zip(test.pixels()).map(pixel))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn differences_are_amplified_and_limited_per_channel() {
        let reference = [0xff10_2030, 0x0000_0000, 0xff05_0505];
        let test = [0xff11_1e30, 0xff00_1aff, 0x0005_0505];
        let (r, t) = (Rgb8::new(3, 1, &reference).unwrap(), Rgb8::new(3, 1, &test).unwrap());
        let expected = [0xff0a_1400, 0xff00_ffff, 0xff00_0000];
        assert_eq!(difference_picture(r, t, CUSTOMARY_GAIN).unwrap(), expected);
        assert_eq!(difference_picture(t, r, CUSTOMARY_GAIN).unwrap(), expected);
        assert_eq!(difference_picture(r, t, 1).unwrap(), [0xff01_0200, 0xff00_1aff, 0xff00_0000]);
        assert_eq!(difference_picture(r, t, u32::MAX).unwrap(), [0xffff_ff00, 0xff00_ffff, 0xff00_0000]);
        let narrow = Rgb8::new(1, 3, &test).unwrap();
        assert!(difference_picture(r, narrow, 10).is_err());
    }
}
