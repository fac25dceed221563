//! A picture to files, band by band.

use std::ops::ControlFlow;
use std::path::PathBuf;

use glam::Vec3;
use metaball_core::{Camera, Color, Hit, Scene, ValueRange, View};
use particle_files::Legend;
use picture_files::{
    HitsFile, LightFile, PictureFile, RunFile, Target, ensure_writable, refuse_overlap,
};

use crate::band::{Planes, bands};
use crate::cpu::{Built, Finisher, Painter};
use crate::draw::{Attempt, no_light, on_adapter};
use crate::inputs::inputs;
use crate::interruptible::Interruptible;
use crate::legend::save_legend;
use crate::spool::{Description, Spool};
use crate::summary::{Progress, Stage, Summary, Tally, asked};
use crate::{DrawOptions, Drawing, Error};

/// Where a picture goes.
#[derive(Debug, Clone, PartialEq)]
pub struct Outputs {
    /// The picture: a [`PictureFile`], `.png`, `.jpg` or `.jpeg`.
    pub image: PathBuf,
    /// Distances and normals: a [`HitsFile`], `.exr` or `.npy`.
    pub hits: Option<PathBuf>,
    /// Linear light: a [`LightFile`], `.exr`. Only with ray traced light.
    pub light: Option<PathBuf>,
    /// What the colours say, as SVG, and where it goes: see [`Outputs::with_legend`].
    pub legend: Option<(Legend, PathBuf)>,
    /// Go on with the bands that an interrupted run left beside the image, if there are any.
    pub resume: bool,
    /// Files that are never written over: those that the scene is read from, such as
    /// [`inputs`](crate::inputs()) finds. The image of the surroundings is one of them without being named.
    pub inputs: Vec<PathBuf>,
}

impl Outputs {
    /// A picture alone, drawn from its first row on.
    pub fn image(path: impl Into<PathBuf>) -> Self {
        Self {
            image: path.into(),
            hits: None,
            light: None,
            legend: None,
            resume: false,
            inputs: Vec::new(),
        }
    }

    /// With a legend beside the picture, named like it with `.legend.svg` for an ending; without one where the
    /// picture goes to a device, a pipe or an open file, beside which there is no place.
    ///
    /// # Errors
    /// When the picture's path names no file.
    pub fn with_legend(self, legend: &Legend) -> Result<Self, Error> {
        let legend = match Target::of(&self.image)? {
            Target::File(_) => Some((legend.clone(), self.image.with_extension("legend.svg"))),
            Target::Stream(_) => None,
        };
        Ok(Self { legend, ..self })
    }

    fn files(&self) -> Vec<RunFile> {
        let legend = self.legend.as_ref().map(|(_, path)| path);
        let others = [
            ("file of hits", self.hits.as_ref()),
            ("file of light", self.light.as_ref()),
            ("legend", legend),
        ];
        let others = others.into_iter().filter_map(|(what, path)| Some((what, path?.clone())));
        [("picture", self.image.clone())].into_iter().chain(others).collect()
    }
}

