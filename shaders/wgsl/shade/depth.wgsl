// Distances as grey: white at the near end of the scale, dark at the far end, black for none.

#import core::hit::{hits, HIT, INSIDE}
#import core::view::{in_picture, pixel_at}
#import shade::picture::{put_encoded, on_scale}

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    let hit = hits[pixel];
    let verdict = hit.status & 255u;
    let is_surface = verdict == HIT || verdict == INSIDE;
    put_encoded(pixel, vec3(select(0.0, 1.0 - 0.85 * on_scale(hit.t), is_surface)));
}
