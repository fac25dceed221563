// Sorts balls by effective distance on the device: a radix sort from the least digit, four bits a
// pass. Each pass counts the digits of each block, turns counts into offsets, and moves the entries
// there in order; so equal keys stay in the order of their balls. Workgroups wait for each other only
// from dispatch to dispatch.

#import core::prefix_sum::{sum_before, THREADS}
#import core::scene::scene
#import illes_fraglist::balls::effective_distance
#import support::support_of

struct Entry {
    // Ordered as the distances are.
    key: u32,
    ball: u32,
}

struct Table {
    // Passes whose offsets are made; zero when the frame begins.
    passes: u32,
    // Digit by digit, in each block by block: how many entries, then where the first of them goes.
    offsets: array<u32>,
}

// Entries of a workgroup, and of one of its invocations: BLOCK of crates/illes-fraglist/src/sort/adapter.rs.
const BLOCK: u32 = 1024u;
const RUN: u32 = 8u;
const GROUP: u32 = 128u;
const DIGITS: u32 = 16u;

@group(2) @binding(0) var<storage, read> entries: array<Entry>;
@group(2) @binding(1) var<storage, read_write> moved: array<Entry>;
@group(2) @binding(2) var<storage, read_write> table: Table;
// What illes_fraglist::balls reads as `ball_of_rank`.
@group(2) @binding(3) var<storage, read_write> order: array<u32>;

@compute @workgroup_size(128)
fn make_entries(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let ball = id.x + id.y * groups.x * GROUP;
    if ball < scene.balls {
        // Without their sign, floats are ordered as integers are, and negative ones in reverse.
        let bits = bitcast<u32>(effective_distance(support_of(ball)));
        moved[ball] = Entry(select(bits | 0x80000000u, ~bits, bits >> 31u == 1u), ball);
    }
}

fn blocks() -> u32 {
    return (scene.balls + BLOCK - 1u) / BLOCK;
}

fn digit_of(key: u32, digit: u32) -> u32 {
    return (key >> (4u * digit)) & 15u;
}

var<workgroup> totals: array<atomic<u32>, DIGITS>;

@compute @workgroup_size(128)
fn count_digits(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let block = group.x + group.y * groups.x;
    for (var part = 0u; part < RUN; part++) {
        let index = block * BLOCK + part * GROUP + thread;
        if index < scene.balls {
            atomicAdd(&totals[digit_of(entries[index].key, table.passes)], 1u);
        }
    }
    workgroupBarrier();
    if thread < DIGITS && block < blocks() {
        table.offsets[thread * blocks() + block] = atomicLoad(&totals[thread]);
    }
}

@compute @workgroup_size(256)
fn scan_digits(@builtin(local_invocation_index) thread: u32) {
    let all = DIGITS * blocks();
    let run = (all + THREADS - 1u) / THREADS;
    let first = min(thread * run, all);
    let end = min(first + run, all);
    var sum = 0u;
    for (var index = first; index < end; index++) {
        sum += table.offsets[index];
    }
    var offset = sum_before(thread, sum);
    for (var index = first; index < end; index++) {
        let count = table.offsets[index];
        table.offsets[index] = offset;
        offset += count;
    }
    if thread == 0u {
        table.passes += 1u;
    }
}

// Of each digit and invocation: how many entries, then where the next one goes in the block.
var<workgroup> counts: array<u32, 2048>;
// Of each digit: from an offset in the block to one among all.
var<workgroup> shifts: array<u32, DIGITS>;

@compute @workgroup_size(128)
fn spread_entries(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let block = group.x + group.y * groups.x;
    let digit = table.passes - 1u;
    let first = min(block * BLOCK + thread * RUN, scene.balls);
    let end = min(first + RUN, scene.balls);
    for (var index = first; index < end; index++) {
        counts[digit_of(entries[index].key, digit) * GROUP + thread] += 1u;
    }
    workgroupBarrier();
    var sum = 0u;
    for (var cell = thread * DIGITS; cell < (thread + 1u) * DIGITS; cell++) {
        sum += counts[cell];
    }
    var offset = sum_before(thread, sum);
    for (var cell = thread * DIGITS; cell < (thread + 1u) * DIGITS; cell++) {
        let count = counts[cell];
        counts[cell] = offset;
        offset += count;
    }
    workgroupBarrier();
    if thread < DIGITS && block < blocks() {
        shifts[thread] = table.offsets[thread * blocks() + block] - counts[thread * GROUP];
    }
    workgroupBarrier();
    for (var index = first; index < end; index++) {
        let entry = entries[index];
        let value = digit_of(entry.key, digit);
        let cell = value * GROUP + thread;
        moved[shifts[value] + counts[cell]] = entry;
        counts[cell] += 1u;
    }
}

@compute @workgroup_size(128)
fn take_order(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let rank = id.x + id.y * groups.x * GROUP;
    if rank < scene.balls {
        order[rank] = entries[rank].ball;
    }
}
