//! Scenes that move: a scene for each frame.

use std::ops::Range;
use std::path::Path;

use glam::Vec3;
use metaball_core::{Aabb, Camera, Kernel, Metaball, Scene};

use crate::cameras::framing;
use crate::error::LoadError;
use crate::exact::turn;
use crate::file::{self, FileKind};
use crate::generate::{self, Recipe};
use crate::known::KnownScene;
use crate::load::{Overrides, open_scene_file, overridden, particles_in, scene_of};
use crate::numbered::NumberedPath;
use crate::packed_frames::PackedFrames;
use crate::particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD};
use crate::{generators, known};

/// Frames to a second of generated motion and of the scene `splash`. The molecule's motion has no time of
/// its own, and users' frames have the time that they say.
pub const FRAME_RATE: u32 = 24;

/// Frames of the molecule's motion until it comes round.
const SWAY: u32 = 96;

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
    /// The frames there are; of a motion that goes on for ever, the first few seconds.
    pub frames: Range<u32>,
    motion: Motion,
    overrides: Overrides,
}

/// Where frames come from.
#[derive(Debug)]
enum Motion {
    /// For ever.
    Generated { recipe: Recipe, scale: f64 },
    /// For ever, round and round: a still scene and how far its balls go.
    Swaying { rest: Scene, modes: PackedFrames },
    /// Frames of equal balls.
    Packed { frames: PackedFrames, kernel: Kernel, threshold: f32 },
    /// A file for each frame. Where files leave the radius to the particles' spacing, all frames have
    /// the same: a surface does not breathe, and shaders are made once.
    Files {
        files: NumberedPath,
        kind: FileKind,
        kernel: Kernel,
        threshold: f32,
        spaced_radius: Option<f32>,
    },
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
    /// The moving scene of a spec: a name of [`moving()`], the spec of a generator that moves, a
    /// particle file for each frame (`fluid-%04d.xyz`), a scene file that names such particles, or a
    /// `.frames` file. The numbers of files are those of frames.
    ///
    /// The camera of files is the scene file's, or one that frames the first and the last of them. Where
    /// they leave the radius to the particles' spacing, that of the first readable file is every frame's.
    ///
    /// # Errors
    /// As [`load`](crate::load()); and where the spec's scene does not move.
    pub fn load(spec: &str, overrides: &Overrides) -> Result<Self, LoadError> {
        let path = Path::new(spec);
        let named = moving().iter().find(|(name, _)| *name == spec);
        let mut moving = if let Some((name, about)) = named {
            Self { name: (*name).to_owned(), about: (*about).to_owned(), ..of_name(name)? }
        } else if let Some(recipe) = generate::parse(spec)? {
            Self::generated(recipe)?
        } else {
            match FileKind::of(path) {
                Some(FileKind::Frames) => Self::packed(spec, &file::read(path)?)?,
                Some(FileKind::SceneFile) => Self::of_scene_file(path)?,
                Some(kind) if spec.contains('%') => {
                    Self::files(path, kind, DEFAULT_KERNEL, DEFAULT_THRESHOLD, None)?
                }
                _ => return Err(still(spec)),
            }
        };
        moving.overrides = *overrides;
        Ok(moving)
    }

    /// The balls of a frame.
    ///
    /// # Errors
    /// When there is no such frame, or its file cannot be used: names it.
    pub fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        overridden(self.motion.frame(number)?, &self.overrides)
    }

    /// The numbers of frames in a range for which there is something to draw: of a sequence of files
    /// those that are there, of all others the whole range.
    ///
    /// # Errors
    /// When the files' folder cannot be read.
    pub fn present(&self, range: Range<u32>) -> Result<Vec<u32>, LoadError> {
        match &self.motion {
            Motion::Files { files, .. } => {
                let numbers = numbers(files)?;
                Ok(numbers.into_iter().filter(|number| range.contains(number)).collect())
            }
            Motion::Packed { frames, .. } => {
                Ok((range.start..range.end.min(frames.len())).collect())
            }
            Motion::Generated { .. } | Motion::Swaying { .. } => Ok(range.collect()),
        }
    }

    fn new(
        name: String,
        motion: Motion,
        frames: Range<u32>,
        seen_from: Vec3,
        seen: &[u32],
    ) -> Result<Self, LoadError> {
        let mut bounds = Aabb::EMPTY;
        for number in seen {
            bounds = bounds.union(&motion.frame(*number)?.bounds());
        }
        Ok(Self {
            about: format!("The frames of {name}."),
            name,
            camera: framing(&bounds, seen_from),
            frames,
            motion,
            overrides: Overrides::default(),
        })
    }

    fn generated(recipe: Recipe) -> Result<Self, LoadError> {
        let (name, seen_from) = (recipe.name(), recipe.seen_from());
        if !recipe.generator().moves() {
            return Err(still(&name));
        }
        let motion = Motion::Generated { scale: recipe.scale(), recipe };
        let seconds = [0, 1, 2, 3].map(|second| second * FRAME_RATE);
        Self::new(name, motion, 0..4 * FRAME_RATE, seen_from, &seconds)
    }

    fn packed(name: &str, bytes: &[u8]) -> Result<Self, LoadError> {
        let frames = PackedFrames::parse(bytes).map_err(|flaw| flaw.in_file(name))?;
        let all: Vec<u32> = (0..frames.len()).collect();
        let motion =
            Motion::Packed { frames, kernel: DEFAULT_KERNEL, threshold: DEFAULT_THRESHOLD };
        let range = 0..all.len() as u32;
        Self::new(name.to_owned(), motion, range, Vec3::new(0.4, 0.3, 1.0), &all)
    }

    fn of_scene_file(path: &Path) -> Result<Self, LoadError> {
        let (scene_file, table, kind) = open_scene_file(path)?;
        let name = path.display().to_string();
        if !scene_file.particles.contains('%') {
            return Err(still(&name));
        }
        let crate::scene_file::SceneFile { kernel, threshold, camera, .. } = scene_file;
        Ok(Self { name, ..Self::files(&table, kind, kernel, threshold, camera)? })
    }

    fn files(
        path: &Path,
        kind: FileKind,
        kernel: Kernel,
        threshold: f32,
        camera: Option<Camera>,
    ) -> Result<Self, LoadError> {
        let name = path.display().to_string();
        let files: NumberedPath = name.parse()?;
        let numbers = numbers(&files)?;
        let (Some(first), Some(last)) = (numbers.first(), numbers.last()) else {
            return Err(LoadError::Parameter {
                name,
                needed: "at least one file of this name".to_owned(),
                found: "none".to_owned(),
            });
        };
        let seen = if camera.is_some() { vec![] } else { vec![*first, *last] };
        let readable = |number: &u32| particles_in(&files.path(*number), kind).ok();
        let spaced_radius = numbers.iter().find_map(readable).and_then(|first| first.spaced_radius);
        let motion = Motion::Files { files, kind, kernel, threshold, spaced_radius };
        let range = *first..last.saturating_add(1);
        let framed = Self::new(name, motion, range, Vec3::new(0.4, 0.3, 1.0), &seen)?;
        Ok(Self { camera: camera.unwrap_or(framed.camera), ..framed })
    }
}

