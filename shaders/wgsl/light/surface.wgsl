// Takes up the answers to the paths' own rays: light of the surroundings where they leave, and a surface
// where they hit, or the floor where that is nearer.

#import metaball::base::base_color
#import metaball::free_ray::ANSWERED
#import metaball::hit::{clearance_of, hits, unfold, HIT, INSIDE, MISS}
#import metaball::effects::environment::environment
#import metaball::effects::floor::{floor_along, floor_base, floor_clearance, horizon, presence, UP}
#import metaball::effects::path::{answered, path_rays, paths, settings, Path, OUTSIDE, WITHIN}
#import metaball::effects::scatter::{go_on, light_directly}
#import metaball::listed::place_of
#import metaball::view::NO_LIMIT

@compute @workgroup_size(64)
fn meet_surface(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let place = place_of(group, index);
    if place >= answered.count {
        return;
    }
    let pixel = answered.pixels[place];
    var path = paths[pixel];
    let ray = path_rays[pixel];
    let hit = hits[pixel];
    let verdict = hit.status & 255u;
    // A ray that starts beyond the surface that it looks for has met it; so does the eye in the solid.
    let is_met = verdict == HIT || verdict == INSIDE;
    let t_surface = select(0.0, hit.t, verdict == HIT);
    let t_floor = floor_along(ray.origin, ray.direction);
    path.on_floor = u32(t_floor < select(NO_LIMIT, t_surface, is_met));
    let t = select(t_surface, t_floor, path.on_floor == 1u);
    path.doubts += u32(verdict != MISS && !is_met);
    if path.stage == WITHIN {
        path.throughput *= exp(-settings.absorption * t);
    }
    path.place = ray.origin + t * ray.direction;
    path.feelers = 0u;
    if path.on_floor == 1u {
        path.place.y = settings.floor_middle.y;
        path.normal = UP;
        path.clearance = floor_clearance(ray.origin, t, path.place);
        path.base = floor_base(path.place);
        let there = presence(path.place);
        path.radiance += path.throughput * (1.0 - there) * horizon(ray.direction);
        path.throughput *= there;
    } else if is_met {
        path.normal = unfold(hit.normal);
        path.clearance = clearance_of(hit);
        path.base = base_color(pixel);
        path.doubts += u32(verdict == INSIDE && path.bounces > 0u && path.stage == OUTSIDE);
    } else {
        path.radiance += path.throughput * environment(ray.direction);
        path_rays[pixel].query |= ANSWERED;
        paths[pixel] = path;
        return;
    }
    light_directly(&path, ray.direction);
    go_on(&path, pixel, ray.direction);
    paths[pixel] = path;
}
