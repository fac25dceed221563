// Takes the answers to shadow and occlusion rays, and sends the next ones.

#import core::hit::{MISS, UNDECIDED}
#import core::ray_list::index_in_list
#import light::path::{answered_shadow_rays, path_rays, paths, shadow_hits}
#import light::scatter::continue_path

@compute @workgroup_size(64)
fn resolve_shadow_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let listed = index_in_list(group, index);
    if listed >= answered_shadow_rays.count {
        return;
    }
    let pixel = answered_shadow_rays.pixels[listed];
    var path = paths[pixel];
    // What is undecided casts no shadow, and is counted.
    let verdict = shadow_hits[pixel].status & 255u;
    if verdict == MISS || verdict >= UNDECIDED {
        path.radiance += path.pending;
    }
    path.undecided += u32(verdict >= UNDECIDED);
    continue_path(&path, pixel, path_rays[pixel].direction);
    paths[pixel] = path;
}
