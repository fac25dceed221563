//! A scene: balls, one kernel, one threshold.

use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::{Aabb, Color, Kernel, Metaball, Support};

/// Balls, their kernel and the threshold T: the surface is where the field equals T.
///
/// Renderers are specialised for what all balls share: a scene in which every strength is 1 stores no
/// strengths, one without colours stores no colours, and neither reaches a shader; one radius, like the
/// kernel, is compiled in. [`Scene::generalized`] undoes that, to measure what it saves.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    supports: Vec<Support>,
    common_radius: Option<f32>,
    strengths: Option<Vec<f32>>,
    colors: Option<Vec<Color>>,
    kernel: Kernel,
    kernel_form: KernelForm,
    threshold: f32,
    origin: DVec3,
}

/// How much of the kernel is compiled into renderers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum KernelForm {
    /// The kernel with its exponent.
    #[default]
    Known,
    /// That it is a power kernel; the exponent is read.
    AnyExponent,
    /// Nothing: which kernel it is, is read.
    AnyKernel,
}

/// What renderers read from a generalised scene, although it could be compiled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Generality {
    /// The kernel, and its exponent.
    Kernel,
    /// The exponent of a power kernel.
    Exponent,
    /// A radius for each ball.
    Radii,
    /// A strength for each ball.
    Strengths,
    /// A colour for each ball.
    Colors,
}

impl Generality {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Kernel, Self::Exponent, Self::Radii, Self::Strengths, Self::Colors];
}

/// Least and greatest support radius, scene units: the square and its inverse are normal f32 numbers.
pub const RADIUS_LIMITS: (f32, f32) = (1e-18, 1e18);

/// Why balls, kernel and threshold are no scene. A ball is named by its index, from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A coordinate is NaN, infinite, or too large to be squared in f32.
    #[error("ball {index}: needed a finite centre with coordinates up to 1e18, found {found}")]
    Center {
        /// Index of the ball.
        index: usize,
        /// Its centre.
        found: Vec3,
    },
    /// The support radius is not a positive number of usable size.
    #[error("ball {index}: needed a support radius from 1e-18 to 1e18, found {found}")]
    Radius {
        /// Index of the ball.
        index: usize,
        /// Its radius.
        found: f32,
    },
    /// The strength is 0 or not a finite number.
    #[error("ball {index}: needed a finite strength other than 0, found {found}")]
    Strength {
        /// Index of the ball.
        index: usize,
        /// Its strength.
        found: f32,
    },
    /// The threshold is not a positive finite number.
    #[error("threshold: needed a finite number above 0, found {found}")]
    Threshold {
        /// The threshold.
        found: f32,
    },
    /// There are more or fewer colours than balls.
    #[error("colours: needed one for each of {balls} balls, found {found}")]
    Colors {
        /// Number of balls.
        balls: usize,
        /// Number of colours.
        found: usize,
    },
    /// More balls than an index of 32 bits can name.
    #[error("needed at most {} balls, found {found}", u32::MAX)]
    TooManyBalls {
        /// Number of balls.
        found: usize,
    },
}

/// A ball that takes away from the field, where all have to add to it.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("needed strengths above 0, found {found} of ball {index}")]
pub struct NegativeBall {
    /// Index of the ball.
    pub index: usize,
    /// Its strength.
    pub found: f32,
}

impl Scene {
    /// Checks and stores the balls. A scene without balls is legal: its picture is empty.
    ///
    /// # Errors
    /// Names the first ball that is refused, or the threshold.
    pub fn new(
        balls: impl IntoIterator<Item = Metaball>,
        kernel: Kernel,
        threshold: f32,
    ) -> Result<Self, SceneError> {
        check_threshold(threshold)?;
        let mut supports = Vec::new();
        let mut strengths = Vec::new();
        for (index, ball) in balls.into_iter().enumerate() {
            check_ball(index, &ball)?;
            supports.push(Support { center: ball.center, radius: ball.radius });
            strengths.push(ball.strength);
        }
        check_field(supports.len(), threshold)?;
        let strengths = strengths.iter().any(|&strength| strength != 1.0).then_some(strengths);
        let kernel_form = KernelForm::Known;
        let common_radius = common_radius(&supports);
        Ok(Self {
            supports,
            common_radius,
            strengths,
            colors: None,
            kernel,
            kernel_form,
            threshold,
            origin: DVec3::ZERO,
        })
    }

