// Rays of a batch, each with a start of its own. A pass answers those that ask its question, along their
// list.

#import batch::free_ray::{FreeRay, ANY_HIT}
#import batch::list::{place_of, Listed}

// The points `origin + t * direction`, 0 <= t <= t_max.
struct Ray {
    origin: vec3<f32>,
    t_max: f32,
    direction: vec3<f32>,
}

// The question that this pass answers. Id 2 of the ids that metaball-core sets.
@id(2) override question: u32 = 1u;

// One ray a pixel, row by row from the top left.
@group(0) @binding(1) var<storage, read> free_rays: array<FreeRay>;

@group(0) @binding(6) var<storage, read> listed: Listed;

// No pixel.
const NOBODY: u32 = 0xffffffffu;

// The pixel whose ray an invocation answers, or NOBODY.
fn pixel_of(group: vec3<u32>, index: u32) -> u32 {
    let place = place_of(group, index);
    if place >= listed.count {
        return NOBODY;
    }
    return listed.pixels[place];
}

fn ray_of(pixel: u32) -> Ray {
    let ray = free_rays[pixel];
    return Ray(ray.origin, ray.t_max, ray.direction);
}

// Whether anything solid on the ray answers it, first or not.
fn any_will_do() -> bool {
    return question == ANY_HIT;
}

// Whether rays go on from the hit, so that it must say how far the surface can be.
fn goes_on() -> bool {
    return question != ANY_HIT;
}
