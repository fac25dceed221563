//! Molecules from structure files, PDB and mmCIF, through the crate pdbtbx.
//!
//! The first model is read, and of alternative places of an atom the first.

use std::io::BufReader;

use glam::Vec3;
use metaball_core::Metaball;
use pdbtbx::{Context, Element, Format, PDB, PDBError, ReadOptions, StrictnessLevel};

use crate::elements::{color, van_der_waals_radius};
use crate::error::Flaw;
use crate::guard::without_panic;
use crate::particles::Particles;

/// Support radius over van der Waals radius: with the default kernel and threshold an atom alone then
/// shows at its van der Waals radius, since the quartic takes the value ¼ at R/√2.
pub const SUPPORT_OVER_VAN_DER_WAALS: f32 = std::f32::consts::SQRT_2;

/// The most atoms that the columns of a PDB file can number.
const PDB_ATOMS: usize = 99_999;

/// One atom.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Atom {
    pub(crate) element: Element,
    /// Ångströms.
    pub(crate) center: Vec3,
}

/// The atoms as metaballs in the colours of their elements.
pub(crate) fn particles_of(atoms: &[Atom]) -> Particles {
    let ball = |atom: &Atom| {
        let radius = SUPPORT_OVER_VAN_DER_WAALS * van_der_waals_radius(atom.element);
        Metaball::new(atom.center, radius)
    };
    Particles {
        balls: atoms.iter().map(ball).collect(),
        colors: Some(atoms.iter().map(|atom| color(atom.element)).collect()),
        ..Particles::default()
    }
}

/// Reads a PDB file.
pub(crate) fn parse_pdb(bytes: &[u8]) -> Result<Particles, Flaw> {
    let atoms = bytes.split(|byte| *byte == b'\n').filter(|line| is_atom(line)).count();
    read(&with_elements(bytes), Format::Pdb).map_err(|flaw| {
        if atoms <= PDB_ATOMS {
            return flaw;
        }
        let needed = format!("at most {PDB_ATOMS} atoms in a PDB file (use mmCIF for more)");
        Flaw::needed(&needed, format_args!("{atoms} ({})", flaw.problem))
    })
}

/// Reads an mmCIF file.
pub(crate) fn parse_mmcif(bytes: &[u8]) -> Result<Particles, Flaw> {
    read(bytes, Format::Mmcif)
}

fn read(bytes: &[u8], format: Format) -> Result<Particles, Flaw> {
    // pdbtbx panics on some files that break the rules, mmCIF without a value for a required column
    // among them. That must not end a program that was given such a file.
    let structure = without_panic(|| {
        ReadOptions::default()
            .set_format(format)
            .set_level(StrictnessLevel::Loose)
            .set_only_atomic_coords(true)
            .set_only_first_model(true)
            .read_raw(BufReader::new(bytes))
    });
    match structure {
        Ok(Ok((structure, _))) => Ok(particles_of(&atoms_of(&structure)?)),
        Ok(Err(errors)) => Err(first_flaw(&errors)),
        Err(panic) => Err(Flaw::needed("a well-formed structure", panic)),
    }
}

fn atoms_of(structure: &PDB) -> Result<Vec<Atom>, Flaw> {
    let mut atoms = Vec::new();
    for residue in structure.residues() {
        let first_place =
            residue.conformers().find_map(|conformer| conformer.alternative_location());
        for conformer in residue.conformers() {
            let place = conformer.alternative_location();
            if place.is_some() && place != first_place {
                continue;
            }
            for atom in conformer.atoms() {
                let (x, y, z) = atom.pos();
                let name = format_args!("{} (serial number {})", atom.name(), atom.serial_number());
                let element = atom
                    .element()
                    .copied()
                    .ok_or_else(|| Flaw::needed("a chemical element for every atom", name))?;
                atoms.push(Atom { element, center: Vec3::new(x as f32, y as f32, z as f32) });
            }
        }
    }
    if atoms.is_empty() {
        return Err(Flaw::needed("atoms", "none"));
    }
    Ok(atoms)
}

