//! Scenes that move: a scene for each frame.

use std::ops::Range;

use glam::Vec3;
use metaball_core::{Aabb, Camera, Scene};
use particle_files::{
    AnimatedScene, BoxError, Cell, Notes, Overrides, PackedFrames, ReadOptions, Sequence, framing,
};

use crate::error::LoadError;
use crate::generate::{self, Recipe};
use crate::known::KnownScene;
use crate::load::{check_unread, is_word};
use crate::vibration::Vibration;
use crate::{generators, known};

/// Frames to a second of generated motion and of the scene `splash`. The molecule's motion has no time of
/// its own, and users' frames have the time that they say.
pub const FRAME_RATE: u32 = 24;

/// A scene that moves. Frames are independent of each other: any can be had, in any order and from
/// any thread, and is the same each time.
#[derive(Debug)]
pub struct Moving {
    /// A known name, a generator's spec in full, or the path of a file.
    pub name: String,
    /// One sentence on what it shows.
    pub about: String,
    /// A camera that sees all frames.
    pub camera: Camera,
    /// The frames there are; of a motion without end, the first few seconds.
    pub frames: Range<u32>,
    motion: Motion,
    overrides: Overrides,
}

/// Where frames come from.
#[derive(Debug)]
enum Motion {
    /// Without end.
    Generated { recipe: Recipe, scale: f64 },
    /// Without end, periodic.
    Vibrating(Vibration),
    /// Files.
    Sequence(Box<Sequence>),
}

/// The moving scenes that have a name, each with one sentence on what it shows. Generators that
/// [move](crate::Generator::moves), numbered files and `.frames` files move too.
pub fn moving() -> &'static [(&'static str, &'static str)] {
    &[
        ("molecule", "Rhodopsin swaying along the softest modes of an elastic network."),
        ("splash", "A simulated column of water that falls into a tank, 5,320 particles."),
        ("tornado-4k", "A turning tornado of 4,000 balls."),
        ("tornado-128k", "A turning tornado of 128,000 balls."),
    ]
}

impl Moving {
    /// The moving scene of a spec: a name of [`moving()`], the spec of a generator that moves, or the path
    /// of a [`Sequence`].
    ///
    /// # Errors
    /// As [`load`](crate::load()); and where the spec's scene does not move.
    pub fn load(spec: &str, overrides: &Overrides) -> Result<Self, LoadError> {
        Self::load_as(spec, &ReadOptions::default(), overrides)
    }

    /// The same; files are read so.
    ///
    /// # Errors
    /// As [`Moving::load`]; and where options are given for a scene of no file.
    pub fn load_as(
        spec: &str,
        options: &ReadOptions,
        overrides: &Overrides,
    ) -> Result<Self, LoadError> {
        let named = moving().iter().find(|(name, _)| *name == spec);
        let moving = if let Some((name, about)) = named {
            check_unread(spec, options)?;
            Self { name: (*name).to_owned(), about: (*about).to_owned(), ..of_name(name)? }
        } else if let Some(recipe) = generate::parse(spec)? {
            check_unread(spec, options)?;
            Self::generated(recipe)?
        } else {
            Self::of_sequence(open_sequence(spec, options)?)
        };
        Ok(Self { overrides: *overrides, ..moving })
    }

