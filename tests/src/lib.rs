//! Support for the tests that cross packages: every method on every small scene against the
//! oracle, each held to exactly what its paper promises.

pub mod judge;
pub mod machine;
pub mod points;
pub mod promise;
pub mod refusals;
pub mod stand_in;
pub mod trials;
