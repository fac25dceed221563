//! Colours, sRGB-encoded and in linear light (IEC 61966-2-1).

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// An opaque colour, sRGB-encoded, eight bits a channel; the fourth byte is always 255, so that a
/// colour is one `u32` for WGSL's `unpack4x8unorm`.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct Color([u8; 4]);

impl Color {
    /// From sRGB-encoded channels.
    pub const fn srgb(red: u8, green: u8, blue: u8) -> Self {
        Self([red, green, blue, 255])
    }

    /// The sRGB-encoded channels: red, green, blue.
    pub const fn to_srgb(self) -> [u8; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The nearest colour to linear light with sRGB's primaries, each channel clamped to \[0, 1\].
    /// Rounds as WGSL's `pack4x8unorm`.
    pub fn from_linear(light: Vec3) -> Self {
        let [red, green, blue] = light.to_array().map(|light| {
            let light = light.clamp(0.0, 1.0);
            let encoded = if light <= 0.003_130_8 {
                light * 12.92
            } else {
                1.055 * libm::powf(light, 1.0 / 2.4) - 0.055
            };
            (0.5 + 255.0 * encoded) as u8
        });
        Self::srgb(red, green, blue)
    }

    /// Linear light with sRGB's primaries, each channel from 0 to 1.
    pub fn to_linear(self) -> Vec3 {
        Vec3::from(self.to_srgb().map(|channel| {
            let encoded = f32::from(channel) / 255.0;
            if encoded <= 0.04045 {
                encoded / 12.92
            } else {
                libm::powf((encoded + 0.055) / 1.055, 2.4)
            }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_light_goes_both_ways() {
        for byte in 0..=255 {
            let grey = Color::srgb(byte, byte, byte);
            assert_eq!(Color::from_linear(grey.to_linear()), grey);
        }
        // sRGB's 188 is half the light of white: 0.5028.
        assert_eq!(Color::from_linear(Vec3::new(0.5, 2.0, -1.0)), Color::srgb(188, 255, 0));
    }
}
