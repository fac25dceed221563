// Light of lamps, along shadow rays where they cast shadows.

#import core::view::NO_LIMIT
#import light::mirror::own_share
#import light::path::{lamps, settings, Path}
#import light::phong::reflected
#import light::sampling::{around, on_disc, point_in_square}
#import light::secondary::{purpose, send, FOR_LAMP}

// Adds the light of all lamps, without shadows.
fn add_unshadowed(path: ptr<function, Path>, direction: vec3<f32>) {
    let share = own_share(*path, direction);
    for (var lamp = 0u; lamp < settings.lamps; lamp++) {
        (*path).radiance += share * reflected(*path, direction, lamp, lamps[lamp].toward);
    }
}

// Sends a ray towards a point of a lamp. False, and no ray, where the surface faces away.
fn send_shadow_ray(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, lamp: u32) -> bool {
    let number = settings.sample * settings.lamps + lamp;
    let disc = lamps[lamp].size * on_disc(point_in_square(pixel, purpose(*path, FOR_LAMP), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around(lamps[lamp].toward, vec3(disc, height));
    let light = own_share(*path, direction) * reflected(*path, direction, lamp, toward);
    return send(path, pixel, toward, NO_LIMIT, light);
}
