//! Atoms as metaballs.

use glam::Vec3;
use metaball_core::Metaball;
use pdbtbx::Element;

use crate::elements::{color, van_der_waals_radius};
use crate::particles::Particles;

/// Support radius over van der Waals radius: with the default kernel and threshold an atom alone then
/// shows at its van der Waals radius, since the quartic takes the value ¼ at R/√2.
pub const SUPPORT_OVER_VAN_DER_WAALS: f32 = std::f32::consts::SQRT_2;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DEFAULT_KERNEL, DEFAULT_THRESHOLD};

    #[test]
    fn an_atom_alone_shows_at_its_van_der_waals_radius() {
        let atom = Atom { element: Element::O, center: Vec3::ZERO };
        let ball = particles_of(&[atom]).balls[0];
        let core = DEFAULT_KERNEL.core_radius(&ball, DEFAULT_THRESHOLD);
        // √2 and the radius are rounded to f32: twice 6e-8 relative.
        approx(core.expect("the quartic reaches 1/4"), 1.5, 2e-7);
    }

    fn approx(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() < tolerance, "{found} is not {expected}");
    }
}
