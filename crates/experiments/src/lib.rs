//! Experiments on methods. Each writes its records, and a page about them, into a folder; `runs/` holds
//! those that are evidence. What methods are measured with is the crate `harness`.
//!
//! - [`mod@compare`]: methods side by side on some scenes. [`mod@score`]: hits of another program alone.
//!   [`mod@diff`]: what changed between two files of records.
//! - [`mod@chart`]: error against time of every option; growth with the number and density of balls.
//! - [`mod@stability`]: parameters of cases that are turned until methods fail.
//! - [`mod@certify`]: the certified tree against the oracle, over many rays.
//! - [`mod@device`]: all that a graphics processor is to be measured by, in minutes.
//! - [`tables`]: what papers print, measured anew, and tables of this program's own.
//!
//! A run that does not show what it was asked for ends in a [`shortfall`]. They share [`console`], which prints,
//! and for pages [`html`], [`table`], [`plot`] and [`conclusions`].

pub mod certify;
pub mod chart;
pub mod compare;
pub mod conclusions;
pub mod console;
pub mod device;
pub mod diff;
pub mod extent;
pub mod html;
pub mod lit_twins;
mod outputs;
mod page;
pub mod plot;
pub mod score;
pub mod shortfall;
pub mod stability;
pub mod table;
pub mod tables;
#[cfg(test)]
mod testing;
mod unfinished;
