//! Particles with radii and colours, before a kernel and a threshold make them a scene.

use glam::DVec3;
use metaball_core::{Color, Kernel, Scene};

use crate::balls::{BallFlaw, Balls, Radii, supports_of_shown};
use crate::cell::Cell;
use crate::coloring::Legend;
use crate::error::{Flaw, LoadError};
use crate::notes::Notes;
use crate::periodic;
use crate::smoothing_length::support_per_h;
use crate::table::{Column, Lines};

/// The kernel of files that name none: the quartic.
pub const DEFAULT_KERNEL: Kernel = Kernel::QUARTIC;

/// The threshold of files that name none: under the quartic a ball alone then shows at R/√2.
pub const DEFAULT_THRESHOLD: f32 = 0.25;

/// Particles, and where they came from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Particles {
    /// Centres in the order of the file: in ångströms for molecules, else in the file's unit.
    pub positions: Vec<DVec3>,
    /// How large they are.
    pub sizes: Sizes,
    /// The strength q of each, not 0: a negative ball takes away from the field. 1 for all where this is `None`.
    pub strengths: Option<Vec<f32>>,
    /// One for each, or `None`.
    pub colors: Option<Vec<Color>>,
    /// What the colours say, where a column gave them.
    pub legend: Option<Legend>,
    /// What else was asked for of each, as the file says it.
    pub columns: Vec<Column>,
    /// The periodic cell, in the unit of the positions.
    pub cell: Option<Cell>,
    /// Whether a scene gets the images of particles that reach into the cell from neighbouring ones.
    pub is_periodic: bool,
    /// The path of the file; `None` for particles of no file.
    pub file: Option<String>,
    /// The line of each.
    pub lines: Lines,
    /// What was read, guessed and left out.
    pub notes: Notes,
}

/// How large particles are, in the unit of their positions.
#[derive(Debug, Clone, PartialEq)]
pub enum Sizes {
    /// The support radius R of each.
    Support(Vec<f32>),
    /// For each the radius at which it shows where it is alone: R follows from kernel, strength and T. That of a
    /// negative ball is the one at which what it takes away reaches T.
    Shown(Vec<f32>),
    /// The smoothing length h of each: R follows from the kernel, as its source has it.
    Smoothing(Vec<f32>),
    /// The support radius R of all, by their spacing: twice that.
    Spacing(f32),
}

impl Default for Sizes {
    fn default() -> Self {
        Self::Support(Vec::new())
    }
}

impl Particles {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The scene of these particles. Where they are so far from the origin that f32 would move them, the
    /// scene has an origin of its own.
    ///
    /// # Errors
    /// Names the first particle that is refused, with its line, or the threshold.
    pub fn into_scene(self, kernel: Kernel, threshold: f32) -> Result<Scene, LoadError> {
        self.into_scene_at(None, kernel, threshold)
    }

    /// The same with a given origin.
    pub(crate) fn into_scene_at(
        self,
        origin: Option<DVec3>,
        kernel: Kernel,
        threshold: f32,
    ) -> Result<Scene, LoadError> {
        let radii = self.support_radii(kernel, threshold)?;
        let images = match &self.cell {
            Some(cell) if self.is_periodic => periodic::images(&self.positions, &radii, cell),
            _ => Vec::new(),
        };
        let balls =
            Balls { positions: &self.positions, radii, strengths: self.strengths.as_deref() };
        let scene = balls
            .scene_at(origin, &images, kernel, threshold)
            .map_err(|flaw| self.flaw_of(flaw))?;
        let Some(mut colors) = self.colors else { return Ok(scene) };
        colors.extend(images.iter().map(|(index, _)| colors[*index]).collect::<Vec<_>>());
        Ok(scene.with_colors(colors)?)
    }

    /// The support radii under a kernel and a threshold.
    fn support_radii(&self, kernel: Kernel, threshold: f32) -> Result<Radii<'_>, LoadError> {
        match &self.sizes {
            Sizes::Support(radii) => Ok(Radii::Each(radii.into())),
            Sizes::Spacing(radius) => Ok(Radii::All(*radius)),
            Sizes::Smoothing(lengths) => {
                let factor = support_per_h(kernel) as f32;
                let radii: Vec<f32> = lengths.iter().map(|length| factor * length).collect();
                Ok(Radii::Each(radii.into()))
            }
            Sizes::Shown(shown) => {
                supports_of_shown(shown, self.strengths.as_deref(), kernel, threshold)
                    .map_err(|flaw| self.flaw_of(flaw))
            }
        }
    }

    /// The flaw of a particle, with its line.
    fn flaw_of(&self, flaw: BallFlaw) -> LoadError {
        let line = flaw.index.and_then(|index| self.lines.get(index));
        let mut flaw = Flaw::new(flaw.problem);
        flaw.location.line = line;
        flaw.location.file = self.file.clone();
        flaw.into()
    }

    /// The same with another radius, if theirs is by their spacing.
    pub(crate) fn respaced(mut self, radius: f32) -> Self {
        if let Sizes::Spacing(own) = &mut self.sizes {
            *own = radius;
        }
        self
    }

    /// The support radius that all were given by their spacing; `None` where the file or the elements
    /// say it.
    pub fn spacing_radius(&self) -> Option<f32> {
        match self.sizes {
            Sizes::Spacing(radius) => Some(radius),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::Metaball;

    use super::*;

    fn one(sizes: Sizes, strength: Option<f32>) -> Particles {
        Particles {
            positions: vec![DVec3::ZERO],
            sizes,
            strengths: strength.map(|strength| vec![strength]),
            ..Particles::default()
        }
    }

    #[test]
    fn a_particle_alone_shows_at_its_radius() {
        for kernel in Kernel::all() {
            for strength in [None, Some(0.75), Some(3.0), Some(-3.0)] {
                let scene = one(Sizes::Shown(vec![1.5]), strength).into_scene(kernel, 0.25);
                let ball = scene.expect("legal").ball(0);
                assert_eq!(ball.strength, strength.unwrap_or(1.0));
                // A negative ball is as large as what it takes away.
                let added = Metaball { strength: ball.strength.abs(), ..ball };
                let shown = kernel.core_radius(&added, 0.25).expect("it shows");
                // Factor and radius are rounded to f32: twice 6e-8 relative.
                assert!((shown - 1.5).abs() < 2e-7, "{kernel}: {shown}");
            }
        }
    }

    #[test]
    fn a_particle_too_weak_to_show_alone_is_refused() {
        let refused = |strength| {
            let scene =
                one(Sizes::Shown(vec![1.0]), Some(strength)).into_scene(Kernel::QUARTIC, 0.25);
            scene.expect_err("refused").to_string()
        };
        assert!(refused(0.25).contains("support_radius"));
        for weak in [0.1, -0.1] {
            assert!(
                refused(weak).starts_with("needed a strength above the threshold 0.25 in size")
            );
        }
        assert!(refused(0.0).contains("a finite strength other than 0"));
        let weak = one(Sizes::Support(vec![1.0]), Some(0.1));
        assert!(weak.into_scene(Kernel::QUARTIC, 0.25).is_ok());
    }

    #[test]
    fn what_f32_moves_is_refused() {
        let particles = Particles {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::new(1e9 + 1.3, 0.0, 0.0)],
            sizes: Sizes::Spacing(1.0),
            ..Particles::default()
        };
        let message = particles.into_scene(Kernel::QUARTIC, 0.25).expect_err("refused").to_string();
        assert!(message.contains("to a 64th of their support radius"), "{message}");
    }
}
