//! Chemical elements: how files write them, their radii and colours.

use metaball_core::Color;

/// A chemical element, by its atomic number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Element(u8);

impl Element {
    pub(crate) const HYDROGEN: Self = Self(1);

    /// The element of an atomic number.
    pub(crate) fn of_number(number: u8) -> Option<Self> {
        (1..=ELEMENTS.len()).contains(&number.into()).then_some(Self(number))
    }

    /// The element of a symbol, in any capitals. Deuterium and tritium are hydrogen.
    pub(crate) fn of_symbol(symbol: &str) -> Option<Self> {
        if ["D", "T"].iter().any(|isotope| isotope.eq_ignore_ascii_case(symbol)) {
            return Some(Self::HYDROGEN);
        }
        let index = ELEMENTS.iter().position(|(own, _)| own.eq_ignore_ascii_case(symbol))?;
        Some(Self(index as u8 + 1))
    }

    /// The atomic number.
    pub(crate) fn number(self) -> u8 {
        self.0
    }

    /// Its symbol.
    pub(crate) fn symbol(self) -> &'static str {
        ELEMENTS[usize::from(self.0) - 1].0
    }

    /// Van der Waals radius in ångströms, by Alvarez (2013), A cartography of the van der Waals
    /// territories, Dalton Transactions 42, 8617; 2 Å for the few elements it leaves out.
    pub(crate) fn van_der_waals_radius(self) -> f32 {
        ELEMENTS[usize::from(self.0) - 1].1
    }

    /// The colour that molecule viewers give an element: the scheme of Corey, Pauling and Koltun with
    /// Jmol's values. Pink for elements that are rare in molecules of life.
    pub(crate) fn color(self) -> Color {
        match self.symbol() {
            "H" => Color::srgb(255, 255, 255),
            "C" => Color::srgb(144, 144, 144),
            "N" => Color::srgb(48, 80, 248),
            "O" => Color::srgb(255, 13, 13),
            "F" => Color::srgb(144, 224, 80),
            "Na" => Color::srgb(171, 92, 242),
            "Mg" => Color::srgb(138, 255, 0),
            "P" => Color::srgb(255, 128, 0),
            "S" => Color::srgb(255, 255, 48),
            "Cl" => Color::srgb(31, 240, 31),
            "K" => Color::srgb(143, 64, 212),
            "Ca" => Color::srgb(61, 255, 0),
            "Mn" => Color::srgb(156, 122, 199),
            "Fe" => Color::srgb(224, 102, 51),
            "Cu" => Color::srgb(200, 128, 51),
            "Zn" => Color::srgb(125, 128, 176),
            "Se" => Color::srgb(255, 161, 0),
            "Br" => Color::srgb(166, 41, 41),
            "I" => Color::srgb(148, 0, 148),
            _ => Color::srgb(255, 20, 147),
        }
    }
}

/// The element that a word says: a symbol in any capitals, an atomic number, or a label that begins with a
/// symbol, as `O1`, `C12` and `O_w` do.
pub(crate) fn element_of_label(label: &str) -> Option<Element> {
    let label = label.trim();
    if let Ok(number) = label.parse() {
        return Element::of_number(number);
    }
    let letters = label.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(label.len());
    let (symbol, behind) = label.split_at(letters);
    // A charge or a number is part of a label; anything else makes it another word.
    let is_label = behind.chars().all(|c| c.is_ascii_digit() || "+-'\"".contains(c))
        || behind.starts_with(['_', '.', '-', '(', '@']);
    if is_label { Element::of_symbol(symbol) } else { None }
}

/// Whether a label is what programs of quantum chemistry call a place without an atom: `X`, `Bq`, `Gh`,
/// `O-Bq`, `H:`.
pub(crate) fn is_ghost(label: &str) -> bool {
    const GHOSTS: [&str; 6] = ["X", "Xx", "Bq", "Gh", "Du", "DA"];
    let label = label.trim();
    let of_element = |behind: &str| {
        label.strip_suffix(behind).is_some_and(|label| element_of_label(label).is_some())
    };
    let letters = label.trim_end_matches(|c: char| c.is_ascii_digit());
    GHOSTS.iter().any(|ghost| ghost.eq_ignore_ascii_case(letters))
        || of_element("-Bq")
        || of_element(":")
}

