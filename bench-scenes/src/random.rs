//! Random numbers that are the same on every platform.

use glam::DVec3;

/// SplitMix64 (Steele, Lea and Flood 2014): 64 bits of state, integer arithmetic only, a good
/// sequence from any seed. Real numbers are made with exact operations alone.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Uniform in \[0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1u64 << 53) as f64;
        (self.bits() >> 11) as f64 * STEP
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Between −1 and 1, most often near 0: the sum of two uniform numbers.
    pub fn triangular(&mut self) -> f64 {
        self.unit() + self.unit() - 1.0
    }

    /// Uniform in the box from −half to half.
    pub fn in_box(&mut self, half: DVec3) -> DVec3 {
        let [x, y, z] = half.to_array().map(|half| self.between(-half, half));
        DVec3::new(x, y, z)
    }

    /// One of some things, each as likely as the others. Panics when there is none.
    pub fn one_of<T: Copy>(&mut self, things: &[T]) -> T {
        things[(self.unit() * things.len() as f64) as usize]
    }

    /// A unit vector, any as likely as another.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let point = self.in_ball();
            if point.length_squared() > 1e-4 {
                return point.normalize();
            }
        }
    }

    /// Uniform in the unit ball, by rejection.
    pub fn in_ball(&mut self) -> DVec3 {
        loop {
            let point = self.in_box(DVec3::ONE);
            if point.length_squared() <= 1.0 {
                return point;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_sequence() {
        // The first outputs for seed 1234567 of the reference implementation (Vigna, splitmix64.c).
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn numbers_stay_in_their_ranges() {
        let mut random = Random::new(0);
        for _ in 0..10_000 {
            assert!((0.0..1.0).contains(&random.unit()));
            assert!(random.triangular().abs() <= 1.0);
            assert!(random.in_ball().length_squared() <= 1.0);
            assert!((random.direction().length() - 1.0).abs() < 1e-12);
            assert!([3, 5].contains(&random.one_of(&[3, 5])));
        }
    }
}
