//! Balls in whatever memory, and the scene that they make.

use std::borrow::Cow;

use glam::DVec3;
use metaball_core::{Kernel, Metaball, Scene, SceneError};
use rayon::prelude::*;

use crate::error::{Flaw, LoadError};
use crate::origin::origin_of;
use crate::spacing::median_spacing;

/// Positions in whatever memory: the table of a file, or arrays that someone else keeps.
pub trait Positions: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// The one at an index below the count.
    fn at(&self, index: usize) -> DVec3;
}

impl Positions for Vec<DVec3> {
    fn count(&self) -> usize {
        self.len()
    }

    #[inline]
    fn at(&self, index: usize) -> DVec3 {
        self[index]
    }
}

/// Support radii, in the unit of the positions.
#[derive(Debug, Clone)]
pub enum Radii<'a> {
    /// One for each.
    Each(Cow<'a, [f32]>),
    /// One for all.
    All(f32),
}

impl Radii<'_> {
    pub(crate) fn get(&self, index: usize) -> f32 {
        match self {
            Self::Each(radii) => radii[index],
            Self::All(radius) => *radius,
        }
    }

    /// The radius of particles that have none: twice the median distance between neighbours, or 1 where there
    /// is no distance to go by.
    pub fn by_spacing<P: Positions>(positions: &P) -> Self {
        Self::All(median_spacing(positions).map_or(1.0, |spacing| (2.0 * spacing) as f32))
    }

    /// The radii with which particles alone show at these; those of negative balls are as if they were not.
    ///
    /// # Errors
    /// Where a strength is too small for a particle to show alone.
    pub fn of_shown(
        shown: &Self,
        strengths: Option<&[f32]>,
        kernel: Kernel,
        threshold: f32,
    ) -> Result<Self, LoadError> {
        match (shown, strengths) {
            (Self::All(radius), None) => {
                Ok(Self::All(radius * support_over_shown(kernel, threshold, 1.0)?))
            }
            (Self::All(radius), Some(strengths)) => {
                let shown = vec![*radius; strengths.len()];
                Ok(supports_of_shown(&shown, Some(strengths), kernel, threshold)?)
            }
            (Self::Each(shown), strengths) => {
                Ok(supports_of_shown(shown, strengths, kernel, threshold)?)
            }
        }
    }
}

/// What is wrong with balls, and with which, if it is one.
#[derive(Debug)]
pub(crate) struct BallFlaw {
    pub(crate) index: Option<usize>,
    pub(crate) problem: String,
}

impl From<BallFlaw> for LoadError {
    fn from(flaw: BallFlaw) -> Self {
        Flaw::new(flaw.problem).into()
    }
}

/// Balls before a kernel and a threshold make them a scene.
#[derive(Debug)]
pub struct Balls<'a, P> {
    /// Their centres.
    pub positions: &'a P,
    /// Their support radii.
    pub radii: Radii<'a>,
    /// The strength of each, not 0; 1 for all where this is `None`.
    pub strengths: Option<&'a [f32]>,
}

impl<P: Positions> Balls<'_, P> {
    /// Their scene. Where they are so far from the origin that f32 would move them, the scene has an origin of
    /// its own. Nothing but the scene is held.
    ///
    /// # Errors
    /// Names the first ball that is refused, or the threshold.
    pub fn scene(&self, kernel: Kernel, threshold: f32) -> Result<Scene, LoadError> {
        Ok(self.scene_at(None, &[], kernel, threshold)?)
    }

    /// The same with a given origin, and with images of some of them elsewhere.
    pub(crate) fn scene_at(
        &self,
        origin: Option<DVec3>,
        images: &[(usize, DVec3)],
        kernel: Kernel,
        threshold: f32,
    ) -> Result<Scene, BallFlaw> {
        let origin = origin.unwrap_or_else(|| origin_of(self.positions, &self.radii));
        self.check_resolution(origin)?;
        let ball = |(index, position): (usize, DVec3)| Metaball {
            center: (position - origin).as_vec3(),
            radius: self.radii.get(index),
            strength: self.strengths.map_or(1.0, |all| all[index]),
        };
        let own = (0..self.positions.count()).map(|index| (index, self.positions.at(index)));
        let balls = own.chain(images.iter().copied()).map(ball);
        let scene = Scene::new(balls, kernel, threshold)
            .map_err(|error| BallFlaw { index: ball_of(&error), problem: error.to_string() })?;
        Ok(scene.with_origin(origin))
    }

    /// Refuses balls that f32 moves by more than a small part of their radius.
    fn check_resolution(&self, origin: DVec3) -> Result<(), BallFlaw> {
        const PART: f64 = 1.0 / 64.0;
        let moved = |position: DVec3| {
            let exact = position - origin;
            (exact - exact.as_vec3().as_dvec3()).abs().max_element()
        };
        // A radius that is none is refused by the scene.
        let too_far = |index: &usize| {
            let radius = f64::from(self.radii.get(*index));
            radius > 0.0 && moved(self.positions.at(*index)) > PART * radius
        };
        let Some(index) = (0..self.positions.count()).into_par_iter().find_first(too_far) else {
            return Ok(());
        };
        let found = self.positions.at(index);
        let flaw = Flaw::needed(
            "particles whose place f32 tells to a 64th of their support radius",
            format_args!(
                "one at {found} with R = {}, {} from the others' middle",
                self.radii.get(index),
                (found - origin).length()
            ),
        );
        let flaw = flaw.or("leave it out with --drop, or scale its radius");
        Err(BallFlaw { index: Some(index), problem: flaw.problem })
    }
}

