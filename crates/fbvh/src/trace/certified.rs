//! Rays through the certified tree: which answers are certain, and why.
//!
//! A leaf is searched in f32 first, by polynomials (`trace/certified/polynomial.rs`), with every
//! rounding accounted for; what that cannot decide, Perlin's kernel among it, is searched in f64 by
//! ranges (`trace/certified/ranges.rs`). Of a root the nearest float is found, in f64,
//! so that it does not matter which search isolated it (`trace/certified/nearest_float.rs`).
//!
//! # By polynomials
//! On an interval \[a, b\] of the ray a ball's v = 1 − r²/R² is a parabola with the Bernstein
//! coefficients v(a), its polar form at (a, b), and v(b). The parabola is nowhere above the one whose
//! coefficients below zero are raised to zero, so the sum of kernels of the raised ones, a polynomial
//! again, is nowhere below the field. It is the field where every ball that counts covers the whole
//! interval; leaving out the balls that do not gives a polynomial that is nowhere above. All terms are
//! products of non-negative numbers: nothing cancels. If all coefficients of the upper polynomial
//! are below T, the interval holds no crossing. If the two agree and their signs change once, it
//! holds one, the first. Otherwise the interval is shortened, from the front to where the upper
//! polynomial may first reach T, and from the back to where the lower one certainly has.
//!
//! Negative balls are enclosed apart from the others: what they take away at most, and at least, is taken off
//! the polynomials below and above what the others add, coefficient by coefficient, each with the rounding of
//! its own sum. Where the field rises, they have to fall; so they are followed backwards, along the mirrored
//! ray, where all that is known of rising parts holds for them.
//!
//! Other kernels than power kernels up to α = 4 and Wyvill's are convex in v, with a second derivative that
//! rises with v: on the range of v that a ball has on the interval such a kernel lies between two parabolas in
//! v, which are polynomials of degree four along the ray (`trace/certified/kernel/convex.rs`). There the interval
//! holds one crossing where the field is below T at its start and above at its end, and a lower bound of its
//! slope is positive throughout.
//!
//! # By the leaf's polynomial
//! Where many rays meet a leaf with a long list, one polynomial for the whole field in it decides most of
//! them whatever the list's length (`trace/certified/leaf_polynomial.rs`), in packets.
//!
//! # By packets
//! Of many rays, eight at a time go through the tree together (`trace/certified/packet.rs`), and a leaf
//! is searched on all of them side by side by the same polynomials (`trace/certified/packet/leaf.rs`).
//! Every bound is one ray's own, with the margins of that ray; what it cannot decide is searched again
//! for that ray alone.
//!
//! # Rays that start inside
//! In a closed solid box the field is above T, outside all leaves it is T or below: the two never touch.
//! So a ray that starts inside leaves the solid in a leaf with a list, and solid leaves are passed
//! through.
//!
//! # Where leaves end
//! Boxes are cut down to where balls can make a surface, so a surface often touches a face with no leaf
//! behind it: a lone ball touches six. There the field may be too close to T to decide at the end of the
//! ray's interval in the leaf, but outside all leaves it is below T. So for an entry, a field that rises
//! towards such a face has not reached T; for an exit, it falls to T at the face, if nowhere before. Only
//! where another leaf continues behind the face does that one have to decide.

mod bernstein;
mod kernel;
mod lanes;
mod leaf_polynomial;
mod nearest_float;
mod packet;
mod parabolas;
mod polynomial;
mod query;
mod ranges;
mod ray;

pub(super) use self::leaf_polynomial::Polynomials;
pub(super) use self::packet::{PacketScratch, packets};
pub(super) use self::query::{Crossing, Query};
pub(super) use self::ray::{Scratch, UNDECIDED};
