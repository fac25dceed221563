// The rays of a view: all start at the eye, all look for the first hit, and no others follow.

#import core::ray::{Ray, NO_PIXEL}
#import core::view::{in_blocks, in_picture, pixel_at, rays, view}

fn pixel_of(group: vec3<u32>, index: u32) -> u32 {
    let position = 8u * group.xy + in_blocks(index);
    return select(NO_PIXEL, pixel_at(position), in_picture(position));
}

fn ray_of(pixel: u32) -> Ray {
    let ray = rays[pixel];
    return Ray(view.eye, ray.t_max, ray.direction);
}

fn any_hit_suffices() -> bool {
    return false;
}

fn needs_clearance() -> bool {
    return false;
}
