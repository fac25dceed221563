//! Radii and colours of chemical elements.

use metaball_core::Color;
use pdbtbx::Element;

/// Van der Waals radius in ångströms, by Alvarez (2013), A cartography of the van der Waals
/// territories, Dalton Transactions 42, 8617; 2 Å for the few elements it leaves out.
pub(crate) fn van_der_waals_radius(element: Element) -> f32 {
    element.atomic_radius().van_der_waals.unwrap_or(2.0) as f32
}

/// The colour that molecule viewers give an element: the scheme of Corey, Pauling and Koltun with
/// Jmol's values. Pink for elements that are rare in molecules of life.
pub(crate) fn color(element: Element) -> Color {
    match element {
        Element::H => Color::srgb(255, 255, 255),
        Element::C => Color::srgb(144, 144, 144),
        Element::N => Color::srgb(48, 80, 248),
        Element::O => Color::srgb(255, 13, 13),
        Element::F => Color::srgb(144, 224, 80),
        Element::Na => Color::srgb(171, 92, 242),
        Element::Mg => Color::srgb(138, 255, 0),
        Element::P => Color::srgb(255, 128, 0),
        Element::S => Color::srgb(255, 255, 48),
        Element::Cl => Color::srgb(31, 240, 31),
        Element::K => Color::srgb(143, 64, 212),
        Element::Ca => Color::srgb(61, 255, 0),
        Element::Mn => Color::srgb(156, 122, 199),
        Element::Fe => Color::srgb(224, 102, 51),
        Element::Cu => Color::srgb(200, 128, 51),
        Element::Zn => Color::srgb(125, 128, 176),
        Element::Se => Color::srgb(255, 161, 0),
        Element::Br => Color::srgb(166, 41, 41),
        Element::I => Color::srgb(148, 0, 148),
        _ => Color::srgb(255, 20, 147),
    }
}
