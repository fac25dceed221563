//! Sequences: particles that move, a scene for each frame.

use std::ops::Range;
use std::path::Path;

use metaball_core::{Aabb, Camera, Kernel, Scene};

use crate::animated_scene::{AnimatedScene, BoxError};
use crate::error::LoadError;
use crate::file;
use crate::formats::PackedFrames;
use crate::framing::{FRONT, framing};
use crate::numbered_path::NumberedPath;
use crate::overrides::Overrides;
use crate::particles::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Particles};
use crate::read::{format_of, read};
use crate::scene_file::SceneFile;

/// The frames of files. They are independent of each other: any can be had, in any order and from any
/// thread, and is the same each time as long as its file is.
#[derive(Debug)]
pub struct Sequence {
    name: String,
    camera: Camera,
    range: Range<u32>,
    frames: Frames,
    overrides: Overrides,
}

/// Where frames come from.
#[derive(Debug)]
enum Frames {
    /// A file for each.
    Numbered(NumberedFiles),
    /// One file with all of them.
    Packed(PackedFrames),
}

#[derive(Debug)]
struct NumberedFiles {
    files: NumberedPath,
    kernel: Kernel,
    threshold: f32,
    /// Where files leave the radius to the particles' spacing, all frames have the same: a surface does
    /// not breathe, and shaders are made once.
    spacing_radius: Option<f32>,
}

impl Sequence {
    /// The sequence of a particle file for each frame (`fluid-%04d.xyz`, a [`NumberedPath`] whose numbers
    /// are those of frames), of a scene file that names such particles, or of a `.frames` file.
    ///
    /// The camera is the scene file's, or one that frames the first and the last file. Where files leave
    /// the radius to the particles' spacing, that of the first readable one is every frame's.
    ///
    /// # Errors
    /// [`LoadError::NotASequence`] where there is only one scene; else as [`load`](crate::load()).
    pub fn open(path: impl AsRef<Path>, overrides: &Overrides) -> Result<Self, LoadError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let (particles, kernel, threshold, camera) = match file::ending(path).as_deref() {
            Some(PackedFrames::ENDING) => {
                let content = PackedFrames::content(&file::read(path)?);
                let frames = content.map_err(|flaw| flaw.in_file(&name))?;
                return Self::packed(&name, frames, overrides);
            }
            Some(SceneFile::ENDING) => {
                let SceneFile { particles, kernel, threshold, camera } = SceneFile::open(path)?;
                (particles, kernel, threshold, camera)
            }
            _ => {
                format_of(path)?;
                (path.to_owned(), DEFAULT_KERNEL, DEFAULT_THRESHOLD, None)
            }
        };
        if !particles.file_name().is_some_and(|name| name.to_string_lossy().contains('%')) {
            return Err(LoadError::NotASequence { file: name });
        }
        let (files, range, camera) = NumberedFiles::open(&particles, kernel, threshold, camera)?;
        let frames = Frames::Numbered(files);
        Ok(Self { name, camera, range, frames, overrides: *overrides })
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
        let frames = Frames::Packed(frames);
        let mut bounds = Aabb::EMPTY;
        for number in range.clone() {
            bounds = bounds.union(&frames.scene(number)?.bounds());
        }
        let camera = framing(&bounds, FRONT);
        Ok(Self { name: name.to_owned(), camera, range, frames, overrides: *overrides })
    }

    /// The path that it was opened by.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What replaces every scene's own choices.
    pub fn overrides(&self) -> &Overrides {
        &self.overrides
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
        self.overrides.apply(self.frames.scene(number)?)
    }

    /// The numbers of frames in a range that are there now.
    ///
    /// # Errors
    /// When the files' folder cannot be read.
    pub fn present(&self, range: Range<u32>) -> Result<Vec<u32>, LoadError> {
        match &self.frames {
            Frames::Numbered(NumberedFiles { files, .. }) => {
                let numbers = files.numbers()?.into_iter();
                Ok(numbers.filter(|number| range.contains(number)).collect())
            }
            Frames::Packed(frames) => Ok((range.start..range.end.min(frames.count())).collect()),
        }
    }
}

impl AnimatedScene for Sequence {
    fn name(&self) -> &str {
        self.name()
    }

    fn description(&self) -> String {
        format!("{} with {:?}", self.name(), self.overrides())
    }

    fn camera(&self) -> &Camera {
        self.camera()
    }

    fn frames(&self) -> Range<u32> {
        self.frames()
    }

    fn present(&self, range: Range<u32>) -> Result<Vec<u32>, BoxError> {
        Ok(self.present(range)?)
    }

    fn frame(&self, number: u32) -> Result<Scene, BoxError> {
        Ok(self.frame(number)?)
    }
}

impl Frames {
    fn scene(&self, number: u32) -> Result<Scene, LoadError> {
        match self {
            Self::Numbered(files) => files.scene(files.particles(number)?),
            Self::Packed(frames) if number < frames.count() => {
                frames.frame(number).into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD)
            }
            Self::Packed(frames) => Err(LoadError::Parameter {
                name: "frame".to_owned(),
                needed: format!("a number below {}", frames.count()),
                found: number.to_string(),
            }),
        }
    }
}

impl NumberedFiles {
    /// The files, the numbers from the first to the last, and the camera. No file is read twice.
    fn open(
        path: &Path,
        kernel: Kernel,
        threshold: f32,
        camera: Option<Camera>,
    ) -> Result<(Self, Range<u32>, Camera), LoadError> {
        let name = path.display().to_string();
        let files: NumberedPath = name.parse()?;
        let numbers = files.numbers()?;
        let [first, later @ ..] = numbers.as_slice() else {
            return Err(LoadError::Parameter {
                name,
                needed: "at least one file of this name".to_owned(),
                found: "none".to_owned(),
            });
        };
        let last = later.last();
        let range = *first..last.unwrap_or(first).saturating_add(1);
        let mut opened = Self { files, kernel, threshold, spacing_radius: None };
        let of_first = opened.particles(*first);
        opened.spacing_radius = match &of_first {
            Ok(particles) => particles.spacing_radius,
            Err(_) => {
                let readable = later.iter().find_map(|number| opened.particles(*number).ok());
                readable.and_then(|particles| particles.spacing_radius)
            }
        };
        let camera = match camera {
            Some(camera) => camera,
            None => {
                let mut bounds = opened.scene(of_first?)?.bounds();
                if let Some(last) = last {
                    bounds = bounds.union(&opened.scene(opened.particles(*last)?)?.bounds());
                }
                framing(&bounds, FRONT)
            }
        };
        Ok((opened, range, camera))
    }

    fn particles(&self, number: u32) -> Result<Particles, LoadError> {
        read(self.files.path(number))
    }

    fn scene(&self, particles: Particles) -> Result<Scene, LoadError> {
        let particles = match self.spacing_radius {
            Some(radius) => particles.respaced(radius),
            None => particles,
        };
        particles.into_scene(self.kernel, self.threshold)
    }
}
