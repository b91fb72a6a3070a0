// SPDX-License-Identifier: MIT OR Apache-2.0
//! Small maths that host code, CPU twin and kernels must agree on to the last bit.
//!
//! Each function here has a counterpart of the same name in `kernels/common/math.clh`, with the same operations in the
//! same order, so that strict builds give equal bits.

use glam::Vec3;

/// Converts the bit pattern of an unsigned word to a float (`as_float` in OpenCL C).
#[inline]
pub fn as_float(bits: u32) -> f32 {
    f32::from_bits(bits)
}

/// Dot product, summed left to right.
#[inline]
pub fn dot(a: Vec3, b: Vec3) -> f32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// Cross product.
#[inline]
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// `a` scaled to unit length by one division and three products.
#[inline]
pub fn normalize(a: Vec3) -> Vec3 {
    let s = 1.0 / dot(a, a).sqrt();
    Vec3::new(a.x * s, a.y * s, a.z * s)
}

/// The lesser of two values; `b` if they do not compare.
#[inline]
pub fn min2(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater of two values; `b` if they do not compare.
#[inline]
pub fn max2(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `a` limited to `[lo, hi]`.
#[inline]
pub fn clamp(a: f32, lo: f32, hi: f32) -> f32 {
    min2(max2(a, lo), hi)
}

/// Base-2 logarithm of a positive normal float, by a polynomial: about 1e-6 absolute error.
#[inline]
#[allow(clippy::excessive_precision)] // the digits of the kernel's constants
pub fn log2_poly(x: f32) -> f32 {
    let bits = x.to_bits();
    // The mantissa is brought to [sqrt(1/2), sqrt(2)), where the series converges fast.
    let shifted = bits.wrapping_sub(0x3f35_04f3);
    let exponent = (shifted as i32) >> 23;
    let m = f32::from_bits(bits.wrapping_sub((exponent << 23) as u32));
    // log2(m) = 2/ln2 * atanh(s), s = (m-1)/(m+1), |s| < 0.1716
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let p = 2.885_390_1 + s2 * (0.961_796_7 + s2 * (0.577_078 + s2 * 0.412_198_6));
    exponent as f32 + s * p
}

/// 2 to the power of `x`, by a polynomial: about 2e-7 relative error; 0 below -126.
#[inline]
#[allow(clippy::excessive_precision, clippy::approx_constant)] // the digits of the kernel's constants
pub fn exp2_poly(x: f32) -> f32 {
    if x < -126.0 {
        return 0.0;
    }
    let x = min2(x, 127.0);
    let whole = (x + 127.5) as i32 - 127; // rounds to nearest, since x + 127.5 is positive
    let f = x - whole as f32; // in [-0.5, 0.5]
    let p = 1.0
        + f * (0.693_147_2
            + f * (0.240_226_5
                + f * (0.055_504_11 + f * (0.009_618_129 + f * (0.001_333_355_8 + f * 0.000_154_035_3)))));
    f32::from_bits(((whole + 127) << 23) as u32) * p
}

/// `x` to the power `y` for `x` in `(0, 1]` and `y >= 0`; 0 for `x <= 0`.
#[inline]
pub fn pow_poly(x: f32, y: f32) -> f32 {
    if x <= 1.0e-30 {
        return 0.0;
    }
    exp2_poly(y * log2_poly(x))
}

/// Packs a unit vector into 32 bits: octahedral mapping, 16 signed bits for each coordinate (low half: x).
pub fn pack_normal(n: Vec3) -> u32 {
    let sum = n.x.abs() + n.y.abs() + n.z.abs();
    let (mut x, mut y) = if sum > 0.0 { (n.x / sum, n.y / sum) } else { (0.0, 0.0) };
    if n.z < 0.0 {
        let (ax, ay) = (x.abs(), y.abs());
        x = if x >= 0.0 { 1.0 - ay } else { ay - 1.0 };
        y = if y >= 0.0 { 1.0 - ax } else { ax - 1.0 };
    }
    let quantise = |v: f32| clamp((v * 32767.0).round(), -32767.0, 32767.0) as i32 as u32 & 0xffff;
    quantise(x) | quantise(y) << 16
}

/// The unit vector that [`pack_normal`] packed.
#[inline]
pub fn unpack_normal(packed: u32) -> Vec3 {
    let x = ((packed << 16) as i32 >> 16) as f32 * (1.0 / 32767.0);
    let y = (packed as i32 >> 16) as f32 * (1.0 / 32767.0);
    let (ax, ay) = (x.abs(), y.abs());
    let z = 1.0 - ax - ay;
    let fold = max2(-z, 0.0);
    let v = Vec3::new(if x >= 0.0 { x - fold } else { x + fold }, if y >= 0.0 { y - fold } else { y + fold }, z);
    normalize(v)
}

/// Two coordinates in `[0, 1)` as 16-bit fractions, `s` in the low half.
#[inline]
pub fn pack_texcoord(s: f32, t: f32) -> u32 {
    (s * 65536.0) as u32 | ((t * 65536.0) as u32) << 16
}

/// A coordinate that [`pack_texcoord`] packed: the middle of its step.
#[inline]
pub fn unpack_texcoord(half_word: u32) -> f32 {
    (half_word as f32 + 0.5) * (1.0 / 65536.0)
}

/// How often a texture whose coordinate is `x` was repeated, modulo 256.
#[inline]
pub fn whole_repeats(x: f32) -> u32 {
    let whole = x.floor() + if x - x.floor() < 1.0 { 0.0 } else { 1.0 };
    (whole - 256.0 * (whole * (1.0 / 256.0)).floor()) as u32
}

/// The fraction of `x`: `x - floor(x)`, in `[0, 1)`.
#[inline]
pub fn fraction(x: f32) -> f32 {
    let f = x - x.floor();
    // A tiny negative x gives exactly 1.0 in float arithmetic.
    if f < 1.0 { f } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pow_is_close_to_the_standard_library() {
        for i in 1..=1000 {
            for y in [0.0f32, 0.5, 1.0, 2.2, 20.22, 198.0, 1000.0] {
                let x = i as f32 / 1000.0;
                let exact = (x as f64).powf(y as f64);
                let ours = pow_poly(x, y) as f64;
                assert!((ours - exact).abs() <= 2e-4 * exact + 1e-9, "{x}^{y}: {ours} not {exact}");
            }
        }
    }

    #[test]
    fn a_packed_normal_comes_back_within_a_hundredth_of_a_degree() {
        for i in 0..10_000u32 {
            let z = 1.0 - (i as f32 + 0.5) / 5000.0;
            let phi = i as f32 * 2.399_963;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let n = Vec3::new(r * phi.cos(), r * phi.sin(), z);
            let back = unpack_normal(pack_normal(n));
            assert!(cross(n, back).length() < 1.7e-4, "{n} came back as {back}");
            assert!(dot(n, back) > 0.0);
        }
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert_eq!(unpack_normal(pack_normal(axis)), axis);
            assert_eq!(unpack_normal(pack_normal(-axis)), -axis);
        }
    }

    #[test]
    fn fractions_lie_below_one() {
        assert_eq!(fraction(1.25), 0.25);
        assert_eq!(fraction(-0.25), 0.75);
        assert_eq!(fraction(-1e-9), 0.0);
    }

    #[test]
    fn whole_repeats_go_with_fractions() {
        for (x, whole) in
            [(0.0, 0), (0.99, 0), (1.0, 1), (255.5, 255), (256.0, 0), (-0.25, 255), (-1e-9, 0), (-3.0, 253)]
        {
            assert_eq!(whole_repeats(x), whole, "{x}");
        }
        assert_eq!(whole_repeats(3.0e9), 3_000_000_000_u32 % 256);
    }
}
