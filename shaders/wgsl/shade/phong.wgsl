// The lit surface.

#import core::hit::{hits, unfold, HIT, INSIDE, MISS}
#import core::view::{rays, in_picture, pixel_at}
#import shade::base::base_color
#import shade::light::{phong, from_within, background, ALARM}
#import shade::picture::put_light

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    let hit = hits[pixel];
    switch hit.status & 255u {
        case MISS: {
            put_light(pixel, background(invocation.y));
        }
        case HIT: {
            put_light(pixel, phong(base_color(pixel), unfold(hit.normal), -rays[pixel].direction));
        }
        case INSIDE: {
            put_light(pixel, from_within(base_color(pixel)));
        }
        default: {
            put_light(pixel, ALARM);
        }
    }
}
