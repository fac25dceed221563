//! Angles without the platform's maths library, whose sine and cosine differ in the last bit from
//! one system to the next: a generator must give the same balls everywhere.

use glam::DVec2;

/// (cos, sin) of an angle given in turns, to 1e-7, by additions and multiplications only.
pub(crate) fn turn(turns: f64) -> DVec2 {
    // An eighth of a turn to either side of the nearest quarter; there Taylor's series to the eighth
    // power of the cosine errs by (π/4)¹⁰/10! = 2.5e-8 at worst, and the sine's by less.
    let quarter = (4.0 * turns).round();
    let angle = (turns - 0.25 * quarter) * std::f64::consts::TAU;
    let square = angle * angle;
    let cos =
        1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
    let sin = angle
        * (1.0
            - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))));
    match quarter.rem_euclid(4.0) as u8 {
        0 => DVec2::new(cos, sin),
        1 => DVec2::new(-sin, cos),
        2 => DVec2::new(-cos, -sin),
        _ => DVec2::new(sin, -cos),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_cosine_and_sine() {
        for step in -1000..1000 {
            let turns = 0.003 * f64::from(step);
            let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
            // The bound of the series, above.
            assert!((turn(turns) - DVec2::new(cos, sin)).abs().max_element() < 3e-7);
        }
    }
}
