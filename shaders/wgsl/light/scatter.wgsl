// What a surface does with light: Phong's model lit through feelers, a mirror, or a clear fluid.
#define_import_path metaball::effects::scatter

#import metaball::free_ray::{FreeRay, ANSWERED, ANY_HIT, EXIT, FIRST_HIT}
#import metaball::effects::environment::ambient
#import metaball::effects::floor::beyond
#import metaball::effects::path::{feelers, lights, path_rays, settings, Path, OUTSIDE, WITHIN}
#import metaball::effects::sampling::{around, on_disc, point_in_square}
#import metaball::view::NO_LIMIT

// Phong's highlight: its exponent, and its brightness beside a white surface's.
const SHININESS: f32 = 48.0;
const HIGHLIGHT: f32 = 0.22;

// Purposes of random numbers; each surface of a path has its own.
const FOR_LIGHT: u32 = 1u;
const FOR_SKY: u32 = 2u;
const FOR_CHOICE: u32 = 3u;

fn purpose(path: Path, number: u32) -> u32 {
    return 4u * path.bounces + number;
}

// Whether the surface is the clear fluid's.
fn is_clear(path: Path) -> bool {
    return settings.refraction > 0.0 && path.on_floor == 0u;
}

// Light that needs no feeler: what comes from all around, and lights that cast no shadows.
fn light_directly(path: ptr<function, Path>, direction: vec3<f32>) {
    if is_clear(*path) {
        return;
    }
    let share = own_share(*path, direction);
    if settings.occlusion_rays == 0u {
        (*path).radiance += share * (*path).base * shaded(ambient((*path).normal));
    }
    if settings.shadows == 0u {
        for (var light = 0u; light < settings.lights; light++) {
            (*path).radiance += share * reflected(*path, direction, light, lights[light].toward);
        }
    }
}

