// A ray with a start and a query of its own: 32 bytes.

// Twin of `FreeRay` in metaball-core. The points `origin + t * direction`, 0 <= t <= t_max; the
// direction is unit to rounding.
struct FreeRay {
    // World space, scene units.
    origin: vec3<f32>,
    t_max: f32,
    direction: vec3<f32>,
    // One of the queries below, plus ANSWERED.
    query: u32,
}

// The values of `RayQuery` in metaball-core; a ray without a query is not traced.
const NOTHING: u32 = 0u;
const FIRST_HIT: u32 = 1u;
const ANY_HIT: u32 = 2u;
const EXIT: u32 = 3u;
// Added to a query once its answer has been read: the ray is not traced again.
const ANSWERED: u32 = 256u;

fn no_ray() -> FreeRay {
    return FreeRay(vec3<f32>(), 0.0, vec3<f32>(), NOTHING);
}
