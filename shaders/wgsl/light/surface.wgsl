// Takes the answers to the paths' own rays: light of the surroundings where they leave the scene, and a
// surface where they hit, or the floor where that is nearer.

#import batch::free_ray::ANSWERED
#import core::hit::{clearance_of, hits, unfold, HIT, INSIDE, MISS}
#import core::ray_list::index_in_list
#import core::view::NO_LIMIT
#import light::environment::environment
#import light::floor::{floor_along, floor_base, floor_clearance, horizon, presence, UP}
#import light::path::{answered, path_rays, paths, settings, Path, OUTSIDE, WITHIN}
#import light::scatter::{continue_path, light_without_rays}
#import shade::base::base_color

@compute @workgroup_size(64)
fn meet_surface(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let listed = index_in_list(group, index);
    if listed >= answered.count {
        return;
    }
    let pixel = answered.pixels[listed];
    var path = paths[pixel];
    let ray = path_rays[pixel];
    let hit = hits[pixel];
    let verdict = hit.status & 255u;
    // A ray that starts beyond the surface that it seeks has met it; so has an eye in the solid.
    let is_met = verdict == HIT || verdict == INSIDE;
    let t_surface = select(0.0, hit.t, verdict == HIT);
    let t_floor = floor_along(ray.origin, ray.direction);
    path.on_floor = u32(t_floor < select(NO_LIMIT, t_surface, is_met));
    let t = select(t_surface, t_floor, path.on_floor == 1u);
    path.undecided += u32(verdict != MISS && !is_met);
    if path.stage == WITHIN {
        path.throughput *= exp(-settings.absorption * t);
    }
    path.position = ray.origin + t * ray.direction;
    path.rays_sent = 0u;
    if path.on_floor == 1u {
        path.position.y = settings.floor_middle.y;
        path.normal = UP;
        path.clearance = floor_clearance(ray.origin, t, path.position);
        path.base = floor_base(path.position);
        let share = presence(path.position);
        path.radiance += path.throughput * (1.0 - share) * horizon(ray.direction);
        path.throughput *= share;
    } else if is_met {
        path.normal = unfold(hit.normal);
        path.clearance = clearance_of(hit);
        path.base = base_color(pixel);
        path.undecided += u32(verdict == INSIDE && path.bounces > 0u && path.stage == OUTSIDE);
    } else {
        path.radiance += path.throughput * environment(ray.direction);
        path_rays[pixel].query |= ANSWERED;
        paths[pixel] = path;
        return;
    }
    light_without_rays(&path, ray.direction);
    continue_path(&path, pixel, ray.direction);
    paths[pixel] = path;
}
