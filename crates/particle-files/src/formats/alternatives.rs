//! Alternative places of atoms: of those that exclude each other the one with the highest occupancy.

use std::collections::{HashMap, HashSet};

/// An atom at one of several places.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Alternative {
    /// The index of the atom.
    pub(super) index: usize,
    /// Which of the places it is at.
    pub(super) label: String,
    /// What tells its residue from all others but its name, which may be an alternative too.
    pub(super) residue: String,
    pub(super) residue_name: String,
    pub(super) name: String,
    /// Part of the molecules that have it there.
    pub(super) occupancy: f64,
}

/// The indices of the atoms that are left out.
///
/// In a residue, places exclude each other that have an atom in common; all do where residues have
/// different names, or none. Of those the one with the highest mean occupancy of its
/// atoms stays; where some are equal the one of most atoms, or the first.
pub(super) fn left_out(alternatives: &[Alternative]) -> HashSet<usize> {
    let mut left_out = HashSet::new();
    for residue in residues(alternatives) {
        left_out.extend(left_out_of_residue(&residue));
    }
    left_out
}

/// The atoms of each residue. An atom that is there already, at the same place, begins another residue:
/// numbers of residues start again, and some formats give waters none.
fn residues(alternatives: &[Alternative]) -> Vec<Vec<&Alternative>> {
    let mut residues: Vec<Vec<&Alternative>> = Vec::new();
    let mut latest: HashMap<&str, usize> = HashMap::new();
    let mut seen = HashSet::new();
    for atom in alternatives {
        let residue = latest.get(atom.residue.as_str()).copied();
        let is_new =
            |index: usize| !seen.contains(&(index, &atom.label, &atom.name, &atom.residue_name));
        let index = residue.filter(|index| is_new(*index)).unwrap_or_else(|| {
            residues.push(Vec::new());
            residues.len() - 1
        });
        latest.insert(&atom.residue, index);
        seen.insert((index, &atom.label, &atom.name, &atom.residue_name));
        residues[index].push(atom);
    }
    residues
}

fn left_out_of_residue(atoms: &[&Alternative]) -> Vec<usize> {
    let mut place_of_label = HashMap::new();
    let mut places: Vec<Place> = Vec::new();
    let mut place_of_atom = Vec::with_capacity(atoms.len());
    for atom in atoms {
        let index = *place_of_label.entry(&atom.label).or_insert_with(|| {
            places.push(Place { group: places.len(), occupancy: 0.0, atoms: 0 });
            places.len() - 1
        });
        places[index].occupancy += atom.occupancy;
        places[index].atoms += 1;
        place_of_atom.push(index);
    }
    let name = &atoms[0].residue_name;
    let has_one_name = !name.is_empty() && atoms.iter().all(|atom| atom.residue_name == *name);
    let mut first_with = HashMap::new();
    for (atom, place) in atoms.iter().zip(&place_of_atom) {
        let common = if has_one_name { atom.name.as_str() } else { "" };
        let first = *first_with.entry(common).or_insert(*place);
        let (group, other) = (group_of(&mut places, first), group_of(&mut places, *place));
        places[other].group = group;
    }
    let mut best: HashMap<usize, usize> = HashMap::new();
    for place in 0..places.len() {
        let best = best.entry(group_of(&mut places, place)).or_insert(place);
        let (one, other) = (&places[place], &places[*best]);
        let has_more = one.mean() == other.mean() && one.atoms > other.atoms;
        if one.mean() > other.mean() || has_more {
            *best = place;
        }
    }
    let mut is_left_out =
        |place: usize| best.get(&group_of(&mut places, place)).is_some_and(|best| *best != place);
    let atoms = atoms.iter().zip(place_of_atom);
    atoms.filter(|(_, place)| is_left_out(*place)).map(|(atom, _)| atom.index).collect()
}

/// One of the places in a residue.
struct Place {
    /// A place that it excludes; itself where it is the first of its group.
    group: usize,
    /// Summed over its atoms.
    occupancy: f64,
    atoms: usize,
}

impl Place {
    fn mean(&self) -> f64 {
        self.occupancy / self.atoms as f64
    }
}

/// The first place of a place's group.
fn group_of(places: &mut [Place], place: usize) -> usize {
    let mut group = place;
    while places[group].group != group {
        // Halving the way keeps it short.
        let above = places[places[group].group].group;
        places[group].group = above;
        group = above;
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `label name residue-name occupancy` of each, in one residue.
    fn left(atoms: &[&str]) -> Vec<usize> {
        let alternative = |(index, atom): (usize, &&str)| {
            let fields: Vec<&str> = atom.split(' ').collect();
            Alternative {
                index,
                label: fields[0].to_owned(),
                residue: "A 1".to_owned(),
                name: fields[1].to_owned(),
                residue_name: fields[2].to_owned(),
                occupancy: fields[3].parse().expect("a number"),
            }
        };
        let atoms: Vec<_> = atoms.iter().enumerate().map(alternative).collect();
        let left_out = left_out(&atoms);
        (0..atoms.len()).filter(|index| !left_out.contains(index)).collect()
    }

    #[test]
    fn the_highest_occupancy_stays() {
        assert_eq!(left(&["A CB SER 0.2", "B CB SER 0.8", "A OG SER 0.2", "B OG SER 0.8"]), [1, 3]);
        assert_eq!(left(&["A CB SER 0.5", "B CB SER 0.5"]), [0]);
        assert_eq!(left(&["B CB SER 0.5", "A CB SER 0.5"]), [0]);
        assert_eq!(left(&["A CB SER 0.5", "B CB SER 0.5", "B OG SER 0.5"]), [1, 2]);
        // The mean counts, not how many there are.
        assert_eq!(left(&["A CB SER 0.4", "B CB SER 0.6", "A HB SER 0.4"]), [1]);
    }

    #[test]
    fn other_residues_at_one_place_exclude_each_other() {
        assert_eq!(left(&["A OG SER 0.6", "B SG CYS 0.4", "B HG CYS 0.4"]), [0]);
    }

    #[test]
    fn what_excludes_nothing_stays() {
        assert_eq!(left(&["A CB SER 0.4", "A OG SER 0.4"]), [0, 1]);
        // Main chain and side chain have places of their own.
        let both = ["A N SER 0.4", "B N SER 0.6", "C OG SER 0.7", "D OG SER 0.3"];
        assert_eq!(left(&both), [1, 2]);
    }

    #[test]
    fn a_residue_that_comes_again_is_another() {
        assert_eq!(left(&["A O HOH 0.6", "B O HOH 0.4", "A O HOH 0.3", "B O HOH 0.7"]), [0, 3]);
    }
}
