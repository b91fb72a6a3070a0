// SPDX-License-Identifier: MIT OR Apache-2.0
//! Three components for each lane, and the small maths of `math.rs` lane by lane: the same operations in the same order.

use std::ops::{Add, Mul, Neg, Sub};

use glam::Vec3;

use super::lanes::{Array, Floats, Lanes, MOST_LANES, Mask, Words, inlined};

/// A vector for each lane.
#[derive(Debug, Clone, Copy)]
#[allow(missing_docs)]
pub struct Vectors<L: Lanes> {
    pub x: Floats<L>,
    pub y: Floats<L>,
    pub z: Floats<L>,
}

impl<L: Lanes> Vectors<L> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(l: L, v: Vec3) -> Self {
        Vectors { x: Floats::splat(l, v.x), y: Floats::splat(l, v.y), z: Floats::splat(l, v.z) }
    }

    /// `self` divided by its length as [`crate::math::normalize`] does.
    #[inline(always)]
    pub fn normalize(self, l: L) -> Self {
        self * (Floats::splat(l, 1.0) / self.dot(self).sqrt())
    }

    /// Dot product, summed left to right.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Floats<L> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Vectors { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }

    /// The greatest component.
    #[inline(always)]
    pub fn greatest(self) -> Floats<L> {
        self.x.max2(self.y.max2(self.z))
    }
}

macro_rules! by_component {
    ($($trait:ident $method:ident),*) => {
        $(impl<L: Lanes> $trait for Vectors<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Vectors { x: self.x.$method(other.x), y: self.y.$method(other.y), z: self.z.$method(other.z) }
            }
        }
        impl<L: Lanes> $trait<Floats<L>> for Vectors<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Floats<L>) -> Self {
                Vectors { x: self.x.$method(other), y: self.y.$method(other), z: self.z.$method(other) }
            }
        })*
    };
}

by_component!(Add add, Sub sub, Mul mul);

impl<L: Lanes> Neg for Vectors<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Vectors { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<L: Lanes> Mask<L> {
    /// `yes` in these lanes, `no` in the others.
    #[inline(always)]
    pub fn select_vectors(self, yes: Vectors<L>, no: Vectors<L>) -> Vectors<L> {
        Vectors { x: self.select(yes.x, no.x), y: self.select(yes.y, no.y), z: self.select(yes.z, no.z) }
    }
}

/// Vectors written lane by lane.
pub struct VectorArray([Array<f32>; 3]);

impl VectorArray {
    /// Zeros.
    #[inline(always)]
    pub fn zeros() -> Self {
        VectorArray([[0.0; MOST_LANES]; 3])
    }

    /// Sets the vector of a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: &[f32]) {
        let lane = lane % MOST_LANES;
        (self.0[0][lane], self.0[1][lane], self.0[2][lane]) = (v[0], v[1], v[2]);
    }

    /// The vectors.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, l: L) -> Vectors<L> {
        let [x, y, z] = &self.0;
        Vectors { x: Floats::from_array(l, x), y: Floats::from_array(l, y), z: Floats::from_array(l, z) }
    }
}

/// [`crate::math::fraction`].
#[inline(always)]
pub fn fraction<L: Lanes>(l: L, x: Floats<L>) -> Floats<L> {
    let f = x - x.floor();
    f.lt(Floats::splat(l, 1.0)).select(f, Floats::splat(l, 0.0))
}

/// [`crate::math::whole_repeats`].
#[inline(always)]
pub fn whole_repeats<L: Lanes>(l: L, x: Floats<L>) -> Words<L> {
    let below = x.floor();
    let more = (x - below).lt(Floats::splat(l, 1.0)).select(Floats::splat(l, 0.0), Floats::splat(l, 1.0));
    let whole = below + more;
    (whole - (whole * (1.0 / 256.0)).floor() * 256.0).to_words()
}

/// [`crate::math::unpack_normal`].
#[inline(always)]
pub fn unpack_normal<L: Lanes>(l: L, packed: Words<L>) -> Vectors<L> {
    let zero = Floats::splat(l, 0.0);
    let x = packed.shifted_left(16).shifted_right_signed(16).signed_to_floats() * (1.0 / 32767.0);
    let y = packed.shifted_right_signed(16).signed_to_floats() * (1.0 / 32767.0);
    let z = Floats::splat(l, 1.0) - x.abs() - y.abs();
    let fold = (-z).max2(zero);
    let folded = inlined(
        #[inline(always)]
        |v: Floats<L>| v.ge(zero).select(v - fold, v + fold),
    );
    Vectors { x: folded(x), y: folded(y), z }.normalize(l)
}

/// [`crate::math::pack_normal`].
#[inline(always)]
pub fn pack_normal<L: Lanes>(l: L, n: Vectors<L>) -> Words<L> {
    let (zero, one) = (Floats::splat(l, 0.0), Floats::splat(l, 1.0));
    let sum = n.x.abs() + n.y.abs() + n.z.abs();
    let some = sum.gt(zero);
    let (x, y) = (some.select(n.x / sum, zero), some.select(n.y / sum, zero));
    let (ax, ay) = (x.abs(), y.abs());
    let below = n.z.lt(zero);
    let fx = x.ge(zero).select(one - ay, ay - one);
    let fy = y.ge(zero).select(one - ax, ax - one);
    let most = Floats::splat(l, 32767.0);
    let quantise = inlined(
        #[inline(always)]
        |v: Floats<L>| {
            // Half away from zero, as `round` does: exact, since values stay below 2^23.
            let v = v * 32767.0;
            let whole = v.truncated().signed_to_floats();
            let away = (v - whole).abs().ge(Floats::splat(l, 0.5)).select(one.with_sign_of(v), zero);
            let rounded = whole + away;
            rounded.max2(-most).min2(most).truncated() & Words::splat(l, 0xffff)
        },
    );
    quantise(below.select(fx, x)) | quantise(below.select(fy, y)).shifted_left(16)
}

/// [`crate::math::pow_poly`].
#[inline(always)]
#[allow(clippy::excessive_precision, clippy::approx_constant)] // the digits of the kernel's constants
pub fn pow_poly<L: Lanes>(l: L, x: Floats<L>, y: Floats<L>) -> Floats<L> {
    let c = |value: f32| Floats::splat(l, value);
    let bits = x.to_bits();
    let exponent = (bits - Words::splat(l, 0x3f35_04f3)).shifted_right_signed(23);
    let m = (bits - exponent.shifted_left(23)).as_floats();
    let s = (m - c(1.0)) / (m + c(1.0));
    let s2 = s * s;
    let p = c(2.885_390_1) + s2 * (c(0.961_796_7) + s2 * (c(0.577_078) + s2 * c(0.412_198_6)));
    let log2 = exponent.signed_to_floats() + s * p;

    let e = y * log2;
    let x2 = e.min2(c(127.0));
    let whole = (x2 + c(127.5)).truncated() - Words::splat(l, 127);
    let f = x2 - whole.signed_to_floats();
    let p = c(1.0)
        + f * (c(0.693_147_2)
            + f * (c(0.240_226_5)
                + f * (c(0.055_504_11) + f * (c(0.009_618_129) + f * (c(0.001_333_355_8) + f * c(0.000_154_035_3))))));
    let exp2 = (whole + Words::splat(l, 127)).shifted_left(23).as_floats() * p;
    let nothing = x.le(c(1.0e-30)) | e.lt(c(-126.0));
    nothing.select(c(0.0), exp2)
}
