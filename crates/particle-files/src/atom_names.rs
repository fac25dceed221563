//! What atoms are by the names that structures give them: elements, ions, beads and virtual sites.

use crate::elements::Element;

/// What structures call water. `W`, `WF` and `PW` are beads of four waters.
pub(crate) const WATER: [&str; 25] = [
    "HOH", "WAT", "SOL", "H2O", "HHO", "OHH", "DOD", "D2O", "TIP", "TIP2", "TIP3", "TIP4", "TIP5",
    "TIP3P", "TP3", "TP4", "TP5", "T3P", "T4P", "SPC", "SPCE", "OPC", "W", "WF", "PW",
];

/// What an atom turns out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Identity {
    /// Of the element that the file says.
    Given(Element),
    /// Of the element that its names say.
    Guessed(Element),
    /// A bead of a coarse-grained model, whose other names say no elements either.
    Bead,
    /// No atom: a place where a model of water has a charge, a lone pair, a pseudo-atom.
    VirtualSite,
    Unknown,
}

/// The names of an atom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Names<'a> {
    /// The element that the file says, or nothing.
    pub(crate) element: &'a str,
    /// The name in its residue.
    pub(crate) name: &'a str,
    pub(crate) residue: &'a str,
    /// How many letters the symbol has, where the name's columns say that.
    pub(crate) letters: Option<usize>,
}

impl Names<'_> {
    /// What such an atom is.
    pub(crate) fn identity(&self) -> Identity {
        let symbol =
            self.element.trim_end_matches(|c: char| c.is_ascii_digit() || "+-".contains(c));
        if let Some(element) = Element::of_symbol(symbol) {
            return Identity::Given(element);
        }
        let given = self.element.to_ascii_uppercase();
        let (name, residue) = (self.name.to_ascii_uppercase(), self.residue.to_ascii_uppercase());
        if NO_ATOMS.contains(&given.as_str()) || is_virtual(&name, &residue) {
            return Identity::VirtualSite;
        }
        if is_bead(&name, &residue) {
            return Identity::Bead;
        }
        // The Protein Data Bank calls atoms of unknown kinds X in these residues.
        if given == "X" && ["UNX", "UNK", "UNL"].contains(&residue.as_str()) {
            return Identity::Unknown;
        }
        match guess(&name, &residue, self.letters) {
            Some(element) => Identity::Guessed(element),
            None if PERHAPS_NO_ATOMS.contains(&given.as_str()) && WATER.contains(&&*residue) => {
                Identity::VirtualSite
            }
            None => Identity::Unknown,
        }
    }
}

/// What programs write for the element of a virtual site.
const NO_ATOMS: [&str; 5] = ["EP", "LP", "XP", "VS", "DU"];

/// The same in water, unless the name says an element; elsewhere these are atoms of unknown kinds.
const PERHAPS_NO_ATOMS: [&str; 3] = ["M", "X", "XX"];

/// Residues of proteins, their protonated forms by AMBER, CHARMM and GROMACS, and caps.
const AMINO_ACIDS: [&str; 59] = [
    "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET",
    "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL", "MSE", "SEC", "PYL", "ASX", "GLX", "UNK",
    "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "CYX", "CYM", "ASH", "GLH", "LYN", "HISA", "HISB",
    "HISD", "HISE", "HISH", "HIS1", "HIS2", "LYSH", "CYSH", "CYS2", "ASPH", "ASPP", "GLUH", "GLUP",
    "ARGN", "ACE", "NME", "NMA", "NH2", "FOR", "SEP", "TPO",
];

/// Residues of nucleic acids, without the digits that say which end they are at.
const NUCLEOTIDES: [&str; 21] = [
    "A", "C", "G", "U", "T", "I", "N", "DA", "DC", "DG", "DT", "DU", "DI", "RA", "RC", "RG", "RU",
    "ADE", "CYT", "GUA", "THY",
];

fn is_amino_acid(residue: &str) -> bool {
    // AMBER puts N or C before the name of a residue at that end.
    let inner = residue.strip_prefix(['N', 'C', 'D']).filter(|inner| inner.len() == 3);
    [Some(residue), inner].into_iter().flatten().any(|name| AMINO_ACIDS.contains(&name))
}

/// Whether it is a residue of proteins or nucleic acids, or water.
pub(crate) fn is_known_residue(residue: &str) -> bool {
    is_polymer(residue) || WATER.contains(&residue)
}

fn is_polymer(residue: &str) -> bool {
    let base = residue.trim_end_matches(['3', '5']);
    is_amino_acid(residue) || NUCLEOTIDES.contains(&base) || base == "URA"
}

