// Adds the sample that is complete to the film.

#import metaball::effects::path::{film, paths}
#import metaball::view::{in_picture, pixel_at}

@compute @workgroup_size(8, 8)
fn add_sample(@builtin(global_invocation_id) id: vec3<u32>) {
    if in_picture(id.xy) {
        let pixel = pixel_at(id.xy);
        film[pixel] += vec4(paths[pixel].radiance, 1.0);
    }
}
