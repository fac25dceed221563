//! Why a picture shows nothing.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::fmt;

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Metaball, Scene};

/// Why no ray of a picture hits a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Emptiness {
    /// There is no ball.
    NoBalls,
    /// There are negative balls alone, which add nothing to the field.
    NothingAdds,
    /// The field stays below the threshold everywhere.
    BelowThreshold {
        /// The field is nowhere more than this.
        most: f64,
        /// T.
        threshold: f32,
    },
    /// There is a surface, and the camera does not see it.
    OutOfSight {
        /// A point in the solid, scene coordinates.
        solid: Vec3,
    },
    /// The field comes so near to the threshold that this cannot be told.
    Unknown,
}

impl fmt::Display for Emptiness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoBalls => formatter.write_str("there are no balls"),
            Self::NothingAdds => formatter.write_str("all strengths are negative"),
            Self::BelowThreshold { most, threshold } => write!(
                formatter,
                "the field is nowhere more than {most:.4}, and the threshold {threshold} is above it: lower \
                 --threshold, or raise --radius-scale"
            ),
            Self::OutOfSight { solid } => write!(
                formatter,
                "the surface is out of the camera's sight, or smaller than a pixel: the solid is at {solid}, for \
                 instance"
            ),
            Self::Unknown => formatter
                .write_str("the field may just reach the threshold: lower --threshold a little"),
        }
    }
}

/// Boxes that are bounded before the search gives up.
const BOXES: usize = 1 << 20;

/// A box with bounds of the field in it.
struct Bounded {
    corners: Aabb,
    /// The balls whose supports reach into it.
    balls: Vec<u32>,
    most: f64,
}

impl Emptiness {
    /// Why a scene shows nothing: the box in which the field can be most is halved, until the field in
    /// the middle of one reaches the threshold, or it can in none.
    pub fn of(scene: &Scene) -> Self {
        let threshold = f64::from(scene.threshold());
        let balls: Vec<u32> = (0..scene.len() as u32).collect();
        if balls.is_empty() {
            return Self::NoBalls;
        }
        if scene.bounds().is_empty() {
            return Self::NothingAdds;
        }
        let mut boxes = BinaryHeap::from([Bounded::new(scene, scene.bounds(), &balls)]);
        let mut greatest = 0.0_f64;
        for _ in 0..BOXES {
            let Some(highest) = boxes.pop() else { break };
            let middle = highest.corners.center();
            let value = field(scene, &highest.balls, middle.as_dvec3());
            if value >= threshold {
                return Self::OutOfSight { solid: middle };
            }
            greatest = greatest.max(value);
            // Near enough to say a number of two digits.
            if highest.most < threshold && highest.most <= 1.01 * greatest {
                return Self::BelowThreshold { most: highest.most, threshold: scene.threshold() };
            }
            boxes.extend(
                halves(&highest.corners).map(|half| Bounded::new(scene, half, &highest.balls)),
            );
        }
        match boxes.peek() {
            Some(highest) if highest.most < threshold => {
                Self::BelowThreshold { most: highest.most, threshold: scene.threshold() }
            }
            _ => Self::Unknown,
        }
    }
}

impl Bounded {
    fn new(scene: &Scene, corners: Aabb, balls: &[u32]) -> Self {
        let balls: Vec<u32> =
            balls.iter().copied().filter(|ball| near(scene, *ball, &corners) != 0.0).collect();
        let most = balls.iter().map(|ball| most(scene, *ball, &corners)).sum();
        Self { corners, balls, most }
    }
}

/// What a ball adds to the field at the point of a box that is nearest to it.
fn near(scene: &Scene, ball: u32, corners: &Aabb) -> f64 {
    let ball = scene.ball(ball as usize);
    let nearest = ball.center.clamp(corners.min, corners.max);
    share(scene, &ball, nearest.as_dvec3())
}

/// The most that a ball adds in a box: for one that takes away, at the box's farthest point. A little more,
/// for roundings: no sum of so many terms is off by a millionth.
fn most(scene: &Scene, index: u32, corners: &Aabb) -> f64 {
    let ball = scene.ball(index as usize);
    if !ball.is_negative() {
        return 1.000_001 * near(scene, index, corners);
    }
    let (center, low, high) =
        (ball.center.as_dvec3(), corners.min.as_dvec3(), corners.max.as_dvec3());
    let farthest = center + (center - low).max(high - center);
    0.999_999 * share(scene, &ball, farthest)
}

fn share(scene: &Scene, ball: &Metaball, point: DVec3) -> f64 {
    let squared = (point - ball.center.as_dvec3()).length_squared();
    f64::from(ball.strength) * scene.kernel().value(squared / f64::from(ball.radius).powi(2))
}

fn field(scene: &Scene, balls: &[u32], point: DVec3) -> f64 {
    balls.iter().map(|ball| share(scene, &scene.ball(*ball as usize), point)).sum()
}

/// Both halves across the longest edge.
fn halves(corners: &Aabb) -> [Aabb; 2] {
    let extent = corners.extent();
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
    let (mut low, mut high) = (*corners, *corners);
    let middle = corners.center()[axis];
    (low.max[axis], high.min[axis]) = (middle, middle);
    [low, high]
}

impl Ord for Bounded {
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most)
    }
}

impl PartialOrd for Bounded {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Bounded {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Bounded {}

#[cfg(test)]
mod tests {
    use metaball_core::Kernel;

    use super::*;

    fn of(balls: &[(f32, f32)], threshold: f32) -> Emptiness {
        let ball = |&(x, strength): &(f32, f32)| Metaball {
            strength,
            ..Metaball::new(Vec3::new(x, 0.3, -0.2), 1.0)
        };
        let scene = Scene::new(balls.iter().map(ball), Kernel::QUARTIC, threshold).expect("legal");
        Emptiness::of(&scene)
    }

    #[test]
    fn what_is_too_weak_says_how_strong_it_is() {
        assert_eq!(of(&[], 0.25), Emptiness::NoBalls);
        assert_eq!(of(&[(0.0, -1.0)], 0.25), Emptiness::NothingAdds);
        for (balls, greatest) in [
            (&[(0.0, 0.2)][..], 0.2),
            // Two that meet: between them the field is 2·0.2·(1 − 0.25²)².
            (&[(-0.25, 0.2), (0.25, 0.2)], 0.3516),
            (&[(0.0, 0.1), (500.0, 0.2)], 0.2),
            // Half of a ball is taken away.
            (&[(0.0, 0.8), (0.0, -0.4)], 0.4),
        ] {
            let Emptiness::BelowThreshold { most, .. } = of(balls, 0.5) else {
                panic!("{:?}", of(balls, 0.5));
            };
            assert!(most >= greatest - 1e-4 && most <= 1.011 * greatest, "{most} for {greatest}");
        }
    }

    #[test]
    fn a_surface_that_is_there_is_found() {
        let Emptiness::OutOfSight { solid } = of(&[(0.0, 0.1), (500.0, 1.0)], 0.5) else {
            panic!("needed a surface");
        };
        assert!((solid.x - 500.0).abs() < 1.0);
        assert!(matches!(of(&[(-0.25, 0.3), (0.25, 0.3)], 0.5), Emptiness::OutOfSight { .. }));
        assert!(matches!(of(&[(0.0, 0.9), (0.6, -3.0)], 0.5), Emptiness::OutOfSight { .. }));
    }
}
