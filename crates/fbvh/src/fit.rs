//! Section 5.3: how far a surface can be from the balls that make it.

use metaball_core::{Aabb, Kernel};

use crate::ball::{Ball, sphere_meets};
use crate::options::Boxes;

/// The radius rᵢ around each ball of a node outside of all of which the field is below T.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Reach {
    /// Rᵢ.
    Support,
    /// min(Rᵢ, `r_max`).
    AtMost(f32),
    /// Rᵢ times a factor.
    Scaled(f32),
}

impl Reach {
    /// The bound for the balls of one node, own and split: `None` where they cannot reach T even if
    /// all had one centre.
    ///
    /// Were the field T at x, then Σ qᵢkᵢ(x) ≥ T, so some ball has kᵢ(x) ≥ T/Σq: x is within
    /// Rᵢ·k⁻¹(T/Σq) of it. The sum must run over all balls whose support meets the node's box.
    pub(crate) fn of<'a>(
        boxes: Boxes,
        kernel: Kernel,
        threshold: f32,
        balls: impl Iterator<Item = &'a Ball>,
    ) -> Option<Self> {
        if matches!(boxes, Boxes::Cut | Boxes::Support) {
            return Some(Self::Support);
        }
        let (strength, radius) = balls.fold((0.0f64, 0.0f32), |(strength, radius), ball| {
            (strength + f64::from(ball.strength), radius.max(ball.radius))
        });
        let share = f64::from(threshold) / strength;
        if share >= 1.0 {
            return None;
        }
        // Rounded up by more than the inverse kernel (1e-15) and the products (6e-8) can be off.
        let factor = (kernel.ratio_at(share).unwrap_or(1.0) * (1.0 + 4e-7)).min(1.0) as f32;
        Some(match boxes {
            Boxes::PerBall => Self::Scaled(factor),
            _ => Self::AtMost(radius * factor),
        })
    }

    /// The radius around a ball.
    pub(crate) fn radius(self, ball: &Ball) -> f32 {
        match self {
            Self::Support => ball.radius,
            Self::AtMost(radius) => ball.radius.min(radius),
            Self::Scaled(factor) => ball.radius * factor,
        }
    }

    /// The box around a ball's part of the surface.
    pub(crate) fn bounds(self, ball: &Ball) -> Aabb {
        Aabb::around_sphere(ball.center, self.radius(ball))
    }
}

/// Section 5.3.2: removes from `splits` the balls that take no part in any surface inside `bounds`,
/// and returns how many are left, at the head of the slice, in their order.
///
/// Were x in the box with F(x) ≥ T, then x is within rⱼ of some ball j. j is not a discarded ball i,
/// whose rᵢ keeps clear of the box; so |x − pᵢ| ≥ |pᵢ − pⱼ| − rⱼ ≥ Rᵢ, where ball i adds nothing.
pub(crate) fn discard(reach: Reach, bounds: &Aabb, own: &[Ball], splits: &mut [Ball]) -> usize {
    let mut kept = splits.len();
    let mut at = 0;
    while at < kept {
        let ball = splits[at];
        let clear_of = |other: &Ball| {
            let gap = ball.radius + reach.radius(other);
            !sphere_meets(ball.center, gap, &Aabb { min: other.center, max: other.center })
        };
        let contributes = sphere_meets(ball.center, reach.radius(&ball), bounds)
            || !own.iter().all(clear_of)
            || !splits[..kept].iter().all(|other| other.index == ball.index || clear_of(other));
        if contributes {
            at += 1;
        } else {
            splits[at..kept].rotate_left(1);
            kept -= 1;
        }
    }
    kept
}
