//! A leaf's balls, and where a packet of rays sees them.

use metaball_core::Aabb;

use super::super::lanes::{Lanes, Mask, WIDTH, array_of, lanes_of};
use super::super::parabolas::{BySign, Parabolas, UNIT};
use super::rays::{ExactPacket, Packet, length_squared};
use crate::Field;

/// A ball, relative to the middle of its leaf's box.
#[derive(Debug, Clone)]
pub(super) struct Ball {
    /// The centre, f64 and rounded.
    pub(super) exact: [f64; 3],
    pub(super) center: [f32; 3],
    /// 1/R².
    pub(super) inverse_square: f64,
    pub(super) inverse_square_f32: f32,
    /// R and 1/R.
    pub(super) radius: f32,
    pub(super) inverse_radius: f32,
    /// The centre's distance from the middle over R.
    pub(super) distance: f32,
    pub(super) strength: f32,
}

/// Eight balls, for culling those that a packet misses.
#[derive(Debug, Clone)]
pub(super) struct Block {
    center: [Lanes<f32>; 3],
    /// The radius and what rounding can add.
    radius: Lanes<f32>,
    /// The lanes that have a ball.
    balls: u32,
}

/// A leaf that has been loaded for packets; kept from leaf to leaf for its memory.
#[derive(Debug, Default)]
pub(super) struct Balls {
    leaf: Option<usize>,
    pub(super) middle: [f64; 3],
    pub(super) least_radius: f64,
    pub(super) balls: Vec<Ball>,
    pub(super) blocks: Vec<Block>,
    /// The balls that reach a ray's interval, and each along the rays.
    pub(super) kept: Vec<u32>,
    pub(super) parabolas: BySign,
}

/// The rays' intervals in a leaf, each relative to a nearby origin: t there is `base` more than here,
/// where it runs from −`half` to `half`.
pub(super) struct RelativePacket {
    /// The nearby origins, from the middle of the leaf's box.
    pub(super) origin: [Lanes<f64>; 3],
    pub(super) base: Lanes<f64>,
    pub(super) half: Lanes<f32>,
    /// How far points of the intervals and their origins are from the leaf's middle, and what f64
    /// rounds between the eye and the origins.
    pub(super) reach: Lanes<f32>,
}

/// A ball around the rays' intervals in a leaf, about the middle of one of them; relative to the middle of
/// the leaf's box, and larger by what rounding can add.
pub(super) struct Surroundings {
    center: [Lanes<f32>; 3],
    radius: f32,
}

const ZERO: Lanes<f32> = Lanes([0.0; WIDTH]);

/// More than all that f32 rounds of distances, per distance from the leaf's middle.
const ROUNDED: f32 = 64.0 * UNIT;

impl Balls {
    /// Loads the balls of a leaf, unless it is loaded already.
    pub(super) fn load(&mut self, field: &impl Field, leaf: usize, bounds: &Aabb, list: &[u32]) {
        if self.leaf == Some(leaf) {
            return;
        }
        self.leaf = Some(leaf);
        let middle = bounds.center().as_dvec3();
        self.middle = middle.to_array();
        self.balls.clear();
        self.balls.extend(list.iter().map(|&ball| {
            let support = field.support(ball as usize);
            let center = support.center.as_dvec3() - middle;
            let inverse = f64::from(support.radius).recip();
            let inverse_square = inverse * inverse;
            let (rounded, inverse_radius) = (center.as_vec3(), inverse as f32);
            Ball {
                exact: center.to_array(),
                center: rounded.to_array(),
                inverse_square,
                inverse_square_f32: inverse_square as f32,
                radius: support.radius,
                inverse_radius,
                distance: rounded.length() * inverse_radius,
                strength: field.strength(ball as usize),
            }
        }));
        let radii = self.balls.iter().map(|ball| f64::from(ball.radius));
        self.least_radius = radii.fold(f64::INFINITY, f64::min);
        self.blocks.clear();
        self.blocks.extend(self.balls.chunks(WIDTH).map(|balls| {
            let zero = Lanes::splat(0.0);
            let (mut center, mut radius) = ([zero; 3], zero);
            for (lane, ball) in balls.iter().enumerate() {
                for (lanes, coordinate) in center.iter_mut().zip(ball.center) {
                    lanes.0[lane] = coordinate;
                }
                radius.0[lane] = ball.radius * (1.0 + ROUNDED * ball.distance);
            }
            Block { center, radius, balls: (1 << balls.len()) - 1 }
        }));
    }

    /// Keeps the balls that may reach some intervals.
    #[inline(always)]
    pub(super) fn keep(&mut self, near: &Surroundings) {
        self.kept.clear();
        for (at, block) in self.blocks.iter().enumerate() {
            self.kept.extend(lanes_of(block.near(near)).map(|lane| (WIDTH * at + lane) as u32));
        }
    }

