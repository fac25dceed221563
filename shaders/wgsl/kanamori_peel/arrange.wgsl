// Once a frame: a rectangle for every ball, and lists of the balls to draw and of those around the
// eye. Lists keep the balls' order, so that frames can be repeated.
//
// The passes are place (a ball each); then, once the balls in view are known, count and spread (256
// balls a workgroup) with total (one workgroup) between them: a prefix sum.

#import metaball::kanamori_peel::arranged::{Arranged, MOST_ACTIVE}
#import metaball::kanamori_peel::rectangle::{place_sphere, Placed}
#import metaball::kanamori_peel::tile::tile_count
#import metaball::scene::{scene, supports}
#import metaball::view::view

// Whether balls that no pixel sees before the kernel spheres are left out.
@id(32) override culling: bool = true;

// Numbers of balls drawn and of balls around the eye.
struct Block {
    drawn: u32,
    around: u32,
}

@group(2) @binding(1) var<storage, read_write> placed: array<Placed>;
@group(2) @binding(2) var<storage, read> seen: array<u32>;
@group(2) @binding(3) var<storage, read_write> arranged: Arranged;
@group(2) @binding(4) var<storage, read_write> blocks: array<Block>;
// Two indirect draws: the balls, and the tiles of the picture.
@group(2) @binding(5) var<storage, read_write> draws: array<u32, 8>;

const LANES: u32 = 256u;

var<workgroup> running: array<vec2<u32>, LANES>;

@compute @workgroup_size(256)
fn place(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < scene.balls {
        let support = supports[id.x];
        placed[id.x] = place_sphere(support.center - view.eye, support.radius);
    }
}

@compute @workgroup_size(256)
fn count(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let sums = sums_up_to(lane, wanted(id.x));
    if lane == LANES - 1u {
        blocks[group.x] = Block(sums.x, sums.y);
    }
}

@compute @workgroup_size(256)
fn total(@builtin(local_invocation_index) lane: u32) {
    let all = (scene.balls + LANES - 1u) / LANES;
    let share = (all + LANES - 1u) / LANES;
    let first = min(lane * share, all);
    let end = min(first + share, all);
    var own = vec2(0u);
    for (var block = first; block < end; block++) {
        own += vec2(blocks[block].drawn, blocks[block].around);
    }
    let sums = sums_up_to(lane, own);
    // Each block's numbers become those of all blocks before it.
    var before = sums - own;
    for (var block = first; block < end; block++) {
        let numbers = vec2(blocks[block].drawn, blocks[block].around);
        blocks[block] = Block(before.x, before.y);
        before += numbers;
    }
    if lane == LANES - 1u {
        arranged.drawn = sums.x;
        arranged.around = sums.y;
        draws = array(4u, sums.x, 0u, 0u, 4u, tile_count(), 0u, 0u);
    }
}

@compute @workgroup_size(256)
fn spread(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
    @builtin(workgroup_id) group: vec3<u32>,
) {
    let own = wanted(id.x);
    let place = sums_up_to(lane, own) - own + vec2(blocks[group.x].drawn, blocks[group.x].around);
    if own.x == 1u {
        arranged.balls[place.x] = id.x;
    }
    if own.y == 1u && place.y < MOST_ACTIVE {
        arranged.around_balls[place.y] = id.x;
    }
}

// 1 where the ball is to be drawn, and where it is around the eye.
fn wanted(ball: u32) -> vec2<u32> {
    if ball >= scene.balls {
        return vec2(0u);
    }
    let here = placed[ball];
    let is_drawn = here.low.x < here.high.x && (!culling || seen[ball] != 0u);
    return vec2(select(0u, 1u, is_drawn), here.around);
}

// The sum over this lane and those before it (Hillis and Steele).
fn sums_up_to(lane: u32, own: vec2<u32>) -> vec2<u32> {
    running[lane] = own;
    for (var reach = 1u; reach < LANES; reach <<= 1u) {
        workgroupBarrier();
        let before = select(vec2(0u), running[lane - min(reach, lane)], lane >= reach);
        workgroupBarrier();
        running[lane] += before;
    }
    workgroupBarrier();
    return running[lane];
}