// Sends the next feeler, or the path's next ray.
fn go_on(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    if is_clear(*path) {
        pass_through(path, pixel, direction);
        return;
    }
    let shadow_rays = settings.lights * settings.shadows;
    while (*path).feelers < shadow_rays + settings.occlusion_rays {
        let number = (*path).feelers;
        (*path).feelers = number + 1u;
        var is_sent: bool;
        if number < shadow_rays {
            is_sent = feel_for_light(path, pixel, direction, number);
        } else {
            is_sent = feel_for_sky(path, pixel, direction, number - shadow_rays);
        }
        if is_sent {
            return;
        }
    }
    feelers[pixel].query |= ANSWERED;
    let mirror = mirror_share(*path, direction);
    let toward = normalize(reflect(direction, (*path).normal));
    (*path).throughput *= mirror;
    if mirror == 0.0 || (*path).bounces >= settings.bounces {
        // The last surface of a path mirrors the surroundings alone.
        (*path).radiance += (*path).throughput * beyond((*path).place, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    (*path).stage = OUTSIDE;
    path_rays[pixel] = FreeRay(start(*path, 1.0), NO_LIMIT, toward, FIRST_HIT);
}

// A point beside the surface, outside (1) or inside (-1), from which a ray can start.
fn start(path: Path, side: f32) -> vec3<f32> {
    return path.place + side * path.clearance * path.normal;
}

// The share of light that is mirrored: Schlick's approximation of Fresnel's equations (1994). None by the
// floor, and none inside the solid.
fn mirror_share(path: Path, direction: vec3<f32>) -> f32 {
    let cosine = -dot(direction, path.normal);
    if path.on_floor == 1u || settings.reflectivity == 0.0 || cosine <= 0.0 {
        return 0.0;
    }
    return mix(pow(1.0 - min(cosine, 1.0), 5.0), 1.0, settings.reflectivity);
}

// The share that the surface itself scatters to the eye.
fn own_share(path: Path, direction: vec3<f32>) -> vec3<f32> {
    return path.throughput * (1.0 - mirror_share(path, direction));
}

// Light of a lamp in a direction that the surface sends back along the ray.
fn reflected(path: Path, direction: vec3<f32>, light: u32, toward: vec3<f32>) -> vec3<f32> {
    let cosine = dot(path.normal, toward);
    if cosine <= 0.0 {
        return vec3<f32>();
    }
    let mirrored = max(dot(reflect(direction, path.normal), toward), 0.0);
    let shine = select(HIGHLIGHT, 0.0, path.on_floor == 1u);
    let highlight = shine * shaded(vec3(pow(mirrored, SHININESS)));
    return lights[light].color * (path.base * shaded(vec3(cosine)) + highlight);
}

// In bands of brightness where cel shading is asked for; the light keeps its colour.
fn shaded(light: vec3<f32>) -> vec3<f32> {
    let brightness = max(light.x, max(light.y, light.z));
    if settings.bands == 0u || brightness == 0.0 {
        return light;
    }
    let bands = f32(settings.bands);
    return light * (floor(brightness * bands + 0.5) / (bands * brightness));
}

fn feel_for_light(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, light: u32) -> bool {
    let lamp = lights[light];
    let number = settings.exposure * settings.lights + light;
    let disc = lamp.size * on_disc(point_in_square(pixel, purpose(*path, FOR_LIGHT), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around(lamp.toward, vec3(disc, height));
    let light_found = own_share(*path, direction) * reflected(*path, direction, light, toward);
    return send_feeler(path, pixel, toward, NO_LIMIT, light_found);
}

// Sky seen by one of the surface's occlusion rays, thrown by Lambert's cosine.
fn feel_for_sky(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, ray: u32) -> bool {
    let number = settings.exposure * settings.occlusion_rays + ray;
    let disc = on_disc(point_in_square(pixel, purpose(*path, FOR_SKY), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around((*path).normal, vec3(disc, height));
    let light_found = own_share(*path, direction) * (*path).base * beyond((*path).place, toward)
        / f32(settings.occlusion_rays);
    return send_feeler(path, pixel, toward, settings.occlusion_reach, light_found);
}

// Whether there is anything to ask: not below the horizon.
fn send_feeler(
    path: ptr<function, Path>,
    pixel: u32,
    toward: vec3<f32>,
    reach: f32,
    light: vec3<f32>,
) -> bool {
    if dot(toward, (*path).normal) <= 0.0 {
        return false;
    }
    (*path).pending = light;
    feelers[pixel] = FreeRay(start(*path, 1.0), reach, toward, ANY_HIT);
    return true;
}

// A clear fluid reflects or refracts, by Fresnel's equations: one of the two at random, as often as it
// has of the light.
fn pass_through(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    // The normal on the side that the ray comes from.
    let leaves = (*path).stage == WITHIN;
    let facing = select((*path).normal, -(*path).normal, leaves);
    let ratio = select(1.0 / settings.refraction, settings.refraction, leaves);
    let cosine = clamp(-dot(direction, facing), 0.0, 1.0);
    let sine_squared = ratio * ratio * (1.0 - cosine * cosine);
    var mirrored = 1.0;
    if sine_squared < 1.0 {
        let onward_cosine = sqrt(1.0 - sine_squared);
        let across = (ratio * cosine - onward_cosine) / (ratio * cosine + onward_cosine);
        let along = (cosine - ratio * onward_cosine) / (cosine + ratio * onward_cosine);
        mirrored = 0.5 * (across * across + along * along);
    }
    let choice = point_in_square(pixel, purpose(*path, FOR_CHOICE), settings.exposure).x;
    let is_mirrored = choice < mirrored;
    let onward = select(refract(direction, facing, ratio), reflect(direction, facing), is_mirrored);
    let toward = normalize(onward);
    if (*path).bounces >= settings.bounces {
        // Beyond the last surface there are only the surroundings.
        (*path).radiance += (*path).throughput * beyond((*path).place, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    let is_within = leaves == is_mirrored;
    (*path).stage = select(OUTSIDE, WITHIN, is_within);
    let question = select(FIRST_HIT, EXIT, is_within);
    path_rays[pixel] = FreeRay(start(*path, select(1.0, -1.0, is_within)), NO_LIMIT, toward, question);
}
