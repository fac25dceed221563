//! A hierarchy over effective spheres, split in the middle; leaves of up to four, tested at once.

use glam::Vec3;
use metaball_core::{Aabb, Ray, Scene, Support};
use wide::f32x4;

use super::chord::Chord;

/// Spheres of a leaf, and lanes of its test.
const LANES: usize = 4;

#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    balls: Vec<Ball>,
}

#[derive(Debug)]
struct Node {
    bounds: Aabb,
    content: Content,
}

#[derive(Debug, Clone, Copy)]
enum Content {
    /// Children: the next node, and the one named here.
    Inner(u32),
    Leaf(u32),
}

/// Up to four spheres, lane by lane. Lanes without one have the index `u32::MAX`.
#[derive(Debug)]
struct Leaf {
    center: [f32x4; 3],
    radius: f32x4,
    balls: [u32; LANES],
}

/// What a ball's chord follows from.
#[derive(Debug, Clone, Copy)]
struct Ball {
    support: Support,
    strength: f64,
    /// 0 or less where the ball has no kernel sphere.
    kernel_radius: f64,
}

impl Tree {
    pub(super) fn build(scene: &Scene) -> Self {
        let balls: Vec<_> = scene
            .supports()
            .iter()
            .zip(scene.balls())
            .map(|(&support, ball)| Ball {
                support,
                strength: f64::from(ball.strength),
                kernel_radius: scene.kernel().core_radius(&ball, scene.threshold()).unwrap_or(-1.0),
            })
            .collect();
        let mut order: Vec<u32> = (0..balls.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), leaves: Vec::new(), balls };
        if !order.is_empty() {
            tree.split(&mut order);
        }
        tree
    }

    /// Adds the node of these balls, and all below it.
    fn split(&mut self, order: &mut [u32]) {
        let supports = order.iter().map(|&ball| self.balls[ball as usize].support);
        let empty = (Aabb::EMPTY, (Vec3::INFINITY, Vec3::NEG_INFINITY));
        let (bounds, (low, high)) = supports.fold(empty, |(bounds, (low, high)), support| {
            let sphere = Aabb::around_sphere(support.center, support.radius);
            (bounds.union(&sphere), (low.min(support.center), high.max(support.center)))
        });
        let node = self.nodes.len();
        if order.len() <= LANES {
            let leaf = self.leaves.len() as u32;
            self.leaves.push(Leaf::new(order, &self.balls));
            self.nodes.push(Node { bounds, content: Content::Leaf(leaf) });
            return;
        }
        let extent = high - low;
        let axis = extent.max_position();
        let middle = 0.5 * low[axis] + 0.5 * high[axis];
        order.sort_unstable_by_key(|&ball| {
            (self.balls[ball as usize].support.center[axis] > middle, ball)
        });
        let first_half =
            order.partition_point(|&ball| self.balls[ball as usize].support.center[axis] <= middle);
        // Coincident centres have no middle.
        let cut = if first_half == order.len() { order.len() / 2 } else { first_half.max(1) };
        let (left, right) = order.split_at_mut(cut);
        self.nodes.push(Node { bounds, content: Content::Inner(0) });
        self.split(left);
        self.nodes[node].content = Content::Inner(self.nodes.len() as u32);
        self.split(right);
    }

    /// Adds the chords of all balls that the ray meets before its nearest kernel sphere, whose t it
    /// returns: infinite where there is none.
    pub(super) fn chords(
        &self,
        ray: &Ray,
        stack: &mut Vec<(u32, f32)>,
        chords: &mut Vec<Chord>,
    ) -> f64 {
        let slabs = Slabs::new(ray);
        let mut kernel_sphere = f64::INFINITY;
        let mut limit = ray.t_max;
        stack.clear();
        if let Some(root) = self.nodes.first()
            && let Some(enter) = slabs.enter(&root.bounds, limit)
        {
            stack.push((0, enter));
        }
        while let Some((node, enter)) = stack.pop() {
            if enter > limit {
                continue;
            }
            match self.nodes[node as usize].content {
                Content::Leaf(leaf) => {
                    for ball in self.leaves[leaf as usize].met(ray) {
                        let Some(chord) = self.chord(ball, ray) else { continue };
                        kernel_sphere = kernel_sphere.min(chord.kernel_sphere(ray.t_min.into()));
                        limit = limit.min(round_up(kernel_sphere));
                        chords.push(chord);
                    }
                }
                Content::Inner(right) => {
                    let child = |child: u32| {
                        let enter = slabs.enter(&self.nodes[child as usize].bounds, limit)?;
                        Some((child, enter))
                    };
                    let (mut near, mut far) = (child(node + 1), child(right));
                    if let (Some(left), Some(right)) = (near, far)
                        && right.1 < left.1
                    {
                        (near, far) = (far, near);
                    }
                    stack.extend(far);
                    stack.extend(near);
                }
            }
        }
        kernel_sphere
    }

    /// A ball along the ray, in f64; `None` where the ray misses it or leaves it behind.
    fn chord(&self, ball: u32, ray: &Ray) -> Option<Chord> {
        let Ball { support, strength, kernel_radius } = self.balls[ball as usize];
        let direction = ray.direction.as_dvec3();
        let to_center = support.center.as_dvec3() - ray.origin.as_dvec3();
        let square = direction.length_squared();
        let middle = to_center.dot(direction) / square;
        let off_axis = (to_center - middle * direction).length_squared();
        let radius = f64::from(support.radius);
        // t counts in the direction's own length, unit to rounding.
        let half_squared = |radius: f64| (radius * radius - off_axis) / square;
        let chord = Chord {
            ball,
            middle,
            half_squared: half_squared(radius),
            inverse_square: square / (radius * radius),
            strength,
            kernel_half_squared: if kernel_radius > 0.0 {
                half_squared(kernel_radius)
            } else {
                -1.0
            },
        };
        (chord.half_squared > 0.0 && chord.leave() > f64::from(ray.t_min)).then_some(chord)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of_val::<[Node]>(&self.nodes)
            + size_of_val::<[Leaf]>(&self.leaves)
            + size_of_val::<[Ball]>(&self.balls)
    }
}

