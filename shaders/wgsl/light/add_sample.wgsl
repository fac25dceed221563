// Adds a complete sample to the film, of the paths whose rays have all been decided.

#import core::view::{in_picture, pixel_at}
#import light::path::{film, paths}

@compute @workgroup_size(8, 8)
fn add_sample(@builtin(global_invocation_id) id: vec3<u32>) {
    if in_picture(id.xy) {
        let pixel = pixel_at(id.xy);
        if paths[pixel].undecided == 0u {
            film[pixel] += vec4(paths[pixel].radiance, 1.0);
        }
    }
}
