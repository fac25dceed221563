// The surface's own colour, unlit.

#import core::hit::{hits, HIT, INSIDE, MISS}
#import core::view::{in_picture, pixel_at}
#import shade::base::base_color
#import shade::light::{background, ALARM}
#import shade::picture::put_light

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    switch hits[pixel].status & 255u {
        case MISS: {
            put_light(pixel, background(invocation.y));
        }
        case HIT, INSIDE: {
            put_light(pixel, base_color(pixel));
        }
        default: {
            put_light(pixel, ALARM);
        }
    }
}