impl Leaf {
    fn new(order: &[u32], balls: &[Ball]) -> Self {
        let lane = |of: &dyn Fn(&Support) -> f32, otherwise: f32| {
            let mut lanes = [otherwise; LANES];
            for (lane, &ball) in lanes.iter_mut().zip(order) {
                *lane = of(&balls[ball as usize].support);
            }
            f32x4::from(lanes)
        };
        let mut indices = [u32::MAX; LANES];
        indices[..order.len()].copy_from_slice(order);
        Self {
            center: [0, 1, 2].map(|axis| lane(&|support| support.center[axis], 0.0)),
            radius: lane(&|support| support.radius, -1.0),
            balls: indices,
        }
    }

    /// Indices of the balls that the ray meets, and perhaps some that it misses by no more than rounding.
    ///
    /// The vector across the ray is q = o − m·d, o from the ray's start to the centre. Each of its terms
    /// rounds by units of 2⁻²⁴ of |o|; the error of m is along d and counts in second order alone. Where
    /// the ray nearly touches the sphere |q| is R, so that Q² = R² − q² errs by less than 2⁻²⁴ times
    /// 20·|o|·R + 8·R², and |o| is at most |m| + R.
    fn met(&self, ray: &Ray) -> impl Iterator<Item = u32> {
        let component = |axis: usize| f32x4::splat(ray.direction[axis]);
        let offset = |axis: usize| self.center[axis] - f32x4::splat(ray.origin[axis]);
        let (dx, dy, dz) = (component(0), component(1), component(2));
        let (x, y, z) = (offset(0), offset(1), offset(2));
        let middle = x * dx + y * dy + z * dz;
        let (qx, qy, qz) = (x - middle * dx, y - middle * dy, z - middle * dz);
        let off_axis = qx * qx + qy * qy + qz * qz;
        let slack = f32x4::splat(2.5e-6) * self.radius * (self.radius + middle.abs());
        let half_squared = self.radius * self.radius + slack - off_axis;
        let met = half_squared.simd_ge(f32x4::splat(0.0)).to_bitmask();
        let balls = self.balls;
        (0..LANES)
            .filter(move |lane| met >> lane & 1 == 1 && balls[*lane] != u32::MAX)
            .map(move |lane| balls[lane])
    }
}

/// No f32 below the number.
fn round_up(t: f64) -> f32 {
    (t * (1.0 + f64::from(f32::EPSILON))) as f32
}

/// A ray against boxes.
struct Slabs {
    origin: Vec3,
    inverse: Vec3,
    t_min: f32,
}

impl Slabs {
    fn new(ray: &Ray) -> Self {
        // No division by zero: across a legal scene a component this small moves a ray by less than rounding.
        let away = |d: f32| if d.abs() < 1e-20 { 1e-20f32.copysign(d) } else { d };
        let direction = ray.direction;
        let direction = Vec3::new(away(direction.x), away(direction.y), away(direction.z));
        Self { origin: ray.origin, inverse: direction.recip(), t_min: ray.t_min }
    }

    /// t at which the ray enters the box, with a margin for the three roundings of each crossing.
    fn enter(&self, bounds: &Aabb, limit: f32) -> Option<f32> {
        const ROUNDING: f32 = 4.0 * f32::EPSILON;
        let one = (bounds.min - self.origin) * self.inverse;
        let other = (bounds.max - self.origin) * self.inverse;
        let enter = one.min(other).max_element();
        let leave = one.max(other).min_element();
        let enter = (enter - ROUNDING * enter.abs()).max(self.t_min);
        (enter <= leave + ROUNDING * leave.abs() && enter <= limit).then_some(enter)
    }
}
