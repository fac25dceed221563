// What a surface does with light: it is lit along shadow and occlusion rays and mirrors, or it is a clear
// fluid.

#import batch::free_ray::ANSWERED
#import light::fluid::{is_clear, pass_through}
#import light::lamps::{add_unshadowed, send_shadow_ray}
#import light::mirror::mirror
#import light::occlusion::{add_unoccluded, send_occlusion_ray}
#import light::path::{settings, shadow_rays, Path}

// Adds the light that needs no ray.
fn light_without_rays(path: ptr<function, Path>, direction: vec3<f32>) {
    if is_clear(*path) {
        return;
    }
    if settings.occlusion_rays == 0u {
        add_unoccluded(path, direction);
    }
    if settings.shadows == 0u {
        add_unshadowed(path, direction);
    }
}

// Sends the surface point's next shadow or occlusion ray; after the last, the path's next ray.
fn continue_path(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    if is_clear(*path) {
        pass_through(path, pixel, direction);
        return;
    }
    let to_lamps = settings.lamps * settings.shadows;
    while (*path).rays_sent < to_lamps + settings.occlusion_rays {
        let number = (*path).rays_sent;
        (*path).rays_sent = number + 1u;
        var is_sent: bool;
        if number < to_lamps {
            is_sent = send_shadow_ray(path, pixel, direction, number);
        } else {
            is_sent = send_occlusion_ray(path, pixel, direction, number - to_lamps);
        }
        if is_sent {
            return;
        }
    }
    shadow_rays[pixel].query |= ANSWERED;
    mirror(path, pixel, direction);
}
