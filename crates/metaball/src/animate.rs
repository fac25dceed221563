//! The frames of a scene that moves.

mod numbers;
mod pipeline;
mod report;

use std::ops::Range;
use std::path::PathBuf;
use std::time::Instant;

use metaball_core::View;
use particle_files::{AnimatedScene, NumberedPath};
use picture_files::{
    PictureFile, PictureFileError, RunFile, Target, ensure_sheet, ensure_writable, refuse_overlap,
    whole_picture, write_atomically, write_sheet,
};

use self::numbers::Numbers;
use self::pipeline::Job;
pub use self::report::{AnimationReport, FrameOutcome, FrameReport, FrameTimes};
use crate::inputs::inputs;
use crate::{DrawOptions, Error};

/// Which frames to draw, how, and where to.
#[derive(Debug, Clone)]
pub struct AnimateOptions {
    /// How to draw each.
    pub draw: DrawOptions,
    /// Which frames; `None` for all, or the first seconds of what never ends.
    pub frames: Option<Range<u32>>,
    /// Only every so manyth of them; 0 counts as 1.
    pub every: u32,
    /// Where the pictures go, `.png`, `.jpg` or `.jpeg`. The report is written next to them, named like the
    /// first but ending in `json`.
    pub out: NumberedPath,
    /// Where a picture of all frames side by side goes, if anywhere; of the same formats. None is written
    /// where frames are broken, or were asked for and are not there.
    pub sheet: Option<PathBuf>,
    /// What is kept of what is there already.
    pub keep: Keep,
    /// Whether each frame is built only after the one before was drawn.
    pub in_turn: bool,
    /// Files that are never written over: those that the scene is read from, such as
    /// [`inputs`](crate::inputs()) finds. The image of the surroundings is one of them without being named.
    pub inputs: Vec<PathBuf>,
}

impl AnimateOptions {
    /// All frames to pictures of these names, with all defaults.
    pub fn new(out: NumberedPath) -> Self {
        Self {
            draw: DrawOptions::default(),
            frames: None,
            every: 1,
            out,
            sheet: None,
            keep: Keep::default(),
            in_turn: false,
            inputs: Vec::new(),
        }
    }
}

/// Which frames that are there already are kept: only whole pictures ever are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// Those that say that they were drawn with the same options, by the same version, on the same kind of
    /// device, the CPU or an adapter.
    #[default]
    Same,
    /// All of the wanted size, whatever they show.
    Complete,
    /// None.
    Nothing,
}

/// What happens while frames are drawn.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum AnimationEvent<'a> {
    /// The first frame begins.
    Begins {
        /// Frames to draw.
        missing: usize,
        /// Frames that are there already.
        kept: usize,
        /// Numbers that are wanted, and for which the scene has no frame.
        absent: usize,
    },
    /// A frame is done.
    Done(&'a FrameReport),
}

