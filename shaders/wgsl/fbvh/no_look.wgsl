// Where leaves are searched by ranges alone: the twin of quartic.wgsl for all other kernels, and for rays
// that look for the way out of the solid.
#define_import_path metaball::fbvh::look

#import metaball::fbvh::local::Frame
#import metaball::fbvh::outlook::{Outlook, UNCLEAR}

const LOOKS: u32 = 0u;

fn look(frame: Frame, direction: vec3<f32>, low: f32, high: f32) -> Outlook {
    return Outlook(UNCLEAR, low, high, high);
}
