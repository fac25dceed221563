//! What methods are compared by: plans, runs, and pages about them.
//!
//! [`mod@compare`] puts methods side by side, [`mod@chart`] error against time, [`mod@stability`] turns
//! the parameters of cases until methods break, [`mod@certify`] holds the certified tree against the
//! oracle, [`tables`] repeats the papers' tables. Each writes its records and a page into a folder;
//! `runs/` holds those that are evidence. What a method is put into is the crate `harness`.

pub mod certify;
pub mod chart;
pub mod compare;
pub mod conclusions;
pub mod console;
pub mod diff;
pub mod extent;
pub mod html;
mod page;
pub mod plot;
pub mod score;
pub mod stability;
pub mod table;
pub mod tables;
#[cfg(test)]
mod testing;
mod unfinished;
