// A level floor below the scene, matt, seen from above. Far from its middle it takes on the colour of the
// horizon behind it, so that it has no edge.

#import core::view::NO_LIMIT
#import light::environment::{ambient, environment}
#import light::path::{lamps, settings}

const UP: vec3<f32> = vec3(0.0, 1.0, 0.0);
// Every other tile has this share of the floor's colour.
const DARK_TILE: f32 = 0.55;

// Where a ray meets the floor; NO_LIMIT for nowhere.
fn floor_along(origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let above = origin.y - settings.floor_middle.y;
    if settings.floor_reach == 0.0 || above <= 0.0 || direction.y >= 0.0 {
        return NO_LIMIT;
    }
    // A ray may be so level that the distance overflows.
    return select(NO_LIMIT, above / -direction.y, above < 1e30 * -direction.y);
}

// What the floor fades into, far off along a ray.
fn horizon(direction: vec3<f32>) -> vec3<f32> {
    let level = vec3(direction.x, 0.0, direction.z);
    return environment(level / max(length(level), 1e-6));
}

// Share of the floor in what is seen there, 0 to 1; the rest is horizon.
fn presence(position: vec3<f32>) -> f32 {
    let away = (position.xz - settings.floor_middle.xz) / settings.floor_reach;
    return exp(-min(dot(away, away), 80.0));
}

// The floor's colour, linear.
fn floor_base(position: vec3<f32>) -> vec3<f32> {
    if settings.tile == 0.0 {
        return settings.floor_color;
    }
    let column = floor((position.xz - settings.floor_middle.xz) / settings.tile);
    let is_odd = abs(column.x + column.y) % 2.0 == 1.0;
    return settings.floor_color * select(1.0, DARK_TILE, is_odd);
}

// What is seen along a ray that meets no surface: the floor as if nothing stood on it, or the surroundings.
fn beyond(origin: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let t = floor_along(origin, direction);
    if t == NO_LIMIT {
        return environment(direction);
    }
    var light = ambient(UP);
    for (var index = 0u; index < settings.lamps; index++) {
        light += lamps[index].color * max(lamps[index].toward.y, 0.0);
    }
    let position = origin + t * direction;
    return mix(horizon(direction), floor_base(position) * light, presence(position));
}

// The clearance of a point on the floor: it errs by the roundings of its sum.
fn floor_clearance(origin: vec3<f32>, t: f32, position: vec3<f32>) -> f32 {
    return 4.0 * 0x1p-23f * (length(origin) + 2.0 * t + length(position));
}
