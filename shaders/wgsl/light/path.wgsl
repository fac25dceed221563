// What the passes of the crate metaball-light share: settings, lamps, and one path of light a pixel,
// followed backwards from the eye.

#import batch::free_ray::FreeRay
#import core::hit::Hit
#import core::ray_list::Listed

// Twin of `twins::Settings` in metaball-light.
struct Settings {
    // exp(-absorption * length) passes through the fluid; 1/scene unit, linear red, green and blue.
    absorption: vec3<f32>,
    // Index of refraction; 0 for an opaque surface.
    refraction: f32,
    // Share of light that is mirrored at normal incidence; 0 for none.
    reflectivity: f32,
    // Surfaces after the first that a path may meet.
    bounces: u32,
    // Whether lamps cast shadows.
    shadows: u32,
    // Occlusion rays of a surface point.
    occlusion_rays: u32,
    // Where occlusion rays end, scene units.
    occlusion_reach: f32,
    lamps: u32,
    // Index of this sample of the picture, and how many there will be.
    sample: u32,
    samples: u32,
    seed: u32,
    // Bands of cel shading; 0 for smooth shading.
    bands: u32,
    // Columns and rows of the environment's image.
    columns: u32,
    rows: u32,
    // The point of the floor below the scene, world space, and the distance around it at which 1/e of the
    // floor is left, scene units; 0 for no floor.
    floor_middle: vec3<f32>,
    floor_reach: f32,
    // Its colour, linear, and the side of its tiles, scene units; 0 for none.
    floor_color: vec3<f32>,
    tile: f32,
}

// Twin of `twins::Lamp` in metaball-light: far away, seen from everywhere in the same direction.
struct Lamp {
    // Unit vector towards its middle, world space.
    toward: vec3<f32>,
    // Sine of the angle between its middle and its rim; 0 casts hard shadows.
    size: f32,
    // Linear light.
    color: vec3<f32>,
    padding: u32,
}

// Twin of `twins::Path` in metaball-light.
struct Path {
    // Light that has reached the eye so far.
    radiance: vec3<f32>,
    // One of the stages below.
    stage: u32,
    // Share of what is found from here on that reaches the eye.
    throughput: vec3<f32>,
    // Shadow and occlusion rays of this surface point so far.
    rays_sent: u32,
    // The surface point, world space.
    position: vec3<f32>,
    // How far from it along the normal a start is certainly on its side of the surface, scene units.
    clearance: f32,
    // Unit, out of the solid.
    normal: vec3<f32>,
    // Surfaces met before this one.
    bounces: u32,
    // Light that reaches the eye if the shadow or occlusion ray on its way hits nothing.
    pending: vec3<f32>,
    // 1 where the surface is the floor, which is matt and opaque.
    on_floor: u32,
    // The surface's own colour, linear.
    base: vec3<f32>,
    // Rays of this path that the method left undecided.
    undecided: u32,
}

// The path's ray runs outside of the solid, or inside. A path is complete when neither its own ray nor its
// shadow ray has a query.
const OUTSIDE: u32 = 1u;
const WITHIN: u32 = 2u;

// The path's own rays.
@group(0) @binding(1) var<storage, read_write> path_rays: array<FreeRay>;
// The pixels whose rays have just been answered.
@group(0) @binding(6) var<storage, read> answered: Listed;
// Shadow and occlusion rays, one a pixel at a time, with their answers, and the pixels whose rays have just
// been answered.
@group(1) @binding(0) var<storage, read_write> shadow_rays: array<FreeRay>;
@group(1) @binding(1) var<storage, read_write> shadow_hits: array<Hit>;
@group(1) @binding(2) var<storage, read> answered_shadow_rays: Listed;
@group(2) @binding(0) var<uniform> settings: Settings;
@group(2) @binding(1) var<storage, read> lamps: array<Lamp>;
@group(2) @binding(2) var<storage, read_write> paths: array<Path>;
// Sums over samples: linear light, and their number.
@group(2) @binding(3) var<storage, read_write> film: array<vec4<f32>>;
