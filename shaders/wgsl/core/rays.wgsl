// The first pass of every frame: the primary rays, and hits that are yet to be found.

#import core::hit::write_nothing
#import core::make_ray::direction_through
#import core::view::{in_picture, pixel_at, PrimaryRay}
#import opaque::opaque_distance

// The buffer that methods read as core::view::rays.
@group(0) @binding(1) var<storage, read_write> made_rays: array<PrimaryRay>;

@compute @workgroup_size(8, 8)
fn make_rays(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    made_rays[pixel] = PrimaryRay(direction_through(invocation.xy), opaque_distance(pixel));
    write_nothing(pixel);
}
