// Begins a sample of the picture: one path a pixel, from the eye through a point of the pixel.

#import batch::free_ray::{FreeRay, FIRST_HIT, no_ray}
#import core::make_ray::direction_through
#import core::view::{in_picture, pixel_at, view, NO_LIMIT}
#import light::path::{path_rays, paths, settings, shadow_rays, Path, OUTSIDE}
#import light::sampling::point_in_square

@compute @workgroup_size(8, 8)
fn start_paths(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    var path = Path();
    path.stage = OUTSIDE;
    path.throughput = vec3(1.0);
    paths[pixel] = path;
    path_rays[pixel] = FreeRay(view.eye, NO_LIMIT, direction(id.xy, pixel), FIRST_HIT);
    shadow_rays[pixel] = no_ray();
}

// Through the pixel's middle when there is one sample; else through points weighted by a tent of two
// pixels' width, which smooths edges without blurring them.
fn direction(position: vec2<u32>, pixel: u32) -> vec3<f32> {
    let middle = direction_through(position);
    if settings.samples == 1u {
        return middle;
    }
    let square = point_in_square(pixel, 0u, settings.sample);
    let moved = 2.0 * view.half_pixel * vec2(tent(square.x), tent(square.y));
    // The picture lies at unit distance along `forward`.
    let toward = middle / dot(middle, view.forward) + moved.x * view.right + moved.y * view.up;
    return toward / sqrt(dot(toward, toward));
}

// From a uniform number to one in [-1, 1] with the density of a tent.
fn tent(uniform_number: f32) -> f32 {
    let x = 2.0 * uniform_number - 1.0;
    return select(-1.0, 1.0, x >= 0.0) * (1.0 - sqrt(1.0 - abs(x)));
}
