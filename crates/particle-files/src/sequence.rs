//! Sequences: particles that move, a scene for each frame.

use std::ops::Range;
use std::path::Path;

use glam::DVec3;
use metaball_core::{Aabb, Camera, Scene};

use crate::animated_scene::{AnimatedScene, BoxError};
use crate::cell::Cell;
use crate::error::LoadError;
use crate::file;
use crate::formats::PackedFrames;
use crate::framing::{FRONT, framed, framing};
use crate::load::Source;
use crate::notes::Notes;
use crate::numbered_path::NumberedPath;
use crate::options::{ReadOptions, parameter};
use crate::overrides::Overrides;
use crate::particles::Particles;
use crate::read::{Content, read};
use crate::surface::Surface;

/// The frames of files. They are independent of each other: any can be had, in any order and from any
/// thread, and is the same each time as long as its file is.
#[derive(Debug)]
pub struct Sequence {
    name: String,
    camera: Camera,
    range: Range<u32>,
    files: Files,
    common: Common,
    overrides: Overrides,
    notes: Notes,
    cell: Option<Cell>,
}

/// Where the particles of frames come from.
#[derive(Debug)]
enum Files {
    /// A file for each frame.
    Numbered(NumberedPath, ReadOptions),
    /// One that holds many.
    One(Content<'static>, ReadOptions),
    /// One packed file with all of them.
    Packed(PackedFrames),
}

/// What all frames have in common.
#[derive(Debug)]
struct Common {
    /// Where a formula finds a threshold, all frames have that of the first.
    surface: Surface,
    /// Where files leave the radius to the particles' spacing, all frames have the same: a surface does
    /// not breathe, and shaders are made once.
    spacing_radius: Option<f32>,
    /// Where the coordinates of all scenes begin.
    origin: Option<DVec3>,
}

impl Sequence {
    /// The sequence of a particle file for each frame (`fluid-%04d.xyz`, a [`NumberedPath`] whose numbers
    /// are those of frames), of one file that holds many frames, of a scene file that names such
    /// particles, or of a `.frames` file.
    ///
    /// The camera is the scene file's, or one that frames the first and the last frame. Where files leave
    /// the radius to the particles' spacing, that of the first readable frame is every frame's; so is its
    /// scene's origin.
    ///
    /// # Errors
    /// [`LoadError::NotASequence`] where there is only one scene; else as [`load`](crate::load()).
    pub fn open(
        path: impl AsRef<Path>,
        options: &ReadOptions,
        overrides: &Overrides,
    ) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        if options.frame.is_some() {
            return Err(parameter("frame", "none for a sequence, which has all", "one"));
        }
        if file::ending(path).as_deref() == Some(PackedFrames::ENDING) {
            if *options != ReadOptions::default() {
                return Err(parameter("options of reading", "none for packed frames", "some"));
            }
            let content = PackedFrames::content(&file::read(path)?);
            let frames = content.map_err(|flaw| flaw.in_file(&name))?;
            return Self::packed(&name, frames, overrides);
        }
        let source = Source::of(path)?;
        let options = &source.options(options);
        let surface = source.surface(options)?.overridden(overrides)?;
        let files = Files::open(&source.particles, &name, options)?;
        let numbers = files.numbers()?;
        let (Some(first), Some(last)) = (numbers.first(), numbers.last()) else {
            return Err(parameter(&name, "at least one file of this name", "none"));
        };
        let mut readable = numbers.iter().map(|number| (number, files.particles(*number)));
        let (number, particles) = match readable.find(|(_, particles)| particles.is_ok()) {
            Some((number, particles)) => (number, particles?),
            None => (first, files.particles(*first)?),
        };
        let spacing_radius = particles.spacing_radius();
        let mut common = Common { surface, spacing_radius, origin: None };
        let cell = particles.cell;
        let (scene, mut notes) = common.scene_and_notes(particles)?;
        let origin = scene.origin();
        common.origin = Some(origin);
        common.surface.threshold = Some(scene.threshold());
        let camera = match source.camera {
            Some(camera) => camera.at(origin).map_err(|flaw| flaw.in_file(&name))?,
            None => {
                let mut bounds = |number_of: &u32| -> Result<Aabb, LoadError> {
                    if number_of == number {
                        return Ok(framed(&scene, cell.as_ref(), options, &mut notes));
                    }
                    let particles = files.particles(*number_of)?;
                    let cell = particles.cell;
                    let scene = common.scene(particles)?;
                    Ok(framed(&scene, cell.as_ref(), options, &mut Notes::default()))
                };
                let (of_first, of_last) = (bounds(first)?, bounds(last)?);
                framing(&of_first.union(&of_last), FRONT)
            }
        };
        let range = *first..last.saturating_add(1);
        let overrides = *overrides;
        Ok(Self { name, camera, range, files, common, overrides, notes, cell })
    }

