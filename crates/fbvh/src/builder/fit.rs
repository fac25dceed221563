//! Section 5.3: how far a surface can be from the balls that make it.

use metaball_core::{Aabb, Kernel};

use super::ball::{Ball, bounds_within, retain, sphere_meets};
use crate::options::Boxes;

/// The radius rᵢ = min(Rᵢ·`factor`, `limit`) around each ball of a node outside of all of which the
/// field is below T.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    factor: f32,
    limit: f32,
}

impl Reach {
    const SUPPORT: Self = Self { factor: 1.0, limit: f32::INFINITY };

    /// The bound for the balls of one node, own and split: `None` where they cannot reach T even if
    /// all had one centre.
    ///
    /// Were the field T at x, then Σ qᵢkᵢ(x) ≥ T, so some ball has kᵢ(x) ≥ T/Σq: x is within
    /// Rᵢ·k⁻¹(T/Σq) of it. The sum must run over all balls whose support meets the node's box.
    pub(super) fn of(boxes: Boxes, kernel: Kernel, threshold: f32, balls: &[Ball]) -> Option<Self> {
        if matches!(boxes, Boxes::Cut | Boxes::Support) {
            return (!balls.is_empty()).then_some(Self::SUPPORT);
        }
        let (strength, radius) = balls.iter().fold((0.0f64, 0.0f32), |(strength, radius), ball| {
            (strength + f64::from(ball.strength), radius.max(ball.radius()))
        });
        let per_ball = Self::per_ball(kernel, threshold, strength)?;
        Some(match boxes {
            Boxes::PerBall => per_ball,
            _ => Self { limit: radius * per_ball.factor, ..Self::SUPPORT },
        })
    }

    /// [`Boxes::PerBall`] of balls whose strengths have this sum.
    pub(super) fn per_ball(kernel: Kernel, threshold: f32, strength: f64) -> Option<Self> {
        let share = f64::from(threshold) / strength;
        if share >= 1.0 {
            return None;
        }
        // Rounded up by more than the inverse kernel (1e-15) and the products (6e-8) can be off.
        let factor = (kernel.ratio_at(share).unwrap_or(1.0) * (1.0 + 4e-7)).min(1.0) as f32;
        Some(Self { factor, ..Self::SUPPORT })
    }

    /// The radius around a ball.
    #[inline]
    pub(super) fn radius(self, ball: &Ball) -> f32 {
        (ball.radius() * self.factor).min(self.limit)
    }

    /// The part of a box around the surface that the balls can make in it.
    pub(super) fn clip(self, balls: &[Ball], bounds: &Aabb) -> Aabb {
        bounds_within(bounds, balls, |ball| self.radius(ball))
    }
}

/// Section 5.3.2: removes from a node's list the split balls that take no part in any surface inside
/// `bounds`, and returns how many balls are left, at the head of the slice, in their order.
///
/// Were x in the box with F(x) ≥ T, then x is within rⱼ of some ball j. j is not a discarded ball i,
/// whose rᵢ keeps clear of the box; so |x − pᵢ| ≥ |pᵢ − pⱼ| − rⱼ ≥ Rᵢ, where ball i adds nothing.
pub(super) fn discard(
    reach: Reach,
    bounds: &Aabb,
    balls: &mut [Ball],
    is_own: impl Fn(&Ball) -> bool,
) -> usize {
    let mut kept = balls.len();
    let mut at = 0;
    while at < kept {
        let ball = balls[at];
        let touches = |other: &Ball| ball.is_within(ball.radius() + reach.radius(other), other);
        let contributes = is_own(&ball)
            || sphere_meets(ball.center(), reach.radius(&ball), bounds)
            || balls[..kept].iter().any(|other| other.index != ball.index && touches(other));
        if contributes {
            at += 1;
        } else {
            balls.copy_within(at + 1..kept, at);
            kept -= 1;
        }
    }
    kept
}

/// Keeps those of a node's balls that reach its box.
pub(super) fn keep_reaching(balls: &mut [Ball], bounds: &Aabb) -> usize {
    retain(balls, |ball| ball.reaches(bounds))
}
