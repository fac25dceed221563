// The B-splines of SPH by the depth v: formulas of crates/metaball-core/src/kernel/profile.rs.

#import core::powers::power
#import profile::rim::{place_at, Place}

// |d2k/dt2| R^2 along any line: at most 2 k', which is greatest at the centre, or 4 (1 - v) k''.
const CUBIC_SPLINE_BEND: f32 = 12.0;
const QUINTIC_SPLINE_BEND: f32 = 16.4;

fn cubic_spline(v: f32) -> f32 {
    let place = place_at(v);
    if place.ratio < 0.5 {
        return 1.0 - 6.0 * (place.ratio * place.ratio * place.to_rim);
    }
    return 2.0 * power(place.to_rim, 3u);
}

fn cubic_spline_slope(v: f32) -> f32 {
    let place = place_at(v);
    if place.ratio < 0.5 {
        return 6.0 - 9.0 * place.ratio;
    }
    return 3.0 * place.to_rim * place.to_rim / place.ratio;
}

// How far 3 rho is from the knots at 3 and at 2, and 0 behind them.
fn to_knots(place: Place) -> vec2<f32> {
    let to_rim = 3.0 * place.to_rim;
    return vec2(to_rim, max(to_rim - 1.0, 0.0));
}

fn quintic_spline(v: f32) -> f32 {
    let place = place_at(v);
    let q = 3.0 * place.ratio;
    if q < 1.0 {
        let square = q * q;
        return (66.0 - square * (60.0 - square * (30.0 - 10.0 * q))) * (1.0 / 66.0);
    }
    let knots = to_knots(place);
    return (power(knots.x, 5u) - 6.0 * power(knots.y, 5u)) * (1.0 / 66.0);
}

fn quintic_spline_slope(v: f32) -> f32 {
    let place = place_at(v);
    let q = 3.0 * place.ratio;
    if q < 1.0 {
        return (60.0 - q * q * (60.0 - 25.0 * q)) * (9.0 / 66.0);
    }
    let knots = to_knots(place);
    return (2.5 * power(knots.x, 4u) - 15.0 * power(knots.y, 4u)) / q * (9.0 / 66.0);
}
