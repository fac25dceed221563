//! A picture to files, band by band.

use std::ops::ControlFlow;
use std::path::PathBuf;

use glam::Vec3;
use metaball_core::{Camera, Color, Hit, Scene, ValueRange, View};
use picture_files::{HitsFile, LightFile, PngFile};

use crate::band::{BAND_PIXELS, Planes, bands};
use crate::cpu::{self, Finisher, Painter};
use crate::draw::{Attempt, no_light, on_adapter};
use crate::spool::{Description, Spool};
use crate::summary::{Progress, Summary, Tally};
use crate::{DrawOptions, Drawing, Error};

/// Where a picture goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outputs {
    /// The picture: PNG.
    pub image: PathBuf,
    /// Distances and normals: a [`HitsFile`], `.exr` or `.npy`.
    pub hits: Option<PathBuf>,
    /// Linear light: a [`LightFile`], `.exr`. Only with ray traced light.
    pub light: Option<PathBuf>,
    /// Go on with the bands that an interrupted run left beside the image, if there are any.
    pub resume: bool,
}

impl Outputs {
    /// A picture alone, drawn from its first row on.
    pub fn image(path: impl Into<PathBuf>) -> Self {
        Self { image: path.into(), hits: None, light: None, resume: false }
    }
}

/// Draws a scene to files. `camera` is the scene's own.
///
/// On the CPU a picture is drawn band by band, and each band that is finished is kept in a spool beside the
/// image, named like it with `.spool` behind: 4 bytes a pixel, 20 more for hits and 12 more for light. When
/// all are finished, the files are written from it, and it is deleted. So a picture takes no more memory than
/// a band of it, and one that was interrupted can be [resumed](Outputs::resume), and has the same bytes in
/// the end. Unfinished bands of this very picture are never thrown away unasked, those of another are.
///
/// An adapter draws a picture at once, in its own memory and in main memory. One that does not fit is left to
/// the CPU, if its method is a tree, and so is one that the CPU began and that is resumed.
///
/// After each part that is done the callback hears of it, and it may break off; so it does once before the
/// first.
///
/// # Errors
/// When an option cannot be used, method or adapter cannot draw the scene, a file cannot be written, there
/// is a spool that does not fit, or the callback breaks off.
pub fn draw_to_files(
    scene: &Scene,
    camera: &Camera,
    options: &DrawOptions,
    outputs: &Outputs,
    mut progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Summary, Error> {
    if outputs.light.is_some() && !options.light.is_asked() {
        return Err(no_light());
    }
    let view = options.view(scene, camera)?;
    // What cannot be written is refused before anything is drawn.
    drop(Files::create(outputs, &view)?);
    let computed_by = if outputs.resume && Spool::path_beside(&outputs.image).exists() {
        "the CPU, which began the picture".to_owned()
    } else {
        let gpu = options.backend.open()?;
        match on_adapter(gpu.as_ref(), options, scene, &view, &mut progress)? {
            Attempt::Drawn(drawing) => return save(*drawing, outputs, &view),
            Attempt::Left { computed_by } => computed_by,
        }
    };
    let job = Job { scene, view: &view, options, outputs, band_pixels: BAND_PIXELS };
    Ok(Summary { computed_by, ..job.draw(progress)? })
}

/// Writes what was drawn at once.
fn save(drawing: Drawing, outputs: &Outputs, view: &View) -> Result<Summary, Error> {
    let Drawing { image, hits, film, summary } = drawing;
    let mut files = Files::create(outputs, view)?;
    let light = film.as_ref().map_or(&[][..], |film| &film.light);
    files.write(bytemuck::cast_slice(&image.rgba), &hits, light)?;
    files.finish()?;
    Ok(summary)
}

/// A picture that the CPU draws to files.
struct Job<'a> {
    scene: &'a Scene,
    view: &'a View,
    options: &'a DrawOptions,
    outputs: &'a Outputs,
    band_pixels: u32,
}

impl Job<'_> {
    /// Draws to the spool, and writes the files from it.
    fn draw(&self, progress: impl FnMut(Progress) -> ControlFlow<()>) -> Result<Summary, Error> {
        let Self { scene, view, options, outputs, .. } = *self;
        let built = cpu::build(&options.method, scene)?;
        let painter = Painter::new(&built, scene, view, options)?;
        let waits = painter.waits();
        let planes = Planes {
            pixels: !waits,
            hits: waits || outputs.hits.is_some(),
            light: outputs.light.is_some(),
        };
        let description = Description::new(scene, view, options, planes);
        let path = Spool::path_beside(&outputs.image);
        let mut spool = Spool::open(path, view, planes, &description, outputs.resume)?;
        self.draw_rest(&mut spool, &painter, planes, progress)?;
        let range = waits.then(|| range_of(&spool)).transpose()?;
        let finisher = range.map(|range| Finisher::new(&painter, range));
        let tally = self.write_files(&spool, finisher.as_ref())?;
        spool.remove()?;
        Ok(Summary {
            tally,
            range,
            samples: None,
            account: options.method.account(),
            computed_by: options.backend.describe(None),
            build: built.time,
        })
    }

    /// Draws the bands that the spool has not.
    fn draw_rest(
        &self,
        spool: &mut Spool,
        painter: &Painter<'_>,
        planes: Planes,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let (of, resumed) = (self.view.height(), spool.rows());
        let mut report = |done| match progress(Progress { done, of, resumed }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Error::Interrupted),
        };
        report(resumed)?;
        for rows in bands(self.view, resumed, self.band_pixels) {
            spool.append(&painter.band(rows, planes))?;
            report(spool.rows())?;
        }
        Ok(())
    }

    /// Writes the files of a picture whose bands are all in the spool.
    fn write_files(
        &self,
        spool: &Spool,
        finisher: Option<&Finisher<'_, '_>>,
    ) -> Result<Tally, Error> {
        let mut files = Files::create(self.outputs, self.view)?;
        let mut tally = Tally::default();
        for band in spool.bands() {
            let mut band = band?;
            if let Some(finisher) = finisher {
                finisher.finish(&mut band);
            }
            files.write(&band.pixels, &band.hits, &band.light)?;
            tally += band.tally;
        }
        files.finish()?;
        Ok(tally)
    }
}

