//! A leaf's balls side by side, and where one ray sees them.

use glam::{DVec3, Vec3};
use metaball_core::{Aabb, Ray};

use super::super::lanes::{Lanes, WIDTH, array_of};
use super::super::parabolas::{BySign, Parabolas, UNIT};
use crate::Field;
use crate::trace::field_tree::negative_balls;

/// Eight balls, relative to the middle of their leaf's box.
#[derive(Debug, Clone)]
pub(super) struct Block {
    /// Centres, f64 and rounded.
    pub(super) exact: [Lanes<f64>; 3],
    center: [Lanes<f32>; 3],
    /// 1/R².
    pub(super) inverse_square: Lanes<f64>,
    inverse_square_f32: Lanes<f32>,
    /// 1/R.
    inverse_radius: Lanes<f32>,
    /// Strengths; 0 in a lane without a ball.
    pub(super) strength: Lanes<f32>,
    is_negative: bool,
}

/// The leaf that has been loaded for a ray; kept from leaf to leaf for its memory.
#[derive(Debug, Default)]
pub(in crate::trace::certified) struct Blocks {
    leaf: Option<usize>,
    pub(super) middle: DVec3,
    pub(super) least_radius: f64,
    /// Of balls of one sign each, negative ones first.
    pub(super) blocks: Vec<Block>,
    pub(super) parabolas: BySign,
}

/// A ray's interval in a leaf, relative to a nearby origin: t there is `base` more than here, where it
/// runs from −`half` to `half`.
#[derive(Debug, Clone, Copy)]
pub(super) struct RelativeRay {
    /// The nearby origin, from the middle of the leaf's box.
    pub(super) origin: DVec3,
    direction: DVec3,
    pub(super) base: f64,
    pub(super) half: f32,
    /// Whether the ray starts with the interval.
    pub(super) starts: bool,
}

impl Blocks {
    /// Loads the balls of a leaf, unless it is loaded already.
    pub(in crate::trace::certified) fn load(
        &mut self,
        field: &impl Field,
        leaf: usize,
        bounds: &Aabb,
        list: &[u32],
    ) {
        if self.leaf == Some(leaf) {
            return;
        }
        self.leaf = Some(leaf);
        self.middle = bounds.center().as_dvec3();
        self.least_radius = f64::INFINITY;
        self.blocks.clear();
        let (negative, positive) = list.split_at(negative_balls(field, list));
        for balls in negative.chunks(WIDTH).chain(positive.chunks(WIDTH)) {
            let mut exact = [Lanes::splat(0.0); 3];
            let mut radius = [1.0f64; WIDTH];
            let mut strength = Lanes::splat(0.0);
            for (lane, &ball) in balls.iter().enumerate() {
                let support = field.support(ball as usize);
                let center = support.center.as_dvec3() - self.middle;
                for axis in 0..3 {
                    exact[axis].0[lane] = center[axis];
                }
                radius[lane] = f64::from(support.radius);
                self.least_radius = self.least_radius.min(radius[lane]);
                strength.0[lane] = field.strength(ball as usize);
            }
            let inverse = Lanes(radius).map(f64::recip);
            let inverse_square = inverse * inverse;
            self.blocks.push(Block {
                exact,
                center: array_of(|axis| exact[axis].map(|x| x as f32)),
                inverse_square,
                inverse_square_f32: inverse_square.map(|x| x as f32),
                inverse_radius: inverse.map(|x| x as f32),
                strength,
                is_negative: strength.0[0] < 0.0,
            });
        }
    }

    /// Moves the ray's origin to the middle of its interval, in f64: the distance of the eye then costs
    /// no digits.
    pub(super) fn relative(&self, ray: &Ray, (start, end): (f64, f64)) -> RelativeRay {
        // Rounded up: the interval may reach past the leaf's far face by a float, not fall short.
        let half = (0.5 * (end - start)) as f32;
        let half = if f64::from(half) < 0.5 * (end - start) { half.next_up() } else { half };
        let base = start + f64::from(half);
        let direction = ray.direction.as_dvec3();
        let origin = (ray.origin.as_dvec3() - self.middle) + base * direction;
        let starts = start <= f64::from(ray.t_min);
        RelativeRay { origin, direction, base, half, starts }
    }

    /// Projects the balls on the ray.
    ///
    /// # Rounding
    /// With u = 2⁻²⁴, ρ = |p − o|/R, λ = `half`·|d|/R, ω = |o|/R: the centre and o are rounded once,
    /// which moves p − o by u(2ω + 2ρ)R. Squares, products, 1/R² and sums add to that; in all v is
    /// right to u(3 + 12ρ² + 20ρλ + 7λ² + 4ω(ρ + λ)) ≤ 12u(1 + (ρ + λ + ω)²), of which 16u is
    /// taken. What f64 rounds between the eye and the nearby origin is added to ω. The slope dv/dt is
    /// right to u(16ρ + 10λ + 4ω)/R, less than a margin over R, since 1 + x² is at least 2x.
    #[inline(always)]
    pub(super) fn project(&mut self, ray: &Ray, relative: &RelativeRay) {
        const MARGIN: f32 = 16.0 * UNIT;
        let origin = relative.origin.as_vec3();
        let direction = ray.direction;
        let square = relative.direction.length_squared();
        let far = ray.origin.as_dvec3().length() + self.middle.length() + relative.base.abs();
        let reach = relative.origin.length()
            + f64::from(relative.half) * square.sqrt()
            + far * (4.0 * f64::EPSILON / f64::from(UNIT));
        let reach = (reach * 1.000_001) as f32;
        let square = square as f32;
        self.parabolas.clear();
        for block in &self.blocks {
            let offset = |axis: usize| block.center[axis] - Lanes::splat(origin[axis]);
            let (x, y, z) = (offset(0), offset(1), offset(2));
            let Vec3 { x: dx, y: dy, z: dz } = direction;
            let along = x * dx + y * dy + z * dz;
            let distance = (x * x + y * y + z * z) * block.inverse_square_f32;
            let reaches = distance.sqrt() + block.inverse_radius * reach;
            let margin = (reaches * reaches).map(|x| MARGIN * (1.0 + x));
            let parabolas = Parabolas {
                constant: distance.map(|x| 1.0 - x),
                linear: along * block.inverse_square_f32 * 2.0,
                square: block.inverse_square_f32 * square,
                margin,
                slope_margin: margin * block.inverse_radius,
                strength: block.strength,
            };
            self.parabolas.push(parabolas, block.is_negative);
        }
    }
}
