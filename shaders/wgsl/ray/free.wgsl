// The rays of a batch that have the pass's query, along their list.

#import batch::queried::{free_rays, is_any_hit}
#import core::ray::{Ray, NO_PIXEL}
#import core::ray_list::{index_in_list, Listed}

@group(0) @binding(6) var<storage, read> listed: Listed;

fn pixel_of(group: vec3<u32>, index: u32) -> u32 {
    let at = index_in_list(group, index);
    if at >= listed.count {
        return NO_PIXEL;
    }
    return listed.pixels[at];
}

fn ray_of(pixel: u32) -> Ray {
    let ray = free_rays[pixel];
    return Ray(ray.origin, ray.t_max, ray.direction);
}

fn any_hit_suffices() -> bool {
    return is_any_hit();
}

fn needs_clearance() -> bool {
    return !is_any_hit();
}
