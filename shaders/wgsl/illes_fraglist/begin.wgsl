// Begins all rays. One that meets no ball has its answer; the others wait for illes_fraglist::cast, which has
// arrays to make room for and nothing to do where there is no list.

#import core::hit::write_miss
#import core::view::{in_blocks, in_picture, pixel_at}
#import illes_fraglist::lists
#import illes_fraglist::waiting::{wait, Progress}

@compute @workgroup_size(8, 8)
fn begin_rays(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let at = 8u * group.xy + in_blocks(index);
    if !in_picture(at) {
        return;
    }
    let pixel = pixel_at(at);
    if lists::head_of(pixel) == lists::END {
        write_miss(pixel);
    } else {
        wait(pixel, Progress());
    }
}