    /// Gives each ball a colour.
    ///
    /// # Errors
    /// When there is not exactly one colour for each ball.
    pub fn with_colors(mut self, colors: Vec<Color>) -> Result<Self, SceneError> {
        if colors.len() != self.len() {
            return Err(SceneError::Colors { balls: self.len(), found: colors.len() });
        }
        self.colors = Some(colors);
        Ok(self)
    }

    /// The same balls under another kernel.
    #[must_use]
    pub fn with_kernel(mut self, kernel: Kernel) -> Self {
        self.kernel = kernel;
        self
    }

    /// The same field with its surface at another threshold.
    ///
    /// # Errors
    /// When the threshold is not a finite number above 0.
    pub fn with_threshold(mut self, threshold: f32) -> Result<Self, SceneError> {
        check_threshold(threshold)?;
        self.threshold = threshold;
        Ok(self)
    }

    /// The same scene, whose coordinates begin at this point of its file's.
    #[must_use]
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        self.origin = origin;
        self
    }

    /// The same scene, for which renderers read what could be compiled in. Hits are the same; colours,
    /// where there were none, are white. What it costs is what specialisation saves.
    #[must_use]
    pub fn generalized(mut self, generality: Generality) -> Self {
        match generality {
            Generality::Kernel => self.kernel_form = KernelForm::AnyKernel,
            Generality::Exponent => {
                if let (Kernel::Power(_), KernelForm::Known) = (self.kernel, self.kernel_form) {
                    self.kernel_form = KernelForm::AnyExponent;
                }
            }
            Generality::Radii => self.common_radius = None,
            Generality::Strengths => {
                self.strengths.get_or_insert_with(|| vec![1.0; self.supports.len()]);
            }
            Generality::Colors => {
                let white = Color::srgb(255, 255, 255);
                self.colors.get_or_insert_with(|| vec![white; self.supports.len()]);
            }
        }
        self
    }

    /// Number of balls.
    pub fn len(&self) -> usize {
        self.supports.len()
    }

    /// Whether there is no ball.
    pub fn is_empty(&self) -> bool {
        self.supports.is_empty()
    }

    /// Support spheres of the balls, in the order given.
    pub fn supports(&self) -> &[Support] {
        &self.supports
    }

    /// The support radius of all balls; `None` when they differ, or there is no ball.
    pub fn common_radius(&self) -> Option<f32> {
        self.common_radius
    }

    /// Strengths of the balls; `None` when all are 1.
    pub fn strengths(&self) -> Option<&[f32]> {
        self.strengths.as_deref()
    }

    /// The first ball that takes away from the field, for what takes none.
    pub fn negative_ball(&self) -> Option<NegativeBall> {
        let mut strengths = self.strengths()?.iter().enumerate();
        let (index, &found) = strengths.find(|&(_, &strength)| strength < 0.0)?;
        Some(NegativeBall { index, found })
    }

    /// Colours of the balls, if the scene has any.
    pub fn colors(&self) -> Option<&[Color]> {
        self.colors.as_deref()
    }

    /// The ball at `index`. Panics when there is none, as slices do.
    pub fn ball(&self, index: usize) -> Metaball {
        let Support { center, radius } = self.supports[index];
        let strength = self.strengths.as_ref().map_or(1.0, |strengths| strengths[index]);
        Metaball { center, radius, strength }
    }

    /// All balls, in the order given.
    pub fn balls(&self) -> impl ExactSizeIterator<Item = Metaball> + '_ {
        (0..self.len()).map(|index| self.ball(index))
    }

    /// The falloff of all balls.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// How much of the kernel is compiled into renderers.
    pub fn kernel_form(&self) -> KernelForm {
        self.kernel_form
    }

    /// T: the field on the surface.
    pub fn threshold(&self) -> f32 {
        self.threshold
    }

    /// Where the scene's coordinates begin in those of the file that it came from, whose coordinates can
    /// be too large for f32: add this to a point of the scene to have the file's.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The smallest box around the support spheres of all balls that add to the field: the solid is in it.
    /// Empty where there are none.
    pub fn bounds(&self) -> Aabb {
        self.balls().filter(|ball| !ball.is_negative()).fold(Aabb::EMPTY, |bounds, ball| {
            bounds.union(&Aabb::around_sphere(ball.center, ball.radius))
        })
    }
}

