// Takes up the answers to feelers, and sends the next ones.

#import metaball::hit::{MISS, UNDECIDED}
#import metaball::free_ray::NOTHING
#import metaball::effects::path::{feeler_hits, feelers, path_rays, paths, FEELING}
#import metaball::effects::scatter::go_on
#import metaball::view::{in_picture, pixel_at}

@compute @workgroup_size(8, 8)
fn feel(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    var path = paths[pixel];
    if path.stage != FEELING {
        return;
    }
    if feelers[pixel].question != NOTHING {
        // What is too close to call casts no shadow, and is counted.
        let verdict = feeler_hits[pixel].status & 255u;
        if verdict == MISS || verdict >= UNDECIDED {
            path.radiance += path.pending;
        }
        path.doubts += u32(verdict >= UNDECIDED);
    }
    go_on(&path, pixel, path_rays[pixel].direction);
    paths[pixel] = path;
}
