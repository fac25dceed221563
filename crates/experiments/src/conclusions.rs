//! Which method to use for what, and how sure that is: three sentences from a run's own records.

use std::collections::BTreeMap;

use harness::methods::find;
use harness::numbers::{decimal, grouped};
use harness::record::{Measured, Record};
use harness::stats::median;

/// Three sentences about records, given scene by scene: what to use where every ray counts, what
/// where speed does, and how sure both are. Only presets are judged. Empty where nothing was
/// measured.
pub fn conclusions(scenes: &[&[Record]]) -> Vec<String> {
    let scenes: Vec<_> = scenes.iter().map(|records| Scene::new(records)).collect();
    let scenes: Vec<_> = scenes.into_iter().filter(|scene| !scene.presets.is_empty()).collect();
    let Some(careful) = careful(&scenes) else { return Vec::new() };
    let mut sentences = vec![exactness(&scenes, careful)];
    sentences.extend(speed(&scenes, careful));
    sentences.push(certainty(&scenes));
    sentences
}

/// The presets that have a result on one scene.
struct Scene<'a> {
    name: &'a str,
    presets: BTreeMap<&'a str, &'a Measured>,
}

impl<'a> Scene<'a> {
    fn new(records: &'a [Record]) -> Self {
        let presets = records
            .iter()
            .filter(|record| record.options.is_empty())
            .filter_map(|record| Some((record.method.as_str(), record.measured.as_ref()?)))
            .collect();
        Self { name: records.first().map_or("", |record| &record.scene), presets }
    }

    /// Methods by rising frame time.
    fn ranking(&self) -> Vec<&'a str> {
        let mut names: Vec<_> = self.presets.keys().copied().collect();
        names.sort_by(|a, b| self.ms(a).total_cmp(&self.ms(b)));
        names
    }

    fn fastest(&self) -> Option<&'a str> {
        self.ranking().first().copied()
    }

    /// The fastest of those without a wrong verdict.
    fn fastest_right(&self) -> Option<&'a str> {
        self.ranking().into_iter().find(|name| self.wrong(name) == 0)
    }

    fn ms(&self, method: &str) -> f64 {
        self.presets.get(method).map_or(f64::INFINITY, |measured| measured.frame_ms.median)
    }

    fn wrong(&self, method: &str) -> usize {
        self.presets.get(method).map_or(0, |measured| measured.accuracy.wrong_verdicts())
    }
}

/// The method for where every ray counts: fewest scenes without a result, then fewest wrong verdicts,
/// then most often the fastest that is right.
fn careful<'a>(scenes: &[Scene<'a>]) -> Option<&'a str> {
    let names = scenes.iter().flat_map(|scene| scene.presets.keys().copied());
    names.min_by_key(|name| {
        let missing = scenes.iter().filter(|scene| !scene.presets.contains_key(name)).count();
        let wrong: usize = scenes.iter().map(|scene| scene.wrong(name)).sum();
        let ahead = scenes.iter().filter(|scene| scene.fastest_right() == Some(name)).count();
        (missing, wrong, scenes.len() - ahead)
    })
}

