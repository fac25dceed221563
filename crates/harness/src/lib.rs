//! What a contender is put into: methods that draw a scene, and how they are judged.
//!
//! [`contest`] is the heart: it takes a scene through [`methods`] with their [`settings`], asks the
//! oracle about the rays that the shaders used ([`mod@reference`]), and yields a [`record`] for each.
//! [`score`] holds the one set of definitions of what is wrong, [`measure`] those of what is fast,
//! [`judge`] what each method promises and is held to. [`auto`] chooses who draws.

pub mod auto;
pub mod contest;
pub mod fronts;
pub mod heat;
pub mod judge;
pub mod machine;
pub mod measure;
pub mod methods;
pub mod numbers;
pub mod output;
pub mod progress;
pub mod record;
pub mod reference;
pub mod score;
pub mod settings;
pub mod stats;
pub mod subset;
pub mod technique;
