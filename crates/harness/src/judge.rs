//! Holds a picture against the truth, ray by ray, to exactly what the method's paper promises.
//!
//! [`score`](crate::score) measures how far off a method is; here it is decided whether it may be.

pub mod points;
pub mod promise;
pub mod stand_in;

use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Hit, Ray, Scene, Verdict};

use self::promise::Promise;
use self::stand_in::StandIn;
use crate::fronts::WRONG_FRONT;
use crate::score::Judgement;

/// What a method is held to.
#[derive(Debug, Clone, Copy)]
pub struct Terms {
    /// Where it must be right.
    pub promise: Promise,
    /// Where its root finder may stop.
    pub stop: Stop,
}

/// How near a root a root finder stops, rounding aside.
#[derive(Debug, Clone, Copy)]
pub enum Stop {
    /// |F − T|/T.
    Residual(f64),
    /// |t − t*| over the smallest support radius at the hit.
    Distance(f64),
    /// At the root, as far as f32 tells: off by what rounding does to the field once more, where t is
    /// stored after the search.
    Rounding,
}

impl Terms {
    /// The |Δt|/R that 99 of 100 hits keep within: the reach of a default root finder, or where a
    /// cubic stands for the field, that of a wrong front.
    pub fn tolerance(&self) -> f64 {
        match self.promise {
            Promise::Fragments { piece, .. } if !piece.is_exact() => WRONG_FRONT,
            _ => 1e-3,
        }
    }
}

/// What became of a ray about which nothing is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ruling {
    /// Too close to call for the oracle.
    Ambiguous,
    /// Late, missed or replaced, where the method promises nothing.
    Excused,
    /// Nothing is there, and nothing was found.
    Empty,
    /// A hit, right in distance and normal.
    Measured,
}

/// What was found; a picture is right when there are no violations.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Findings {
    /// What must not be, in words, with the pixel: at most one a pixel.
    pub violations: Vec<String>,
    /// Late, missed or replaced hits at rays for which the method promises nothing.
    pub excused: usize,
    /// Rays too close to call for the oracle.
    pub ambiguous: usize,
    /// Rays that both hit, held to distance and normal.
    pub measured: usize,
}

/// Rays of a view with the truth about each.
pub struct Judge<'a> {
    scene: &'a Scene,
    oracle: &'a Oracle<'a>,
    rays: &'a [Ray],
    truths: Vec<Truth>,
}

impl<'a> Judge<'a> {
    /// With the oracle's truth about each ray.
    pub fn new(scene: &'a Scene, oracle: &'a Oracle<'a>, rays: &'a [Ray]) -> Self {
        Self { scene, oracle, rays, truths: oracle.first_hits(rays) }
    }

    /// The rays, row by row from the top left.
    pub fn rays(&self) -> &[Ray] {
        self.rays
    }

    /// The truth about each ray.
    pub fn truths(&self) -> &[Truth] {
        &self.truths
    }

    /// Judges a picture.
    pub fn judge(&self, hits: &[Hit], terms: &Terms) -> Findings {
        let mut findings = Findings::default();
        if hits.len() != self.rays.len() {
            let (needed, found) = (self.rays.len(), hits.len());
            findings.violations.push(format!("needed {needed} hits, found {found}"));
            return findings;
        }
        for (pixel, hit) in hits.iter().enumerate() {
            match self.rule(pixel, hit, terms) {
                Ok(Ruling::Ambiguous) => findings.ambiguous += 1,
                Ok(Ruling::Excused) => findings.excused += 1,
                Ok(Ruling::Measured) => findings.measured += 1,
                Ok(Ruling::Empty) => {}
                Err(violation) => findings.violations.push(format!("pixel {pixel}: {violation}")),
            }
        }
        findings
    }

