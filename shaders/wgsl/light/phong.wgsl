// Phong's model, in bands where cel shading is asked for.

#import light::path::{lamps, settings, Path}

// Phong's highlight: its exponent, and its brightness beside a white surface's.
const SHININESS: f32 = 48.0;
const HIGHLIGHT: f32 = 0.22;

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
