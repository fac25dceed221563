// The rays of a view, as a method that follows any ray sees them: all start at the eye, all ask for
// the first hit.

#import core::view::{in_blocks, in_picture, pixel_at, rays, view}

// The points `origin + t * direction`, 0 <= t <= t_max.
struct Ray {
    origin: vec3<f32>,
    t_max: f32,
    direction: vec3<f32>,
}

// No pixel.
const NOBODY: u32 = 0xffffffffu;

// The pixel whose ray an invocation answers, or NOBODY.
fn pixel_of(group: vec3<u32>, index: u32) -> u32 {
    let at = 8u * group.xy + in_blocks(index);
    return select(NOBODY, pixel_at(at), in_picture(at));
}

fn ray_of(pixel: u32) -> Ray {
    let ray = rays[pixel];
    return Ray(view.eye, ray.t_max, ray.direction);
}

// Whether anything solid on the ray answers it, first or not.
fn any_will_do() -> bool {
    return false;
}

// Whether rays go on from the hit, so that it must say how far the surface can be.
fn goes_on() -> bool {
    return false;
}
