// Normals as colours: red to the right, green upwards, blue towards the eye; black for none.

#import core::hit::{hits, unfold, HIT, INSIDE}
#import core::view::{view, in_picture, pixel_at}
#import shade::picture::put_encoded

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    let hit = hits[pixel];
    let verdict = hit.status & 255u;
    if verdict != HIT && verdict != INSIDE {
        put_encoded(pixel, vec3<f32>());
        return;
    }
    let normal = unfold(hit.normal);
    let seen = vec3(dot(normal, view.right), dot(normal, view.up), -dot(normal, view.forward));
    put_encoded(pixel, 0.5 + 0.5 * seen);
}
