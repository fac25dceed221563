// The separators that a ray has yet to pass: ends and midpoints of effective intervals, ordered by
// distance, in a local array of fixed size (section 6). The nearest is the last, so that taking it
// is counting down.

#import illes_fraglist::budget

// What a separator is to its ball.
const ENTER: u32 = 0u;
const MIDDLE: u32 = 1u;
const LEAVE: u32 = 2u;

// The array's size as compiled: WGSL has no private arrays of overridable size.
const ARRAY_CAPACITY: u32 = 96u;
// Records that may be in it, from 3 to ARRAY_CAPACITY.
@id(49) override capacity: u32 = ARRAY_CAPACITY;

struct Record {
    // Distance along the ray, scene units.
    at: f32,
    // Four times the ball's rank, plus the kind.
    label: u32,
}

var<private> records: array<Record, ARRAY_CAPACITY>;
var<private> count: u32;

fn rank_of(record: Record) -> u32 {
    return record.label >> 2u;
}

fn kind_of(record: Record) -> u32 {
    return record.label & 3u;
}

// Whether the separators of one more ball fit.
fn has_capacity() -> bool {
    return count + 3u <= capacity;
}

fn nearest() -> f32 {
    return records[count - 1u].at;
}

fn take() -> Record {
    count--;
    return records[count];
}

// Inserts the separators of a ball from the kind `first` on, at rising distances. What is nearer is
// moved once, by as many indices as are still to be filled behind it.
fn insert(rank: u32, at: vec3<f32>, first: u32) {
    var gap = 3u - first;
    var unmoved = count;
    count += gap;
    for (var kind = first; kind <= LEAVE; kind++) {
        while unmoved > 0u && records[unmoved - 1u].at <= at[kind] {
            unmoved--;
            records[unmoved + gap] = records[unmoved];
            budget::spend(1u);
        }
        gap--;
        records[unmoved + gap] = Record(at[kind], 4u * rank + kind);
    }
    budget::spend(3u);
}
