//! How many pixels are drawn while the camera moves.

use std::time::Duration;

/// A frame that is drawn in this time leaves the window enough of a fifteenth of a second to show it.
const AIM: Duration = Duration::from_millis(45);

/// The least share of columns and rows: coarser pictures show nothing.
const COARSEST: f64 = 0.125;

/// Learns from each picture what a pixel takes.
#[derive(Debug, Default)]
pub(crate) struct Pace {
    seconds_a_pixel: Option<f64>,
}

impl Pace {
    /// The size at which a picture of this one is quick enough; a quarter of its pixels before any has
    /// been drawn.
    pub(crate) fn coarse(&self, (width, height): (u32, u32)) -> (u32, u32) {
        let pixels = f64::from(width) * f64::from(height);
        let share = match self.seconds_a_pixel {
            Some(seconds) => (AIM.as_secs_f64() / (seconds * pixels)).sqrt(),
            None => 0.5,
        };
        let share = share.clamp(COARSEST, 1.0);
        let of = |length: u32| ((f64::from(length) * share).round() as u32).max(1);
        (of(width), of(height))
    }

    /// Whether nothing has been drawn yet: then something coarse is soon better than something sharp later.
    pub(crate) fn is_new(&self) -> bool {
        self.seconds_a_pixel.is_none()
    }

    /// Learns that so many pixels took this long. A single picture that was held up by something else
    /// counts for half.
    pub(crate) fn learn(&mut self, pixels: usize, time: Duration) {
        let found = time.as_secs_f64().max(1e-6) / pixels.max(1) as f64;
        let known = self.seconds_a_pixel.unwrap_or(found);
        self.seconds_a_pixel = Some(0.5 * (known + found));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_pictures_get_fewer_pixels() {
        let mut pace = Pace::default();
        assert_eq!(pace.coarse((1280, 720)), (640, 360));
        pace.learn(1280 * 720, AIM);
        assert_eq!(pace.coarse((1280, 720)), (1280, 720));
        for _ in 0..20 {
            pace.learn(1280 * 720, 4 * AIM);
        }
        assert_eq!(pace.coarse((1280, 720)), (640, 360));
        for _ in 0..20 {
            pace.learn(10, AIM);
        }
        assert_eq!(pace.coarse((1280, 720)), (160, 90));
        assert_eq!(pace.coarse((1, 1)), (1, 1));
    }
}
