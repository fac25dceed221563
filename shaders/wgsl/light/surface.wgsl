// Takes up the answers to the paths' own rays: light of the surroundings where they leave, and a surface
// where they hit.

#import metaball::base::base_color
#import metaball::free_ray::ANSWERED
#import metaball::hit::{clearance_of, hits, unfold, HIT, INSIDE, MISS}
#import metaball::effects::environment::environment
#import metaball::effects::path::{path_rays, paths, settings, Path, GONE, OUTSIDE, WITHIN}
#import metaball::effects::scatter::{go_on, light_directly}
#import metaball::view::{in_picture, pixel_at}

@compute @workgroup_size(8, 8)
fn meet_surface(@builtin(global_invocation_id) id: vec3<u32>) {
    if !in_picture(id.xy) {
        return;
    }
    let pixel = pixel_at(id.xy);
    var path = paths[pixel];
    if path.stage == GONE {
        return;
    }
    let ray = path_rays[pixel];
    let hit = hits[pixel];
    let verdict = hit.status & 255u;
    let t = select(0.0, hit.t, verdict == HIT);
    if path.stage == WITHIN {
        path.throughput *= exp(-settings.absorption * t);
    }
    // A ray that starts beyond the surface that it looks for has met it; so does the eye in the solid.
    if verdict == HIT || verdict == INSIDE {
        path.place = ray.origin + t * ray.direction;
        path.normal = unfold(hit.normal);
        path.clearance = clearance_of(hit);
        path.base = base_color(pixel);
        path.feelers = 0u;
        path.doubts += u32(verdict == INSIDE && path.bounces > 0u && path.stage == OUTSIDE);
        light_directly(&path, ray.direction);
        go_on(&path, pixel, ray.direction);
    } else {
        path.doubts += u32(verdict != MISS);
        path.radiance += path.throughput * environment(ray.direction);
        path.stage = GONE;
        path_rays[pixel].question |= ANSWERED;
    }
    paths[pixel] = path;
}
