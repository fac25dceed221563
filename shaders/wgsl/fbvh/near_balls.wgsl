// The list of the leaf that is searched, and which of its balls are near: reach the ray's interval in the
// leaf. A bit each, so that of all walks along the list only the first visits those that do not. A walk goes
// through the words, and in each through its bits. Of a list longer than the words all balls count as near,
// and of one so short that a first walk saves nothing.

#import core::nearby_origin::UNIT
#import fbvh::budget::spent
#import fbvh::projection::{greatest_depth, project}
#import fbvh::relative_ray::RelativeRay
#import fbvh::structure::lists
#import kernel::{kernel, kernel_roundings}
#import work::count_evaluations

const WORDS: u32 = 8u;
// Balls of the shortest list that has its bits.
const SHORTEST: u32 = 5u;

// The list's first entry, and one past its last.
var<private> first: u32;
var<private> end: u32;
// How many balls are near, and which.
var<private> count: u32;
var<private> near: array<u32, WORDS>;

// Begins with a list and, where it has bits, walks along it. Returns an upper bound of the field on the
// interval.
fn gather(ray: RelativeRay, direction: vec3<f32>, list_first: u32, list_end: u32) -> f32 {
    first = list_first;
    end = list_end;
    count = end - first;
    if !has_bits() {
        return 1e38;
    }
    count_evaluations(count);
    spent += walk_length();
    count = 0u;
    var most = 0.0;
    var word = 0u;
    loop {
        let word_first = first + 32u * word;
        let word_end = min(word_first + 32u, end);
        var bits = 0u;
        var entry = word_first;
        loop {
            let seen = project(ray, direction, lists[entry]);
            let v = greatest_depth(seen, ray.enter, ray.leave);
            bits |= u32(v > 0.0) << (entry - word_first);
            most += seen.weight * kernel(v);
            entry++;
            if entry >= word_end {
                break;
            }
        }
        near[word] = bits;
        count += countOneBits(bits);
        word++;
        if word >= words() {
            break;
        }
    }
    return most * (1.0 + sum_error());
}

// A sum over the balls near, each term a kernel or its slope in a few products, errs by less than this part
// of the terms' sum without their signs.
fn sum_error() -> f32 {
    return f32(count + 16u + kernel_roundings()) * UNIT;
}

// Iterations of a walk along the balls near.
fn walk_length() -> u32 {
    return count + words() + 1u;
}

// Counts a walk.
fn begin_walk() {
    count_evaluations(count);
    spent += walk_length();
}

fn words() -> u32 {
    return (end - first + 31u) / 32u;
}

// A bit for each of a word's balls that is near, the first in the lowest.
fn near_in(word: u32) -> u32 {
    if has_bits() {
        return near[word];
    }
    return 0xffffffffu >> (32u - min(end - first - 32u * word, 32u));
}

// Whether there is a bit for each ball of the list.
fn has_bits() -> bool {
    let length = end - first;
    return SHORTEST <= length && length <= 32u * WORDS;
}

// The ball of the lowest bit of a word; of none the word's first.
fn ball_of(word: u32, bits: u32) -> u32 {
    return lists[first + 32u * word + firstTrailingBit(max(bits, 1u))];
}