/// The support radii of balls that alone show at these.
pub(crate) fn supports_of_shown(
    shown: &[f32],
    strengths: Option<&[f32]>,
    kernel: Kernel,
    threshold: f32,
) -> Result<Radii<'static>, BallFlaw> {
    // R over the radius that shows, for one strength after the other: most are the same.
    let mut last = None;
    let mut radii = Vec::with_capacity(shown.len());
    for (index, radius) in shown.iter().enumerate() {
        let strength = strengths.map_or(1.0, |strengths| strengths[index]);
        let flaw = |flaw: Flaw| BallFlaw { index: Some(index), problem: flaw.problem };
        let factor = match last {
            Some((of, factor)) if of == strength => factor,
            _ => support_over_shown(kernel, threshold, strength).map_err(flaw)?,
        };
        last = Some((strength, factor));
        radii.push(radius * factor);
    }
    Ok(Radii::Each(radii.into()))
}

/// The support radius over the radius at which a ball alone shows, or would if it added what it takes away.
fn support_over_shown(kernel: Kernel, threshold: f32, strength: f32) -> Result<f32, Flaw> {
    let unit = Metaball { strength: strength.abs(), ..Metaball::new(glam::Vec3::ZERO, 1.0) };
    match kernel.core_radius(&unit, threshold) {
        Some(shown) if shown > 0.0 => Ok((1.0 / shown) as f32),
        _ if !(threshold.is_finite() && threshold > 0.0) => {
            Err(Flaw::new(SceneError::Threshold { found: threshold }.to_string()))
        }
        _ if !strength.is_finite() || strength == 0.0 => {
            Err(Flaw::needed("a finite strength other than 0", strength))
        }
        _ => Err(Flaw::needed(
            &format!(
                "a strength above the threshold {threshold} in size, so that it shows alone at its radius"
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

    /// The third axis is not stored.
    struct Flat([[f32; 2]; 3]);

    impl Positions for Flat {
        fn count(&self) -> usize {
            self.0.len()
        }

        fn at(&self, index: usize) -> DVec3 {
            let [x, y] = self.0[index];
            DVec3::new(x.into(), y.into(), 0.0)
        }
    }

    #[test]
    fn balls_in_any_memory_make_the_scene_of_particles() {
        let flat = Flat([[0.0, 0.0], [1.0, 0.0], [2.0, 0.5]]);
        let strengths = [1.0, 0.75, 3.0];
        let shown = Radii::Each(vec![1.0, 1.5, 2.0].into());
        let radii = Radii::of_shown(&shown, Some(&strengths), Kernel::QUARTIC, 0.25);
        let balls = Balls {
            positions: &flat,
            radii: radii.expect("they show"),
            strengths: Some(&strengths),
        };
        let particles = crate::Particles {
            positions: (0..3).map(|index| flat.at(index)).collect(),
            sizes: crate::Sizes::Shown(vec![1.0, 1.5, 2.0]),
            strengths: Some(strengths.to_vec()),
            ..crate::Particles::default()
        };
        let wanted = particles.into_scene(Kernel::QUARTIC, 0.25).expect("legal");
        assert_eq!(balls.scene(Kernel::QUARTIC, 0.25).expect("legal"), wanted);
    }

    #[test]
    fn one_radius_for_all_is_that_of_each() {
        let flat = Flat([[0.0, 0.0], [1.0, 0.0], [2.0, 0.5]]);
        let of = |shown: &Radii<'_>, strengths: Option<&[f32]>| {
            let radii = Radii::of_shown(shown, strengths, Kernel::Wyvill, 0.4).expect("they show");
            [0, 1, 2].map(|index| radii.get(index))
        };
        let each = Radii::Each(vec![0.5; 3].into());
        assert_eq!(of(&Radii::All(0.5), None), of(&each, None));
        let strengths = [1.0, 2.0, 3.0];
        assert_eq!(of(&Radii::All(0.5), Some(&strengths)), of(&each, Some(&strengths)));
        let weak = Radii::of_shown(&each, Some(&[1.0, 0.1, 1.0]), Kernel::Wyvill, 0.4);
        let weak = weak.expect_err("too weak").to_string();
        assert!(weak.starts_with("needed a strength above the threshold 0.4 in size"), "{weak}");
        // Half of them are 1 from the next, the last is √1.25.
        assert!(matches!(Radii::by_spacing(&flat), Radii::All(2.0)));
    }
}
