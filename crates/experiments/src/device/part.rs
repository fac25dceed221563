//! The parts of a run, most important first: what is to be known even if no other part gets its time.

use std::collections::BTreeMap;

/// How large scenes and pictures are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// What a graphics processor takes minutes for.
    Whole,
    /// What software Vulkan takes seconds for, and canaries: parts that must fail.
    Rehearsal,
}

/// A part that is a command of no other name: `metaball device --part NAME`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnPart {
    /// Which adapter there is.
    Adapter,
    /// Every method on the small scenes, held to what it promises.
    Agreement,
    /// Lit pictures of the adapter beside those of the CPU.
    Light,
    /// Frame times by number of balls and size of the picture.
    Sizes,
    /// Frame times of effects.
    Effects,
    /// Panics.
    Panic,
    /// Does not end.
    Hang,
}

/// A command and what it is for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    /// Its name, and that of its folder.
    pub(super) name: &'static str,
    /// What it finds out.
    pub(super) about: &'static str,
    /// Its share of the time: seconds of eight minutes.
    pub(super) share: f64,
    /// The most seconds that it gets, whatever others leave of theirs.
    pub(super) most: f64,
    /// The arguments of this program, without adapter and folder; `None` where it needs an adapter and there
    /// is none.
    pub(super) arguments: Option<Vec<String>>,
    /// Variables of its environment.
    pub(super) environment: BTreeMap<String, String>,
    /// Whether it must fail.
    pub(super) is_canary: bool,
}

/// All parts of a run, with or without an adapter.
pub(super) fn plan(scale: Scale, has_adapter: bool) -> Vec<Part> {
    let mut parts = match scale {
        Scale::Whole => whole(),
        Scale::Rehearsal => rehearsal(),
    };
    if !has_adapter {
        parts.iter_mut().for_each(Part::leave_adapter);
    }
    parts
}

fn whole() -> Vec<Part> {
    let checked = "compare molecule tornado-4k dam-break --frames 20 --methods \
                   fbvh,fbvh-certified,kanamori-robust,illes-robust";
    vec![
        Part::new("agreement", AGREEMENT, 60.0, "device --part agreement"),
        Part::new("certify", CERTIFY, 40.0, "certify --rays 20000000 --seconds 30"),
        Part::new("light", LIGHT, 30.0, "device --part light"),
        Part::new("compare", COMPARE, 90.0, "compare --frames 20"),
        Part::new("sizes", SIZES, 120.0, "device --part sizes"),
        Part::new("checked", CHECKED, 30.0, checked).with(CHECKS, "on"),
        Part::new("density", DENSITY, 50.0, "chart --only density --frames 20 --fresh"),
        Part::new("effects", EFFECTS, 60.0, "device --part effects"),
    ]
}

fn rehearsal() -> Vec<Part> {
    let compare = "compare two-merging --size 32x24 --frames 2 --methods \
                   fbvh-certified,fbvh-certified-cpu";
    let density = "chart --only density --quick --size 16x12 --frames 2 --fresh --methods \
                   fbvh-certified,fbvh-certified-cpu";
    vec![
        Part::new("panic", "must fail", 2.0, "device --part panic").canary(),
        Part::new("agreement", AGREEMENT, 60.0, "device --rehearse --part agreement"),
        Part::new("certify", CERTIFY, 60.0, "certify --rays 1000 --quick --seconds 1"),
        Part::new("light", LIGHT, 60.0, "device --rehearse --part light"),
        Part::new("hang", "must be cut short", 2.0, "device --part hang").canary(),
        Part::new("compare", COMPARE, 60.0, compare),
        Part::new("sizes", SIZES, 60.0, "device --rehearse --part sizes"),
        Part::new("unchecked", UNCHECKED, 60.0, compare).with(CHECKS, "off"),
        Part::new("density", DENSITY, 60.0, density),
        Part::new("effects", EFFECTS, 60.0, "device --rehearse --part effects"),
    ]
}

const AGREEMENT: &str = "every method on the small scenes, held to what its paper promises";
const CERTIFY: &str = "the certified tree against the reference along hard rays";
const LIGHT: &str = "lit pictures of the adapter beside those of the CPU";
const COMPARE: &str = "frame times, passes and wrong verdicts of methods";
const SIZES: &str = "frame times by number of balls and size of the picture";
const CHECKED: &str = "the same with shaders that check indices and loops";
const UNCHECKED: &str = "the same with shaders that check neither indices nor loops";
const DENSITY: &str = "frame times by density";
const EFFECTS: &str = "frame times of effects";

/// The variable of [`ShaderChecks`](metaball_core::gpu::ShaderChecks).
const CHECKS: &str = "METABALL_SHADER_CHECKS";

impl Part {
    fn new(name: &'static str, about: &'static str, share: f64, line: &str) -> Self {
        let arguments = Some(line.split_whitespace().map(str::to_owned).collect());
        Self {
            name,
            about,
            share,
            most: f64::INFINITY,
            arguments,
            environment: BTreeMap::new(),
            is_canary: false,
        }
    }

    fn with(mut self, variable: &str, value: &str) -> Self {
        self.environment.insert(variable.to_owned(), value.to_owned());
        self
    }

    /// Must fail, or be cut short after two seconds.
    fn canary(self) -> Self {
        Self { is_canary: true, most: 2.0, ..self }
    }

    /// What the CPU does of it; nothing where it is of an adapter alone.
    fn leave_adapter(&mut self) {
        const OF_ADAPTERS: [&str; 4] = ["light", "checked", "unchecked", "effects"];
        if OF_ADAPTERS.contains(&self.name) {
            self.arguments = None;
        } else if let Some(arguments) = &mut self.arguments {
            arguments.push("--cpu".to_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_seconds_of_eight_minutes_and_correctness_comes_first() {
        let parts = plan(Scale::Whole, true);
        assert_eq!(parts.iter().map(|part| part.share).sum::<f64>(), 480.0);
        let names: Vec<_> = parts.iter().map(|part| part.name).collect();
        assert_eq!(names[..3], ["agreement", "certify", "light"]);
        assert!(parts.iter().all(|part| part.arguments.is_some() && !part.is_canary));
        for (index, part) in parts.iter().enumerate() {
            assert!(parts[..index].iter().all(|other| other.name != part.name));
        }
    }

    #[test]
    fn without_an_adapter_the_cpu_does_what_it_can() {
        for scale in [Scale::Whole, Scale::Rehearsal] {
            let parts = plan(scale, false);
            let (done, left): (Vec<_>, Vec<_>) =
                parts.iter().partition(|part| part.arguments.is_some());
            assert!(left.iter().any(|part| part.name == "light"));
            for arguments in done.iter().filter_map(|part| part.arguments.as_ref()) {
                assert_eq!(arguments.last().map(String::as_str), Some("--cpu"));
            }
            assert!(done.iter().any(|part| part.name == "certify"));
        }
    }

    /// A rehearsal rehearses every part, the one of shaders' checks the other way round.
    #[test]
    fn a_rehearsal_has_all_parts_and_canaries_among_them() {
        let names = |scale| -> Vec<_> {
            let parts = plan(scale, true).into_iter().filter(|part| !part.is_canary);
            parts.map(|part| part.name.trim_start_matches("un")).collect()
        };
        assert_eq!(names(Scale::Rehearsal), names(Scale::Whole));
        let parts = plan(Scale::Rehearsal, true);
        assert_eq!(parts.iter().filter(|part| part.is_canary).count(), 2);
        assert!(parts.last().is_some_and(|part| !part.is_canary), "others follow the canaries");
    }
}