    /// Holds two pictures against each other, without asking the truth what is drawn: wherever both
    /// methods promise an answer, they must give the same, on the same front.
    pub fn compare(
        &self,
        (ours, our_promise): (&[Hit], Promise),
        (theirs, their_promise): (&[Hit], Promise),
    ) -> Findings {
        let mut findings = Findings::default();
        if ours.len() != theirs.len() || ours.len() != self.rays.len() {
            let (needed, found) = (self.rays.len(), (ours.len(), theirs.len()));
            findings.violations.push(format!("needed {needed} hits each, found {found:?}"));
            return findings;
        }
        for (pixel, (our, their)) in ours.iter().zip(theirs).enumerate() {
            let (ray, truth) = (&self.rays[pixel], &self.truths[pixel]);
            let is_promised = |promise: Promise, hit: &Hit| {
                let is_clear =
                    truth.verdict == Verdict::Miss && promise.stand_in(self.scene, ray).is_none();
                (is_clear || promise.holds(self.scene, ray, truth)) && !hit.fallback
            };
            if truth.is_ambiguous() {
                findings.ambiguous += 1;
            } else if !is_promised(our_promise, our) || !is_promised(their_promise, their) {
                findings.excused += 1;
            } else {
                findings.measured += usize::from(our.is_hit());
                // A miss has t = ∞, and ∞ − ∞ is no distance at all. Where a field stands in for the
                // scene's, its root is elsewhere: that it is on the same front is tested with the
                // oracle.
                let is_root_of = |promise: Promise| promise.stand_in(self.scene, ray).is_none();
                let distance = f64::from(our.t) - f64::from(their.t);
                let is_apart = our.is_hit()
                    && is_root_of(our_promise)
                    && is_root_of(their_promise)
                    && distance.abs() > WRONG_FRONT * f64::from(truth.smallest_radius);
                if our.is_hit() != their.is_hit() || is_apart {
                    findings.violations.push(format!("pixel {pixel}: {our:?} against {their:?}"));
                }
            }
        }
        findings
    }

    /// Judges what was found along one of the rays.
    ///
    /// # Errors
    /// What must not be, in words.
    pub fn rule(&self, ray: usize, hit: &Hit, terms: &Terms) -> Result<Ruling, String> {
        let (ray, truth) = (&self.rays[ray], &self.truths[ray]);
        if truth.is_ambiguous() {
            return Ok(Ruling::Ambiguous);
        }
        if hit.fallback && terms.promise.allows_fallback(self.scene, ray, truth) {
            return Ok(Ruling::Excused);
        }
        if hit.verdict == Verdict::Undecided || hit.fallback {
            return Err(format!(
                "needed an answer of the method's own to {truth:?}, found {hit:?}"
            ));
        }
        if let Some(field) = terms.promise.stand_in(self.scene, ray) {
            return self.rule_on_stand_in(ray, (truth, hit), terms, &field);
        }
        let found = if Judgement::new(truth, hit).is_wrong() {
            Err(format!("needed {truth:?}, found {hit:?}"))
        } else if hit.is_hit() {
            self.measure(ray, truth, hit, terms).map(|()| Ruling::Measured)
        } else {
            Ok(Ruling::Empty)
        };
        // A method that promises nothing for a ray may be late or miss; it may never see a surface
        // before the first, or where there is none.
        let is_late = truth.verdict != Verdict::Miss && f64::from(hit.t) > truth.t;
        if found.is_err() && is_late && !terms.promise.holds(self.scene, ray, truth) {
            return Ok(Ruling::Excused);
        }
        found
    }

    /// Judges a root of a field that is not the scene's.
    fn rule_on_stand_in(
        &self,
        ray: &Ray,
        (truth, hit): (&Truth, &Hit),
        terms: &Terms,
        stand_in: &StandIn,
    ) -> Result<Ruling, String> {
        let is_there = truth.verdict != Verdict::Miss;
        let t = f64::from(hit.t);
        if stand_in.keeps(truth, self.scene.threshold()) {
            // Two roundings of t, and one of the point where the truth leaves the solid.
            let is_later = hit.is_hit() && t > truth.exit * (1.0 + 4.0 * f64::from(f32::EPSILON));
            if hit.is_hit() != is_there || is_later {
                return Err(format!("needed {truth:?}, found {hit:?}"));
            }
        }
        if !hit.is_hit() {
            return Ok(if is_there { Ruling::Excused } else { Ruling::Empty });
        }
        let rounding = Rounding::at(self.scene, ray, t);
        let point = ray.origin.as_dvec3() + t * ray.direction.as_dvec3();
        let threshold = f64::from(self.scene.threshold());
        let residual = self.oracle.field(point) - threshold;
        let slack = rounding.of_field
            + match terms.stop {
                Stop::Residual(residual) => residual * threshold,
                Stop::Rounding => rounding.of_field,
                Stop::Distance(distance) => {
                    distance * f64::from(truth.smallest_radius) * rounding.slope
                }
            };
        let (least, greatest) = stand_in.at(t);
        // A start inside has any field from T up.
        if residual < least - slack || (t > 0.0 && residual > greatest + slack) {
            return Err(format!(
                "F - T = {residual:.3e}, needed from {least:.3e} to {greatest:.3e}, found {hit:?}"
            ));
        }
        self.check_normal(ray, truth, hit, &rounding)?;
        Ok(Ruling::Measured)
    }

