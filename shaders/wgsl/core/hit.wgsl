// What a method writes: one hit a pixel.

// Twin of `PackedHit` in metaball-core.
struct Hit {
    // Unit outward normal, folded onto an octahedron (Cigolle et al. 2014).
    normal: vec2<f32>,
    // Distance along the ray, scene units; 0 for a miss.
    t: f32,
    // One of the statuses below, plus FALLBACK; above them the clearance.
    status: u32,
}

// The verdicts of metaball-core, by number.
const MISS: u32 = 0u;
const HIT: u32 = 1u;
const INSIDE: u32 = 2u;
const UNDECIDED: u32 = 3u;
// Added where a published rule for trouble made the pixel.
const FALLBACK: u32 = 256u;
// What a frame begins with: it counts as undecided, so a pixel that no pass wrote is never a miss.
const NOTHING: u32 = 255u;

@group(0) @binding(2) var<storage, read_write> hits: array<Hit>;

fn write_miss(pixel: u32) {
    hits[pixel] = Hit(vec2<f32>(), 0.0, MISS);
}

// `normal` is unit and points out of the solid; `status` is HIT, INSIDE or UNDECIDED, perhaps plus
// FALLBACK.
fn write_hit(pixel: u32, t: f32, normal: vec3<f32>, status: u32) {
    hits[pixel] = Hit(fold(normal), t, status);
}

// The same where secondary rays may start: `clearance` is what a start must keep from the hit, along the
// normal, to be certainly on its side of the surface. Scene units, not negative. The upper 23 bits of the
// float are kept, rounded up.
fn write_hit_with_clearance(pixel: u32, t: f32, normal: vec3<f32>, status: u32, clearance: f32) {
    let upper = (bitcast<u32>(clearance) + 511u) & ~511u;
    hits[pixel] = Hit(fold(normal), t, status | upper);
}

fn clearance_of(hit: Hit) -> f32 {
    return bitcast<f32>(hit.status & ~511u);
}

// Whether the frame has the pixel's answer.
fn is_answered(pixel: u32) -> bool {
    return hits[pixel].status != NOTHING;
}

fn write_nothing(pixel: u32) {
    hits[pixel] = Hit(vec2<f32>(), 0.0, NOTHING);
}

// Octahedral coordinates of a unit vector.
fn fold(normal: vec3<f32>) -> vec2<f32> {
    let upper = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let lower = (1.0 - abs(upper.yx)) * select(vec2(-1.0), vec2(1.0), upper >= vec2(0.0));
    return select(lower, upper, normal.z >= 0.0);
}

// The unit vector at octahedral coordinates.
fn unfold(folded: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(folded.x) - abs(folded.y);
    let lower = (1.0 - abs(folded.yx)) * select(vec2(-1.0), vec2(1.0), folded >= vec2(0.0));
    return normalize(vec3(select(lower, folded, z >= 0.0), z));
}
