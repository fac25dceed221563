//! Scenes that a method refuses, by its own paper: the only list of them.

use metaball_core::{Kernel, Scene};

/// Why a method refuses a scene.
#[derive(Debug)]
pub struct Refusal {
    /// The method.
    pub method: &'static str,
    /// The kernels of the scenes that it refuses.
    pub refuses: fn(Kernel) -> bool,
    /// What its error must say.
    pub reason: &'static str,
}

const REFUSALS: &[Refusal] =
    &[no_polynomial("kanamori"), above_degree_six("illes-exact"), above_degree_six("illes-robust")];

const fn no_polynomial(method: &'static str) -> Refusal {
    Refusal {
        method,
        refuses: |kernel| kernel.degree_along_ray().is_none(),
        reason: "needed a kernel that is a polynomial along a ray",
    }
}

const fn above_degree_six(method: &'static str) -> Refusal {
    Refusal {
        method,
        refuses: |kernel| kernel.degree_along_ray().is_none_or(|degree| degree > 6),
        reason: "needed a kernel that is a polynomial of degree six or less along a ray",
    }
}

/// The refusal that is expected of a method for a scene.
pub fn refusal_of(method: &str, scene: &Scene) -> Option<&'static Refusal> {
    REFUSALS.iter().find(|refusal| refusal.method == method && (refusal.refuses)(scene.kernel()))
}
