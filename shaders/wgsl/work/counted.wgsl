// Counted in private memory.

#import core::work_record::{Work, work_of_pixel}

var<private> work: Work;
// Iterations since the last search ended.
var<private> in_search: u32;

// Levels of a tree at most. Twin: MAX_DEPTH of crates/fbvh/src/node.rs.
const MAX_DEPTH: u32 = 64u;

// Interior nodes on the way from a tree's root to where a walk is, and to the subtrees that it left for
// later, each in its slot.
var<private> level: u32;
var<private> levels_left: array<u32, MAX_DEPTH>;

fn count_node() {
    work.nodes += 1u;
}

fn go_down() {
    level += 1u;
    work.depth = max(work.depth, level);
}

fn leave_for_later(slot: u32) {
    levels_left[slot] = level;
}

fn come_back_to(slot: u32) {
    level = levels_left[slot];
}

fn count_leaf_test() {
    work.leaf_tests += 1u;
}

fn count_balls(n: u32) {
    work.balls += n;
}

fn count_evaluations(n: u32) {
    work.evaluations += n;
}

fn count_iterations(n: u32) {
    work.iterations += n;
    in_search += n;
}

fn count_search_end() {
    work.longest_search = max(work.longest_search, in_search);
    in_search = 0u;
}

fn count_layers(n: u32) {
    work.layers += n;
}

// Adds what was counted to what earlier passes of the frame wrote.
fn write_work(pixel: u32) {
    work_of_pixel[pixel].nodes += work.nodes;
    work_of_pixel[pixel].leaf_tests += work.leaf_tests;
    work_of_pixel[pixel].balls += work.balls;
    work_of_pixel[pixel].evaluations += work.evaluations;
    work_of_pixel[pixel].iterations += work.iterations;
    work_of_pixel[pixel].layers += work.layers;
    work_of_pixel[pixel].depth = max(work_of_pixel[pixel].depth, work.depth);
    let longest = max(work_of_pixel[pixel].longest_search, work.longest_search);
    work_of_pixel[pixel].longest_search = longest;
    work = Work();
}
