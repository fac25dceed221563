// A ray with any start, for methods that trace more than primary rays.

// The points `origin + t * direction`, 0 <= t <= t_max. The direction is unit to rounding.
struct Ray {
    // World space, scene units.
    origin: vec3<f32>,
    t_max: f32,
    direction: vec3<f32>,
}

// Instead of a pixel's index, for an invocation without a ray.
const NO_PIXEL: u32 = 0xffffffffu;