fn exactness(scenes: &[Scene<'_>], careful: &str) -> String {
    let rays: usize = scenes
        .iter()
        .filter_map(|scene| scene.presets.get(careful))
        .map(|measured| measured.accuracy.rays)
        .sum();
    let wrong: usize = scenes.iter().map(|scene| scene.wrong(careful)).sum();
    let rays = grouped(rays);
    let wrong = match wrong {
        0 => format!("not one of {rays} rays is wrong"),
        wrong => format!("{} of {rays} rays are wrong, fewer than with any other", grouped(wrong)),
    };
    let ahead = scenes.iter().filter(|scene| scene.fastest_right() == Some(careful)).count();
    let others: Vec<_> = scenes
        .iter()
        .filter_map(|scene| Some((scene.name, scene.fastest_right()?)))
        .filter(|&(_, name)| name != careful)
        .map(|(scene, name)| format!("on {scene} {} is faster and right too", title(name)))
        .collect();
    let others = if others.is_empty() { String::new() } else { format!("; {}", others.join(", ")) };
    format!(
        "Where every ray counts use {}: {wrong}, and of the methods that are right it is the fastest \
         on {ahead} of {} scenes{others}.",
        title(careful),
        scenes.len()
    )
}

/// What the fastest method gains over the careful one, and what that costs.
fn speed(scenes: &[Scene<'_>], careful: &str) -> Option<String> {
    let fastest =
        scenes.iter().flat_map(|scene| scene.presets.keys().copied()).max_by_key(|name| {
            let first = scenes.iter().filter(|scene| scene.fastest() == Some(name)).count();
            (first, *name == careful)
        })?;
    let first = scenes.iter().filter(|scene| scene.fastest() == Some(fastest)).count();
    let count = scenes.len();
    if fastest == careful {
        return Some(format!(
            "Nothing is gained by giving that up: it is the fastest of all on {first} of {count} \
             scenes."
        ));
    }
    let ratios: Vec<_> = scenes
        .iter()
        .map(|scene| scene.ms(careful) / scene.ms(fastest))
        .filter(|ratio| ratio.is_finite())
        .collect();
    let (wrong, rays) = scenes.iter().filter_map(|scene| scene.presets.get(fastest)).fold(
        (0, 0),
        |(wrong, rays), measured| {
            (wrong + measured.accuracy.wrong_verdicts(), rays + measured.accuracy.rays)
        },
    );
    Some(format!(
        "Where speed counts for more {} is the fastest on {first} of {count} scenes: {} times as fast \
         at the median, with {} wrong rays in a million.",
        title(fastest),
        decimal(median(&ratios)?),
        decimal(1e6 * wrong as f64 / rays.max(1) as f64)
    ))
}

/// How far apart the first two are, and what cannot be known.
fn certainty(scenes: &[Scene<'_>]) -> String {
    let is_clear = |scene: &&Scene<'_>| match scene.ranking()[..] {
        [first, second, ..] => {
            scene.presets[first].frame_ms.p75 < scene.presets[second].frame_ms.p25
        }
        _ => true,
    };
    let clear = scenes.iter().filter(is_clear).count();
    let accuracies =
        scenes.iter().filter_map(|scene| scene.presets.values().next()).map(|m| &m.accuracy);
    let (ambiguous, rays) =
        accuracies.fold((0, 0), |(ambiguous, rays), a| (ambiguous + a.ambiguous, rays + a.rays));
    format!(
        "The first is ahead of the second by more than the quartiles of both on {clear} of {} scenes; \
         {} of {} rays are too close for the reference to call and count against no method; the times \
         are those of this machine.",
        scenes.len(),
        grouped(ambiguous),
        grouped(rays)
    )
}

fn title(name: &str) -> String {
    find(name).map_or_else(|| name.to_owned(), |method| format!("{} ({name})", method.title))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::measured_as;

    fn scene(name: &str, methods: &[(&str, f64, usize)]) -> Vec<Record> {
        methods.iter().map(|&(method, ms, wrong)| measured_as(name, method, ms, wrong)).collect()
    }

    #[test]
    fn the_exact_and_the_fast_are_distinguished() {
        let one =
            scene("one", &[("fbvh", 20.0, 3), ("fbvh-certified", 10.0, 0), ("illes", 5.0, 9)]);
        let two = scene("two", &[("fbvh", 8.0, 0), ("fbvh-certified", 9.0, 0), ("illes", 4.5, 1)]);
        let sentences = conclusions(&[&one, &two]);
        assert_eq!(sentences.len(), 3);
        assert!(sentences[0].contains("(fbvh-certified): not one of 8 rays is wrong"));
        assert!(sentences[0].contains("on 1 of 2 scenes; on two Fitted BVH (fbvh) is faster"));
        assert!(sentences[1].contains("(illes) is the fastest on 2 of 2 scenes: 2.00 times"));
        assert!(sentences[2].contains("on 2 of 2 scenes"), "{}", sentences[2]);
    }

    #[test]
    fn one_method_may_be_both() {
        let one = scene("one", &[("fbvh-certified", 4.0, 0), ("illes", 5.0, 9)]);
        let sentences = conclusions(&[&one]);
        assert!(sentences[1].starts_with("Nothing is gained"), "{}", sentences[1]);
        assert!(conclusions(&[]).is_empty() && conclusions(&[&[]]).is_empty());
    }
}