/// Whether the name is that of a place without an atom.
fn is_virtual(name: &str, residue: &str) -> bool {
    let is_numbered = |stem: &str| {
        name.strip_prefix(stem).is_some_and(|rest| rest.bytes().all(|b| b.is_ascii_digit()))
    };
    let has_prefix = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    if ["EP", "EPW", "LP", "LPA", "LPB", "XP", "DUM"].iter().any(|stem| is_numbered(stem)) {
        return true;
    }
    if WATER.contains(&residue) {
        return name == "M" || has_prefix(&["MW", "OM", "DM", "VS", "IW"]);
    }
    // Masses of rigid groups (GROMACS), and the middle of hydrogens that NMR cannot tell apart.
    is_numbered("MW") || (is_amino_acid(residue) && has_prefix(&["M", "Q"]))
}

/// Whether the name is one that only coarse-grained models have (MARTINI).
fn is_bead(name: &str, residue: &str) -> bool {
    match name {
        "BB" | "SC1" | "SC2" | "SC3" | "SC4" | "SC5" => is_amino_acid(residue),
        "W" | "WP" | "WM" => ["W", "WF", "PW"].contains(&residue),
        "WF" | "SW" | "TW" => residue == name,
        "PO4" | "GL1" | "GL2" => residue != name,
        _ => false,
    }
}

fn guess(name: &str, residue: &str, letters: Option<usize>) -> Option<Element> {
    // Old names of hydrogens begin with a number.
    let bare = name.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
    let word = &bare[..bare.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(bare.len())];
    let first = word.get(..1)?;
    if let Some(element) = ion(word, residue) {
        return Some(element);
    }
    if is_known_residue(residue) {
        match first {
            _ if word == "SE" => return Element::of_symbol(word),
            "H" | "C" | "N" | "O" | "S" | "P" | "D" => return Element::of_symbol(first),
            _ => {}
        }
    }
    let two = word.get(..2).filter(|_| bare.len() == name.len());
    let is_two = two.is_some_and(|two| match letters {
        Some(1) => false,
        // Names of four letters begin a column earlier, whatever their element.
        Some(_) if name.len() < 4 => !two.starts_with('H') || word.len() == 2,
        _ => UNMISTAKABLE.contains(&two) || ["CU", "NI"].contains(&word),
    });
    let of_two = two.filter(|_| is_two).and_then(Element::of_symbol);
    // Longer words begin with the symbol of an element only where it is common.
    let is_likely = word.len() == 1 || "HCNOSPFD".contains(first);
    of_two.or_else(|| Element::of_symbol(first).filter(|_| is_likely && first != "T"))
}

/// Symbols that no name of an atom of another element begins with.
const UNMISTAKABLE: [&str; 17] = [
    "CL", "BR", "FE", "ZN", "MG", "MN", "SE", "SI", "LI", "AL", "AS", "PT", "RU", "RH", "AU", "AG",
    "MO",
];

/// What CHARMM calls ions.
const IONS: [(&str, &str); 11] = [
    ("SOD", "NA"),
    ("POT", "K"),
    ("CLA", "CL"),
    ("CAL", "CA"),
    ("CES", "CS"),
    ("LIT", "LI"),
    ("RUB", "RB"),
    ("BAR", "BA"),
    ("CAD", "CD"),
    ("IOD", "I"),
    ("ZIN", "ZN"),
];

