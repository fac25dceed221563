//! Colours, sRGB-encoded and in linear light (IEC 61966-2-1).

use std::array;
use std::sync::LazyLock;

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
        let least = &*LEAST_LIGHT;
        let number = |light: f32| least.partition_point(|&least| least <= light) as u8;
        let [red, green, blue] = light.to_array().map(number);
        Self::srgb(red, green, blue)
    }

    /// Linear light with sRGB's primaries, each channel from 0 to 1.
    pub fn to_linear(self) -> Vec3 {
        let light = &*LIGHT;
        Vec3::from(self.to_srgb().map(|channel| light[usize::from(channel)]))
    }
}

/// The linear light of each number of a channel.
static LIGHT: LazyLock<[f32; 256]> =
    LazyLock::new(|| array::from_fn(|number| decode(number as f32 / 255.0)));

/// The least linear light that rounds to each number of a channel from 1 on: to be looked up, since a
/// power takes longer.
static LEAST_LIGHT: LazyLock<[f32; 255]> = LazyLock::new(|| {
    array::from_fn(|below| {
        let reaches = |light: f32| (0.5 + 255.0 * encode(light)) as usize > below;
        let mut least = decode((below as f32 + 0.5) / 255.0);
        while reaches(least) {
            least = least.next_down();
        }
        while !reaches(least) {
            least = least.next_up();
        }
        least
    })
});

/// sRGB's transfer function, for light from 0 to 1.
fn encode(light: f32) -> f32 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * libm::powf(light, 1.0 / 2.4) - 0.055 }
}

/// Its inverse.
fn decode(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
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
        assert_eq!(Color::from_linear(Vec3::NAN), Color::srgb(0, 0, 0));
    }

    /// Every float within 100 of a step, and others in between.
    #[test]
    fn what_is_looked_up_is_the_transfer_function() {
        let near = |step: &f32| step.to_bits() - 100..=step.to_bits() + 100;
        let steps = LEAST_LIGHT.iter().flat_map(near).map(f32::from_bits);
        let others = (0..=50_000u16).map(|step| f32::from(step) / 50_000.0);
        for light in steps.chain(others).filter(|light| *light <= 1.0) {
            let number = (0.5 + 255.0 * encode(light)) as u8;
            assert_eq!(Color::from_linear(Vec3::splat(light)), Color::srgb(number, number, number));
        }
    }
}