/// Draws the frames that are not there yet. Returns the report, and where it is written.
///
/// A frame is there if its file is a whole picture, to its last byte, and one that [`Keep`] keeps. Whether the
/// user's particles have changed since is not looked at.
///
/// A frame whose particles cannot be used does not stop the others: the report
/// [names it](AnimationReport::broken). So it is with frames that
/// [`frames`](AnimateOptions::frames) asks for and that the scene has not: the report
/// [names them](AnimationReport::absent), as it does gaps between the first frame and the last where all are
/// drawn. What the method or the adapter refuses stops the run.
///
/// # Errors
/// When there is no frame to draw, one cannot be drawn, or a file cannot be written or is an input or
/// another output. What cannot be written is refused before anything is drawn.
pub fn animate(
    scene: &dyn AnimatedScene,
    options: &AnimateOptions,
    mut on_event: impl FnMut(AnimationEvent<'_>),
) -> Result<(AnimationReport, PathBuf), Error> {
    let draw = &options.draw;
    let numbers = Numbers::of(scene, options)?;
    let files = Files::of(options, &numbers.present);
    files.check(options)?;
    let (width, height) = draw.size;
    // The same for all frames, whichever of them are drawn: where and how large the scene is, and what can
    // draw it, its first one says.
    let (mut camera, mut lighting) = (*scene.camera(), None);
    let first = scene.frame(scene.frames().start);
    let opened = draw.open(first.as_ref().ok())?;
    if draw.viewpoint.is_asked() || draw.light.is_asked() {
        let first = first.map_err(Error::Frames)?;
        camera = draw.viewpoint.camera(&camera, &first)?;
        let is_lit = draw.light.is_asked();
        lighting = is_lit.then(|| draw.light.lighting(&camera, &first)).transpose()?;
    }
    let view = View::new(camera, width, height)?;
    let job = Job {
        options: draw,
        scene,
        view: &view,
        gpu: opened.gpu.as_ref(),
        lighting: lighting.as_ref(),
        out: &options.out,
    };

    let is_kept = |number: &u32| {
        let found = || whole_picture(&options.out.path(*number));
        match options.keep {
            Keep::Same => {
                let description = found().and_then(|found| found.description);
                description.is_some_and(|description| description == job.description(*number))
            }
            Keep::Complete => found().is_some_and(|found| found.size == draw.size),
            Keep::Nothing => false,
        }
    };
    let (kept, missing): (Vec<u32>, Vec<u32>) =
        numbers.present.iter().partition(|number| is_kept(number));
    let absent = numbers.absent_count();
    on_event(AnimationEvent::Begins { missing: missing.len(), kept: kept.len(), absent });
    let start = Instant::now();
    let frames =
        job.draw(&missing, options.in_turn, |frame| on_event(AnimationEvent::Done(frame)))?;

    let whole = numbers.has_all();
    let about = (job.scene, &opened);
    let report =
        AnimationReport::new(about, options, (kept, numbers.absent), frames, start.elapsed());
    let json = serde_json::to_vec_pretty(&report).map_err(|source| PictureFileError::Encode {
        what: files.report.display().to_string(),
        source: source.into(),
    })?;
    write_atomically(&files.report, &json)?;
    if let (Some(sheet), true, None) = (&options.sheet, whole, report.broken().next()) {
        write_sheet(sheet, &files.frames)?;
    }
    Ok((report, files.report))
}

/// The files of a run but for the sheet.
struct Files {
    frames: Vec<PathBuf>,
    report: PathBuf,
}

impl Files {
    /// Of frames with these numbers, at least one.
    fn of(options: &AnimateOptions, numbers: &[u32]) -> Self {
        let frames: Vec<_> = numbers.iter().map(|number| options.out.path(*number)).collect();
        Self { report: frames[0].with_extension("json"), frames }
    }

    /// Refuses what cannot be written.
    fn check(&self, options: &AnimateOptions) -> Result<(), Error> {
        let AnimateOptions { draw, sheet, .. } = options;
        let (width, height) = draw.size;
        let frames = self.frames.iter().map(|path| ("frame", path));
        let others =
            [("report", &self.report)].into_iter().chain(sheet.iter().map(|path| ("sheet", path)));
        let outputs: Vec<RunFile> =
            frames.chain(others).map(|(what, path)| (what, path.clone())).collect();
        refuse_overlap(&outputs, &inputs(&options.inputs, &draw.light))?;
        drop(PictureFile::create(&self.frames[0], width, height)?);
        for path in &self.frames {
            Target::of(path)?;
        }
        ensure_writable(&self.report)?;
        if let Some(sheet) = sheet {
            ensure_sheet(sheet, self.frames.len(), draw.size)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use bench_scenes::{Moving, Overrides};
    use metaball_core::gpu::{AdapterChoice, Gpu};
    use particle_files::{ReadOptions, Sequence};

    use super::*;
    use crate::{Backend, LightOptions};

    fn moving(spec: &str) -> Moving {
        Moving::load(spec, &Overrides::default()).expect("a scene that moves")
    }

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a folder")
    }

    fn options(backend: Backend, folder: &Path) -> AnimateOptions {
        let out = folder.join("f-%02d.png").display().to_string().parse().expect("numbered");
        AnimateOptions {
            draw: DrawOptions { size: (32, 24), backend, ..DrawOptions::default() },
            frames: Some(0..4),
            ..AnimateOptions::new(out)
        }
    }

    fn run(scene: &dyn AnimatedScene, options: &AnimateOptions) -> AnimationReport {
        animate(scene, options, |_| ()).expect("drawn").0
    }

    fn frames(folder: &Path) -> Vec<Vec<u8>> {
        (0..4).map(|n| fs::read(folder.join(format!("f-{n:02}.png"))).expect("drawn")).collect()
    }

    /// The pictures do not depend on the order, the threads or the runs that they were made in.
    fn same_frames_however_made(backend: &Backend) {
        let tornado = moving("tornado:300");
        let folders = [folder(), folder(), folder()];
        let [piped, in_turn, resumed] = folders.each_ref().map(tempfile::TempDir::path);
        let options = |folder: &Path| options(backend.clone(), folder);
        run(&tornado, &options(piped));
        run(&tornado, &AnimateOptions { in_turn: true, ..options(in_turn) });
        assert_eq!(frames(piped), frames(in_turn));
        let distinct = frames(piped);
        assert!(distinct.windows(2).all(|pair| pair[0] != pair[1]), "the scene moves");

        // Interrupted: two frames, one of them of another size, and half of a third.
        let mut other = options(resumed);
        other.draw.size = (16, 12);
        run(&tornado, &AnimateOptions { frames: Some(0..1), ..other });
        run(&tornado, &AnimateOptions { frames: Some(2..3), ..options(resumed) });
        let third = resumed.join("f-02.png");
        let before = fs::metadata(&third).and_then(|data| data.modified()).expect("a file");
        fs::write(resumed.join("f-03.png"), &distinct[3][..distinct[3].len() / 2])
            .expect("written");
        assert_eq!(run(&tornado, &options(resumed)).kept, [2]);
        assert_eq!(frames(resumed), distinct);
        let after = fs::metadata(&third).and_then(|data| data.modified()).expect("a file");
        assert_eq!(before, after, "a frame that was there was drawn again");
        assert!(resumed.join("f-00.json").is_file());
    }

    #[test]
    fn what_is_kept_is_whole_and_what_was_asked_for() {
        let (folder, tornado) = (folder(), moving("tornado:300"));
        let at = |number: u32| folder.path().join(format!("f-{number:02}.png"));
        let plain = options(Backend::Cpu, folder.path());
        run(&tornado, &plain);
        let mut lit = plain.clone();
        lit.draw.light = LightOptions { shadows: true, ..LightOptions::default() };
        // A picture of another size, and one without its last byte.
        let mut small = AnimateOptions { frames: Some(1..2), ..plain };
        small.draw.size = (16, 12);
        run(&tornado, &small);
        let bytes = fs::read(at(2)).expect("drawn");
        fs::write(at(2), &bytes[..bytes.len() - 1]).expect("written");
        let kept = |keep| run(&tornado, &AnimateOptions { keep, ..lit.clone() }).kept;
        assert_eq!(kept(Keep::Complete), [0, 3]);
        assert_eq!(kept(Keep::Complete), [0, 1, 2, 3]);
        assert_eq!(kept(Keep::Same), [1, 2]);
        assert_eq!(kept(Keep::Nothing), Vec::<u32>::new());
    }

    #[test]
    fn the_cpu_draws_the_same_frames_however_made() {
        same_frames_however_made(&Backend::Cpu);
    }

    #[test]
    fn an_adapter_draws_the_same_frames_however_made() {
        if Gpu::for_test().is_none() {
            return;
        }
        same_frames_however_made(&Backend::Adapter(AdapterChoice::Environment));
    }

    fn same_light_however_made(backend: &Backend) {
        let tornado = moving("tornado:100");
        let lit = |light: LightOptions, in_turn| {
            let folder = folder();
            let mut options = options(backend.clone(), folder.path());
            options.draw.light = light;
            run(&tornado, &AnimateOptions { frames: Some(3..5), in_turn, ..options });
            fs::read(folder.path().join("f-04.png")).expect("drawn")
        };
        let shadows = LightOptions { shadows: true, ..LightOptions::default() };
        let plain = LightOptions { samples: Some(1), ..LightOptions::default() };
        let picture = lit(shadows.clone(), false);
        assert_eq!(lit(shadows, true), picture);
        assert_ne!(lit(plain, false), picture, "there is no shadow");
    }

    #[test]
    fn the_cpu_lights_the_same_frames_however_made() {
        same_light_however_made(&Backend::Cpu);
    }

    #[test]
    fn an_adapter_lights_the_same_frames_however_made() {
        if Gpu::for_test().is_none() {
            return;
        }
        same_light_however_made(&Backend::Adapter(AdapterChoice::Environment));
    }

    #[test]
    fn a_broken_file_is_named_and_the_others_are_drawn() {
        let folder = folder();
        let folder = folder.path();
        for number in 0..4 {
            let radius = if number == 1 { "much" } else { "1" };
            let table = format!("x,y,z,radius\n{number},0,0,{radius}\n");
            fs::write(folder.join(format!("p{number}.csv")), table).expect("written");
        }
        let files =
            Sequence::open(folder.join("p%d.csv"), &ReadOptions::default(), &Overrides::default())
                .expect("there");
        let options = options(Backend::Cpu, folder);
        let report =
            run(&files, &AnimateOptions { sheet: Some(folder.join("s.png")), ..options.clone() });
        let broken: Vec<_> = report.broken().collect();
        let [(1, reason)] = broken[..] else { panic!("frame 1 is broken: {broken:?}") };
        assert!(reason.contains("p1.csv, line 2"), "{reason}");
        let there = |number: u32| folder.join(format!("f-{number:02}.png")).is_file();
        assert_eq!([0, 1, 2, 3].map(there), [true, false, true, true]);
        assert!(!folder.join("s.png").exists());
        let report = fs::read_to_string(folder.join("f-00.json")).expect("written");
        assert!(report.contains("p1.csv, line 2"), "{report}");

        assert!(report.contains("\"drawn\": 3"), "{report}");

        let beyond = AnimateOptions { frames: Some(7..9), ..options };
        let error = animate(&files, &beyond, |_| ()).expect_err("there are none").to_string();
        assert!(error.starts_with("frames 7..9: needed some of"), "{error}");
    }
    /// Frames 1, 2 and 5 of a ball that moves.
    fn gappy(folder: &Path) -> Sequence {
        for number in [1, 2, 5] {
            let table = format!("x,y,z,radius\n{number},0,0,1\n");
            fs::write(folder.join(format!("p{number}.csv")), table).expect("written");
        }
        Sequence::open(folder.join("p%d.csv"), &ReadOptions::default(), &Overrides::default())
            .expect("there")
    }

    #[test]
    fn frames_that_are_not_there_are_named() {
        let folder = folder();
        let files = gappy(folder.path());
        let sheet = folder.path().join("s.png");
        let options =
            AnimateOptions { sheet: Some(sheet.clone()), ..options(Backend::Cpu, folder.path()) };
        let all = |range| run(&files, &AnimateOptions { frames: range, ..options.clone() });
        let asked = all(Some(1..9));
        assert_eq!(asked.absent, [[3, 4], [6, 8]]);
        assert_eq!((asked.drawn, asked.frames.len()), (3, 3));
        assert!(!sheet.exists());
        let gaps = all(None);
        assert_eq!((gaps.absent, gaps.kept), (vec![[3, 4]], vec![1, 2, 5]));
        assert!(sheet.is_file());
        assert_eq!(all(Some(1..3)).absent, Vec::<[u32; 2]>::new());
    }

    #[test]
    fn no_output_is_an_input_or_another_output() {
        let folder = folder();
        let files = gappy(folder.path());
        let options = AnimateOptions { frames: None, ..options(Backend::Cpu, folder.path()) };
        let refused = |options: AnimateOptions| {
            let drawn = animate(&files, &options, |_| panic!("drawn"));
            drawn.expect_err("refused").to_string()
        };
        let at = |name: &str| folder.path().join(name);
        let numbered = |name: &str| at(name).display().to_string().parse().expect("numbered");
        let over = AnimateOptions {
            out: numbered("p%d.csv"),
            inputs: vec![at("p2.csv")],
            ..options.clone()
        };
        let error = refused(over);
        assert!(error.contains("of its own for the frame, found the scene"), "{error}");
        let sheet = AnimateOptions { sheet: Some(at("f-02.png")), ..options.clone() };
        let error = refused(sheet);
        assert!(error.contains("of its own for the sheet, found the frame"), "{error}");
        let report = AnimateOptions { inputs: vec![at("f-01.json")], ..options.clone() };
        let error = refused(report);
        assert!(error.contains("of its own for the report, found the scene"), "{error}");
        let gif = AnimateOptions { out: numbered("f-%d.gif"), ..options.clone() };
        assert!(refused(gif).ends_with("found .gif"));
        let gif = AnimateOptions { sheet: Some(at("s.gif")), ..options.clone() };
        assert!(refused(gif).ends_with("found .gif"));
        fs::create_dir(at("f-05.png")).expect("made");
        assert!(refused(options).ends_with("found a folder"));
        assert!(!at("f-01.png").exists() && !at("f-01.json").exists());
    }

    #[test]
    fn frames_may_be_jpegs() {
        let folder = folder();
        let files = gappy(folder.path());
        let out = folder.path().join("f-%d.jpg").display().to_string().parse().expect("numbered");
        let sheet = Some(folder.path().join("s.jpeg"));
        let options =
            AnimateOptions { frames: None, out, sheet, ..options(Backend::Cpu, folder.path()) };
        assert_eq!(run(&files, &options).drawn, 3);
        assert_eq!(run(&files, &options).kept, [1, 2, 5]);
        for name in ["f-1.jpg", "s.jpeg"] {
            let bytes = fs::read(folder.path().join(name)).expect("written");
            assert!(bytes.starts_with(&[0xff, 0xd8, 0xff]), "{name}");
        }
    }
}