impl Motion {
    fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        match self {
            Self::Generated { recipe, scale } => {
                recipe.at(f64::from(number) / f64::from(FRAME_RATE), *scale)
            }
            Self::Swaying { rest, modes } => swayed(rest, modes, number),
            Self::Packed { frames, kernel, threshold } => {
                if number >= frames.len() {
                    return Err(LoadError::Parameter {
                        name: "frame".to_owned(),
                        needed: format!("a number below {}", frames.len()),
                        found: number.to_string(),
                    });
                }
                let balls = frames.frame(number).balls;
                Ok(Scene::new(balls, *kernel, *threshold)?)
            }
            Self::Files { files, kind, kernel, threshold, spaced_radius } => {
                let path = files.path(number);
                let particles = particles_in(&path, *kind)?;
                let particles = match spaced_radius {
                    Some(radius) => particles.respaced(*radius),
                    None => particles,
                };
                scene_of(particles, &path, *kernel, *threshold)
            }
        }
    }
}

/// Every ball at its place of rest plus its share of each mode, the softest of which swings once
/// while the motion comes round, the next twice, and so on: at frame 0 all are at rest.
fn swayed(rest: &Scene, modes: &PackedFrames, number: u32) -> Result<Scene, LoadError> {
    let mut balls: Vec<Metaball> = rest.balls().collect();
    for mode in 0..modes.len() {
        let phase = (mode + 1) * (number % SWAY);
        let swing = turn(f64::from(phase) / f64::from(SWAY)).y as f32;
        for (ball, displaced) in balls.iter_mut().zip(modes.frame(mode).balls) {
            ball.center += swing * displaced.center;
        }
    }
    let scene = Scene::new(balls, rest.kernel(), rest.threshold())?;
    match rest.colors() {
        Some(colors) => Ok(scene.with_colors(colors.to_vec())?),
        None => Ok(scene),
    }
}

fn of_name(name: &str) -> Result<Moving, LoadError> {
    match name {
        "splash" => {
            let splash = Moving::packed("splash.frames", include_bytes!("../data/splash.frames"))?;
            // The tank seen from its front, with room for what climbs its right wall.
            let camera = Camera::look_at(
                Vec3::new(2.0, 1.5, 3.4),
                Vec3::new(0.86, 0.62, 0.45),
                Vec3::Y,
                38.0,
            )?;
            Ok(Moving { camera, ..splash })
        }
        "molecule" => {
            const MODES: &str = "md_1u19-modes.frames";
            let bytes = include_bytes!("../data/md_1u19-modes.frames");
            let modes = PackedFrames::parse(bytes).map_err(|flaw| flaw.in_file(MODES))?;
            let still = crate::load(name, &Overrides::default())?;
            let motion = Motion::Swaying { rest: still.scene, modes };
            let sway = Moving::new(name.to_owned(), motion, 0..SWAY, Vec3::X, &[])?;
            Ok(Moving { camera: still.camera, ..sway })
        }
        _ => match known().iter().find(|known| known.name == name).and_then(KnownScene::spec) {
            Some(spec) => generate::parse(spec)?.map_or(Err(still(name)), Moving::generated),
            None => Err(still(name)),
        },
    }
}

fn numbers(files: &NumberedPath) -> Result<Vec<u32>, LoadError> {
    let file = files.path(0).parent().map(Path::to_owned).unwrap_or_default();
    files.numbers().map_err(|source| LoadError::Read { file: file.display().to_string(), source })
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
