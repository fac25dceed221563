//! Molecules in the format of the Protein Data Bank: the first model, and of alternative locations of an
//! atom the first.

use pdbtbx::Element;

use super::structure::{self, Syntax};
use crate::error::Flaw;
use crate::particles::Particles;

/// The most atoms that the columns of a PDB file can number.
const PDB_ATOMS: usize = 99_999;

/// Reads a PDB file.
pub(super) fn parse(bytes: &[u8]) -> Result<Particles, Flaw> {
    let atoms = bytes.split(|byte| *byte == b'\n').filter(|line| is_atom(line)).count();
    structure::read(&with_elements(bytes), Syntax::Pdb).map_err(|flaw| {
        if atoms <= PDB_ATOMS {
            return flaw;
        }
        let needed = format!("at most {PDB_ATOMS} atoms in a PDB file (use mmCIF for more)");
        Flaw::needed(&needed, format_args!("{atoms} ({})", flaw.problem))
    })
}

fn is_atom(line: &[u8]) -> bool {
    line.starts_with(b"ATOM  ") || line.starts_with(b"HETATM")
}

/// The PDB file with columns 77–78, the element, filled in where they are blank, as simulation
/// programs leave them. Without them pdbtbx takes the name for a symbol, and every Cα for calcium.
fn with_elements(bytes: &[u8]) -> Vec<u8> {
    let mut filled = Vec::with_capacity(bytes.len());
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        let text = line.trim_ascii_end();
        let blank = text.get(76..78).is_none_or(|element| element == b"  ");
        match element_of_name(text) {
            Some(element) if blank => {
                let mut text = text.to_vec();
                text.resize(text.len().max(78), b' ');
                text[76..78].copy_from_slice(&element);
                filled.extend(text);
                filled.push(b'\n');
            }
            _ => filled.extend(line),
        }
    }
    filled
}

/// The element by the rule for atom names, columns 13–16 (PDB format 3.3, ATOM): the symbol ends in
/// column 14, save for four-letter names of hydrogens, which start in column 13.
fn element_of_name(line: &[u8]) -> Option<[u8; 2]> {
    if !is_atom(line) || !line.is_ascii() {
        return None;
    }
    let name: [u8; 4] = line.get(12..16)?.try_into().ok()?;
    let two = std::str::from_utf8(&name[..2]).ok()?;
    if !name[0].is_ascii_alphabetic() {
        return name[1].is_ascii_alphabetic().then_some([b' ', name[1]]);
    }
    let long_hydrogen = name[0] == b'H' && name[3] != b' ';
    if Element::from_symbol(two).is_some() && !long_hydrogen {
        return Some([name[0], name[1]]);
    }
    Some([b' ', name[0]])
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::super::structure::tests::{mutated, symbols};
    use super::*;
    use crate::SUPPORT_OVER_VAN_DER_WAALS;

    const PDB: &str = "\
ATOM      1  CA  ALA     1      37.970  45.620   7.550  1.00  0.00            \n\
ATOM      2 HH11 ARG     2      38.970  45.620   7.550  1.00  0.00            \n\
ATOM      3 1HB  ALA     3      39.970  45.620   7.550  1.00  0.00            \n\
HETATM    4 CA    CA     4      40.970  45.620   7.550  1.00  0.00            \n\
HETATM    5 FE   HEM     5      41.970  45.620   7.550  1.00  0.00          FE\n";

    #[test]
    fn elements_come_from_the_columns_of_the_name() {
        let particles = parse(PDB.as_bytes()).expect("legal");
        assert_eq!(symbols(&particles), ["C", "H", "H", "CA", "FE"]);
        assert_eq!(particles.balls[0].center, Vec3::new(37.97, 45.62, 7.55));
        // Carbon, Alvarez: 1.77 Å.
        assert_eq!(particles.balls[0].radius, 1.77 * SUPPORT_OVER_VAN_DER_WAALS);
    }

    #[test]
    fn refusals_name_the_line() {
        let broken = PDB.replace("38.970", "38.x70");
        let message = parse(broken.as_bytes()).expect_err("refused").in_file("a.pdb").to_string();
        assert!(message.starts_with("a.pdb, line 2, column 31: needed a well-formed"), "{message}");
        assert!(parse(b"").expect_err("refused").problem.contains("needed"));
    }

    #[test]
    fn too_large_for_pdb_says_so() {
        let row = |serial| {
            format!("ATOM  {serial:>5}  C   ALA A   1      37.970  45.620   7.550  1.00  0.00\n")
        };
        let rows: String = (0..100_001).map(|_| row("A0000")).collect();
        let problem = parse(rows.as_bytes()).expect_err("refused").problem;
        assert!(
            problem.starts_with("needed at most 99999 atoms in a PDB file (use mmCIF"),
            "{problem}"
        );
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = parse(&bytes);
        }

        #[test]
        fn no_mutated_file_panics(bytes in mutated(PDB)) {
            let _ = parse(&bytes);
        }
    }
}
