//! Rays and hits.

use std::cmp::Ordering;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// The points `origin + t * direction` with `t_min` ≤ t ≤ `t_max`; the same bit for bit to every method
/// and to the reference.
///
/// A ray starts at `t_min`. The rays of a view start at its eye, and shaders know no others than those
/// that start at their origin: a frame's rays and a batch's have a `t_min` of 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where t is 0, world space, scene units.
    pub origin: Vec3,
    /// Direction, unit to rounding (6e-8). Never normalised again: t counts this vector.
    pub direction: Vec3,
    /// Least t, scene units, not negative: 0 where the ray starts at its origin, more where what lies
    /// before that does not count.
    pub t_min: f32,
    /// Greatest t, scene units, where something opaque ends the ray; [`NO_LIMIT`] where nothing does.
    pub t_max: f32,
}

impl Ray {
    /// A ray from its origin, without an end.
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: NO_LIMIT }
    }

    /// Whether it has no points, which is a miss: `t_min` above `t_max`, or a NaN among them.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.t_min.partial_cmp(&self.t_max).is_none_or(Ordering::is_gt)
    }
}

/// `t_max` of rays without an end: the greatest finite f32, since WGSL need not have infinities.
pub const NO_LIMIT: f32 = f32::MAX;

/// Whether a ray meets the solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Verdict {
    /// The field stays below T along the whole ray.
    Miss = 0,
    /// The field first reaches T at the hit's distance.
    Hit = 1,
    /// The field is T or more where the ray starts; the hit is there, at t = `t_min`.
    Inside = 2,
    /// Arithmetic could not decide, not even at the last float. Only methods that certify their answers
    /// report it.
    Undecided = 3,
}

/// What a method finds along one ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Whether the ray meets the solid.
    pub verdict: Verdict,
    /// Whether a rule that the method's paper publishes for trouble made this hit.
    pub fallback: bool,
    /// t of the hit, scene units: the ray's `t_min` inside, +∞ for a miss.
    pub t: f32,
    /// Unit vector out of the solid, against the field's gradient, world space; zero for a miss.
    pub normal: Vec3,
}

impl Hit {
    /// A ray that hits nothing.
    pub const MISS: Self =
        Self { verdict: Verdict::Miss, fallback: false, t: f32::INFINITY, normal: Vec3::ZERO };

    /// The hit, but for a ray that is undecided: where a root was sought and not told apart from none, a
    /// hit is most likely, and elsewhere a miss.
    #[must_use]
    pub fn most_likely(&self) -> Self {
        match self.verdict {
            Verdict::Undecided if self.t.is_finite() && self.normal != Vec3::ZERO => {
                Self { verdict: Verdict::Hit, ..*self }
            }
            Verdict::Undecided => Self { fallback: self.fallback, ..Self::MISS },
            _ => *self,
        }
    }

    /// Whether there is a surface point: a hit, or a start inside.
    pub fn is_hit(&self) -> bool {
        matches!(self.verdict, Verdict::Hit | Verdict::Inside)
    }
}

/// A hit as shaders write it, sixteen bytes: WGSL's `Hit` of `shaders/wgsl/core/hit.wgsl`. The normal is
/// folded onto an octahedron (Cigolle et al. 2014, "A survey of efficient representations for independent
/// unit vectors") in full f32, which keeps it to 1e-7.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct PackedHit {
    /// Octahedral coordinates of the unit outward normal, each in \[−1, 1\].
    pub normal: [f32; 2],
    /// Distance along the ray; 0 for a miss.
    pub t: f32,
    /// The verdict's number in the low byte, plus [`PackedHit::FALLBACK`]; above them the upper bits
    /// of the [clearance](PackedHit::clearance).
    pub status: u32,
}

impl PackedHit {
    /// The bit of `status` that marks a fallback pixel.
    pub const FALLBACK: u32 = 1 << 8;