    /// The sequence of packed frames, under the default kernel and threshold.
    ///
    /// # Errors
    /// When the balls of a frame make no scene.
    pub fn packed(
        name: &str,
        frames: PackedFrames,
        overrides: &Overrides,
    ) -> Result<Self, LoadError> {
        let range = 0..frames.count();
        let common =
            Common { surface: Surface::default(), spacing_radius: None, origin: Some(DVec3::ZERO) };
        let mut bounds = Aabb::EMPTY;
        for number in range.clone() {
            bounds = bounds.union(&common.scene(frames.frame(number))?.bounds());
        }
        Ok(Self {
            name: name.to_owned(),
            camera: framing(&bounds, FRONT),
            range,
            files: Files::Packed(frames),
            common,
            overrides: *overrides,
            notes: Notes::default(),
            cell: None,
        })
    }

    /// The path that it was opened by.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What replaces every scene's own choices.
    pub fn overrides(&self) -> &Overrides {
        &self.overrides
    }

    /// What was read, guessed and left out in the first frame.
    pub fn notes(&self) -> &Notes {
        &self.notes
    }

    /// The periodic cell of the first frame.
    pub fn cell(&self) -> Option<Cell> {
        self.cell
    }

    /// A camera for all frames.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The numbers of its frames, from the first to the last. Numbered files may leave gaps.
    pub fn frames(&self) -> Range<u32> {
        self.range.clone()
    }

    /// The scene of a frame.
    ///
    /// # Errors
    /// When there is no such frame, or its file cannot be used: names it.
    pub fn frame(&self, number: u32) -> Result<Scene, LoadError> {
        self.overrides.apply(self.common.scene(self.files.particles(number)?)?)
    }

    /// The numbers of frames in a range that are there now.
    ///
    /// # Errors
    /// When the files' folder cannot be read.
    pub fn present(&self, range: Range<u32>) -> Result<Vec<u32>, LoadError> {
        let numbers = self.files.numbers()?.into_iter();
        Ok(numbers.filter(|number| range.contains(number)).collect())
    }
}

impl AnimatedScene for Sequence {
    fn name(&self) -> &str {
        self.name()
    }

    fn description(&self) -> String {
        let options = match &self.files {
            Files::Numbered(_, options) | Files::One(_, options) => format!("{options:?}"),
            Files::Packed(_) => String::new(),
        };
        format!("{} with {:?} {options}", self.name(), self.overrides())
    }

    fn camera(&self) -> &Camera {
        self.camera()
    }

    fn frames(&self) -> Range<u32> {
        self.frames()
    }

    fn notes(&self) -> Option<&Notes> {
        Some(self.notes())
    }

    fn present(&self, range: Range<u32>) -> Result<Vec<u32>, BoxError> {
        Ok(self.present(range)?)
    }

    fn frame(&self, number: u32) -> Result<Scene, BoxError> {
        Ok(self.frame(number)?)
    }
}

impl Files {
    /// Those of a path with a `%`, or one that holds frames.
    fn open(path: &Path, name: &str, options: &ReadOptions) -> Result<Self, LoadError> {
        let options = options.clone();
        if path.file_name().is_some_and(|name| name.to_string_lossy().contains('%')) {
            return Ok(Self::Numbered(path.display().to_string().parse()?, options));
        }
        let content = Content::new(path, file::read(path)?.into())?;
        if content.frames() < 2 {
            return Err(LoadError::NotASequence { file: name.to_owned() });
        }
        Ok(Self::One(content, options))
    }

    /// The numbers of the frames that are there.
    fn numbers(&self) -> Result<Vec<u32>, LoadError> {
        match self {
            Self::Numbered(files, _) => files.numbers(),
            Self::One(content, _) => {
                Ok((0..u32::try_from(content.frames()).unwrap_or(u32::MAX)).collect())
            }
            Self::Packed(frames) => Ok((0..frames.count()).collect()),
        }
    }

    fn particles(&self, number: u32) -> Result<Particles, LoadError> {
        match self {
            Self::Numbered(files, options) => read(files.path(number), options),
            Self::One(content, options) => {
                content.particles(&ReadOptions { frame: Some(number), ..options.clone() })
            }
            Self::Packed(frames) if number < frames.count() => Ok(frames.frame(number)),
            Self::Packed(frames) => {
                Err(parameter("frame", &format!("a number below {}", frames.count()), number))
            }
        }
    }
}

impl Common {
    fn scene(&self, particles: Particles) -> Result<Scene, LoadError> {
        self.scene_and_notes(particles).map(|(scene, _)| scene)
    }

    fn scene_and_notes(&self, particles: Particles) -> Result<(Scene, Notes), LoadError> {
        let particles = match self.spacing_radius {
            Some(radius) => particles.respaced(radius),
            None => particles,
        };
        self.surface.scene(particles, self.origin)
    }
}
