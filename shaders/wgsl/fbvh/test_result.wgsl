// The result of a polynomial test of an interval of a ray in a leaf.

// Outcomes. Nothing is certain.
const UNCERTAIN: u32 = 0u;
// The field stays below T.
const BELOW: u32 = 1u;
// The field reaches T once, and is above it at the end.
const ONCE: u32 = 2u;
// The field is above T at `high`: only where any hit suffices.
const ABOVE: u32 = 3u;

struct TestResult {
    outcome: u32,
    // The interval that is left, if it is uncertain: the field does not reach T before `low`.
    low: f32,
    high: f32,
    // If once: about where.
    guess: f32,
}
