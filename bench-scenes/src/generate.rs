//! Generated scenes of any size: `name:count[:density[:seed]]`.
//!
//! A generator lays out balls and gives them relative sizes; their common scale follows from the
//! density, which means the same for all of them: the supports of so many other balls hold a ball's
//! centre, on average. All is made with exact operations from integers, so that a spec gives the
//! same balls on every platform. Some of them move: their still scene is frame 0.

mod cloud;
mod fountain;
mod generator;
mod lattice;
mod list;
mod mud;
mod pool;
mod recipe;
mod tornado;

pub use generator::Generator;
pub use list::generators;
pub(crate) use recipe::{Recipe, parse};

#[cfg(test)]
mod tests {
    use metaball_core::Scene;

    use super::*;
    use crate::{Overrides, load, mean_overlap};

    fn scene(spec: &str) -> Scene {
        load(spec, &Overrides::default()).expect("legal").scene
    }

    /// FNV-1a over the bits of all centres and radii.
    fn fingerprint(scene: &Scene) -> u64 {
        let numbers = scene.supports().iter().flat_map(|s| s.center.extend(s.radius).to_array());
        numbers
            .flat_map(|number| number.to_bits().to_le_bytes())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
            })
    }

    /// Records of different machines may only be compared if their balls are the same, to the bit.
    #[test]
    fn a_spec_is_the_same_scene_everywhere() {
        let found: Vec<(&str, u64)> = generators()
            .iter()
            .map(|generator| {
                (generator.name, fingerprint(&scene(&format!("{}:500", generator.name))))
            })
            .collect();
        let expected = [
            ("scattered", 0x39714a8416b30f93),
            ("random", 0x1ab5b387e5eb617a),
            ("tornado", 0xf57f9ed8e0b09073),
            ("pool", 0x32461d46e849d0ba),
            ("fountain", 0xd975846822022b5b),
            ("mud", 0x2dc38b66b2662ed4),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn seeds_and_counts_change_the_balls() {
        for generator in generators() {
            let name = generator.name;
            let [one, two] = [1, 2].map(|seed| scene(&format!("{name}:300:20:{seed}")));
            assert_eq!(one.len(), 300);
            assert_ne!(fingerprint(&one), fingerprint(&two));
        }
    }

    /// The density is set over the same pairs that it is measured over, up to 2,828 balls all of them:
    /// what remains is the rounding of the radius to f32, a pair or two.
    #[test]
    fn the_density_is_what_the_spec_says() {
        for generator in generators() {
            for density in [2.0, 50.0] {
                let scene = scene(&format!("{}:1000:{density}", generator.name));
                let found = mean_overlap(&scene);
                assert!((found - density).abs() < 0.005, "{}: {found}", generator.name);
            }
        }
    }
}
