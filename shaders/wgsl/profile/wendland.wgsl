// Wendland's functions by the depth v: formulas of crates/metaball-core/src/kernel/profile.rs.

#import core::powers::power
#import profile::rim::place_at

// |d2k/dt2| R^2 along any line: at most 2 k', which is greatest at the centre, or 4 (1 - v) k''.
const WENDLAND_C2_BEND: f32 = 20.0;
const WENDLAND_C4_BEND: f32 = 18.7;
const WENDLAND_C6_BEND: f32 = 22.0;

fn wendland_c2(v: f32) -> f32 {
    let place = place_at(v);
    return power(place.to_rim, 4u) * (1.0 + 4.0 * place.ratio);
}

fn wendland_c2_slope(v: f32) -> f32 {
    return 10.0 * power(place_at(v).to_rim, 3u);
}

fn wendland_c4(v: f32) -> f32 {
    let place = place_at(v);
    let factor = 1.0 + place.ratio * (6.0 + (35.0 / 3.0) * place.ratio);
    return power(place.to_rim, 6u) * factor;
}

fn wendland_c4_slope(v: f32) -> f32 {
    let place = place_at(v);
    return power(place.to_rim, 5u) * ((28.0 / 3.0) * (1.0 + 5.0 * place.ratio));
}

fn wendland_c6(v: f32) -> f32 {
    let place = place_at(v);
    let factor = 1.0 + place.ratio * (8.0 + place.ratio * (25.0 + 32.0 * place.ratio));
    return power(place.to_rim, 8u) * factor;
}

fn wendland_c6_slope(v: f32) -> f32 {
    let place = place_at(v);
    let factor = 11.0 * (1.0 + place.ratio * (7.0 + 16.0 * place.ratio));
    return power(place.to_rim, 7u) * factor;
}