/// The element of an atom that is a residue of its own: both have the name of the ion.
fn ion(word: &str, residue: &str) -> Option<Element> {
    let symbol = |word: &str| {
        let named = IONS.iter().find(|(name, _)| *name == word).map(|(_, symbol)| *symbol);
        Element::of_symbol(named.unwrap_or(word))
    };
    let alone = residue.trim_matches(|c: char| !c.is_ascii_alphabetic());
    let is_ion = alone.starts_with("ION") || alone == word || symbol(alone) == symbol(word);
    let is_short = word.len() <= 2 || IONS.iter().any(|(name, _)| *name == word);
    (is_ion && is_short && alone != "DC").then(|| symbol(word)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(element: &str, name: &str, residue: &str, letters: Option<usize>) -> Identity {
        Names { element, name, residue, letters }.identity()
    }

    fn guessed(name: &str, residue: &str, letters: Option<usize>) -> String {
        match identity("", name, residue, letters) {
            Identity::Guessed(element) => element.symbol().to_owned(),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn a_given_element_wins() {
        let calcium = Identity::Given(Element::of_symbol("Ca").expect("an element"));
        for given in ["CA", "Ca", "Ca2+", "ca"] {
            assert_eq!(identity(given, "CA", "ALA", Some(1)), calcium);
        }
        assert_eq!(identity("D", "MW", "SOL", None), Identity::Given(Element::HYDROGEN));
        let carbon = Element::of_symbol("C").expect("an element");
        assert_eq!(identity("A", "CA", "ALA", None), Identity::Guessed(carbon));
    }

    #[test]
    fn names_of_residues_say_elements() {
        for (name, residue, letters, symbol) in [
            ("CA", "ALA", None, "C"),
            ("CA", "ALA", Some(2), "C"),
            ("CA", "NALA", Some(2), "C"),
            ("CA", "CA", Some(2), "Ca"),
            ("CA", "CA", None, "Ca"),
            ("CA", "CA2", None, "Ca"),
            ("HG11", "ILE", Some(2), "H"),
            ("1HD1", "ILE", Some(1), "H"),
            ("HO5'", "DA", Some(2), "H"),
            ("O5'", "DA5", Some(1), "O"),
            ("C5", "DC", None, "C"),
            ("C4", "C", None, "C"),
            ("SE", "MSE", Some(2), "Se"),
            ("SD", "MET", None, "S"),
            ("D1", "DOD", None, "H"),
            ("DA", "ALA", None, "H"),
            ("NA", "HEM", Some(1), "N"),
            ("NA", "HEM", None, "N"),
            ("FE", "HEM", Some(2), "Fe"),
            ("FE", "HEM", None, "Fe"),
            ("CL1", "LIG", None, "Cl"),
            ("CD", "LIG", None, "C"),
            ("CD", "LIG", Some(2), "Cd"),
            ("HG", "LIG", Some(2), "Hg"),
            ("HAA1", "LIG", Some(2), "H"),
            ("CAA1", "LIG", Some(2), "C"),
            ("CL12", "LIG", Some(2), "Cl"),
            ("NA", "NA", None, "Na"),
            ("NA+", "NA+", None, "Na"),
            ("NA", "ION", None, "Na"),
            ("SOD", "SOD", None, "Na"),
            ("CLA", "CLA", None, "Cl"),
            ("CL", "CLA", None, "Cl"),
            ("CL-", "ION", None, "Cl"),
            ("POT", "POT", None, "K"),
            ("K", "K", Some(1), "K"),
            ("CAL", "CAL", None, "Ca"),
            ("ZN", "ZN2", None, "Zn"),
            ("FE", "FE2", None, "Fe"),
            ("MG", "MG", None, "Mg"),
            ("OW", "SOL", None, "O"),
            ("HW1", "SOL", None, "H"),
            ("OH2", "TIP3", None, "O"),
            ("P", "POPC", None, "P"),
            ("C218", "POPC", None, "C"),
            ("CU", "CU1", None, "Cu"),
            ("CO", "B12", Some(2), "Co"),
            ("F1", "LIG", None, "F"),
            ("U1", "LIG", None, "U"),
        ] {
            assert_eq!(guessed(name, residue, letters), symbol, "{name} in {residue}, {letters:?}");
        }
        for name in ["", "1", "''", "*", "Å", "X1", "A", "UNK", "T1"] {
            assert_eq!(identity("", name, "LIG", None), Identity::Unknown, "{name}");
        }
    }

    #[test]
    fn virtual_sites_are_no_atoms() {
        for (element, name, residue) in [
            ("", "MW", "SOL"),
            ("", "M", "HOH"),
            ("", "EPW", "WAT"),
            ("", "EP1", "LIG"),
            ("", "LP2", "TIP5"),
            ("EP", "ABC", "WAT"),
            ("X", "A", "HOH"),
            ("", "QB", "ALA"),
            ("", "MCB1", "ALA"),
        ] {
            let found = identity(element, name, residue, None);
            assert_eq!(found, Identity::VirtualSite, "{name} in {residue}");
        }
        assert_eq!(identity("X", "U", "UNX", None), Identity::Unknown);
        assert_eq!(identity("X", "X", "SYS", None), Identity::Unknown);
        assert_eq!(guessed("MG", "MG", None), "Mg");
        assert_eq!(guessed("MN", "MN", None), "Mn");
    }

    #[test]
    fn beads_are_known_by_names_of_their_own() {
        for (name, residue) in [("BB", "ALA"), ("SC1", "LYS"), ("W", "W"), ("PO4", "POP")] {
            assert_eq!(identity("", name, residue, None), Identity::Bead, "{name} in {residue}");
        }
        assert_ne!(identity("", "P", "PO4", None), Identity::Bead);
        assert_ne!(identity("B", "BB", "ALA", None), Identity::Bead);
    }
}
