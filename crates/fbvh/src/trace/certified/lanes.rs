//! Eight numbers side by side, in plain arrays that the compiler turns into vector instructions:
//! where `pulp` finds wider ones at run time, code under its `dispatch` uses those. No operation is
//! fused, so results are the same on every machine.

use std::iter;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Not, Sub};

use metaball_core::kernel::Real;

/// How many numbers, and how many rays make a packet.
pub(in crate::trace) const WIDTH: usize = 8;

/// The numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes<T>(pub(super) [T; WIDTH]);

/// The lanes of the bits that are set, in their order.
#[inline(always)]
pub(super) fn lanes_of(bits: u32) -> impl Iterator<Item = usize> {
    let mut rest = bits & ((1 << WIDTH) - 1);
    iter::from_fn(move || {
        let lane = rest.trailing_zeros() as usize;
        rest &= rest.wrapping_sub(1);
        (lane < WIDTH).then_some(lane)
    })
}

/// As [`std::array::from_fn`], which may compile the function by itself, without the vector instructions
/// of its caller.
#[inline(always)]
pub(super) fn array_of<T: Copy, const N: usize>(entry: impl Fn(usize) -> T) -> [T; N] {
    let mut entries = [entry(0); N];
    for (k, slot) in entries.iter_mut().enumerate().skip(1) {
        *slot = entry(k);
    }
    entries
}

impl<T: Copy> Lanes<T> {
    /// The first numbers of a slice.
    #[inline(always)]
    pub(super) fn of(numbers: &[T]) -> Self {
        Self(array_of(|lane| numbers[lane]))
    }

    #[inline(always)]
    pub(super) fn splat(value: T) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    pub(super) fn map<U>(self, function: impl Fn(T) -> U) -> Lanes<U> {
        let [a, b, c, d, e, f, g, h] = self.0;
        Lanes([
            function(a),
            function(b),
            function(c),
            function(d),
            function(e),
            function(f),
            function(g),
            function(h),
        ])
    }

    #[inline(always)]
    pub(super) fn zip<U: Copy, V>(self, other: Lanes<U>, function: impl Fn(T, U) -> V) -> Lanes<V> {
        let ([a, b, c, d, e, f, g, h], with) = (self.0, other.0);
        Lanes([
            function(a, with[0]),
            function(b, with[1]),
            function(c, with[2]),
            function(d, with[3]),
            function(e, with[4]),
            function(f, with[5]),
            function(g, with[6]),
            function(h, with[7]),
        ])
    }
}

impl<T: Copy + PartialOrd> Lanes<T> {
    /// The greater one; the other where this is NaN.
    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

    /// The lesser one; the other where this is NaN.
    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
}

impl<T: Copy + Add<Output = T>> Lanes<T> {
    /// The sum, in pairs: three roundings.
    #[inline(always)]
    pub(super) fn sum(self) -> T {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

impl Lanes<f32> {
    #[inline(always)]
    pub(super) fn sqrt(self) -> Self {
        self.map(f32::sqrt)
    }
}

impl<T: Real + PartialOrd> Real for Lanes<T> {
    const EXPONENTIAL_TERMS: usize = T::EXPONENTIAL_TERMS;

    #[inline(always)]
    fn of(number: f64) -> Self {
        Self::splat(T::of(number))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(T::sqrt)
    }

    #[inline(always)]
    fn choose(self, limit: Self, below: Self, otherwise: Self) -> Self {
        let chosen = below.zip(otherwise, |below, otherwise| (below, otherwise));
        let compared = self.zip(limit, |number, limit| (number, limit));
        compared.zip(chosen, |(number, limit), (below, otherwise)| {
            number.choose(limit, below, otherwise)
        })
    }

    #[inline(always)]
    fn nearest_power(self) -> (Self, Self) {
        let both = self.map(T::nearest_power);
        (both.map(|(turns, _)| turns), both.map(|(_, power)| power))
    }
}

/// Which lanes satisfy a condition: all bits of a lane, or none.
pub(super) type Mask = Lanes<u32>;

impl Mask {
    pub(super) const NONE: Self = Self([0; WIDTH]);

    /// The lanes of the bits that are set.
    #[inline(always)]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(array_of(|lane| if bits & 1 << lane == 0 { 0 } else { u32::MAX }))
    }

    /// Lane i in bit i: one instruction where the machine has AVX.
    #[inline(always)]
    pub(super) fn bits(self) -> u32 {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return simd.avx._mm256_movemask_ps(pulp::cast(self.0)) as u32;
        }
        self.sum_of_bits()
    }

    /// The same on any machine.
    ///
    /// Each lane adds 3·2ⁱ. For 2ⁱ the compiler would extract a flag from lane 0 and shift it, which splits
    /// all computations that lead here into four lanes, two and single ones.
    #[inline(always)]
    fn sum_of_bits(self) -> u32 {
        (0..WIDTH).fold(0, |bits, lane| bits + (self.0[lane] & 3 << lane)) / 3
    }

    /// Whether any lane satisfies it.
    #[inline(always)]
    pub(super) fn any(self) -> bool {
        self.0.iter().fold(0, |bits, &lane| bits | lane) != 0
    }

    /// The first number in lanes that satisfy it, the second elsewhere.
    #[inline(always)]
    pub(super) fn select(self, yes: Lanes<f32>, no: Lanes<f32>) -> Lanes<f32> {
        let chosen = yes.zip(no, |yes, no| (yes, no));
        self.zip(chosen, |mask, (yes, no)| if mask != 0 { yes } else { no })
    }
}

impl<T: Copy + PartialOrd> Lanes<T> {
    /// The lanes where this is less: none where either is NaN.
    #[inline(always)]
    pub(super) fn is_less(self, other: Self) -> Mask {
        self.zip(other, |a, b| if a < b { u32::MAX } else { 0 })
    }

    /// The lanes where this is at most the other: none where either is NaN.
    #[inline(always)]
    pub(super) fn is_at_most(self, other: Self) -> Mask {
        self.zip(other, |a, b| if a <= b { u32::MAX } else { 0 })
    }
}

impl BitAnd for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }
}

impl BitOr for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }
}

impl Not for Mask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        self.map(|a| !a)
    }
}

impl<T: Copy + Add<Output = T>> Add for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<T: Copy + Add<Output = T>> AddAssign for Lanes<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Copy + Sub<Output = T>> Sub for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<T: Copy + Mul<Output = T>> Mul for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<T: Copy + Div<Output = T>> Div for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl<T: Copy + Mul<Output = T>> Mul<T> for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        self.map(|a| a * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_and_bits_say_the_same() {
        for bits in 0..1 << WIDTH {
            let mask = Mask::from_bits(bits);
            assert_eq!((mask.bits(), mask.any()), (bits, bits != 0));
            assert_eq!(mask.sum_of_bits(), bits);
            assert_eq!((!mask).bits(), !bits & 0xff);
            assert_eq!(lanes_of(bits).fold(0, |found, lane| found | 1 << lane), bits);
        }
    }
}
