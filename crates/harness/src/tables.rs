//! Tables that papers print, measured anew and set beside the printed numbers.

pub mod gourmel;
pub mod illes;
pub mod kanamori;
