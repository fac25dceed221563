// A view without a solid scene: nothing ends a ray.

#import core::view::NO_LIMIT

fn opaque_distance(pixel: u32) -> f32 {
    return NO_LIMIT;
}
