//! Molecular structures through the crate pdbtbx, which reads PDB and mmCIF.
//!
//! The first model is read, and of alternative locations of an atom the first.

use std::io::BufReader;

use glam::Vec3;
use pdbtbx::{Context, PDB, PDBError, ReadOptions, StrictnessLevel};

use crate::error::Flaw;
use crate::guard::without_panic;
use crate::molecule::{Atom, particles_of};
use crate::particles::Particles;

pub(super) use pdbtbx::Format as Syntax;

/// The atoms of a structure's first model.
pub(super) fn read(bytes: &[u8], syntax: Syntax) -> Result<Particles, Flaw> {
    // pdbtbx panics on some files that break the rules, mmCIF without a value for a required column
    // among them. That must not end a program that was given such a file.
    let structure = without_panic(|| {
        ReadOptions::default()
            .set_format(syntax)
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
        let first_location =
            residue.conformers().find_map(|conformer| conformer.alternative_location());
        for conformer in residue.conformers() {
            let location = conformer.alternative_location();
            if location.is_some() && location != first_location {
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

#[cfg(test)]
pub(super) mod tests {
    use pdbtbx::Element;
    use proptest::prelude::*;

    use super::*;
    use crate::elements::color;

    /// The symbols of the elements that have the particles' colours.
    pub(in crate::formats) fn symbols(particles: &Particles) -> Vec<&'static str> {
        let colors = particles.colors.as_ref().expect("molecules have colours");
        let all = (1..=118).filter_map(Element::new);
        let symbol = |wanted| all.clone().find(|element| color(*element) == wanted);
        colors.iter().filter_map(|wanted| symbol(*wanted)).map(|e| e.symbol()).collect()
    }

    /// One byte of the text changed, one cut out, or the rest cut off.
    pub(in crate::formats) fn mutated(text: &'static str) -> impl Strategy<Value = Vec<u8>> {
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
}
