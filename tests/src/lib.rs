//! Support for the tests that cross packages: every method on every small scene against the
//! oracle, each held to exactly what its paper promises.

pub mod machine;
pub mod trials;