/// Draws a scene to files. `camera` is the scene's own.
///
/// On the CPU a picture is drawn band by band, and each band that is finished is kept in a spool beside the
/// image, named like it with `.spool` behind: 4 bytes a pixel, 20 more for hits and 12 more for light. Where
/// the image is no regular file the spool has no name. When
/// all are finished, the files are written from it, and it is deleted. So a picture takes no more memory than
/// a band of it, 4 bytes a pixel of an eighth of it with a depth cue, 3 bytes a pixel of all of it as JPEG; and one that was interrupted can be
/// [resumed](Outputs::resume), and has the same bytes in the end. Finished bands of this very picture are never
/// thrown away unasked, those of another are.
///
/// An adapter draws a picture at once, in its own memory and in main memory. One that does not fit is left to
/// the CPU, if its method is a tree, and so is one that the CPU began and that is resumed.
///
/// After each part that is done the callback hears of it, and it may break off. On the CPU it hears first
/// of what an interrupted run did.
///
/// # Errors
/// When an option cannot be used, method or adapter cannot draw the scene, a file cannot be written or is
/// an input or another output, there is a spool that does not fit, or the callback breaks off. What cannot
/// be written is refused before anything is drawn.
pub fn draw_to_files(
    scene: &Scene,
    camera: &Camera,
    options: &DrawOptions,
    outputs: &Outputs,
    progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Summary, Error> {
    if outputs.light.is_some() && !options.light.is_asked() {
        return Err(no_light());
    }
    let view = options.view(scene, camera)?;
    refuse_overlap(&outputs.files(), &inputs(&outputs.inputs, &options.light))?;
    drop(Files::create(outputs, &view)?);
    if let Some((_, path)) = &outputs.legend {
        ensure_writable(path)?;
    }
    let summary = draw_files(scene, &view, options, outputs, progress)?;
    if let Some((legend, path)) = &outputs.legend {
        save_legend(legend, path)?;
    }
    Ok(summary)
}

/// Draws to the picture's files.
fn draw_files(
    scene: &Scene,
    view: &View,
    options: &DrawOptions,
    outputs: &Outputs,
    mut progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<Summary, Error> {
    let computed_by = if outputs.resume && Spool::is_beside(&outputs.image)? {
        "the CPU, which began the picture".to_owned()
    } else {
        match on_adapter(&options.open(Some(scene))?, options, scene, view, &mut progress)? {
            Attempt::Drawn(drawing) => return save(*drawing, outputs, view),
            Attempt::Left { computed_by } => computed_by,
        }
    };
    Job { scene, view, options, outputs, computed_by, band_pixels: None }.draw(progress)
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
    /// Why it is the CPU, in words.
    computed_by: String,
    /// Pixels of a band; as many as suit the picture when left out.
    band_pixels: Option<u32>,
}

impl Job<'_> {
    /// Draws to the spool, and writes the files from it.
    fn draw(
        &self,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Summary, Error> {
        let Self { scene, view, options, outputs, .. } = *self;
        let lighting = options.lighting(view, scene)?;
        let built = Built::new(&options.method, scene)?;
        let tracer = built.tracer(scene, &options.clip_of(scene))?;
        let tracer = Interruptible::never(tracer);
        let painter = Painter::new(&tracer, scene, view, options, lighting.as_ref())?;
        let planes = painter.planes(outputs.hits.is_some(), outputs.light.is_some());
        let description = Description::new(scene, view, options, planes);
        let mut spool = Spool::open(&outputs.image, view, planes, &description, outputs.resume)?;
        self.draw_rest(&mut spool, &painter, planes, &mut progress)?;
        let range = (!planes.pixels).then(|| range_of(&spool)).transpose()?;
        let mut finisher = range.map(|range| painter.finisher(range));
        let tally = self.write_files(&spool, finisher.as_mut(), &mut progress)?;
        spool.remove()?;
        Ok(Summary {
            tally,
            range: finisher.and_then(|finisher| finisher.scale()),
            samples: lighting.map(|lighting| lighting.samples()),
            account: options.method.account(),
            computed_by: self.computed_by.clone(),
            build: built.time,
        })
    }

    /// Draws the bands that the spool has not.
    fn draw_rest(
        &self,
        spool: &mut Spool,
        painter: &Painter<'_>,
        planes: Planes,
        progress: &mut impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        let (of, resumed) = (self.view.height(), spool.rows());
        let stage = Stage::Drawing;
        let mut report = |done| asked(progress(Progress { stage, done, of, resumed }));
        report(resumed)?;
        let pixels = self.band_pixels.unwrap_or(painter.band_pixels());
        for rows in bands(self.view, resumed, pixels) {
            spool.append(&painter.band(rows, planes))?;
            report(spool.rows())?;
        }
        Ok(())
    }

    /// Writes the files of a picture whose bands are all in the spool.
    fn write_files(
        &self,
        spool: &Spool,
        mut finisher: Option<&mut Finisher<'_, '_>>,
        progress: &mut impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Tally, Error> {
        let (stage, of) = (Stage::Writing, self.view.height());
        let mut files = Files::create(self.outputs, self.view)?;
        let mut tally = Tally::default();
        let mut ahead = spool.bands();
        for band in spool.bands() {
            let mut band = band?;
            if let Some(finisher) = &mut finisher {
                while finisher.has_to_see(band.rows.end) {
                    let Some(band) = ahead.next() else { break };
                    finisher.see(&band?.hits);
                }
                finisher.finish(&mut band);
            }
            files.write(&band.pixels, &band.hits, &band.light)?;
            tally += band.tally;
            asked(progress(Progress { stage, done: band.rows.end, of, resumed: 0 }))?;
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
    image: PictureFile,
    hits: Option<HitsFile>,
    light: Option<LightFile>,
}

impl Files {
    fn create(outputs: &Outputs, view: &View) -> Result<Self, Error> {
        let (width, height) = (view.width(), view.height());
        let hits = outputs.hits.as_ref().map(|path| HitsFile::create(path, width, height));
        let light = outputs.light.as_ref().map(|path| LightFile::create(path, width, height));
        Ok(Self {
            image: PictureFile::create(&outputs.image, width, height)?,
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
    use crate::{Backend, LightOptions, Method, draw};

    fn bench(name: &str) -> BenchScene {
        load(name, &Overrides::default()).expect("known")
    }

    fn options(picture: Picture) -> DrawOptions {
        DrawOptions { size: (50, 70), picture, backend: Backend::Cpu, ..DrawOptions::default() }
    }

    fn lit(light: LightOptions) -> DrawOptions {
        DrawOptions { light, ..options(Picture::Phong) }
    }

    const NEVER: (Stage, u32) = (Stage::Writing, 71);

    fn legend() -> Legend {
        Legend { title: "charge".to_owned(), scale: particle_files::Scale::Numbers(0.0, 1.0) }
    }

    #[test]
    fn a_legend_lies_beside_the_picture() {
        let bench = bench("colors-100");
        let folder = tempfile::tempdir().expect("a folder");
        let draw = |outputs: &Outputs| {
            let all = |_| ControlFlow::Continue(());
            draw_to_files(&bench.scene, &bench.camera, &options(Picture::Phong), outputs, all)
        };
        let outputs = Outputs::image(folder.path().join("image.png"));
        draw(&outputs.with_legend(&legend()).expect("beside it")).expect("drawn");
        let names: Vec<_> = files(folder.path()).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["image.legend.svg", "image.png"]);
        if cfg!(unix) {
            let null = Outputs::image("/dev/null").with_legend(&legend()).expect("a device");
            assert_eq!(null.legend, None);
        }
    }

    /// Draws with five bands, and breaks off when so many rows are there, or written.
    fn draw_until(
        bench: &BenchScene,
        options: &DrawOptions,
        outputs: &Outputs,
        end: (Stage, u32),
    ) -> Result<Summary, Error> {
        let view = options.view(&bench.scene, &bench.camera)?;
        let scene = &bench.scene;
        let computed_by = "the CPU".to_owned();
        let job = Job { scene, view: &view, options, outputs, computed_by, band_pixels: Some(1) };
        job.draw(|progress| {
            assert_eq!(progress.of, 70);
            let is_end = progress.stage == end.0 && progress.done >= end.1;
            if is_end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }

    /// All files in a folder: names and contents.
    fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(folder).expect("readable").map(|entry| entry.expect("readable"));
        let mut files: Vec<_> = entries
            .map(|entry| (entry.file_name().display().to_string(), entry.path()))
            .map(|(name, path)| (name, fs::read(path).expect("readable")))
            .collect();
        files.sort();
        files
    }

    #[test]
    fn files_are_those_of_the_whole_picture_however_often_interrupted() {
        let shadows = LightOptions { shadows: true, ..LightOptions::default() };
        let cued = LightOptions { depth_cue: Some(1.0), samples: Some(2), ..shadows.clone() };
        for (scene, hits, options) in [
            ("colors-100", "hits.exr", options(Picture::Phong)),
            ("eye-inside-surface", "hits.npy", options(Picture::Color)),
            ("strengths-100", "hits.exr", options(Picture::Depth)),
            ("colors-100", "hits.npy", lit(shadows)),
            ("strengths-100", "hits.exr", lit(cued)),
        ] {
            let bench = bench(scene);
            let whole = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
            let [wanted, found] = folders.each_ref().map(tempfile::TempDir::path);
            whole.save_image(wanted.join("image.png")).expect("written");
            whole.save_hits(wanted.join(hits)).expect("written");
            let mut outputs = Outputs::image(found.join("image.png"));
            outputs.hits = Some(found.join(hits));
            if options.light.is_asked() {
                whole.save_light(wanted.join("light.exr")).expect("written");
                outputs.light = Some(found.join("light.exr"));
            }

            let drawing = [0, 16, 32, 32, 64, 70].map(|row| (Stage::Drawing, row));
            let writing = [16, 32].map(|row| (Stage::Writing, row));
            for end in drawing.into_iter().chain(writing) {
                let stopped = draw_until(&bench, &options, &outputs, end);
                assert!(matches!(stopped, Err(Error::Interrupted)), "{stopped:?}");
                let there: Vec<_> = files(found).into_iter().map(|(name, _)| name).collect();
                assert_eq!(there, ["image.png.spool"]);
                outputs.resume = true;
            }
            let summary = draw_until(&bench, &options, &outputs, NEVER).expect("drawn");
            assert!(files(found) == files(wanted), "{scene}, {options:?}");
            let timeless = |tally| Tally { frame: Duration::ZERO, light: Duration::ZERO, ..tally };
            assert_eq!(timeless(summary.tally), timeless(whole.summary.tally));
            assert_eq!(summary.range, whole.summary.range);
        }
    }

    /// A picture alone keeps nothing else, and is the same.
    #[test]
    fn a_picture_alone_is_the_same() {
        let cued = LightOptions { depth_cue: Some(1.0), ..LightOptions::default() };
        for options in [options(Picture::Normal), options(Picture::Depth), lit(cued)] {
            let bench = bench("colors-100");
            let folder = tempfile::tempdir().expect("a folder");
            let [wanted, found] = ["wanted.png", "found.png"].map(|name| folder.path().join(name));
            let whole = draw(&bench.scene, &bench.camera, &options).expect("drawn");
            whole.save_image(&wanted).expect("written");
            let outputs = Outputs::image(&found);
            let all = |_| ControlFlow::Continue(());
            draw_to_files(&bench.scene, &bench.camera, &options, &outputs, all).expect("drawn");
            let [wanted, found] = [wanted, found].map(|path| fs::read(path).expect("written"));
            assert!(found == wanted, "{options:?}");
        }
    }

    /// What was begun is gone on with if it is the same in everything that pixels depend on, and is never
    /// thrown away unasked.
    #[test]
    fn only_the_same_picture_is_resumed() {
        let bench = bench("colors-100");
        let folder = tempfile::tempdir().expect("a folder");
        let outputs = Outputs::image(folder.path().join("image.png"));
        let resume = Outputs { resume: true, ..outputs.clone() };
        let plain = options(Picture::Phong);
        let message = |scene: &BenchScene, options: &DrawOptions, outputs: &Outputs| {
            draw_until(scene, options, outputs, (Stage::Drawing, 0))
                .expect_err("broken off")
                .to_string()
        };
        assert_eq!(message(&bench, &plain, &resume), "interrupted", "nothing is there");
        draw_until(&bench, &plain, &outputs, (Stage::Drawing, 32)).expect_err("broken off");
        assert!(message(&bench, &plain, &outputs).contains("32 of 70 rows"));
        assert_eq!(message(&bench, &plain, &resume), "interrupted");

        let mut eye = plain.clone();
        eye.viewpoint.fov = Some(20.0);
        let shadows = LightOptions { shadows: true, ..LightOptions::default() };
        let hits = Outputs { hits: Some(folder.path().join("hits.exr")), ..resume.clone() };
        let threshold = Overrides { threshold: Some(0.3), ..Overrides::default() };
        let threshold = load("colors-100", &threshold).expect("known");
        let fitted = Method::Tree(fbvh::Options::fitted());
        for (what, refused) in [
            ("camera", message(&bench, &eye, &resume)),
            ("picture", message(&bench, &options(Picture::Normal), &resume)),
            ("method", message(&bench, &DrawOptions { method: fitted, ..plain.clone() }, &resume)),
            ("light", message(&bench, &lit(shadows), &resume)),
            ("planes", message(&bench, &plain, &hits)),
            ("scene", message(&threshold, &plain, &resume)),
        ] {
            assert!(refused.contains(&format!("needed the {what} of this picture")), "{refused}");
        }
        assert!(message(&bench, &plain, &outputs).contains("32 of 70 rows"), "it is still there");
        assert_eq!(message(&bench, &eye, &outputs), "interrupted", "another is drawn anew");
        assert_eq!(message(&bench, &plain, &outputs), "interrupted", "and the first is gone");
    }

    #[test]
    fn what_cannot_be_written_is_refused_before_anything_is_drawn() {
        let bench = bench("colors-100");
        let folder = tempfile::tempdir().expect("a folder");
        let outputs = Outputs::image(folder.path().join("image.png"));
        let refused = |outputs: &Outputs| {
            let options = options(Picture::Phong);
            let drawn =
                draw_to_files(&bench.scene, &bench.camera, &options, outputs, |_| panic!("drawn"));
            drawn.expect_err("refused").to_string()
        };
        let hits = Outputs { hits: Some(folder.path().join("hits.txt")), ..outputs.clone() };
        assert!(refused(&hits).ends_with("found .txt"));
        let light = Outputs { light: Some(folder.path().join("light.exr")), ..outputs };
        assert!(refused(&light).starts_with("light: needed"));
        let picture = Outputs::image(folder.path().join("image.gif"));
        assert!(refused(&picture).ends_with("needed a picture, .png, .jpg or .jpeg, found .gif"));
        let taken = folder.path().join("taken.png");
        fs::create_dir(&taken).expect("made");
        let into = refused(&Outputs::image(&taken));
        assert!(into.ends_with("needed the path of a file, found a folder"), "{into}");
        fs::remove_dir(&taken).expect("it is empty");
        assert_eq!(files(folder.path()), []);
    }

    #[test]
    fn no_output_is_an_input_or_another_output() {
        let bench = bench("colors-100");
        let folder = tempfile::tempdir().expect("a folder");
        let [png, exr] = ["a.png", "a.exr"].map(|name| folder.path().join(name));
        for path in [&png, &exr] {
            fs::write(path, "mine").expect("written");
        }
        let shadows = LightOptions { shadows: true, ..LightOptions::default() };
        let in_sky = LightOptions { environment: Some(exr.clone()), ..shadows.clone() };
        let refused = |outputs: Outputs, light: &LightOptions| {
            let options = lit(light.clone());
            let drawn =
                draw_to_files(&bench.scene, &bench.camera, &options, &outputs, |_| panic!("drawn"));
            drawn.expect_err("refused").to_string()
        };
        let outputs = Outputs::image(folder.path().join("b.png"));
        let scene = Outputs { image: png.clone(), inputs: vec![png.clone()], ..outputs.clone() };
        assert!(
            refused(scene, &shadows).contains("a file of its own for the picture, found the scene")
        );
        let sky = Outputs { light: Some(exr.clone()), ..outputs.clone() };
        assert!(refused(sky, &in_sky).contains("for the file of light, found the environment"));
        let twice = Outputs { hits: Some(exr.clone()), light: Some(exr.clone()), ..outputs };
        assert!(refused(twice, &shadows).contains("for the file of light, found the file of hits"));
        let svg = folder.path().join("b.legend.svg");
        fs::write(&svg, "mine").expect("written");
        let drawing =
            Outputs { inputs: vec![svg.clone()], ..Outputs::image(folder.path().join("b.png")) };
        let drawing = drawing.with_legend(&legend()).expect("beside it");
        assert!(refused(drawing, &shadows).contains("for the legend, found the scene"));
        for path in [&png, &exr, &svg] {
            assert_eq!(fs::read(path).expect("there"), b"mine");
        }
        assert_eq!(files(folder.path()).len(), 3);
    }

    #[test]
    #[cfg(unix)]
    fn links_stay_and_devices_are_written_to() {
        use std::os::unix::fs::symlink;

        let bench = bench("colors-100");
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("real")).expect("made");
        let options = options(Picture::Phong);
        let draw = |outputs: &Outputs| {
            let all = |_| ControlFlow::Continue(());
            draw_to_files(&bench.scene, &bench.camera, &options, outputs, all)
        };
        let link = folder.path().join("link.png");
        symlink("real/image.png", &link).expect("linked");
        let outputs = Outputs::image(&link);
        draw_until(&bench, &options, &outputs, (Stage::Drawing, 32)).expect_err("broken off");
        let real = folder.path().join("real");
        assert_eq!(files(&real)[0].0, "image.png.spool", "beside the file itself");
        draw(&Outputs { resume: true, ..outputs }).expect("drawn");
        assert!(link.is_symlink());
        assert!(matches!(&files(&real)[..], [(name, _)] if name == "image.png"));

        let null = Outputs::image("/dev/null");
        draw(&null).expect("drawn");
        assert!(!Path::new("/dev/null").is_file() && !Path::new("/dev/null.spool").exists());
        let error = draw(&Outputs { resume: true, ..null }).expect_err("nothing to resume");
        assert!(error.to_string().starts_with("resume: needed"), "{error}");
    }
}
