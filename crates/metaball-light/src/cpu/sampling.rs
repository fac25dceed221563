//! Low-discrepancy numbers: Roberts' sequence R2, shifted for each pixel and purpose by a hash of both
//! and of the seed (Cranley and Patterson 1976). The same seed gives the same picture.

use std::f32::consts::FRAC_PI_4;

use glam::{Vec2, Vec3};

/// The fractions 1/p and 1/p², p³ = p + 1, of 2³².
const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];

/// Points in the unit square.
#[derive(Debug, Clone, Copy)]
pub(super) struct Points {
    shifts: [u32; 2],
}

impl Points {
    /// Those of a pixel, for one purpose.
    pub(super) fn new(seed: u32, pixel: u32, purpose: u32) -> Self {
        Self::shifted(hash(hash(pixel ^ hash(purpose)) ^ seed))
    }

    fn shifted(shift_x: u32) -> Self {
        Self { shifts: [shift_x, hash(shift_x)] }
    }

    pub(super) fn nth(self, index: u32) -> Vec2 {
        // The sum wraps as a fraction should.
        let fraction =
            |axis: usize| self.shifts[axis].wrapping_add(index.wrapping_mul(STEPS[axis]));
        let number = |axis| (fraction(axis) >> 8) as f32 / (1u32 << 24) as f32;
        Vec2::new(number(0), number(1))
    }
}

/// How far sample `index` of a picture is moved, in pixels to the right and up, where all pixels share
/// one shift: from −1 to 1 each, with the density of a tent.
#[cfg(feature = "gpu")]
pub(crate) fn shift(index: u32, seed: u32) -> Vec2 {
    let point = Points::shifted(hash(seed)).nth(index);
    Vec2::new(tent(point.x), tent(point.y))
}

/// PCG's output function (Jarzynski and Olano 2020).
fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// From a uniform number to one in \[−1, 1\] with the density of a tent.
pub(super) fn tent(uniform_number: f32) -> f32 {
    let x = 2.0 * uniform_number - 1.0;
    (1.0 - (1.0 - x.abs()).sqrt()).copysign(x)
}

/// A point of the unit disc: the concentric map (Shirley and Chiu 1997).
pub(super) fn on_disc(square: Vec2) -> Vec2 {
    let centered = 2.0 * square - 1.0;
    let (radius, angle) = if centered.x.abs() > centered.y.abs() {
        (centered.x, FRAC_PI_4 * centered.y / centered.x)
    } else if centered.y == 0.0 {
        return Vec2::ZERO;
    } else {
        (centered.y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * centered.x / centered.y)
    };
    let (sine, cosine) = libm::sincosf(angle);
    radius * Vec2::new(cosine, sine)
}

/// Three perpendicular unit vectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame([Vec3; 3]);

impl Frame {
    /// One whose third vector is `axis` (Duff et al. 2017).
    pub(super) fn around(axis: Vec3) -> Self {
        let side = if axis.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (side + axis.z);
        let b = axis.x * axis.y * a;
        let first = Vec3::new(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
        let second = Vec3::new(b, side + axis.y * axis.y * a, -axis.y);
        Self([first, second, axis])
    }

    /// The unit vector over a point of the unit disc.
    pub(super) fn over(self, disc: Vec2) -> Vec3 {
        let [first, second, axis] = self.0;
        let height = (1.0 - disc.length_squared()).max(0.0).sqrt();
        (disc.x * first + disc.y * second + height * axis).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(feature = "gpu")]
    fn shifts_fill_the_tent_evenly() {
        let shifts: Vec<_> = (0..256).map(|index| shift(index, 5)).collect();
        let mean = |of: fn(&Vec2) -> f32| shifts.iter().map(of).sum::<f32>() / 256.0;
        assert!(mean(|shift| shift.x).abs() < 0.02 && mean(|shift| shift.y).abs() < 0.02);
        // The variance of a tent from −1 to 1 is 1/6.
        assert!((mean(|shift| shift.x * shift.x) - 1.0 / 6.0).abs() < 0.01);
        assert!(shifts.iter().all(|shift| shift.abs().max_element() <= 1.0));
        assert_ne!(shift(0, 5), shift(0, 6));
    }

    #[test]
    fn directions_around_an_axis_are_as_lambert_weighs_them() {
        let axis = Vec3::new(0.48, -0.6, -0.64);
        let (frame, points) = (Frame::around(axis), Points::new(3, 7, 2));
        let directions: Vec<_> =
            (0..1024).map(|index| frame.over(on_disc(points.nth(index)))).collect();
        assert!(directions.iter().all(|toward| (toward.length() - 1.0).abs() < 1e-6));
        // The mean of the cosine under its own density is 2/3, and sideways there is no preference.
        let mean = directions.iter().sum::<Vec3>() / 1024.0;
        assert!((mean - 2.0 / 3.0 * axis).length() < 0.01, "{mean}");
    }
}
