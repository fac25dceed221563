// Secondary rays: where they start, and for which purposes they take random numbers.

#import batch::free_ray::{FreeRay, ANY_HIT}
#import light::path::{shadow_rays, Path}

// Purposes of random numbers; each surface of a path has its own. 0 is the point in the pixel.
const FOR_LAMP: u32 = 1u;
const FOR_SKY: u32 = 2u;
const FOR_CHOICE: u32 = 3u;

fn purpose(path: Path, number: u32) -> u32 {
    return 4u * path.bounces + number;
}

// The start of a secondary ray: off the surface by its clearance, outside (1) or inside (-1).
fn start(path: Path, side: f32) -> vec3<f32> {
    return path.position + side * path.clearance * path.normal;
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
