// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors of lanes: beside `dispatch.rs`, which asks what the processor has, the one file that names the crate behind them.
//!
//! [`Floats`], [`Words`] and [`Mask`] hold one value for each lane of [`Lanes`], whose number is that of the instruction set:
//! 4 (SSE2, NEON), 8 (AVX2), 16 (AVX-512). Every operation rounds as the twin's scalar one does: there is no fused
//! multiplication, no approximate reciprocal, and [`Floats::min2`] and [`Floats::max2`] are what comparisons give, so that NaN
//! and zeros go the same way on every processor.
//!
//! All functions here and above are `inline(always)`: a function that is not inlined into the one that enables the
//! instructions would give the right values, many times slower.

use std::ops::{Add, BitAnd, BitOr, BitXor, Mul, Neg, Not, Sub};

use fearless_simd::prelude::*;

/// Most lanes of any instruction set: the length of arrays that hold a value for each.
pub const MOST_LANES: usize = 16;

/// An instruction set, by a token that proves that this processor has it.
pub trait Lanes: Simd {
    /// Number of lanes.
    const COUNT: usize = <Self::f32s as SimdBase<Self>>::LEN;

    /// Runs `f` compiled for this instruction set, in a function of its own.
    #[inline(always)]
    fn enter<R>(self, f: impl FnOnce() -> R) -> R {
        self.vectorize(f)
    }
}

impl<S: Simd> Lanes for S {}

/// x86's own minimum and maximum give the second value where the two do not compare, zeros among them, as `a < b ? a : b`
/// does. Those of other processors look at NaN and at the signs of zeros.
const EXTREMES_COMPARE: bool = cfg!(target_arch = "x86_64");

/// A value for each lane in an array, of which the first [`Lanes::COUNT`] count.
pub type Array<T> = [T; MOST_LANES];

/// A float for each lane.
#[derive(Debug, Clone, Copy)]
pub struct Floats<L: Lanes>(L::f32s);

/// A 32-bit word for each lane.
#[derive(Debug, Clone, Copy)]
pub struct Words<L: Lanes>(L::u32s);

/// Which lanes are meant.
#[derive(Debug, Clone, Copy)]
pub struct Mask<L: Lanes>(L::mask32s);

macro_rules! binary {
    ($type:ident $($trait:ident $method:ident),*) => {
        $(impl<L: Lanes> $trait for $type<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(self.0.$method(other.0))
            }
        })*
    };
}

binary!(Floats Add add, Sub sub, Mul mul);
binary!(Words Add add, Sub sub, BitAnd bitand, BitOr bitor, BitXor bitxor);
binary!(Mask BitAnd bitand, BitOr bitor, BitXor bitxor);

impl<L: Lanes> std::ops::Div for Floats<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Floats(self.0 / other.0)
    }
}

impl<L: Lanes> Neg for Floats<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Floats(-self.0)
    }
}

impl<L: Lanes> Not for Mask<L> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Mask(!self.0)
    }
}

impl<L: Lanes> Mul<f32> for Floats<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f32) -> Self {
        Floats(self.0 * other)
    }
}

impl<L: Lanes> Floats<L> {
    /// The same value in every lane.
    #[inline(always)]
    pub fn splat(l: L, value: f32) -> Self {
        Floats(L::f32s::splat(l, value))
    }

    /// A value for each lane.
    #[inline(always)]
    pub fn from_array(l: L, values: &Array<f32>) -> Self {
        Floats(L::f32s::from_slice(l, &values[..L::COUNT]))
    }

    /// The values, lane by lane.
    #[inline(always)]
    pub fn to_array(self) -> Array<f32> {
        let mut values = [0.0; MOST_LANES];
        self.0.store_slice(&mut values[..L::COUNT]);
        values
    }

    /// The lesser of two values; `other` where they do not compare ([`crate::math::min2`]).
    #[inline(always)]
    pub fn min2(self, other: Self) -> Self {
        if EXTREMES_COMPARE { Floats(self.0.min(other.0)) } else { self.lt(other).select(self, other) }
    }

    /// The greater of two values; `other` where they do not compare ([`crate::math::max2`]).
    #[inline(always)]
    pub fn max2(self, other: Self) -> Self {
        if EXTREMES_COMPARE { Floats(self.0.max(other.0)) } else { self.gt(other).select(self, other) }
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Floats(self.0.abs())
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Floats(self.0.sqrt())
    }

    #[inline(always)]
    pub fn floor(self) -> Self {
        Floats(self.0.floor())
    }

    /// Its absolute value with the sign of `sign`.
    #[inline(always)]
    pub fn with_sign_of(self, sign: Self) -> Self {
        Floats(self.0.copysign(sign.0))
    }

    #[inline(always)]
    pub fn lt(self, other: Self) -> Mask<L> {
        Mask(self.0.simd_lt(other.0))
    }

    #[inline(always)]
    pub fn le(self, other: Self) -> Mask<L> {
        Mask(self.0.simd_le(other.0))
    }

