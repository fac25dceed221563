// A clear fluid, which reflects and refracts.

#import batch::free_ray::{FreeRay, ANSWERED, EXIT, FIRST_HIT}
#import core::view::NO_LIMIT
#import light::floor::beyond
#import light::path::{path_rays, settings, Path, OUTSIDE, WITHIN}
#import light::sampling::point_in_square
#import light::secondary::{purpose, start, FOR_CHOICE}

// Whether the surface is the clear fluid's.
fn is_clear(path: Path) -> bool {
    return settings.refraction > 0.0 && path.on_floor == 0u;
}

// A clear fluid reflects or refracts, by Fresnel's equations: one of the two at random, with its share of
// the light as probability.
fn pass_through(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    // The normal on the side that the ray comes from.
    let leaves = (*path).stage == WITHIN;
    let facing = select((*path).normal, -(*path).normal, leaves);
    let ratio = select(1.0 / settings.refraction, settings.refraction, leaves);
    let cosine = clamp(-dot(direction, facing), 0.0, 1.0);
    let sine_squared = ratio * ratio * (1.0 - cosine * cosine);
    var mirrored = 1.0;
    if sine_squared < 1.0 {
        let onward_cosine = sqrt(1.0 - sine_squared);
        let across = (ratio * cosine - onward_cosine) / (ratio * cosine + onward_cosine);
        let along = (cosine - ratio * onward_cosine) / (cosine + ratio * onward_cosine);
        mirrored = 0.5 * (across * across + along * along);
    }
    let choice = point_in_square(pixel, purpose(*path, FOR_CHOICE), settings.sample).x;
    let is_mirrored = choice < mirrored;
    let onward = select(refract(direction, facing, ratio), reflect(direction, facing), is_mirrored);
    let toward = normalize(onward);
    if (*path).bounces >= settings.bounces {
        // Beyond the last surface there are only the surroundings.
        (*path).radiance += (*path).throughput * beyond((*path).position, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    let is_within = leaves == is_mirrored;
    (*path).stage = select(OUTSIDE, WITHIN, is_within);
    let query = select(FIRST_HIT, EXIT, is_within);
    path_rays[pixel] = FreeRay(start(*path, select(1.0, -1.0, is_within)), NO_LIMIT, toward, query);
}