/// Symbols and van der Waals radii, from hydrogen on.
#[rustfmt::skip]
const ELEMENTS: [(&str, f32); 118] = [
    ("H", 1.2), ("He", 1.43), ("Li", 2.12), ("Be", 1.98), ("B", 1.91), ("C", 1.77),
    ("N", 1.66), ("O", 1.5), ("F", 1.46), ("Ne", 1.58), ("Na", 2.5), ("Mg", 2.51),
    ("Al", 2.25), ("Si", 2.19), ("P", 1.9), ("S", 1.89), ("Cl", 1.82), ("Ar", 1.83),
    ("K", 2.73), ("Ca", 2.62), ("Sc", 2.58), ("Ti", 2.46), ("V", 2.42), ("Cr", 2.45),
    ("Mn", 2.45), ("Fe", 2.44), ("Co", 2.4), ("Ni", 2.4), ("Cu", 2.38), ("Zn", 2.39),
    ("Ga", 2.32), ("Ge", 2.29), ("As", 1.88), ("Se", 1.82), ("Br", 1.86), ("Kr", 2.25),
    ("Rb", 3.21), ("Sr", 2.84), ("Y", 2.75), ("Zr", 2.52), ("Nb", 2.56), ("Mo", 2.45),
    ("Tc", 2.44), ("Ru", 2.46), ("Rh", 2.44), ("Pd", 2.15), ("Ag", 2.53), ("Cd", 2.49),
    ("In", 2.43), ("Sn", 2.42), ("Sb", 2.47), ("Te", 1.99), ("I", 2.04), ("Xe", 2.06),
    ("Cs", 3.48), ("Ba", 3.03), ("La", 2.98), ("Ce", 2.88), ("Pr", 2.92), ("Nd", 2.95),
    ("Pm", 2.0), ("Sm", 2.9), ("Eu", 2.87), ("Gd", 2.83), ("Tb", 2.79), ("Dy", 2.87),
    ("Ho", 2.81), ("Er", 2.83), ("Tm", 2.79), ("Yb", 2.8), ("Lu", 2.74), ("Hf", 2.63),
    ("Ta", 2.53), ("W", 2.57), ("Re", 2.49), ("Os", 2.48), ("Ir", 2.41), ("Pt", 2.29),
    ("Au", 2.32), ("Hg", 2.45), ("Tl", 2.47), ("Pb", 2.6), ("Bi", 2.54), ("Po", 2.0),
    ("At", 2.0), ("Rn", 2.0), ("Fr", 2.0), ("Ra", 2.0), ("Ac", 2.8), ("Th", 2.93),
    ("Pa", 2.88), ("U", 2.71), ("Np", 2.82), ("Pu", 2.81), ("Am", 2.83), ("Cm", 3.05),
    ("Bk", 3.4), ("Cf", 3.05), ("Es", 2.7), ("Fm", 2.0), ("Md", 2.0), ("No", 2.0), ("Lr", 2.0),
    ("Rf", 2.0), ("Db", 2.0), ("Sg", 2.0), ("Bh", 2.0), ("Hs", 2.0), ("Mt", 2.0), ("Ds", 2.0),
    ("Rg", 2.0), ("Cn", 2.0), ("Nh", 2.0), ("Fl", 2.0), ("Mc", 2.0), ("Lv", 2.0), ("Ts", 2.0),
    ("Og", 2.0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_symbols_are_the_same_elements() {
        for number in 1..=118 {
            let element = Element::of_number(number).expect("an element");
            assert_eq!(Element::of_symbol(element.symbol()), Some(element));
            assert!((1.0..3.6).contains(&element.van_der_waals_radius()), "{element:?}");
        }
        for (number, symbol) in [(1, "H"), (26, "Fe"), (79, "Au"), (118, "Og")] {
            assert_eq!(Element::of_number(number).map(Element::symbol), Some(symbol));
        }
        assert_eq!((Element::of_number(0), Element::of_number(119)), (None, None));
    }

    #[test]
    fn ghosts_are_no_elements() {
        for label in ["X", "XX", "Bq", "bq3", "Gh", "Du", "O-Bq", "H:"] {
            assert!(is_ghost(label), "{label}");
        }
        for label in ["Xe", "H", "bead", ":", "B", ""] {
            assert!(!is_ghost(label), "{label}");
        }
    }

    #[test]
    fn labels_say_elements() {
        for (label, symbol) in [
            ("O", "O"),
            ("O1", "O"),
            ("H12", "H"),
            ("C_w", "C"),
            ("FE", "FE"),
            ("cl", "CL"),
            ("Na+", "NA"),
            ("Ca2+", "CA"),
            ("8", "O"),
            ("D", "H"),
            ("C1'", "C"),
        ] {
            let found = element_of_label(label).map(|element| element.symbol().to_uppercase());
            assert_eq!(found.as_deref(), Some(symbol), "{label}");
        }
        for label in ["", "bead", "0", "119", "-1", "Å", "O2x", "1O", "_O", "Xx"] {
            assert_eq!(element_of_label(label), None, "{label}");
        }
    }
}
