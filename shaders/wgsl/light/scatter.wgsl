// What a surface does with light: Phong's model lit along shadow and occlusion rays, a mirror, or a clear
// fluid.

#import batch::free_ray::{FreeRay, ANSWERED, ANY_HIT, EXIT, FIRST_HIT}
#import light::environment::ambient
#import light::floor::beyond
#import light::path::{lamps, path_rays, settings, shadow_rays, Path, OUTSIDE, WITHIN}
#import light::sampling::{around, on_disc, point_in_square}
#import core::view::NO_LIMIT

// Phong's highlight: its exponent, and its brightness beside a white surface's.
const SHININESS: f32 = 48.0;
const HIGHLIGHT: f32 = 0.22;

// Purposes of random numbers; each surface of a path has its own.
const FOR_LAMP: u32 = 1u;
const FOR_SKY: u32 = 2u;
const FOR_CHOICE: u32 = 3u;

fn purpose(path: Path, number: u32) -> u32 {
    return 4u * path.bounces + number;
}

// Whether the surface is the clear fluid's.
fn is_clear(path: Path) -> bool {
    return settings.refraction > 0.0 && path.on_floor == 0u;
}

// Light that needs no ray: the surroundings' mean where nothing occludes them, and lamps that cast no
// shadows.
fn light_without_rays(path: ptr<function, Path>, direction: vec3<f32>) {
    if is_clear(*path) {
        return;
    }
    let share = own_share(*path, direction);
    if settings.occlusion_rays == 0u {
        (*path).radiance += share * (*path).base * shaded(ambient((*path).normal));
    }
    if settings.shadows == 0u {
        for (var lamp = 0u; lamp < settings.lamps; lamp++) {
            (*path).radiance += share * reflected(*path, direction, lamp, lamps[lamp].toward);
        }
    }
}

// Sends the surface point's next shadow or occlusion ray; after the last, the path's next ray.
fn continue_path(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>) {
    if is_clear(*path) {
        pass_through(path, pixel, direction);
        return;
    }
    let to_lamps = settings.lamps * settings.shadows;
    while (*path).rays_sent < to_lamps + settings.occlusion_rays {
        let number = (*path).rays_sent;
        (*path).rays_sent = number + 1u;
        var is_sent: bool;
        if number < to_lamps {
            is_sent = send_shadow_ray(path, pixel, direction, number);
        } else {
            is_sent = send_occlusion_ray(path, pixel, direction, number - to_lamps);
        }
        if is_sent {
            return;
        }
    }
    shadow_rays[pixel].query |= ANSWERED;
    let mirror = mirror_share(*path, direction);
    let toward = normalize(reflect(direction, (*path).normal));
    (*path).throughput *= mirror;
    if mirror == 0.0 || (*path).bounces >= settings.bounces {
        // The last surface of a path mirrors the surroundings alone.
        (*path).radiance += (*path).throughput * beyond((*path).position, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    (*path).stage = OUTSIDE;
    path_rays[pixel] = FreeRay(start(*path, 1.0), NO_LIMIT, toward, FIRST_HIT);
}

// The start of a secondary ray: off the surface by its clearance, outside (1) or inside (-1).
fn start(path: Path, side: f32) -> vec3<f32> {
    return path.position + side * path.clearance * path.normal;
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

// Light of a lamp in direction `toward` that the surface reflects back along the ray.
fn reflected(path: Path, direction: vec3<f32>, lamp: u32, toward: vec3<f32>) -> vec3<f32> {
    let cosine = dot(path.normal, toward);
    if cosine <= 0.0 {
        return vec3<f32>();
    }
    let mirrored = max(dot(reflect(direction, path.normal), toward), 0.0);
    let shine = select(HIGHLIGHT, 0.0, path.on_floor == 1u);
    let highlight = shine * shaded(vec3(pow(mirrored, SHININESS)));
    return lamps[lamp].color * (path.base * shaded(vec3(cosine)) + highlight);
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

// Towards a point of a lamp. Whether there is a ray to trace.
fn send_shadow_ray(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, lamp: u32) -> bool {
    let number = settings.sample * settings.lamps + lamp;
    let disc = lamps[lamp].size * on_disc(point_in_square(pixel, purpose(*path, FOR_LAMP), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around(lamps[lamp].toward, vec3(disc, height));
    let light = own_share(*path, direction) * reflected(*path, direction, lamp, toward);
    return send(path, pixel, toward, NO_LIMIT, light);
}

// One of the surface's occlusion rays, distributed by Lambert's cosine. Whether there is a ray to trace.
fn send_occlusion_ray(path: ptr<function, Path>, pixel: u32, direction: vec3<f32>, ray: u32) -> bool {
    let number = settings.sample * settings.occlusion_rays + ray;
    let disc = on_disc(point_in_square(pixel, purpose(*path, FOR_SKY), number));
    let height = sqrt(max(1.0 - dot(disc, disc), 0.0));
    let toward = around((*path).normal, vec3(disc, height));
    let light = own_share(*path, direction) * (*path).base * beyond((*path).position, toward)
        / f32(settings.occlusion_rays);
    return send(path, pixel, toward, settings.occlusion_reach, light);
}

// Sends a ray that brings this light if it hits nothing; false, and no ray, below the surface's horizon.
fn send(
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
    shadow_rays[pixel] = FreeRay(start(*path, 1.0), reach, toward, ANY_HIT);
    return true;
}

// A clear fluid reflects or refracts, by Fresnel's equations: one of the two at random, with its share of
// the light as probability.
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
    let choice = point_in_square(pixel, purpose(*path, FOR_CHOICE), settings.sample).x;
    let is_mirrored = choice < mirrored;
    let onward = select(refract(direction, facing, ratio), reflect(direction, facing), is_mirrored);
    let toward = normalize(onward);
    if (*path).bounces >= settings.bounces {
        // Beyond the last surface there are only the surroundings.
        (*path).radiance += (*path).throughput * beyond((*path).position, toward);
        path_rays[pixel].query |= ANSWERED;
        return;
    }
    (*path).bounces += 1u;
    let is_within = leaves == is_mirrored;
    (*path).stage = select(OUTSIDE, WITHIN, is_within);
    let query = select(FIRST_HIT, EXIT, is_within);
    path_rays[pixel] = FreeRay(start(*path, select(1.0, -1.0, is_within)), NO_LIMIT, toward, query);
}
