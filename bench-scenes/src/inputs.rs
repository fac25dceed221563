//! The files behind what a user types.

use std::path::PathBuf;

use crate::{generate, known, moving};

/// The files that [`load`](crate::load()) and [`Moving::load`](crate::Moving::load) read for a spec; none
/// for a known name and for a generator's.
pub fn inputs(spec: &str) -> Vec<PathBuf> {
    let is_known = known().iter().any(|known| known.name == spec)
        || moving().iter().any(|(name, _)| *name == spec);
    match generate::parse(spec) {
        Ok(None) if !is_known => particle_files::inputs(spec),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_are_read() {
        for spec in ["molecule", "splash", "scattered:100", "scattered:x"] {
            assert_eq!(inputs(spec), Vec::<PathBuf>::new(), "{spec}");
        }
        assert_eq!(inputs("b.xyz"), [PathBuf::from("b.xyz")]);
    }
}