    /// Moves the rays' origins to the middles of their intervals, in f64.
    #[inline(always)]
    pub(super) fn relative(
        &self,
        packet: &Packet,
        exact: &ExactPacket,
        (start, end): (Lanes<f64>, Lanes<f64>),
    ) -> RelativePacket {
        // Rounded up, as for a single ray.
        let half = ((end - start) * 0.5).map(|half| {
            (half * (1.0 + f64::from(f32::EPSILON)) + f64::from(f32::MIN_POSITIVE)) as f32
        });
        let base = start + half.map(f64::from);
        let mut origin = exact.origin;
        for (axis, start) in origin.iter_mut().enumerate() {
            let direction = packet.direction[axis].map(f64::from);
            *start = (*start - Lanes::splat(self.middle[axis])) + base * direction;
        }
        let [x, y, z] = array_of(|axis| origin[axis].map(|x| x as f32));
        let distance = (x * x + y * y + z * z).sqrt();
        let middle = self.middle.iter().map(|x| x.abs()).sum::<f64>() as f32;
        let far = exact.distance + Lanes::splat(middle) + base.map(|base| base.abs() as f32);
        let far = far * (4.0 * f64::EPSILON / f64::from(UNIT)) as f32;
        let reach = (distance * 2.0 + half * exact.length + far) * 1.000_01;
        RelativePacket { origin, base, half, reach }
    }
}

impl Ball {
    /// The ball along the rays, and the projections of its centre, in lengths of the directions times
    /// scene units.
    ///
    /// # Rounding
    /// As for a single ray (`project` of `trace/certified/polynomial/blocks.rs`): ρ + λ + ω is at most
    /// the distance of the ball's centre from the leaf's middle plus `reach`, in radii. The projection,
    /// where v is largest, is misplaced by a few u(ρ + λ + ω)R, which changes v by the square of that.
    #[inline(always)]
    pub(super) fn along(
        &self,
        packet: &Packet,
        exact: &ExactPacket,
        relative: &RelativePacket,
    ) -> (Parabolas, Lanes<f32>) {
        const MARGIN: f32 = 16.0 * UNIT;
        let offset =
            |axis: usize| Lanes::splat(self.center[axis]) - relative.origin[axis].map(|x| x as f32);
        let (x, y, z) = (offset(0), offset(1), offset(2));
        let [dx, dy, dz] = packet.direction;
        let along = x * dx + y * dy + z * dz;
        let distance = (x * x + y * y + z * z) * self.inverse_square_f32;
        let reaches = (relative.reach * self.inverse_radius).map(|reach| self.distance + reach);
        let margin = (reaches * reaches).map(|x| MARGIN * (1.0 + x));
        let parabola = Parabolas {
            constant: distance.map(|x| 1.0 - x),
            linear: along * (2.0 * self.inverse_square_f32),
            square: exact.square.map(|square| square as f32) * self.inverse_square_f32,
            margin,
            slope_margin: margin * self.inverse_radius,
            strength: Lanes::splat(self.strength),
        };
        (parabola, along)
    }
}

impl RelativePacket {
    /// Surrounds parts of the intervals of some lanes, from `first` to `last`.
    #[inline(always)]
    pub(super) fn surroundings(
        &self,
        packet: &Packet,
        exact: &ExactPacket,
        (first, last): (Lanes<f32>, Lanes<f32>),
        lanes: Mask,
    ) -> Surroundings {
        let lane = lanes.bits().trailing_zeros() as usize;
        let middle = (first + last) * 0.5;
        let middles: [_; 3] =
            array_of(|axis| self.origin[axis].map(|x| x as f32) + packet.direction[axis] * middle);
        let center = array_of(|axis| Lanes::splat(middles[axis].0[lane]));
        let away = array_of(|axis| middles[axis] - center[axis]);
        let radius = length_squared(away).sqrt() + (last - first) * 0.5 * exact.length;
        let radius = lanes.select(radius * (1.0 + ROUNDED) + self.reach * ROUNDED, ZERO);
        // Where f32 overflows no ball is culled.
        let is_finite = radius.0.iter().all(|radius| radius.is_finite());
        let widest = radius.0.into_iter().fold(0.0f32, f32::max);
        Surroundings { center, radius: if is_finite { widest } else { f32::INFINITY } }
    }
}

impl Block {
    /// The lanes whose balls may reach an interval.
    #[inline(always)]
    pub(super) fn near(&self, surroundings: &Surroundings) -> u32 {
        let Surroundings { center, radius } = surroundings;
        let distance = length_squared(array_of(|axis| self.center[axis] - center[axis]));
        let reach = self.radius.map(|own| own + radius);
        self.balls & !(reach * reach).is_less(distance).bits()
    }
}
