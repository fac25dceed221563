// The balls whose chords hold the current piece of the ray, for pieces that are made anew from them.

#import illes_fraglist::array_size::ARRAY_SIZE
#import illes_fraglist::balls::{segment_of, support_of_rank}
#import illes_fraglist::budget
#import work::count_balls

// What a separator is to its ball.
const ENTER: u32 = 0u;
const MIDDLE: u32 = 1u;
const LEAVE: u32 = 2u;

struct Active {
    rank: u32,
    // The chord, along the ray: its midpoint and half its length, scene units.
    middle: f32,
    half: f32,
    radius: f32,
    // The piece's factor of the ball's shape.
    weight: f32,
}

// Each active ball's LEAVE is among the records, so there are at most as many.
var<private> balls: array<Active, ARRAY_SIZE>;
var<private> count: u32;

// A separator as one number: four times the ball's rank, plus the kind.
fn label_of(rank: u32, kind: u32) -> u32 {
    return 4u * rank + kind;
}

fn rank_of(label: u32) -> u32 {
    return label >> 2u;
}

fn kind_of(label: u32) -> u32 {
    return label & 3u;
}

// A ball as the ray meets it, without its weight.
fn ball_along(rank: u32, direction: vec3<f32>) -> Active {
    let support = support_of_rank(rank);
    let segment = segment_of(support.center, support.radius, direction);
    return Active(rank, segment.middle, segment.half, support.radius, 0.0);
}

// v at the chord's midpoint, Q²/R².
fn depth_of(ball: Active) -> f32 {
    let ratio = ball.half / ball.radius;
    return ratio * ratio;
}

fn enter(ball: Active) {
    balls[count] = ball;
    count++;
    count_balls(1u);
}

fn leave(rank: u32) {
    var index = 0u;
    while index < count && balls[index].rank != rank {
        index++;
    }
    budget::spend(index);
    if index < count {
        count--;
        balls[index] = balls[count];
    }
}
