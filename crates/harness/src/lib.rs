//! Measures metaball ray casters against an exact reference and each other: the library behind the
//! binary `metaball`.
//!
//! [`contest`] is the heart: it takes a scene through all [`methods`], asks the oracle about the rays
//! that the shaders used ([`mod@reference`]), and yields a [`record`] for each. [`score`] holds the one
//! set of definitions of what is wrong, [`measure`] those of what is fast, [`judge`] what each method
//! promises and is held to. [`mod@compare`], [`mod@render`], [`mod@animate`], [`mod@stability`] and
//! [`mod@certify`] are the commands; [`camera`] and [`light`] have options of `render` and `animate`,
//! [`auto`] chooses who draws. [`tables`] holds the tables of papers.
//! [`cpu`] and [`shade`] draw where there is no adapter.

pub mod animate;
pub mod auto;
pub mod camera;
pub mod certify;
pub mod chart;
pub mod compare;
pub mod conclusions;
pub mod console;
pub mod contest;
pub mod cpu;
pub mod frame_png;
pub mod heat;
pub mod hits_exr;
pub mod html;
pub mod judge;
pub mod light;
pub mod list;
pub mod machine;
pub mod measure;
pub mod methods;
pub mod numbers;
pub mod output;
mod page;
pub mod picture;
pub mod plot;
pub mod record;
pub mod reference;
pub mod render;
pub mod report;
pub mod score;
pub mod settings;
pub mod shade;
pub mod sheet;
pub mod stability;
pub mod stats;
pub mod subset;
pub mod tables;
