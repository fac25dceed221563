// As Nishita, Sederberg and Kakimoto 1990 have it, what section 5.4 builds on: every
// curve is clipped by its hull, and split in two where that does not narrow it. The recursion's stack is
// as deep as can be needed.

#import kanamori_peel::bernstein::{Curve, degree}
#import kanamori_peel::bezier::{
    cut, hull_on_axis, left_half, LOST, MOST_ITERATIONS, NARROWED, NO_ROOT, Piece, reaches_axis,
    right_half,
}
#import work::count_iterations

// Width, in parts of the interval, at which a range is a root.
@id(33) override width_of_root: f32 = 0.001;

// A range is halved each time that one more waits, and the narrowest root is 1e-6 > 2^-20 wide.
const MOST_WAITING: u32 = 20u;

var<private> waiting: array<Piece, MOST_WAITING>;

fn first_root(whole: Curve) -> f32 {
    var piece = Piece(whole, 0.0, 1.0);
    var waiting_count = 0u;
    for (var iteration = 0u; iteration < MOST_ITERATIONS; iteration++) {
        count_iterations(1u);
        if piece.curve.d[0] >= 0.0 {
            return piece.low;
        }
        if !reaches_axis(piece.curve) {
            if waiting_count == 0u {
                return NO_ROOT;
            }
            waiting_count--;
            piece = waiting[waiting_count];
        } else if piece.high - piece.low <= width_of_root {
            return 0.5 * (piece.low + piece.high);
        } else {
            let hull = hull_on_axis(piece.curve);
            if hull.y - hull.x > NARROWED {
                waiting[waiting_count] = right_half(piece);
                waiting_count++;
                piece = left_half(piece);
            } else {
                piece = cut(piece, hull.x, hull.y);
            }
        }
    }
    return LOST;
}
