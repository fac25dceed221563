//! Eight numbers side by side, in plain arrays that the compiler turns into vector instructions:
//! where `pulp` finds wider ones at run time, code under its `dispatch` uses those. No operation is
//! fused, so results are the same on every machine.

use std::array;
use std::ops::{Add, AddAssign, Mul, Sub};

/// How many numbers.
pub(super) const WIDTH: usize = 8;

/// The numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes<T>(pub(super) [T; WIDTH]);

impl<T: Copy> Lanes<T> {
    #[inline(always)]
    pub(super) fn splat(value: T) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    pub(super) fn map<U>(self, function: impl Fn(T) -> U) -> Lanes<U> {
        Lanes(array::from_fn(|lane| function(self.0[lane])))
    }

    #[inline(always)]
    pub(super) fn zip<U: Copy, V>(self, other: Lanes<U>, function: impl Fn(T, U) -> V) -> Lanes<V> {
        Lanes(array::from_fn(|lane| function(self.0[lane], other.0[lane])))
    }
}

impl<T: Copy + PartialOrd> Lanes<T> {
    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }

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

/// Whether any lane is true.
#[inline(always)]
pub(super) fn any(lanes: Lanes<bool>) -> bool {
    lanes.0.iter().fold(false, |any, &lane| any | lane)
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

impl<T: Copy + Mul<Output = T>> Mul<T> for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        self.map(|a| a * factor)
    }
}
