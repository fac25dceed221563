//! A leaf's balls, and where a packet of rays sees them.

use metaball_core::Aabb;

use super::super::lanes::{Lanes, WIDTH, array_of, lanes_of};
use super::super::parabolas::{Parabolas, UNIT};
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
struct Block {
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
    middle: [f64; 3],
    pub(super) balls: Vec<Ball>,
    blocks: Vec<Block>,
    /// The balls that reach a ray's interval, and each along the rays.
    pub(super) kept: Vec<u32>,
    pub(super) parabolas: Vec<Parabolas>,
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

    /// Lists the balls that may reach an interval. They are found along the interval of the ray in
    /// `lane`, within the radius plus the spread of the packet: a point of another ray's interval is no
    /// farther from its counterpart there than the ends of the two intervals are.
    #[inline(always)]
    pub(super) fn cull(&mut self, packet: &Packet, relative: &RelativePacket, lane: usize) {
        let zero = Lanes::splat(0.0f32);
        let (mut start, mut end) = (zero, zero);
        let (mut from, mut span) = ([zero; 3], [zero; 3]);
        for axis in 0..3 {
            let origin = relative.origin[axis].map(|x| x as f32);
            let half_span = packet.direction[axis] * relative.half;
            let (near, far) = (origin - half_span, origin + half_span);
            from[axis] = Lanes::splat(near.0[lane]);
            span[axis] = Lanes::splat(far.0[lane] - near.0[lane]);
            let (near, far) = (near - from[axis], far - Lanes::splat(far.0[lane]));
            start += near * near;
            end += far * far;
        }
        let spread = start.max(end).sqrt() + relative.reach * ROUNDED;
        let square = length_squared(span);
        // Where f32 overflows no ball is culled.
        let is_finite = (spread + square).0.iter().all(|number| number.is_finite());
        let widest = spread.0.into_iter().fold(0.0f32, f32::max);
        let spread = if is_finite { widest } else { f32::INFINITY };
        let inverse = square.map(|square| 1.0 / square.max(f32::MIN_POSITIVE));
        self.kept.clear();
        for (at, block) in self.blocks.iter().enumerate() {
            let [x, y, z] = block.center;
            let (x, y, z) = (x - from[0], y - from[1], z - from[2]);
            let t = (x * span[0] + y * span[1] + z * span[2]) * inverse;
            let t = t.min(Lanes::splat(1.0)).max(zero);
            let distance = length_squared([x - span[0] * t, y - span[1] * t, z - span[2] * t]);
            let reach = block.radius.map(|radius| radius + spread);
            let near = block.balls & !(reach * reach).is_less(distance).bits();
            self.kept.extend(lanes_of(near).map(|lane| (WIDTH * at + lane) as u32));
        }
    }

    /// Moves the rays' origins to the middles of their intervals, in f64. All other lanes than those
    /// given repeat one of them.
    #[inline(always)]
    pub(super) fn relative(
        &self,
        packet: &Packet,
        exact: &ExactPacket,
        (start, end): (Lanes<f64>, Lanes<f64>),
        lanes: u32,
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
        let mut relative = RelativePacket { origin, base, half, reach };
        let first = lanes.trailing_zeros() as usize;
        for lane in lanes_of(!lanes) {
            relative.origin.iter_mut().for_each(|numbers| numbers.0[lane] = numbers.0[first]);
            relative.base.0[lane] = relative.base.0[first];
            relative.half.0[lane] = relative.half.0[first];
            relative.reach.0[lane] = relative.reach.0[first];
        }
        relative
    }
}
