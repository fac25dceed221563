// A level floor below the scene, matt, seen from above. Far from its middle it takes on the colour of the
// horizon behind it, so that it has no edge.
#define_import_path metaball::effects::floor

#import metaball::effects::environment::{ambient, environment}
#import metaball::effects::path::{lights, settings}
#import metaball::view::NO_LIMIT

const UP: vec3<f32> = vec3(0.0, 1.0, 0.0);
// Every other tile has this share of the floor's colour.
const DARK_TILE: f32 = 0.55;

// Where a ray meets the floor; NO_LIMIT for nowhere.
fn floor_along(origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let above = origin.y - settings.floor_middle.y;
    if settings.floor_reach == 0.0 || above <= 0.0 || direction.y >= 0.0 {
        return NO_LIMIT;
    }
    // A ray may be so level that it meets the floor beyond all floats.
    return select(NO_LIMIT, above / -direction.y, above < 1e30 * -direction.y);
}

// What the floor is lost in, far off along a ray.
fn horizon(direction: vec3<f32>) -> vec3<f32> {
    let level = vec3(direction.x, 0.0, direction.z);
    return environment(level / max(length(level), 1e-6));
}

// How much of what is seen there is floor, 0 to 1.
fn presence(place: vec3<f32>) -> f32 {
    let away = (place.xz - settings.floor_middle.xz) / settings.floor_reach;
    return exp(-min(dot(away, away), 80.0));
}

// The floor's colour, linear.
fn floor_base(place: vec3<f32>) -> vec3<f32> {
    if settings.tile == 0.0 {
        return settings.floor_color;
    }
    let column = floor((place.xz - settings.floor_middle.xz) / settings.tile);
    let is_odd = abs(column.x + column.y) % 2.0 == 1.0;
    return settings.floor_color * select(1.0, DARK_TILE, is_odd);
}

// What is seen along a ray that meets no surface: the floor as if nothing stood on it, and surroundings.
fn beyond(origin: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    let t = floor_along(origin, direction);
    if t == NO_LIMIT {
        return environment(direction);
    }
    var light = ambient(UP);
    for (var index = 0u; index < settings.lights; index++) {
        light += lights[index].color * max(lights[index].toward.y, 0.0);
    }
    let place = origin + t * direction;
    return mix(horizon(direction), floor_base(place) * light, presence(place));
}

// What a start beside the floor must keep from it: the point errs by the roundings of its sum.
fn floor_clearance(origin: vec3<f32>, t: f32, place: vec3<f32>) -> f32 {
    return 4.0 * 0x1p-23f * (length(origin) + 2.0 * t + length(place));
}