    /// Holds a hit to the field at its own point, which is well conditioned where distance is not.
    fn measure(&self, ray: &Ray, truth: &Truth, hit: &Hit, terms: &Terms) -> Result<(), String> {
        let point = ray.origin.as_dvec3() + f64::from(hit.t) * ray.direction.as_dvec3();
        let threshold = f64::from(self.scene.threshold());
        let rounding = Rounding::at(self.scene, ray, f64::from(hit.t));

        let residual = self.oracle.field(point) - threshold;
        let distance = (f64::from(hit.t) - truth.t).abs() / f64::from(truth.smallest_radius);
        let allowed = rounding.of_field
            + match terms.stop {
                Stop::Residual(residual) => residual * threshold,
                Stop::Rounding => rounding.of_field,
                Stop::Distance(allowed) if distance <= allowed => f64::INFINITY,
                Stop::Distance(_) => 0.0,
            };
        // A start inside has any field from T up.
        if truth.verdict != Verdict::Inside && residual.abs() > allowed {
            return Err(format!("|F - T| = {:.3e}, needed at most {allowed:.3e}", residual.abs()));
        }

        self.check_normal(ray, truth, hit, &rounding)
    }

    fn check_normal(
        &self,
        ray: &Ray,
        truth: &Truth,
        hit: &Hit,
        rounding: &Rounding,
    ) -> Result<(), String> {
        // A start inside is no surface point: any normal will do.
        let point = ray.origin.as_dvec3() + f64::from(hit.t) * ray.direction.as_dvec3();
        let exact = self.oracle.normal(point);
        if truth.verdict != Verdict::Inside && rounding.of_normal < 1.0 {
            let normal = hit.normal.as_dvec3();
            let angle = normal.cross(exact).length().atan2(normal.dot(exact));
            let allowed = rounding.of_normal.asin() + 1e-6;
            if angle.is_nan() || angle > allowed {
                return Err(format!("normal off by {angle:.3e}, needed at most {allowed:.3e}"));
            }
        }
        Ok(())
    }
}

/// What f32 can do at a point of a ray.
///
/// A ball's offset is (eye − p) + t·d, wrong by at most u(|eye − p| + t + |offset|) with u = 2⁻²³
/// (WGSL may round either way) for the difference, the product and the sum; call it e. Then
/// v = 1 − |offset|²/R² is wrong by 2e/R + 6u inside the support: three squares and two sums, a
/// square, a division and the last difference. The field follows with q·k′; the sum of n terms adds
/// n·u·Σ|q|k. The gradient's term −2q·k′·offset/R² is wrong by as much as its own size times
/// (k″/k′)·δv + e/R + 5u, and k″δv is at most 56δv for the steepest kernel (α = 8).
struct Rounding {
    of_field: f64,
    /// The field is nowhere steeper at the point, 1/scene unit.
    slope: f64,
    /// Sine of the angle between the gradient and its f32 value; 1 or more: any normal is right.
    of_normal: f64,
}

impl Rounding {
    fn at(scene: &Scene, ray: &Ray, t: f64) -> Self {
        let unit = f64::from(f32::EPSILON);
        let kernel = scene.kernel();
        let (mut of_field, mut steepest, mut sizes, mut count) = (0.0, 0.0, 0.0, 0.0);
        let (mut gradient, mut of_gradient) = (glam::DVec3::ZERO, 0.0);
        for ball in scene.balls() {
            let from_center = ray.origin.as_dvec3() - ball.center.as_dvec3();
            let offset = from_center + t * ray.direction.as_dvec3();
            let (radius, strength) = (f64::from(ball.radius), f64::from(ball.strength));
            let squared_ratio = offset.length_squared() / (radius * radius);
            let of_offset = unit * (from_center.length() + t + offset.length());
            let of_v = 2.0 * of_offset / radius + 6.0 * unit;
            // A ball just outside may seem just inside.
            if squared_ratio >= 1.0 + of_v {
                continue;
            }
            let slope = kernel.slope(squared_ratio).abs();
            count += 1.0;
            let size = strength.abs();
            sizes += size * kernel.value(squared_ratio);
            steepest += 2.0 * size * slope / radius;
            of_field += size * (slope * of_v + 28.0 * of_v * of_v);
            gradient += 2.0 * strength * slope / (radius * radius) * offset;
            of_gradient += 2.0 * size / radius
                * (56.0 * of_v + slope * (of_offset / radius + (5.0 + count) * unit));
        }
        let of_normal = if gradient.length() > 0.0 { of_gradient / gradient.length() } else { 1.0 };
        Self { of_field: of_field + count * unit * sizes, slope: steepest, of_normal }
    }
}
