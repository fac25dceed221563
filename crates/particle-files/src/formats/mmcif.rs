//! Molecules in mmCIF: the first model, and of alternative locations of an atom the first.

use super::structure::{self, Syntax};
use crate::error::Flaw;
use crate::particles::Particles;

/// Reads an mmCIF file.
pub(super) fn parse(bytes: &[u8]) -> Result<Particles, Flaw> {
    structure::read(bytes, Syntax::Mmcif)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::structure::tests::{mutated, symbols};
    use super::*;

    const MMCIF: &str = "\
data_test\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n\
_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n\
_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
ATOM 1 C CA ALA A 1 1.0 2.0 3.0\nATOM 2 O O ALA A 1 2.0 2.0 3.0\n";

    #[test]
    fn mmcif_is_read() {
        let particles = parse(MMCIF.as_bytes()).expect("legal");
        assert_eq!(symbols(&particles), ["C", "O"]);
        assert!(parse(b"x").expect_err("refused").problem.contains("needed"));
    }

    #[test]
    fn a_value_missing_where_pdbtbx_panics_is_an_error() {
        let broken = MMCIF.replace("ATOM 1 C CA ALA A 1 1.0", "ATOM 1 C CA ALA A 1 ?");
        let problem = parse(broken.as_bytes()).expect_err("refused").problem;
        assert!(problem.contains("Atom X position should be provided"), "{problem}");
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = parse(&bytes);
        }

        #[test]
        fn no_mutated_file_panics(bytes in mutated(MMCIF)) {
            let _ = parse(&bytes);
        }
    }
}