/// The first error that is more than a warning.
fn first_flaw(errors: &[PDBError]) -> Flaw {
    let breaking = errors.iter().find(|error| error.fails(StrictnessLevel::Loose));
    let Some(error) = breaking.or(errors.first()) else {
        return Flaw::needed("a well-formed structure", "one that pdbtbx refuses without a reason");
    };
    let found = format!("{}: {}", error.short_description(), error.long_description());
    let flaw = |found: &str| Flaw::needed("a well-formed structure", found);
    match error.context() {
        Context::FullLine { linenumber, .. } => flaw(&found).at_line(*linenumber),
        Context::Line { linenumber, offset, .. } => {
            flaw(&found).at_line(*linenumber).at_column(offset + 1)
        }
        Context::Range { start_linenumber, .. } => flaw(&found).at_line(*start_linenumber),
        Context::Show { line } => flaw(&format!("{found} ({line})")),
        _ => flaw(&found),
    }
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
    use proptest::prelude::*;

    use super::*;

    const PDB: &str = "\
ATOM      1  CA  ALA     1      37.970  45.620   7.550  1.00  0.00            \n\
ATOM      2 HH11 ARG     2      38.970  45.620   7.550  1.00  0.00            \n\
ATOM      3 1HB  ALA     3      39.970  45.620   7.550  1.00  0.00            \n\
HETATM    4 CA    CA     4      40.970  45.620   7.550  1.00  0.00            \n\
HETATM    5 FE   HEM     5      41.970  45.620   7.550  1.00  0.00          FE\n";

    const MMCIF: &str = "\
data_test\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n\
_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n\
_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
ATOM 1 C CA ALA A 1 1.0 2.0 3.0\nATOM 2 O O ALA A 1 2.0 2.0 3.0\n";

    fn symbols(particles: &Particles) -> Vec<&'static str> {
        let colors = particles.colors.as_ref().expect("molecules have colours");
        let all = (1..=118).filter_map(Element::new);
        let symbol = |wanted| all.clone().find(|element| color(*element) == wanted);
        colors.iter().filter_map(|wanted| symbol(*wanted)).map(|e| e.symbol()).collect()
    }

    #[test]
    fn elements_come_from_the_columns_of_the_name() {
        let particles = parse_pdb(PDB.as_bytes()).expect("legal");
        assert_eq!(symbols(&particles), ["C", "H", "H", "CA", "FE"]);
        assert_eq!(particles.balls[0].center, Vec3::new(37.97, 45.62, 7.55));
        // Carbon, Alvarez: 1.77 Å.
        assert_eq!(particles.balls[0].radius, 1.77 * SUPPORT_OVER_VAN_DER_WAALS);
    }

    #[test]
    fn mmcif_is_read() {
        let particles = parse_mmcif(MMCIF.as_bytes()).expect("legal");
        assert_eq!(symbols(&particles), ["C", "O"]);
    }

    #[test]
    fn an_atom_alone_shows_at_its_van_der_waals_radius() {
        let atom = Atom { element: Element::O, center: Vec3::ZERO };
        let ball = particles_of(&[atom]).balls[0];
        let core = crate::DEFAULT_KERNEL.core_radius(&ball, crate::DEFAULT_THRESHOLD);
        // √2 and the radius are rounded to f32: twice 6e-8 relative.
        approx(core.expect("the quartic reaches 1/4"), 1.5, 2e-7);
    }

    fn approx(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() < tolerance, "{found} is not {expected}");
    }

    #[test]
    fn refusals_name_the_line() {
        let broken = PDB.replace("38.970", "38.x70");
        let message =
            parse_pdb(broken.as_bytes()).expect_err("refused").in_file("a.pdb").to_string();
        assert!(message.starts_with("a.pdb, line 2, column 31: needed a well-formed"), "{message}");
        assert!(parse_pdb(b"").expect_err("refused").problem.contains("needed"));
        assert!(parse_mmcif(b"x").expect_err("refused").problem.contains("needed"));
    }

    #[test]
    fn too_large_for_pdb_says_so() {
        let row = |serial| {
            format!("ATOM  {serial:>5}  C   ALA A   1      37.970  45.620   7.550  1.00  0.00\n")
        };
        let rows: String = (0..100_001).map(|_| row("A0000")).collect();
        let problem = parse_pdb(rows.as_bytes()).expect_err("refused").problem;
        assert!(
            problem.starts_with("needed at most 99999 atoms in a PDB file (use mmCIF"),
            "{problem}"
        );
    }

    #[test]
    fn a_value_missing_where_pdbtbx_panics_is_an_error() {
        let broken = MMCIF.replace("ATOM 1 C CA ALA A 1 1.0", "ATOM 1 C CA ALA A 1 ?");
        let problem = parse_mmcif(broken.as_bytes()).expect_err("refused").problem;
        assert!(problem.contains("Atom X position should be provided"), "{problem}");
    }

    /// One byte of the text changed, one cut out, or the rest cut off.
    fn mutated(text: &'static str) -> impl Strategy<Value = Vec<u8>> {
        (0..text.len(), any::<u8>(), 0..3).prop_map(move |(at, byte, change)| {
            let mut bytes = text.as_bytes().to_vec();
            match change {
                0 => bytes[at] = byte,
                1 => drop(bytes.remove(at)),
                _ => bytes.truncate(at),
            }
            bytes
        })
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = (parse_pdb(&bytes), parse_mmcif(&bytes));
        }

        #[test]
        fn no_mutated_pdb_panics(bytes in mutated(PDB)) {
            let _ = parse_pdb(&bytes);
        }

        #[test]
        fn no_mutated_mmcif_panics(bytes in mutated(MMCIF)) {
            let _ = parse_mmcif(&bytes);
        }
    }
}
