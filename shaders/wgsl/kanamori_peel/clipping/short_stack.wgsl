// The recursive short-stack form (section 5.4).

#import kanamori_peel::bernstein::{Curve, degree}
#import kanamori_peel::bezier::{
    before, cut, left_half, LOST, MOST_ITERATIONS, NARROWED, NO_ROOT, Piece, reaches_axis, right_half,
}
#import work::count_iterations

// Width, in parts of the interval, at which a range is a root.
@id(33) override width_of_root: f32 = 0.001;
// Ranges that can wait, from 1 to 4. Where one more has to, the furthest is dropped and made again
// from the whole curve when its turn comes.
@id(34) override stack_size: u32 = 3u;

const MOST_WAITING: u32 = 4u;

var<private> waiting: array<Piece, MOST_WAITING>;
var<private> waiting_count: u32;

fn first_root(whole: Curve) -> f32 {
    // Ranges with several sign changes may hold no root at all; here their hull is as narrow as
    // rounding.
    let width_of_touch = max(width_of_root * width_of_root, 1e-6);
    var piece = Piece(whole, 0.0, 1.0);
    var dropped_from = NO_ROOT;
    var holds_root = false;
    waiting_count = 0u;
    for (var iteration = 0u; iteration < MOST_ITERATIONS; iteration++) {
        count_iterations(1u);
        if piece.curve.d[0] >= 0.0 {
            return piece.low;
        }
        let changes = sign_changes(piece.curve);
        let width = piece.high - piece.low;
        if changes == 0u {
            // Only rounding can take away a root that a range was known to hold.
            if holds_root {
                return piece.high;
            }
            if waiting_count > 0u {
                waiting_count--;
                piece = waiting[waiting_count];
            } else if dropped_from < 1.0 {
                piece = cut(Piece(whole, 0.0, 1.0), dropped_from, 1.0);
                dropped_from = NO_ROOT;
            } else {
                return NO_ROOT;
            }
        } else if changes == 1u {
            if width <= width_of_root {
                return 0.5 * (piece.low + piece.high);
            }
            piece = clip(piece);
            holds_root = true;
        } else if width <= width_of_touch {
            return piece.low;
        } else {
            // Two or more roots perhaps: the range would not get narrower, so it is split at once.
            let right = right_half(piece);
            piece = left_half(piece);
            if reaches_axis(right.curve) {
                if waiting_count == stack_size {
                    dropped_from = waiting[0].low;
                    for (var k = 1u; k < stack_size; k++) {
                        waiting[k - 1u] = waiting[k];
                    }
                    waiting_count--;
                }
                waiting[waiting_count] = right;
                waiting_count++;
            }
        }
    }
    return LOST;
}

// Cuts away what the hull of the control points keeps below or above the axis (section 3.2). For a
// curve with one change of sign, from below.
fn clip(piece: Piece) -> Piece {
    var low = 1.0;
    var high = 0.0;
    let n = degree();
    for (var i = 0u; i < n; i++) {
        let from_below = piece.curve.d[i];
        if from_below >= 0.0 {
            break;
        }
        for (var j = n; j > i; j--) {
            let to_above = piece.curve.d[j];
            if to_above < 0.0 {
                break;
            }
            let share = from_below / (from_below - to_above);
            let crossing = (f32(i) + f32(j - i) * share) / f32(n);
            low = min(low, crossing);
            high = max(high, crossing);
        }
    }
    if high - low > NARROWED {
        // Too little: the half with the root is surely less.
        let left = before(piece.curve, 0.5);
        let is_left = left.d[n] >= 0.0;
        low = select(0.5, 0.0, is_left);
        high = select(1.0, 0.5, is_left);
    }
    return cut(piece, low, high);
}

fn sign_changes(curve: Curve) -> u32 {
    var changes = 0u;
    for (var i = 0u; i < degree(); i++) {
        changes += select(0u, 1u, (curve.d[i] >= 0.0) != (curve.d[i + 1u] >= 0.0));
    }
    return changes;
}
