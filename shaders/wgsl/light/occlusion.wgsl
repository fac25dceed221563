// Light of the surroundings, along occlusion rays where it is occluded.

#import light::environment::ambient
#import light::floor::beyond
#import light::mirror::own_share
#import light::path::{settings, Path}
#import light::phong::shaded
#import light::sampling::{around, on_disc, point_in_square}
#import light::secondary::{purpose, send, FOR_SKY}

// Adds the surroundings' mean, as if nothing occluded them.
fn add_unoccluded(path: ptr<function, Path>, direction: vec3<f32>) {
    let light = shaded(ambient((*path).normal));
    (*path).radiance += own_share(*path, direction) * (*path).base * light;
}

// Sends one of the surface's occlusion rays, distributed by Lambert's cosine. False, and no ray, where it
// does not leave the surface.
fn send_occlusion_ray(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, ray: u32) -> bool {
    let number = settings.sample * settings.occlusion_rays + ray;
    let disc = on_disc(point_in_square(pixel, purpose(*path, FOR_SKY), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around((*path).normal, vec3(disc, height));
    let light = own_share(*path, direction) * (*path).base * beyond((*path).position, toward)
        / f32(settings.occlusion_rays);
    return send(path, pixel, toward, settings.occlusion_reach, light);
}
