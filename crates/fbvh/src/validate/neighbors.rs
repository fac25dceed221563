//! Which supports overlap, found without a tree.

use super::samples::overlap;
use crate::Field;

/// Balls in the order of their centres' x.
pub(super) struct Neighbors {
    /// x of the centre, and the ball.
    sorted: Vec<(f32, u32)>,
    largest_radius: f32,
}

impl Neighbors {
    pub(super) fn new(field: &impl Field) -> Self {
        let supports = || (0..field.ball_count()).map(|ball| field.support(ball));
        let mut sorted: Vec<(f32, u32)> =
            (0..).zip(supports()).map(|(ball, support)| (support.center.x, ball)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let largest_radius = supports().fold(0.0, |largest, support| support.radius.max(largest));
        Self { sorted, largest_radius }
    }

    /// The balls that overlap a ball, itself included.
    pub(super) fn of(&self, field: &impl Field, ball: usize) -> Vec<u32> {
        let support = field.support(ball);
        let reach = (support.radius + self.largest_radius) * 1.01;
        let x = support.center.x;
        let first = self.sorted.partition_point(|&(other, _)| other < x - reach);
        self.sorted[first..]
            .iter()
            .take_while(|&&(other, _)| other <= x + reach)
            .map(|&(_, other)| other)
            .filter(|&other| overlap(&support, &field.support(other as usize)))
            .collect()
    }
}
