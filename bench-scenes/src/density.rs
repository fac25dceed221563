//! Density: how many other balls a ball's centre lies in.

use glam::DVec3;
use metaball_core::{Scene, Support};

/// A ball whose position and relative size are known, but not its scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnscaledBall {
    /// Centre, scene units.
    pub(crate) center: DVec3,
    /// Support radius over the scene's common scale.
    pub(crate) size: f64,
}

/// Distances measured: enough to know the density of dense scenes to about 1 %, few enough to take
/// a fraction of a second.
const DISTANCES: usize = 8_000_000;

/// Balls whose neighbourhood is measured even where that takes more distances.
const LEAST_SAMPLE: usize = 16;

/// The scale at which the supports of `density` other balls hold a ball's centre, on average over
/// balls picked at equal steps through the list. Scattered without order, the balls then also cover
/// any point `density` times on average. `density` must be below the number of other balls.
pub(crate) fn scale_for(balls: &[UnscaledBall], density: f64) -> f64 {
    let mut squared_scales = Vec::new();
    let mut sampled = 0;
    for (index, ball) in sample(balls) {
        sampled += 1;
        squared_scales.extend(balls.iter().enumerate().filter(|(other, _)| *other != index).map(
            |(_, other)| {
                (other.center.distance_squared(ball.center) / (other.size * other.size)) as f32
            },
        ));
    }
    let wanted = (density * f64::from(sampled)) as usize;
    let last = squared_scales.len() - 1;
    let (_, squared, _) = squared_scales.select_nth_unstable_by(wanted.min(last), f32::total_cmp);
    f64::from(*squared).sqrt()
}

/// The mean number of other balls' supports that hold a ball's centre; 0 for an empty scene. Exact up
/// to 2,828 balls, else over balls picked at equal steps through the list: sixteen, or more while
/// they make eight million pairs.
pub fn mean_overlap(scene: &Scene) -> f64 {
    let supports = scene.supports();
    let holds = |support: &Support, ball: &Support| {
        let (radius, apart) =
            (f64::from(support.radius), support.center.as_dvec3() - ball.center.as_dvec3());
        apart.length_squared() < radius * radius
    };
    let (mut held, mut sampled) = (0, 0);
    for (_, ball) in sample(supports) {
        sampled += 1;
        // The ball holds its own centre.
        held += supports.iter().filter(|support| holds(support, ball)).count() - 1;
    }
    held as f64 / f64::from(sampled.max(1))
}

/// Items at equal steps through the list: all if that makes no more than [`DISTANCES`] pairs with the
/// others, else as many as make that many, but at least [`LEAST_SAMPLE`].
fn sample<T>(items: &[T]) -> impl Iterator<Item = (usize, &T)> {
    let step = (items.len() * items.len()).div_ceil(DISTANCES);
    let step = step.min(items.len() / LEAST_SAMPLE).max(1);
    items.iter().enumerate().step_by(step)
}
