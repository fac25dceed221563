// What a look at the field along an interval of a ray in a leaf has come to: made by quartic.wgsl, or
// by no_look.wgsl, which never tells anything.

// Outcomes. Nothing certain.
const UNCLEAR: u32 = 0u;
// The field stays below T.
const BELOW: u32 = 1u;
// The field reaches T once, and is above it at the end.
const ONCE: u32 = 2u;
// The field is above T at `high`: told only where any hit will do.
const ABOVE: u32 = 3u;

struct Outlook {
    outcome: u32,
    // Where to look next, if it is unclear: the field does not reach T before `low`.
    low: f32,
    high: f32,
    // If once: where, nearly.
    guess: f32,
}
