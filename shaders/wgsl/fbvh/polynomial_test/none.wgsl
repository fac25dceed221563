// Where leaves are searched by ranges alone: the twin of quartic.wgsl for all other kernels, and for rays
// that look for the way out of the solid.

#import fbvh::relative_ray::Frame
#import fbvh::test_result::{Outlook, UNCLEAR}

const LOOKS: u32 = 0u;

fn look(frame: Frame, direction: vec3<f32>, low: f32, high: f32) -> Outlook {
    return Outlook(UNCLEAR, low, high, high);
}
