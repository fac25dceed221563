//! What a generator's spec makes: `name:count[:density[:seed]]`.

use glam::Vec3;
use metaball_core::{Metaball, Scene};
use particle_files::framing;

use super::generator::{Generator, Layout};
use super::list::generators;
use crate::bench_scene::{BenchScene, Kind};
use crate::density::{UnscaledBall, scale_for};
use crate::error::LoadError;
use crate::random::Random;

/// The seed of specs that name none.
const SEED: u64 = 1;

/// The most balls of a spec: 2²⁴, two gigabytes while they are laid out.
const MOST_BALLS: usize = 1 << 24;

/// What a spec says.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe {
    generator: &'static Generator,
    count: usize,
    density: f64,
    seed: u64,
}

/// What `name:count[:density[:seed]]` says; `None` when the first word is no generator's.
pub(crate) fn parse(spec: &str) -> Result<Option<Recipe>, LoadError> {
    let (name, numbers) = spec.split_once(':').unwrap_or((spec, ""));
    let Some(generator) = generators().iter().find(|generator| generator.name == name) else {
        return Ok(None);
    };
    let refused = |part: &str, needed: String, found: &str| LoadError::Parameter {
        name: format!("{part} of {spec:?}"),
        needed,
        found: format!("{found:?}"),
    };

    let mut numbers = numbers.split(':');
    let count = numbers.next().unwrap_or_default();
    let density = numbers.next();
    let seed = numbers.next();
    if let Some(more) = numbers.next() {
        return Err(refused("end", format!("{name}:count[:density[:seed]]"), more));
    }
    let count =
        count.parse().ok().filter(|count: &usize| *count <= MOST_BALLS).ok_or_else(|| {
            refused("count", format!("a number of balls up to {MOST_BALLS}"), count)
        })?;
    let density = match density {
        None => generator.density,
        Some(text) => text
            .parse()
            .ok()
            .filter(|d: &f64| *d > 0.0)
            .ok_or_else(|| refused("density", "a number above 0".to_owned(), text))?,
    };
    let seed = match seed {
        None => SEED,
        Some(text) => text
            .parse()
            .map_err(|_| refused("seed", "an integer from 0 to 2⁶⁴ − 1".to_owned(), text))?,
    };
    // A ball has at most all others around it.
    if density + 1.0 >= count as f64 {
        let needed = format!("more than {} balls for a density of {density}", density + 1.0);
        return Err(refused("count", needed, &count.to_string()));
    }
    Ok(Some(Recipe { generator, count, density, seed }))
}

impl Recipe {
    /// The still scene.
    pub(crate) fn scene(&self) -> Result<BenchScene, LoadError> {
        let balls = self.unscaled(0.0);
        let scene = self.scaled(&balls, scale_for(&balls, self.density))?;
        let (bounds, seen_from) = (scene.bounds(), self.generator.seen_from);
        Ok(BenchScene {
            name: self.name(),
            about: self.generator.about.to_owned(),
            camera: framing(&bounds, seen_from),
            path: (self.generator.path)(&bounds, seen_from),
            kind: Kind::General,
            scene,
            file: None,
        })
    }

    /// The same with all its parts named.
    pub(crate) fn name(&self) -> String {
        format!("{}:{}:{}:{}", self.generator.name, self.count, self.density, self.seed)
    }

    pub(crate) fn generator(&self) -> &'static Generator {
        self.generator
    }

    /// From the middle of the balls to the eye.
    pub(crate) fn seen_from(&self) -> Vec3 {
        self.generator.seen_from
    }

    /// The scale of the balls at all times: that of the still scene.
    pub(crate) fn scale(&self) -> f64 {
        scale_for(&self.unscaled(0.0), self.density)
    }

    /// The balls after so many seconds.
    pub(crate) fn at(&self, time: f64, scale: f64) -> Result<Scene, LoadError> {
        self.scaled(&self.unscaled(time), scale)
    }

    fn unscaled(&self, time: f64) -> Vec<UnscaledBall> {
        let random = &mut Random::new(self.seed);
        match self.generator.layout {
            Layout::Still(lay_out) => lay_out(self.count, random),
            Layout::Moving(lay_out) => lay_out(self.count, random, time),
        }
    }

    fn scaled(&self, balls: &[UnscaledBall], scale: f64) -> Result<Scene, LoadError> {
        let balls = balls
            .iter()
            .map(|ball| Metaball::new(ball.center.as_vec3(), (scale * ball.size) as f32));
        Ok(Scene::new(balls, self.generator.kernel, self.generator.threshold)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_name_the_part_of_the_spec() {
        let refusal = |spec: &str| parse(spec).expect_err("refused").to_string();
        assert_eq!(
            refusal("pool"),
            "count of \"pool\": needed a number of balls up to 16777216, found \"\""
        );
        assert!(refusal("pool:x").contains("found \"x\""));
        assert!(refusal("pool:99999999").contains("needed a number of balls up to"));
        assert!(
            refusal("pool:100:-1").starts_with("density of \"pool:100:-1\": needed a number above")
        );
        assert!(refusal("pool:100:NaN").starts_with("density"));
        assert!(refusal("pool:100:5:1.5").starts_with("seed"));
        assert!(refusal("pool:100:5:1:2").starts_with("end"));
        assert_eq!(
            refusal("pool:20"),
            "count of \"pool:20\": needed more than 46 balls for a density of 45, found \"20\""
        );
        assert!(refusal("pool:20:inf").contains("needed more than inf balls"));
        assert!(parse("lake:20").expect("not a generator").is_none());
    }
}
