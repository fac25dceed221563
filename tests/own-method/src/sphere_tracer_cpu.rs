//! The same on the CPU: rays in, hits out, and no adapter. In f64, with a ray on each thread.

use metaball_core::{Hit, HostError, HostMethod, HostRenderer, Kernel, Ray, Scene, Verdict};
use rayon::prelude::*;

use crate::sphere_tracer::{REACH, TOLERANCE};

const NAME: &str = "sphere-tracer-cpu";

/// The method without a scene.
pub struct SphereTracerCpu;

impl HostMethod for SphereTracerCpu {
    fn name(&self) -> &'static str {
        NAME
    }

    fn build<'s>(&self, scene: &'s Scene) -> Result<Box<dyn HostRenderer + 's>, HostError> {
        if refuses(scene.kernel()).is_some() {
            let reason = format!("needed a power kernel, found {}", scene.kernel());
            return Err(HostError::Unsupported { method: NAME, reason });
        }
        let radii = scene.supports().iter().map(|support| support.radius);
        let reach = REACH * radii.fold(f32::INFINITY, f32::min).min(f32::MAX);
        Ok(Box::new(Built { scene, reach: reach.into() }))
    }
}

/// What is said of a kernel whose steepest slope is not at the ball's centre.
pub fn refuses(kernel: Kernel) -> Option<&'static str> {
    (!matches!(kernel, Kernel::Power(_))).then_some("needed a power kernel")
}

struct Built<'s> {
    scene: &'s Scene,
    /// No step is longer, scene units, except where no ball reaches it.
    reach: f64,
}

impl HostRenderer for Built<'_> {
    fn picture_hits(&self, rays: &[Ray], _width: usize) -> Vec<Hit> {
        rays.par_iter().map(|ray| self.first_hit(ray)).collect()
    }

    fn bytes(&self) -> u64 {
        0
    }
}

impl Built<'_> {
    fn first_hit(&self, ray: &Ray) -> Hit {
        let threshold = f64::from(self.scene.threshold());
        let mut t = 0.0;
        while t <= f64::from(ray.t_max) {
            let (field, slope, gap) = self.field_at(ray, t);
            let below = threshold - field;
            if below <= f64::from(TOLERANCE) * threshold {
                let is_inside = t == 0.0 && below <= 0.0;
                return self.hit(ray, t, if is_inside { Verdict::Inside } else { Verdict::Hit });
            }
            t += if slope > 0.0 { (below / slope).min(self.reach) } else { gap };
        }
        Hit::MISS
    }

    /// The field, a bound of its slope within reach, and the distance to the nearest support that is out of
    /// reach.
    fn field_at(&self, ray: &Ray, t: f64) -> (f64, f64, f64) {
        let kernel = self.scene.kernel();
        let point = ray.origin.as_dvec3() + t * ray.direction.as_dvec3();
        self.scene.balls().fold((0.0, 0.0, f64::MAX), |(field, slope, gap), ball| {
            let (radius, strength) = (f64::from(ball.radius), f64::from(ball.strength));
            let distance = point.distance(ball.center.as_dvec3());
            if distance - radius >= self.reach {
                return (field, slope, gap.min(distance - radius));
            }
            let added = strength * kernel.value((distance / radius).powi(2));
            (field + added, slope - 2.0 * strength * kernel.slope(0.0) / radius, gap)
        })
    }

    fn hit(&self, ray: &Ray, t: f64, verdict: Verdict) -> Hit {
        let kernel = self.scene.kernel();
        let point = ray.origin.as_dvec3() + t * ray.direction.as_dvec3();
        let term = |ball: metaball_core::Metaball| {
            let offset = point - ball.center.as_dvec3();
            let square = f64::from(ball.radius).powi(2);
            let slope = kernel.slope(offset.length_squared() / square);
            -f64::from(ball.strength) * slope / square * offset
        };
        let outward = self.scene.balls().map(term).reduce(|sum, term| sum + term);
        let normal = outward.and_then(|outward| outward.try_normalize());
        let normal = normal.map_or(-ray.direction, |normal| normal.as_vec3());
        Hit { verdict, fallback: false, t: t as f32, normal }
    }
}
