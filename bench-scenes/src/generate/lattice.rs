//! Particles on a lattice that fills the space under a surface, as a simulated fluid's nearly do.

use glam::DVec3;

use crate::random::Random;

/// The space between y = 0 and a surface over a rectangle.
pub(super) struct Under<F> {
    /// Half the extent along x and z, scene units.
    pub(super) half: (f64, f64),
    /// The height that a whole number of layers fills, scene units.
    pub(super) depth: f64,
    /// Height of the surface over x and z; none where it is not positive.
    pub(super) surface: F,
}

impl<F: Fn(f64, f64) -> f64> Under<F> {
    /// `count` sites, each moved by up to a third of the spacing: the lattice is refined until it has
    /// enough, and the surplus is left out evenly.
    pub(super) fn fill(&self, count: usize, random: &mut Random) -> Vec<DVec3> {
        let mut layers = 1;
        loop {
            let sites = self.sites(layers);
            if sites.len() >= count {
                return thin(sites, count, self.depth / f64::from(layers), random);
            }
            layers += 1;
        }
    }

    /// Lattice sites under the surface, with so many layers to the depth.
    fn sites(&self, layers: u32) -> Vec<DVec3> {
        let spacing = self.depth / f64::from(layers);
        let steps = |half: f64| (half / spacing) as i32;
        let mut sites = Vec::new();
        for column in -steps(self.half.0)..=steps(self.half.0) {
            for row in -steps(self.half.1)..=steps(self.half.1) {
                let (x, z) = (spacing * f64::from(column), spacing * f64::from(row));
                let layers = ((self.surface)(x, z) / spacing) as i32;
                sites.extend(
                    (0..layers).map(|layer| DVec3::new(x, spacing * (f64::from(layer) + 0.5), z)),
                );
            }
        }
        sites
    }
}

/// Keeps `count` of the sites, evenly, and moves them.
fn thin(sites: Vec<DVec3>, count: usize, spacing: f64, random: &mut Random) -> Vec<DVec3> {
    let all = sites.len();
    let kept = sites
        .into_iter()
        .enumerate()
        .filter(|(index, _)| (index + 1) * count / all > index * count / all)
        .map(|(_, site)| site);
    kept.map(|site| site + random.in_box(DVec3::splat(spacing / 3.0))).collect()
}
