//! Low-discrepancy numbers on the host: the twin of `light/sampling.wgsl` and of the tent in
//! `light/start.wgsl`, for a picture whose pixels all share one sample's shift.

/// How far sample `index` of a picture is moved, in pixels to the right and up: from −1 to 1 each,
/// with the density of a tent.
pub(crate) fn shift(index: u32, seed: u32) -> (f32, f32) {
    let shift_x = hash(seed);
    let shift_y = hash(shift_x);
    // Roberts' sequence R2, as fractions of 2^32.
    let x = shift_x.wrapping_add(index.wrapping_mul(3_242_174_889));
    let y = shift_y.wrapping_add(index.wrapping_mul(2_447_445_414));
    (tent(x), tent(y))
}

fn tent(fraction: u32) -> f32 {
    let x = 2.0 * ((fraction >> 8) as f32 / (1u32 << 24) as f32) - 1.0;
    (1.0 - (1.0 - x.abs()).sqrt()).copysign(x)
}

/// PCG's output function (Jarzynski and Olano 2020).
fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shifts_fill_the_tent_evenly() {
        let shifts: Vec<_> = (0..256).map(|index| shift(index, 5)).collect();
        let mean = |of: fn(&(f32, f32)) -> f32| shifts.iter().map(of).sum::<f32>() / 256.0;
        assert!(mean(|shift| shift.0).abs() < 0.02 && mean(|shift| shift.1).abs() < 0.02);
        // The variance of a tent from −1 to 1 is 1/6.
        assert!((mean(|shift| shift.0 * shift.0) - 1.0 / 6.0).abs() < 0.01);
        assert!(shifts.iter().all(|(x, y)| x.abs() <= 1.0 && y.abs() <= 1.0));
        assert_ne!(shift(0, 5), shift(0, 6));
    }
}
