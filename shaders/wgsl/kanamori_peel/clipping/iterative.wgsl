// Without a stack, what section 5.4 replaces: the paper describes the form of Pabst et al. 2006 as
// iterative, with few registers and more iterations. Here a range and where it was split off are all that
// is kept; what lies behind is made again from the whole curve once the range holds no root.

#import kanamori_peel::bernstein::{Curve, degree}
#import kanamori_peel::bezier::{
    cut, hull_on_axis, left_half, LOST, MOST_ITERATIONS, NARROWED, NO_ROOT, Piece, reaches_axis,
}
#import work::count_iterations

// Width, in parts of the interval, at which a range is a root.
@id(33) override width_of_root: f32 = 0.001;

fn first_root(whole: Curve) -> f32 {
    var piece = Piece(whole, 0.0, 1.0);
    var split_at = 1.0;
    for (var iteration = 0u; iteration < MOST_ITERATIONS; iteration++) {
        count_iterations(1u);
        if piece.curve.d[0] >= 0.0 {
            return piece.low;
        }
        if !reaches_axis(piece.curve) {
            if split_at >= 1.0 {
                return NO_ROOT;
            }
            piece = cut(Piece(whole, 0.0, 1.0), split_at, 1.0);
            split_at = 1.0;
        } else if piece.high - piece.low <= width_of_root {
            return 0.5 * (piece.low + piece.high);
        } else {
            let hull = hull_on_axis(piece.curve);
            if hull.y - hull.x > NARROWED {
                piece = left_half(piece);
                split_at = piece.high;
            } else {
                piece = cut(piece, hull.x, hull.y);
            }
        }
    }
    return LOST;
}
