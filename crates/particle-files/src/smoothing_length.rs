//! What the smoothing length h of a simulation means.

use metaball_core::Kernel;

/// The support radius of a kernel over the smoothing length h, as its sources and most codes have it: 2 for the
/// cubic spline (Monaghan and Lattanzio 1985) and Wendland's functions (Dehnen and Aly 2012; Crespo et al. 2015),
/// 3 for the quintic spline (Morris 1996), cut/√2 for a Gaussian, whose h is √2 standard deviations (Gingold and
/// Monaghan 1977), and 1 for kernels of graphics (Müller et al. 2003). Some codes (Gadget, LAMMPS) call the
/// support radius h.
pub(crate) fn support_per_h(kernel: Kernel) -> f64 {
    match kernel {
        Kernel::CubicSpline | Kernel::WendlandC2 | Kernel::WendlandC4 | Kernel::WendlandC6 => 2.0,
        Kernel::QuinticSpline => 3.0,
        Kernel::Gaussian(cut) => cut.get() / std::f64::consts::SQRT_2,
        Kernel::Power(_) | Kernel::Wyvill | Kernel::Perlin => 1.0,
    }
}