    /// How far from the hit, along the normal, a secondary ray must start to be certainly on its side of
    /// the surface: scene units, rounded up. 0 where the method does not report it.
    pub fn clearance(self) -> f32 {
        f32::from_bits(self.status & !0x1ff)
    }

    /// The hit that a shader wrote. A status that no shader writes reads as undecided.
    pub fn unpack(self) -> Hit {
        let fallback = self.status & Self::FALLBACK != 0;
        let verdict = match self.status & 0xff {
            0 => return Hit { fallback, ..Hit::MISS },
            1 => Verdict::Hit,
            2 => Verdict::Inside,
            _ => Verdict::Undecided,
        };
        Hit { verdict, fallback, t: self.t, normal: unfold(self.normal) }
    }
}

impl From<Hit> for PackedHit {
    /// As a shader would write it. A miss has no distance.
    fn from(hit: Hit) -> Self {
        let fallback = if hit.fallback { Self::FALLBACK } else { 0 };
        let status = hit.verdict as u32 | fallback;
        if !hit.is_hit() {
            return Self { normal: [0.0; 2], t: 0.0, status };
        }
        Self { normal: fold(hit.normal), t: hit.t, status }
    }
}

/// Octahedral coordinates of a unit vector.
fn fold(normal: Vec3) -> [f32; 2] {
    let n = normal / normal.abs().element_sum().max(f32::MIN_POSITIVE);
    if n.z >= 0.0 {
        [n.x, n.y]
    } else {
        [(1.0 - n.y.abs()).copysign(n.x), (1.0 - n.x.abs()).copysign(n.y)]
    }
}

/// The unit vector at octahedral coordinates.
fn unfold([x, y]: [f32; 2]) -> Vec3 {
    let z = 1.0 - x.abs() - y.abs();
    let (x, y) =
        if z >= 0.0 { (x, y) } else { ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)) };
    Vec3::new(x, y, z).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_the_octahedron() {
        assert_eq!(unfold([0.0, 0.0]), Vec3::Z);
        assert_eq!(unfold([1.0, 0.0]), Vec3::X);
        assert_eq!(unfold([0.0, -1.0]), Vec3::NEG_Y);
        assert_eq!(unfold([1.0, 1.0]), Vec3::NEG_Z);
    }

    /// Folding and unfolding make about six roundings of 6e-8 on coordinates up to 1, which the
    /// normalisation stretches by at most √3.
    #[test]
    fn what_is_packed_unpacks() {
        for normal in [Vec3::new(0.6, -0.48, 0.64), Vec3::new(-0.6, 0.48, -0.64), Vec3::NEG_Z] {
            let hit = Hit { verdict: Verdict::Hit, fallback: true, t: 3.0, normal };
            let back = PackedHit::from(hit).unpack();
            assert!((back.normal - normal).length() < 6e-7);
            assert_eq!(Hit { normal, ..back }, hit);
        }
        assert_eq!(PackedHit::from(Hit::MISS).unpack(), Hit::MISS);
    }

    #[test]
    fn what_is_undecided_is_most_likely_a_hit_where_a_root_was_sought() {
        let hit = Hit { verdict: Verdict::Hit, fallback: false, t: 2.0, normal: Vec3::Y };
        assert_eq!(Hit { verdict: Verdict::Undecided, ..hit }.most_likely(), hit);
        assert_eq!(Hit { verdict: Verdict::Undecided, ..Hit::MISS }.most_likely(), Hit::MISS);
        assert_eq!(hit.most_likely(), hit);
    }

    #[test]
    fn packed_statuses() {
        let packed = |status| PackedHit { normal: [0.0; 2], t: 2.0, status }.unpack();
        assert_eq!(packed(0), Hit::MISS);
        assert_eq!(packed(1).t, 2.0);
        assert_eq!(packed(2).verdict, Verdict::Inside);
        assert!(packed(PackedHit::FALLBACK | 1).fallback);
        assert_eq!(packed(77).verdict, Verdict::Undecided);
    }
}
