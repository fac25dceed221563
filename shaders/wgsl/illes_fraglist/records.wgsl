// The separators that a ray has yet to pass: ends and midpoints of effective intervals, ordered by
// distance, in a local array of fixed size, each with what it changes (section 6). The nearest is the
// last, so that taking it is counting down.

#import illes_fraglist::array_size::ARRAY_SIZE
#import illes_fraglist::budget
#import illes_fraglist::piece::Change

// Records that may be in the array, from 3 to ARRAY_SIZE.
@id(49) override capacity: u32 = ARRAY_SIZE;

// A record is a distance along the ray, scene units, and a change: apart, since places are found by
// distances alone.
var<private> distances: array<f32, ARRAY_SIZE>;
var<private> changes: array<Change, ARRAY_SIZE>;
var<private> count: u32;

// While a ball's records are inserted: how many are to come, and how many others are where they were.
var<private> to_come: u32;
var<private> unmoved: u32;

// Whether the separators of one more ball fit.
fn has_capacity() -> bool {
    return count + 3u <= capacity;
}

fn nearest() -> f32 {
    return distances[count - 1u];
}

fn take() -> Change {
    count--;
    return changes[count];
}

// Makes room for so many records of a ball, to be inserted at rising distances.
fn make_room(records: u32) {
    to_come = records;
    unmoved = count;
    count += records;
}

// What is nearer is moved once, by as many indices as are still to be filled behind it.
fn insert(at: f32, change: Change) {
    while unmoved > 0u && distances[unmoved - 1u] <= at {
        unmoved--;
        distances[unmoved + to_come] = distances[unmoved];
        changes[unmoved + to_come] = changes[unmoved];
        budget::spend(1u);
    }
    to_come--;
    distances[unmoved + to_come] = at;
    changes[unmoved + to_come] = change;
    budget::spend(1u);
}
