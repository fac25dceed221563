// A mirror: the share of light that it reflects, and the path that continues along the reflection.

#import batch::free_ray::{FreeRay, ANSWERED, FIRST_HIT}
#import core::view::NO_LIMIT
#import light::floor::beyond
#import light::path::{path_rays, settings, Path, OUTSIDE}
#import light::secondary::start

// The share of light that is mirrored: Schlick's approximation of Fresnel's equations (1994). None by the
// floor, and none inside the solid.
fn mirror_share(path: Path, direction: vec3<f32>) -> f32 {
    let cosine = -dot(direction, path.normal);
    if path.on_floor == 1u || settings.reflectivity == 0.0 || cosine <= 0.0 {
        return 0.0;
    }
    return mix(pow(1.0 - min(cosine, 1.0), 5.0), 1.0, settings.reflectivity);
}

// The share that the surface itself scatters to the eye.
fn own_share(path: Path, direction: vec3<f32>) -> vec3<f32> {
    return path.throughput * (1.0 - mirror_share(path, direction));
}

// Continues the path along the reflection, or ends it.
fn mirror(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    let share = mirror_share(*path, direction);
    let toward = normalize(reflect(direction, (*path).normal));
    (*path).throughput *= share;
    if share == 0.0 || (*path).bounces >= settings.bounces {
        // The last surface of a path mirrors the surroundings alone.
        (*path).radiance += (*path).throughput * beyond((*path).position, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    (*path).stage = OUTSIDE;
    path_rays[pixel] = FreeRay(start(*path, 1.0), NO_LIMIT, toward, FIRST_HIT);
}
