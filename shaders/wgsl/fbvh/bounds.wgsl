// What is certain of the excess on an interval of a ray.

struct Bounds {
    // The excess is nowhere more than this.
    most: f32,
    // The slope is nowhere less, 1/scene unit.
    least_slope: f32,
    // At the end: certainly at least and at most this.
    end_least: f32,
    end_most: f32,
    // Excess and slope at either end: best values, no bounds.
    start: vec2<f32>,
    end: vec2<f32>,
    // Least radius among the balls that reach the interval.
    radius: f32,
}