/// The distances of a whole picture.
fn range_of(spool: &Spool) -> Result<ValueRange, Error> {
    let mut range: Option<ValueRange> = None;
    for band in spool.bands() {
        let found = ValueRange::spanned(&band?.hits);
        range = range.into_iter().chain(found).reduce(ValueRange::union);
    }
    Ok(range.unwrap_or_default())
}

/// The files of a picture on their way to the disk.
struct Files {
    image: PngFile,
    hits: Option<HitsFile>,
    light: Option<LightFile>,
}

impl Files {
    fn create(outputs: &Outputs, view: &View) -> Result<Self, Error> {
        let (width, height) = (view.width(), view.height());
        let hits = outputs.hits.as_ref().map(|path| HitsFile::create(path, width, height));
        let light = outputs.light.as_ref().map(|path| LightFile::create(path, width, height));
        Ok(Self {
            image: PngFile::create(&outputs.image, width, height)?,
            hits: hits.transpose()?,
            light: light.transpose()?,
        })
    }

    /// Writes the next rows; planes that have no file are not looked at.
    fn write(&mut self, pixels: &[Color], hits: &[Hit], light: &[Vec3]) -> Result<(), Error> {
        self.image.write(pixels)?;
        self.hits.as_mut().map_or(Ok(()), |file| file.write(hits))?;
        self.light.as_mut().map_or(Ok(()), |file| file.write(light))?;
        Ok(())
    }

    fn finish(self) -> Result<(), Error> {
        self.image.finish()?;
        self.hits.map_or(Ok(()), HitsFile::finish)?;
        self.light.map_or(Ok(()), LightFile::finish)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;
    use std::time::Duration;

    use bench_scenes::{BenchScene, Overrides, load};
    use metaball_core::Picture;

    use super::*;
    use crate::{Backend, draw};

    fn bench(name: &str) -> BenchScene {
        load(name, &Overrides::default()).expect("known")
    }

    fn options(picture: Picture) -> DrawOptions {
        DrawOptions { size: (50, 70), picture, backend: Backend::Cpu, ..DrawOptions::default() }
    }

    fn outputs(folder: &Path, hits: &str) -> Outputs {
        Outputs { hits: Some(folder.join(hits)), ..Outputs::image(folder.join("image.png")) }
    }

    /// Draws with five bands, and breaks off when so many rows are there.
    fn draw_until(
        bench: &BenchScene,
        options: &DrawOptions,
        outputs: &Outputs,
        end: u32,
    ) -> Result<Summary, Error> {
        let view = options.view(&bench.scene, &bench.camera)?;
        let scene = &bench.scene;
        let job = Job { scene, view: &view, options, outputs, band_pixels: 1 };
        job.draw(|progress| {
            assert_eq!(progress.of, 70);
            if progress.done >= end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }

    fn files(folder: &Path, names: [&str; 2]) -> [Vec<u8>; 2] {
        names.map(|name| fs::read(folder.join(name)).expect("written"))
    }

    #[test]
    fn files_are_those_of_the_whole_picture_however_often_interrupted() {
        for (scene, hits, picture) in [
            ("colors-100", "hits.exr", Picture::Phong),
            ("eye-inside-surface", "hits.npy", Picture::Color),
            ("colors-100", "hits.npy", Picture::Normal),
            ("strengths-100", "hits.exr", Picture::Depth),
        ] {
            let (bench, options) = (bench(scene), options(picture));
            let folder = tempfile::tempdir().expect("a folder");
            let folder = folder.path();
            let names = ["image.png", hits];
            let whole = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            whole.save_image(folder.join(names[0])).expect("written");
            whole.save_hits(folder.join(names[1])).expect("written");
            let wanted = files(folder, names);
            for name in names {
                fs::remove_file(folder.join(name)).expect("removed");
            }

            let mut outputs = outputs(folder, hits);
            for end in [0, 16, 32, 32, 64, 70] {
                let stopped = draw_until(&bench, &options, &outputs, end);
                assert!(matches!(stopped, Err(Error::Interrupted)), "{stopped:?}");
                let there: Vec<_> = fs::read_dir(folder).expect("readable").collect();
                assert_eq!(there.len(), 1, "only the spool: {there:?}");
                outputs.resume = true;
            }
            let summary = draw_until(&bench, &options, &outputs, 71).expect("drawn");
            assert!(files(folder, names) == wanted, "{scene}, {picture:?}");
            assert_eq!(fs::read_dir(folder).expect("readable").count(), 2);
            let counts = |tally| Tally { frame: Duration::ZERO, ..tally };
            assert_eq!(counts(summary.tally), counts(whole.summary.tally));
            assert_eq!(summary.range, whole.summary.range);
        }
    }
}
