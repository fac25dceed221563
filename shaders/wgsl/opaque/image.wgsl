// A view with a solid scene in front (Illés and Szécsi, phase 2): no ray continues beyond it.

// Scene units; the host has put NO_LIMIT for infinity.
@group(1) @binding(0) var<storage, read> opaque_distances: array<f32>;

fn opaque_distance(pixel: u32) -> f32 {
    return opaque_distances[pixel];
}
