//! Tables that papers print, measured anew and set beside the printed numbers; and one of programs
//! that a user would take instead.

pub mod gourmel;
pub mod illes;
pub mod kanamori;
pub mod peers;
