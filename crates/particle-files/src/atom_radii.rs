//! Van der Waals radii of elements, of which programs have their own.

use crate::elements::Element;

/// A list of van der Waals radii, ångströms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AtomRadii {
    /// Alvarez 2013.
    Alvarez,
    /// VMD's (`periodic_table.h` of its file plugins): Bondi 1964, for ions CHARMM's, hydrogen less than bare.
    Vmd,
    /// Mol*'s (`atomic/measures.ts`): Mantina et al. 2009 and what others extend it by.
    MolStar,
}

impl AtomRadii {
    /// The radius of an atom.
    pub(crate) fn of(self, element: Option<Element>) -> f32 {
        match (self, element) {
            (_, None) => self.unknown(),
            (Self::Alvarez, Some(element)) => element.van_der_waals_radius(),
            (Self::Vmd, Some(element)) => listed(VMD, element),
            (Self::MolStar, Some(element)) => listed(MOL_STAR, element),
        }
    }

    /// The radius of an atom of no known element.
    pub(crate) fn unknown(self) -> f32 {
        match self {
            Self::Alvarez => 2.0,
            Self::Vmd => 1.5,
            Self::MolStar => 1.7,
        }
    }

    /// Whose they are.
    pub(crate) fn source(self) -> &'static str {
        match self {
            Self::Alvarez => "Alvarez 2013",
            Self::Vmd => "VMD's: Bondi 1964, hydrogen 1 Å",
            Self::MolStar => "Mol*'s: Mantina et al. 2009",
        }
    }
}

/// The radius in a list; 2 Å where it has none.
fn listed(list: &[(&str, f32)], element: Element) -> f32 {
    let own = list.iter().find(|(symbol, _)| *symbol == element.symbol());
    own.map_or(2.0, |(_, radius)| *radius)
}

#[rustfmt::skip]
const VMD: &[(&str, f32)] = &[
    ("H", 1.0), ("C", 1.7), ("N", 1.55), ("O", 1.52), ("P", 1.8), ("S", 1.8), ("He", 1.4), ("Li", 1.82),
    ("F", 1.47), ("Ne", 1.54), ("Na", 1.36), ("Mg", 1.18), ("Si", 2.1), ("Cl", 2.27), ("Ar", 1.88), ("K", 1.76),
    ("Ca", 1.37), ("Ni", 1.63), ("Cu", 1.4), ("Zn", 1.39), ("Ga", 1.07), ("As", 1.85), ("Se", 1.9), ("Br", 1.85),
    ("Kr", 2.02), ("Pd", 1.63), ("Ag", 1.72), ("Cd", 1.58), ("In", 1.93), ("Sn", 2.17), ("Te", 2.06), ("I", 1.98),
    ("Xe", 2.16), ("Cs", 2.1), ("Pt", 1.72), ("Au", 1.66), ("Hg", 1.55), ("Tl", 1.96), ("Pb", 2.02), ("U", 1.86),
];

#[rustfmt::skip]
const MOL_STAR: &[(&str, f32)] = &[
    ("H", 1.1), ("C", 1.7), ("N", 1.55), ("O", 1.52), ("P", 1.8), ("S", 1.8), ("He", 1.4), ("Li", 1.81),
    ("Be", 1.53), ("B", 1.92), ("F", 1.47), ("Ne", 1.54), ("Na", 2.27), ("Mg", 1.73), ("Al", 1.84), ("Si", 2.1),
    ("Cl", 1.75), ("Ar", 1.88), ("K", 2.75), ("Ca", 2.31), ("Sc", 2.3), ("Ti", 2.15), ("V", 2.05), ("Cr", 2.05),
    ("Mn", 2.05), ("Fe", 2.05), ("Zn", 2.1), ("Ga", 1.87), ("Ge", 2.11), ("As", 1.85), ("Se", 1.9), ("Br", 1.83),
    ("Kr", 2.02), ("Rb", 3.03), ("Sr", 2.49), ("Y", 2.4), ("Zr", 2.3), ("Nb", 2.15), ("Mo", 2.1), ("Tc", 2.05),
    ("Ru", 2.05), ("Pd", 2.05), ("Ag", 2.1), ("Cd", 2.2), ("In", 2.2), ("Sn", 1.93), ("Sb", 2.17), ("Te", 2.06),
    ("I", 1.98), ("Xe", 2.16), ("Cs", 3.43), ("Ba", 2.68), ("La", 2.5), ("Ce", 2.48), ("Pr", 2.47), ("Nd", 2.45),
    ("Pm", 2.43), ("Sm", 2.42), ("Eu", 2.4), ("Gd", 2.38), ("Tb", 2.37), ("Dy", 2.35), ("Ho", 2.33), ("Er", 2.32),
    ("Tm", 2.3), ("Yb", 2.28), ("Lu", 2.27), ("Hf", 2.25), ("Ta", 2.2), ("W", 2.1), ("Re", 2.05), ("Pt", 2.05),
    ("Au", 2.1), ("Hg", 2.05), ("Tl", 1.96), ("Pb", 2.02), ("Bi", 2.07), ("Po", 1.97), ("At", 2.02), ("Rn", 2.2),
    ("Fr", 3.48), ("Ra", 2.83), ("Th", 2.4), ("U", 2.3),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_an_element_and_all_have_a_radius() {
        for (symbol, radius) in VMD.iter().chain(MOL_STAR) {
            let element = Element::of_symbol(symbol).expect(symbol);
            assert_eq!(element.symbol(), *symbol);
            assert!((1.0..3.6).contains(radius), "{symbol}");
        }
        let iron = Element::of_symbol("Fe");
        let of_iron =
            [AtomRadii::Alvarez, AtomRadii::Vmd, AtomRadii::MolStar].map(|radii| radii.of(iron));
        assert_eq!(of_iron, [2.44, 2.0, 2.05]);
        assert_eq!(AtomRadii::Vmd.of(None), 1.5);
    }
}
