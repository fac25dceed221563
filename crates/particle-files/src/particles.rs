//! Particles with radii and colours, before a kernel and a threshold make them a scene.

use glam::DVec3;
use metaball_core::{Color, Kernel, Metaball, Scene, SceneError};
use rayon::prelude::*;

use crate::cell::Cell;
use crate::coloring::Legend;
use crate::error::{Flaw, LoadError};
use crate::notes::Notes;
use crate::origin::origin_of;
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
    /// The strength q of each; 1 for all where this is `None`.
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
    /// For each the radius at which it shows where it is alone: R follows from kernel, strength and T.
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
        let origin = origin.unwrap_or_else(|| origin_of(&self.positions, &radii));
        self.check_resolution(origin, &radii)?;
        let strength = |index: usize| self.strengths.as_ref().map_or(1.0, |all| all[index]);
        let ball = |(index, position): (usize, DVec3)| Metaball {
            center: (position - origin).as_vec3(),
            radius: radii.get(index),
            strength: strength(index),
        };
        let images = match &self.cell {
            Some(cell) if self.is_periodic => periodic::images(&self.positions, &radii, cell),
            _ => Vec::new(),
        };
        let balls =
            self.positions.iter().copied().enumerate().chain(images.iter().copied()).map(ball);
        let scene = Scene::new(balls, kernel, threshold).map_err(|error| {
            let ball = ball_of(&error);
            self.flaw_at(ball, Flaw::new(error.to_string()))
        })?;
        let scene = scene.with_origin(origin);
        let Some(mut colors) = self.colors else { return Ok(scene) };
        colors.extend(images.iter().map(|(index, _)| colors[*index]).collect::<Vec<_>>());
        Ok(scene.with_colors(colors)?)
    }

    /// The support radii under a kernel and a threshold.
    fn support_radii(&self, kernel: Kernel, threshold: f32) -> Result<Radii<'_>, LoadError> {
        let shown = match &self.sizes {
            Sizes::Support(radii) => return Ok(Radii::Each(radii.into())),
            Sizes::Spacing(radius) => return Ok(Radii::All(*radius)),
            Sizes::Smoothing(lengths) => {
                let factor = support_per_h(kernel) as f32;
                let radii: Vec<f32> = lengths.iter().map(|length| factor * length).collect();
                return Ok(Radii::Each(radii.into()));
            }
            Sizes::Shown(shown) => shown,
        };
        // R over the radius that shows, for one strength after the other: most are the same.
        let mut last = None;
        let mut radii = Vec::with_capacity(shown.len());
        for (index, radius) in shown.iter().enumerate() {
            let strength = self.strengths.as_ref().map_or(1.0, |strengths| strengths[index]);
            let factor = match last {
                Some((of, factor)) if of == strength => factor,
                _ => support_over_shown(kernel, threshold, strength)
                    .map_err(|flaw| self.flaw_at(Some(index), flaw))?,
            };
            last = Some((strength, factor));
            radii.push(radius * factor);
        }
        Ok(Radii::Each(radii.into()))
    }

    /// Refuses particles that f32 moves by more than a small part of their radius.
    fn check_resolution(&self, origin: DVec3, radii: &Radii<'_>) -> Result<(), LoadError> {
        const PART: f64 = 1.0 / 64.0;
        let moved = |position: &DVec3| {
            let exact = position - origin;
            (exact - exact.as_vec3().as_dvec3()).abs().max_element()
        };
        let too_far = |(index, position): (usize, &DVec3)| {
            moved(position) > PART * f64::from(radii.get(index))
        };
        match self.positions.par_iter().enumerate().position_first(too_far) {
            None => Ok(()),
            Some(index) => {
                let found = self.positions[index];
                let flaw = Flaw::needed(
                    "particles whose place f32 tells to a 64th of their support radius",
                    format_args!(
                        "one at {found} with R = {}, {} from the others' middle",
                        radii.get(index),
                        (found - origin).length()
                    ),
                );
                Err(self
                    .flaw_at(Some(index), flaw.or("leave it out with --drop, or scale its radius")))
            }
        }
    }

    /// The flaw of a particle.
    pub(crate) fn flaw_at(&self, index: Option<usize>, mut flaw: Flaw) -> LoadError {
        flaw.location.line = index.and_then(|index| self.lines.get(index));
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

/// Support radii.
pub(crate) enum Radii<'a> {
    Each(std::borrow::Cow<'a, [f32]>),
    All(f32),
}

impl Radii<'_> {
    pub(crate) fn get(&self, index: usize) -> f32 {
        match self {
            Self::Each(radii) => radii[index],
            Self::All(radius) => *radius,
        }
    }
}

/// The support radius over the radius at which a ball alone shows.
fn support_over_shown(kernel: Kernel, threshold: f32, strength: f32) -> Result<f32, Flaw> {
    let unit = Metaball { strength, ..Metaball::new(glam::Vec3::ZERO, 1.0) };
    match kernel.core_radius(&unit, threshold) {
        Some(shown) if shown > 0.0 => Ok((1.0 / shown) as f32),
        _ if !(threshold.is_finite() && threshold > 0.0) => {
            Err(Flaw::new(SceneError::Threshold { found: threshold }.to_string()))
        }
        _ if !(strength.is_finite() && strength > 0.0) => {
            Err(Flaw::needed("a finite strength above 0", strength))
        }
        _ => Err(Flaw::needed(
            &format!(
                "a strength above the threshold {threshold}, so that it shows alone at its radius"
            ),
            strength,
        )
        .or("name the column support_radius if it is the radius at which the kernel ends")),
    }
}

fn ball_of(error: &SceneError) -> Option<usize> {
    match *error {
        SceneError::Center { index, .. }
        | SceneError::Radius { index, .. }
        | SceneError::Strength { index, .. } => Some(index),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
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
            for strength in [None, Some(0.75), Some(3.0)] {
                let scene = one(Sizes::Shown(vec![1.5]), strength).into_scene(kernel, 0.25);
                let scene = scene.expect("legal");
                let shown = kernel.core_radius(&scene.ball(0), 0.25).expect("it shows");
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
        assert!(refused(0.1).starts_with("needed a strength above the threshold 0.25"));
        assert!(refused(-1.0).contains("a finite strength above 0"));
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
