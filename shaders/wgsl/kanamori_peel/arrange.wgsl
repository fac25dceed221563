// Once a frame, a ball each: where it is on the picture; and, once it is known which balls are visible,
// which are drawn, and the list of those around the eye. It keeps the balls' order, so that frames can
// be repeated.
//
// The passes are place; then count and spread (256 balls a workgroup) with total (one workgroup)
// between them: a prefix sum.

#import core::scene::scene
#import core::view::view
#import kanamori_peel::arranged::{Arranged, MOST_ACTIVE}
#import kanamori_peel::placed::{is_drawn, place_sphere, Placed}
#import support::support_of

// Whether balls that no pixel sees before the kernel spheres are left out.
@id(32) override culling: bool = true;

@group(2) @binding(1) var<storage, read_write> placed: array<Placed>;
@group(2) @binding(2) var<storage, read> seen: array<u32>;
@group(2) @binding(3) var<storage, read_write> arranged: Arranged;
// Numbers of balls in the picture, drawn, and around the eye, of each workgroup of balls.
@group(2) @binding(4) var<storage, read_write> blocks: array<vec3<u32>>;

const LANES: u32 = 256u;

var<workgroup> running: array<vec3<u32>, LANES>;

@compute @workgroup_size(256)
fn place(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < scene.balls {
        let support = support_of(id.x);
        placed[id.x] = place_sphere(support.center - view.eye, support.radius);
    }
}

@compute @workgroup_size(256)
fn count(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    var own = vec3(0u);
    if id.x < scene.balls {
        let here = placed[id.x];
        let is_hidden = culling && seen[id.x] == 0u;
        if is_hidden {
            placed[id.x].high = here.low;
        }
        let in_view = select(0u, 1u, is_drawn(here));
        own = vec3(in_view, select(in_view, 0u, is_hidden), here.around);
    }
    let sums = sums_up_to(lane, own);
    if lane == LANES - 1u {
        blocks[group.x] = sums;
    }
}

@compute @workgroup_size(256)
fn total(@builtin(local_invocation_index) lane: u32) {
    let all = (scene.balls + LANES - 1u) / LANES;
    let share = (all + LANES - 1u) / LANES;
    let first = min(lane * share, all);
    let end = min(first + share, all);
    var own = vec3(0u);
    for (var block = first; block < end; block++) {
        own += blocks[block];
    }
    let sums = sums_up_to(lane, own);
    // Each block's numbers become those of all blocks before it.
    var before = sums - own;
    for (var block = first; block < end; block++) {
        let numbers = blocks[block];
        blocks[block] = before;
        before += numbers;
    }
    if lane == LANES - 1u {
        arranged.in_view = sums.x;
        arranged.drawn = sums.y;
        arranged.around = sums.z;
    }
}

@compute @workgroup_size(256)
fn spread(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    var own = vec3(0u);
    if id.x < scene.balls {
        own.z = placed[id.x].around;
    }
    let index = sums_up_to(lane, own).z - own.z + blocks[group.x].z;
    if own.z == 1u && index < MOST_ACTIVE {
        arranged.around_balls[index] = id.x;
    }
}

// The sum over this lane and those before it (Hillis and Steele).
fn sums_up_to(lane: u32, own: vec3<u32>) -> vec3<u32> {
    running[lane] = own;
    for (var reach = 1u; reach < LANES; reach <<= 1u) {
        workgroupBarrier();
        let before = select(vec3(0u), running[lane - min(reach, lane)], lane >= reach);
        workgroupBarrier();
        running[lane] += before;
    }
    workgroupBarrier();
    return running[lane];
}
