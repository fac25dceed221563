//! What methods are measured with: the list of them, and how their pictures are compared, timed and
//! judged.
//!
//! - [`methods`] is the only list of methods; a [`technique`] is what one does, with its options, and a
//!   [`mod@configuration`] is a method with some of them set otherwise.
//! - A [`renderer`] draws on an adapter or on the CPU; a [`canvas`] is where: either kind gets the same
//!   rays, and where there is no adapter those on the CPU are left.
//! - [`comparison`] draws a scene with all configurations, holds the pictures against the oracle along the
//!   rays that the shaders used ([`mod@reference`], on a [`subset`] of large pictures) and yields a
//!   [`record`] for each. [`score`] defines what is wrong, [`measure`] what is fast, [`heat`] draws the
//!   difference.
//! - [`judge`] holds a picture to what its method promises.
//! - [`auto`] chooses the quickest configuration that is right enough for a scene.
//! - [`machine`], [`output`], [`numbers`], [`stats`] and [`progress`] are what all of these need.

pub mod auto;
pub mod canvas;
pub mod comparison;
pub mod configuration;
pub mod heat;
pub mod imported;
pub mod judge;
pub mod machine;
pub mod measure;
pub mod methods;
pub mod numbers;
pub mod output;
pub mod progress;
pub mod record;
pub mod record_csv;
pub mod reference;
pub mod renderer;
pub mod score;
pub mod subset;
pub mod technique;

pub use scoring::{fronts, stats};
