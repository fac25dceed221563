// Takes up the answers to feelers, and sends the next ones.

#import metaball::hit::{MISS, UNDECIDED}
#import metaball::effects::path::{answered_feelers, feeler_hits, path_rays, paths}
#import metaball::effects::scatter::go_on
#import metaball::listed::place_of

@compute @workgroup_size(64)
fn feel(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, index);
    if place >= answered_feelers.count {
        return;
    }
    let pixel = answered_feelers.pixels[place];
    var path = paths[pixel];
    // What is too close to call casts no shadow, and is counted.
    let verdict = feeler_hits[pixel].status & 255u;
    if verdict == MISS || verdict >= UNDECIDED {
        path.radiance += path.pending;
    }
    path.doubts += u32(verdict >= UNDECIDED);
    go_on(&path, pixel, path_rays[pixel].direction);
    paths[pixel] = path;
}
