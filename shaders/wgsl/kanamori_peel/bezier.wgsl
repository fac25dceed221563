// Curves in Bernstein form over parts of an interval, for the modules that clip them.

#import kanamori_peel::bernstein::{Curve, degree}

// Instead of a root in [0, 1]: there is none.
const NO_ROOT: f32 = 2.0;
// The iterations ran out, which no exact arithmetic can bring about.
const LOST: f32 = 3.0;
const MOST_ITERATIONS: u32 = 4096u;

// Clipping that leaves more than this of a range has not narrowed it (Nishita et al. 1990).
const NARROWED: f32 = 0.8;

// A curve over a part of the interval.
struct Piece {
    curve: Curve,
    low: f32,
    high: f32,
}

fn left_half(piece: Piece) -> Piece {
    return Piece(before(piece.curve, 0.5), piece.low, 0.5 * (piece.low + piece.high));
}

fn right_half(piece: Piece) -> Piece {
    return Piece(after(piece.curve, 0.5), 0.5 * (piece.low + piece.high), piece.high);
}

// The part of a piece between two parameters, 0 to 1.
fn cut(piece: Piece, low: f32, high: f32) -> Piece {
    let width = piece.high - piece.low;
    let curve = part(piece.curve, low, high);
    return Piece(curve, piece.low + low * width, piece.low + high * width);
}

// Parts of a range that the hull's is widened by at each end, so that rounding costs no root (the
// heuristic of Campagna et al. 1997).
const WIDENING: f32 = 0.001;

// Where the hull of the control points meets the axis (section 3.2), for a curve that begins below
// and reaches it.
fn hull_on_axis(curve: Curve) -> vec2<f32> {
    var range = vec2(1.0, 0.0);
    let n = degree();
    for (var i = 0u; i <= n; i++) {
        let below = curve.d[i];
        if below >= 0.0 {
            continue;
        }
        for (var j = 0u; j <= n; j++) {
            let above = curve.d[j];
            if above >= 0.0 {
                let crossing = mix(f32(i), f32(j), below / (below - above)) / f32(n);
                range = vec2(min(range.x, crossing), max(range.y, crossing));
            }
        }
    }
    return clamp(range + vec2(-WIDENING, WIDENING), vec2(0.0), vec2(1.0));
}

fn reaches_axis(curve: Curve) -> bool {
    var greatest = curve.d[0];
    for (var i = 1u; i <= degree(); i++) {
        greatest = max(greatest, curve.d[i]);
    }
    return greatest >= 0.0;
}

// The curve from `low` to `high`, 0 <= low <= high <= 1, by two subdivisions of de Casteljau.
fn part(curve: Curve, low: f32, high: f32) -> Curve {
    let rest = 1.0 - low;
    if rest <= 0.0 {
        return after(curve, 1.0);
    }
    return before(after(curve, low), min((high - low) / rest, 1.0));
}

// The curve from 0 to u.
fn before(curve: Curve, u: f32) -> Curve {
    var result = curve;
    let n = degree();
    for (var round = 1u; round <= n; round++) {
        for (var i = n; i >= round; i--) {
            result.d[i] = mix(result.d[i - 1u], result.d[i], u);
        }
    }
    return result;
}

// The curve from u to 1.
fn after(curve: Curve, u: f32) -> Curve {
    var result = curve;
    let n = degree();
    for (var round = 1u; round <= n; round++) {
        for (var i = 0u; i <= n - round; i++) {
            result.d[i] = mix(result.d[i], result.d[i + 1u], u);
        }
    }
    return result;
}