    /// The balls of a frame.
    ///
    /// # Errors
    /// When there is no such frame, or its file cannot be used: names it.
    pub fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        Ok(self.overrides.apply(self.motion.frame(number)?)?)
    }

    /// The numbers of frames in a range for which there is something to draw: of a sequence of files
    /// those that are there, of all others the whole range.
    ///
    /// # Errors
    /// When the files' folder cannot be read.
    pub fn present(&self, range: Range<u32>) -> Result<Vec<u32>, LoadError> {
        match &self.motion {
            Motion::Sequence(sequence) => Ok(sequence.present(range)?),
            Motion::Generated { .. } | Motion::Vibrating(_) => Ok(range.collect()),
        }
    }

    /// The periodic cell of the first frame of a file.
    pub fn cell(&self) -> Option<Cell> {
        match &self.motion {
            Motion::Sequence(sequence) => sequence.cell(),
            Motion::Generated { .. } | Motion::Vibrating(_) => None,
        }
    }

    fn new(name: String, motion: Motion, frames: Range<u32>, camera: Camera) -> Self {
        let about = format!("The frames of {name}.");
        Self { name, about, camera, frames, motion, overrides: Overrides::default() }
    }

    fn generated(recipe: Recipe) -> Result<Self, LoadError> {
        let name = recipe.name();
        if !recipe.generator().moves() {
            return Err(still(&name));
        }
        let seen_from = recipe.seen_from();
        let motion = Motion::Generated { scale: recipe.scale(), recipe };
        let mut bounds = Aabb::EMPTY;
        for second in 0..4 {
            bounds = bounds.union(&motion.frame(second * FRAME_RATE)?.bounds());
        }
        Ok(Self::new(name, motion, 0..4 * FRAME_RATE, framing(&bounds, seen_from)))
    }

    fn of_sequence(sequence: Sequence) -> Self {
        let (name, camera) = (sequence.name().to_owned(), *sequence.camera());
        let frames = sequence.frames();
        Self::new(name, Motion::Sequence(Box::new(sequence)), frames, camera)
    }
}

impl AnimatedScene for Moving {
    fn name(&self) -> &str {
        &self.name
    }

    fn description(&self) -> String {
        let source = match &self.motion {
            Motion::Sequence(sequence) => sequence.description(),
            Motion::Generated { .. } | Motion::Vibrating(_) => self.name.clone(),
        };
        format!("{source} with {:?}", self.overrides)
    }

    fn camera(&self) -> &Camera {
        &self.camera
    }

    fn frames(&self) -> Range<u32> {
        self.frames.clone()
    }

    fn notes(&self) -> Option<&Notes> {
        match &self.motion {
            Motion::Sequence(sequence) => Some(sequence.notes()),
            Motion::Generated { .. } | Motion::Vibrating(_) => None,
        }
    }

    fn present(&self, range: Range<u32>) -> Result<Vec<u32>, BoxError> {
        Ok(self.present(range)?)
    }

    fn frame(&self, number: u32) -> Result<Scene, BoxError> {
        Ok(self.frame(number)?)
    }
}

impl Motion {
    fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        match self {
            Self::Generated { recipe, scale } => {
                recipe.at(f64::from(number) / f64::from(FRAME_RATE), *scale)
            }
            Self::Vibrating(vibration) => vibration.frame(number),
            Self::Sequence(sequence) => Ok(sequence.frame(number)?),
        }
    }
}

fn of_name(name: &str) -> Result<Moving, LoadError> {
    match name {
        "splash" => {
            let frames = PackedFrames::parse(include_bytes!("../data/splash.frames"))?;
            let splash = Sequence::packed("splash.frames", frames, &Overrides::default())?;
            // The tank seen from its front, with space for what climbs its right wall.
            let camera = Camera::look_at(
                Vec3::new(2.0, 1.5, 3.4),
                Vec3::new(0.86, 0.62, 0.45),
                Vec3::Y,
                38.0,
            )?;
            Ok(Moving { camera, ..Moving::of_sequence(splash) })
        }
        "molecule" => {
            let modes = PackedFrames::parse(include_bytes!("../data/md_1u19-modes.frames"))?;
            let still = crate::load(name, &Overrides::default())?;
            let motion = Motion::Vibrating(Vibration { rest: still.scene, modes });
            Ok(Moving::new(name.to_owned(), motion, 0..Vibration::PERIOD, still.camera))
        }
        _ => match known().iter().find(|known| known.name == name).and_then(KnownScene::spec) {
            Some(spec) => generate::parse(spec)?.map_or(Err(still(name)), Moving::generated),
            None => Err(still(name)),
        },
    }
}

fn open_sequence(spec: &str, options: &ReadOptions) -> Result<Sequence, LoadError> {
    if is_word(spec) {
        return Err(still(spec));
    }
    Ok(Sequence::open(spec, options, &Overrides::default())?)
}

fn still(spec: &str) -> LoadError {
    let generators = generators().iter().filter(|generator| generator.moves());
    let generators: Vec<_> = generators.map(|generator| generator.name).collect();
    let known: Vec<_> = moving().iter().map(|(name, _)| *name).collect();
    LoadError::Still {
        spec: spec.to_owned(),
        known: known.join(", "),
        generators: generators.join(", "),
    }
}
