//! Stability cases: scenes with one parameter that is varied until something breaks. A file here for
//! each category.
//!
//! Unless a case says otherwise, balls have radius 1 and strength 1, the kernel is the quartic, and
//! T = 0.25, so that a ball alone shows at the core radius 1/√2.

mod case;
mod image;
mod magnitude;
mod overlap;
mod shape;
#[cfg(test)]
mod tests;
mod viewpoint;

use std::sync::LazyLock;

pub use case::{Case, Category, Redraw};

/// All cases, by category.
pub fn cases() -> &'static [Case] {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
        [overlap::CASES, magnitude::CASES, shape::CASES, viewpoint::CASES, image::CASES].concat()
    });
    &CASES
}