    #[inline(always)]
    pub fn gt(self, other: Self) -> Mask<L> {
        Mask(other.0.simd_lt(self.0))
    }

    #[inline(always)]
    pub fn ge(self, other: Self) -> Mask<L> {
        Mask(other.0.simd_le(self.0))
    }

    #[inline(always)]
    pub fn equals(self, other: Self) -> Mask<L> {
        Mask(self.0.simd_eq(other.0))
    }

    /// Its bits.
    #[inline(always)]
    pub fn to_bits(self) -> Words<L> {
        Words(self.0.bitcast())
    }

    /// Towards zero, for values that a signed word holds; anything in the other lanes.
    #[inline(always)]
    pub fn truncated(self) -> Words<L> {
        let whole: L::i32s = self.0.to_int();
        Words(whole.bitcast())
    }

    /// Towards zero as `as u32` does: at least 0, and 0 for NaN.
    #[inline(always)]
    pub fn to_words(self) -> Words<L> {
        Words(self.0.to_int_precise())
    }
}

impl<L: Lanes> Words<L> {
    /// The same word in every lane.
    #[inline(always)]
    pub fn splat(l: L, word: u32) -> Self {
        Words(L::u32s::splat(l, word))
    }

    /// A word for each lane.
    #[inline(always)]
    pub fn from_array(l: L, words: &Array<u32>) -> Self {
        Words(L::u32s::from_slice(l, &words[..L::COUNT]))
    }

    /// The words, lane by lane.
    #[inline(always)]
    pub fn to_array(self) -> Array<u32> {
        let mut words = [0; MOST_LANES];
        self.0.store_slice(&mut words[..L::COUNT]);
        words
    }

    #[inline(always)]
    pub fn equals(self, other: Self) -> Mask<L> {
        Mask(self.0.simd_eq(other.0))
    }

    #[inline(always)]
    pub fn lt(self, other: Self) -> Mask<L> {
        Mask(self.0.simd_lt(other.0))
    }

    /// Lanes in which any of `bits` is set.
    #[inline(always)]
    pub fn has(self, l: L, bits: u32) -> Mask<L> {
        !(self & Words::splat(l, bits)).equals(Words::splat(l, 0))
    }

    #[inline(always)]
    pub fn shifted_left(self, bits: u32) -> Self {
        Words(self.0 << bits)
    }

    #[inline(always)]
    pub fn shifted_right(self, bits: u32) -> Self {
        Words(self.0 >> bits)
    }

    /// Shifted right, the sign bit repeated.
    #[inline(always)]
    pub fn shifted_right_signed(self, bits: u32) -> Self {
        let signed: L::i32s = self.0.bitcast();
        Words((signed >> bits).bitcast())
    }

    /// Floats that have these bits.
    #[inline(always)]
    pub fn as_floats(self) -> Floats<L> {
        Floats(self.0.bitcast())
    }

    /// The words, taken as signed, as floats.
    #[inline(always)]
    pub fn signed_to_floats(self) -> Floats<L> {
        let signed: L::i32s = self.0.bitcast();
        Floats(signed.to_float())
    }
}

impl<L: Lanes> Mask<L> {
    /// All lanes or none.
    #[inline(always)]
    pub fn splat(l: L, set: bool) -> Self {
        Mask(L::mask32s::splat(l, set))
    }

    /// Lane i where bit i is set.
    #[inline(always)]
    pub fn from_bits(l: L, bits: u32) -> Self {
        Mask(L::mask32s::from_bitmask(l, u64::from(bits)))
    }

    /// Bit i for lane i.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0.to_bitmask() as u32
    }

    #[inline(always)]
    pub fn any(self) -> bool {
        self.0.any_true()
    }

    /// These lanes without those of `other`.
    #[inline(always)]
    pub fn without(self, other: Self) -> Self {
        self & !other
    }

    /// `yes` in these lanes, `no` in the others.
    #[inline(always)]
    pub fn select(self, yes: Floats<L>, no: Floats<L>) -> Floats<L> {
        Floats(self.0.select(yes.0, no.0))
    }

    /// Likewise of words.
    #[inline(always)]
    pub fn select_words(self, yes: Words<L>, no: Words<L>) -> Words<L> {
        Words(self.0.select(yes.0, no.0))
    }

    /// Likewise of masks.
    #[inline(always)]
    pub fn select_mask(self, yes: Self, no: Self) -> Self {
        (self & yes) | (!self & no)
    }
}

/// The numbers of the set bits of `bits`, from the lowest on: the lanes of a mask.
#[inline(always)]
pub fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(
        #[inline(always)]
        move || {
            let lane = bits.trailing_zeros() as usize;
            (bits != 0).then(|| {
                bits &= bits - 1;
                lane
            })
        },
    )
}

/// The closure itself: in a call's argument it can have the attribute `inline(always)`, which a `let` cannot give it.
#[inline(always)]
pub fn inlined<F>(closure: F) -> F {
    closure
}
