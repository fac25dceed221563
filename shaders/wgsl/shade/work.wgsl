// What each pixel cost, as a heat map.

#import core::view::{in_picture, pixel_at}
#import core::work_record::{Work, work_of_pixel}
#import shade::picture::{put_encoded, on_scale}

// Which counter: its index in `Work`. Id 1 of the ids that metaball-core sets.
@id(1) override counter: u32 = 0u;

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if !in_picture(invocation.xy) {
        return;
    }
    let pixel = pixel_at(invocation.xy);
    put_encoded(pixel, viridis(on_scale(f32(counted(work_of_pixel[pixel])))));
}

fn counted(work: Work) -> u32 {
    switch counter {
        case 0u: { return work.nodes; }
        case 1u: { return work.leaf_tests; }
        case 2u: { return work.balls; }
        case 3u: { return work.evaluations; }
        case 4u: { return work.iterations; }
        case 5u: { return work.layers; }
        default: { return work.depth; }
    }
}

// The colour map viridis (van der Walt and Smith 2015), sRGB-encoded, in Zucker's polynomial fit of
// degree six (2019, CC0), which keeps it to 0.02. Lightness rises evenly from 0 to 1.
fn viridis(t: f32) -> vec3<f32> {
    let c0 = vec3(0.2777273272, 0.0054073445, 0.3340998053);
    let c1 = vec3(0.1050930431, 1.4046135299, 1.3845901626);
    let c2 = vec3(-0.3308618287, 0.2148475595, 0.0950951630);
    let c3 = vec3(-4.6342304990, -5.7991009734, -19.3324409563);
    let c4 = vec3(6.2282699363, 14.1799333668, 56.6905526007);
    let c5 = vec3(4.7763849977, -13.7451453777, -65.3530326334);
    let c6 = vec3(-5.4354558559, 4.6458526122, 26.3124352496);
    return c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * (c5 + t * c6)))));
}
