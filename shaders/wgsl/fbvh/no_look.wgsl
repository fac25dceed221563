// Where leaves are searched by ranges alone: the twin of quartic.wgsl for all other kernels, and for rays
// that look for the way out of the solid.
#define_import_path metaball::fbvh::look

#import metaball::fbvh::local::Frame

const LOOKS: u32 = 0u;

const UNCLEAR: u32 = 0u;
const BELOW: u32 = 1u;
const ONCE: u32 = 2u;

struct Look {
    outcome: u32,
    low: f32,
    high: f32,
    guess: f32,
}

fn look(frame: Frame, direction: vec3<f32>, first: u32, end: u32, low: f32, high: f32) -> Look {
    return Look(UNCLEAR, low, high, high);
}