fn common_radius(supports: &[Support]) -> Option<f32> {
    let radius = supports.first()?.radius;
    supports.iter().all(|support| support.radius == radius).then_some(radius)
}

fn check_threshold(threshold: f32) -> Result<(), SceneError> {
    if threshold.is_finite() && threshold > 0.0 {
        Ok(())
    } else {
        Err(SceneError::Threshold { found: threshold })
    }
}

/// Whether a field may have this threshold and so many balls, whoever keeps them; returns how many,
/// as an index counts them.
///
/// # Errors
/// Names the threshold, or the number of balls.
pub fn check_field(balls: usize, threshold: f32) -> Result<u32, SceneError> {
    check_threshold(threshold)?;
    u32::try_from(balls).map_err(|_| SceneError::TooManyBalls { found: balls })
}

/// Whether a field may have this ball, the one at `index`.
///
/// # Errors
/// Names the ball, what of it was refused, and what is needed.
pub fn check_ball(index: usize, ball: &Metaball) -> Result<(), SceneError> {
    let usable = |coordinate: f32| coordinate.abs() <= RADIUS_LIMITS.1;
    if !ball.center.to_array().into_iter().all(usable) {
        return Err(SceneError::Center { index, found: ball.center });
    }
    if !(RADIUS_LIMITS.0..=RADIUS_LIMITS.1).contains(&ball.radius) {
        return Err(SceneError::Radius { index, found: ball.radius });
    }
    if !ball.strength.is_finite() || ball.strength == 0.0 {
        return Err(SceneError::Strength { index, found: ball.strength });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(radius: f32, strength: f32) -> Metaball {
        Metaball { center: Vec3::ZERO, radius, strength }
    }

    #[test]
    fn refusals_name_the_ball_and_the_value() {
        let message = |balls: &[Metaball], threshold| {
            Scene::new(balls.iter().copied(), Kernel::Wyvill, threshold)
                .expect_err("refused")
                .to_string()
        };
        let good = ball(1.0, 1.0);
        assert_eq!(
            message(&[good, ball(0.0, 1.0)], 0.5),
            "ball 1: needed a support radius from 1e-18 to 1e18, found 0"
        );
        assert!(message(&[ball(-1.0, 1.0)], 0.5).starts_with("ball 0: needed a support radius"));
        assert!(message(&[ball(f32::NAN, 1.0)], 0.5).ends_with("found NaN"));
        assert!(
            message(&[good, good, ball(1.0, 0.0)], 0.5)
                .starts_with("ball 2: needed a finite strength")
        );
        assert!(message(&[ball(1.0, f32::INFINITY)], 0.5).ends_with("found inf"));
        for center in [Vec3::NAN, Vec3::X * f32::INFINITY, Vec3::new(0.0, f32::NAN, 0.0)] {
            let broken = Metaball { center, ..good };
            assert!(message(&[broken], 0.5).starts_with("ball 0: needed a finite centre"));
        }
        assert!(message(&[ball(1.0, f32::NAN)], 0.5).ends_with("other than 0, found NaN"));
        for threshold in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(message(&[good], threshold).starts_with("threshold: needed"));
        }
    }

    #[test]
    fn colours_must_match_the_balls() {
        let scene = Scene::new([ball(1.0, 1.0)], Kernel::QUARTIC, 0.5).expect("legal");
        let error = scene.with_colors(Vec::new()).expect_err("refused");
        assert_eq!(error, SceneError::Colors { balls: 1, found: 0 });
    }

    #[test]
    fn unit_strengths_are_not_stored() {
        let scene =
            |strength| Scene::new([ball(1.0, strength)], Kernel::QUARTIC, 0.5).expect("legal");
        assert_eq!(scene(1.0).strengths(), None);
        assert_eq!(scene(2.0).strengths(), Some(&[2.0][..]));
        assert_eq!(scene(2.0).ball(0).strength, 2.0);
    }

    #[test]
    fn the_solid_is_where_balls_add() {
        let scene = |strengths: [f32; 2]| {
            let balls = [0.0, 9.0].map(|x| x * Vec3::X).into_iter().zip(strengths);
            let balls = balls.map(|(center, strength)| Metaball { center, ..ball(1.0, strength) });
            Scene::new(balls, Kernel::QUARTIC, 0.5).expect("legal")
        };
        assert_eq!(scene([1.0, 2.0]).negative_ball(), None);
        let ends_at = |strengths, x: f32| {
            let end = scene(strengths).bounds().max.x;
            assert!((x..x + 1e-5).contains(&end), "{end} is not where {x} is");
        };
        ends_at([1.0, 2.0], 10.0);
        let negative = scene([1.0, -2.0]).negative_ball().expect("one of two");
        assert_eq!(negative.to_string(), "needed strengths above 0, found -2 of ball 1");
        ends_at([1.0, -2.0], 1.0);
        assert!(scene([-1.0, -2.0]).bounds().is_empty());
    }

    #[test]
    fn one_radius_is_known_as_such() {
        let scene = |radii: &[f32]| {
            let balls = radii.iter().map(|&radius| ball(radius, 1.0));
            Scene::new(balls, Kernel::QUARTIC, 0.5).expect("legal")
        };
        assert_eq!(scene(&[0.7, 0.7]).common_radius(), Some(0.7));
        assert_eq!(scene(&[0.7, 0.7f32.next_up()]).common_radius(), None);
        assert_eq!(scene(&[]).common_radius(), None);
    }

    #[test]
    fn a_generalized_scene_has_the_same_balls() {
        let scene = Scene::new([ball(0.7, 1.0)], Kernel::QUARTIC, 0.5).expect("legal");
        let general = Generality::ALL.into_iter().fold(scene.clone(), Scene::generalized);
        assert_eq!(general.common_radius(), None);
        assert_eq!(general.strengths(), Some(&[1.0][..]));
        assert_eq!(general.colors().map(<[Color]>::len), Some(1));
        assert_eq!(general.kernel_form(), KernelForm::AnyKernel);
        assert!(general.balls().eq(scene.balls()) && general.kernel() == scene.kernel());

        let form = |kernel| {
            scene.clone().with_kernel(kernel).generalized(Generality::Exponent).kernel_form()
        };
        assert_eq!(form(Kernel::QUARTIC), KernelForm::AnyExponent);
        assert_eq!(form(Kernel::Wyvill), KernelForm::Known, "it has no exponent");
    }

    #[test]
    fn strengths_of_ones_own_stay_where_all_get_one() {
        let scene = Scene::new([ball(0.7, 2.0)], Kernel::QUARTIC, 0.5).expect("legal");
        assert_eq!(scene.generalized(Generality::Strengths).strengths(), Some(&[2.0][..]));
    }

    #[test]
    fn an_empty_scene_is_legal() {
        let scene = Scene::new([], Kernel::Perlin, 0.5).expect("legal");
        assert!(scene.is_empty() && scene.bounds().is_empty());
    }
}
