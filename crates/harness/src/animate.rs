//! The command `animate`: the frames of a moving scene, by one method.

mod pipeline;
mod report;

use std::ops::Range;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{bail, ensure};
use bench_scenes::Moving;
use metaball_core::View;
use particle_files::NumberedPath;

use crate::animate::pipeline::{Job, Outcome};
use crate::animate::report::Report;
use crate::console::{self, Progress};
use crate::frame_png::description_in;
use crate::output::write_atomically;
use crate::render::{Drawing, open};
use crate::sheet::write_sheet;

/// What to draw, how, and where to.
#[derive(Debug, Clone)]
pub struct Order {
    /// What to draw and how; the scene is one that moves.
    pub drawing: Drawing,
    /// Which frames; `None` for all, or the first seconds of a motion that goes on for ever.
    pub frames: Option<Range<u32>>,
    /// Only every so manyth of them, at least 1.
    pub every: u32,
    /// Where the PNGs go. The report goes beside them, named like the first but ending in `json`.
    pub out: NumberedPath,
    /// Where a picture of all frames side by side goes, if anywhere.
    pub sheet: Option<PathBuf>,
    /// Draw what is there already, too.
    pub force: bool,
    /// Whether each frame is built only after the one before was drawn.
    pub in_turn: bool,
}

/// Draws the frames that are not there yet, and reports.
///
/// A frame is there if its file is a whole PNG that says it was drawn with these options. Whether the
/// user's particles have changed since is not looked at.
///
/// A frame whose particles cannot be used does not stop the others: it is reported when they are
/// done, and the command fails. What the method or the device refuses stops the run.
///
/// # Errors
/// When the scene does not move or not load, a frame cannot be drawn or a file not be written.
pub fn animate(order: &Order) -> anyhow::Result<()> {
    let drawing = &order.drawing;
    let moving = Moving::load(&drawing.scene, &drawing.overrides)?;
    let numbers = numbers(order, &moving)?;
    let (width, height) = drawing.size;
    // The same for all frames, whichever of them are drawn: where and how large the scene is, its first
    // one says.
    let (mut camera, mut lighting) = (moving.camera, None);
    if drawing.camera.is_asked() || drawing.light.is_asked() {
        let first = moving.frame(moving.frames.start)?;
        camera = drawing.camera.camera(&camera, first.bounds().center())?;
        let is_lit = drawing.light.is_asked();
        lighting = is_lit.then(|| drawing.light.lighting(&camera, &first)).transpose()?;
    }
    let view = View::new(camera, width, height)?;
    let gpu = open(&drawing.device)?;
    let job = Job {
        drawing,
        moving: &moving,
        view: &view,
        gpu: gpu.as_ref(),
        lighting: lighting.as_ref(),
        out: &order.out,
    };

    let is_there = |number: &u32| {
        let found = description_in(&order.out.path(*number));
        !order.force && found.is_some_and(|found| found == job.description(*number))
    };
    let (there, missing): (Vec<u32>, Vec<u32>) =
        numbers.iter().partition(|number| is_there(number));
    if !there.is_empty() {
        console::note(&format!("{} of {} frames are there already", there.len(), numbers.len()));
    }
    let start = Instant::now();
    let progress = Progress::new(missing.len() as u64);
    let frames = job.draw(&missing, order.in_turn, |frame| {
        progress.advance(1);
        progress.stage(format!("frame {}: {}", frame.number, frame.outcome));
    })?;
    drop(progress);

    let report = Report::new(&job, order.in_turn, there, frames, start.elapsed());
    let path = order.out.path(numbers[0]).with_extension("json");
    write_atomically(&path, &serde_json::to_vec_pretty(&report)?)?;
    report.print();
    console::line(&format!("{:<10} {}", "report", path.display()));

    let broken: Vec<_> = report.frames.iter().filter(|frame| frame.outcome.is_broken()).collect();
    for frame in &broken {
        if let Outcome::Broken { error } = &frame.outcome {
            console::note(&format!("frame {}: {error}", frame.number));
        }
    }
    if !broken.is_empty() {
        bail!("{} of {} frames could not be drawn", broken.len(), numbers.len());
    }
    if let Some(sheet) = &order.sheet {
        let pictures: Vec<_> = numbers.iter().map(|number| order.out.path(*number)).collect();
        write_sheet(sheet, &pictures)?;
    }
    Ok(())
}

/// The frames to draw: those of the range that there are.
fn numbers(order: &Order, moving: &Moving) -> anyhow::Result<Vec<u32>> {
    let range = order.frames.clone().unwrap_or(moving.frames.clone());
    let (wanted, name) = (range.len(), &moving.name);
    let present = moving.present(range.clone())?;
    ensure!(
        !present.is_empty(),
        "frames {}..{}: needed some of {name}'s frames {}..{}",
        range.start,
        range.end,
        moving.frames.start,
        moving.frames.end
    );
    if present.len() < wanted {
        let missing = wanted - present.len();
        console::note(&format!("{name} has no frame for {missing} of {wanted} numbers"));
    }
    Ok(present.into_iter().step_by(order.every.max(1) as usize).collect())
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use bench_scenes::Overrides;
    use metaball_core::gpu::{AdapterChoice, Gpu, Picture};

    use super::*;
    use crate::camera::CameraOptions;
    use crate::light::LightOptions;
    use crate::light::tests::options;
    use crate::methods::find;
    use crate::output::tests::scratch;
    use crate::render::Device;

    fn order(scene: &str, device: Device, folder: &Path) -> Order {
        let drawing = Drawing {
            scene: scene.to_owned(),
            overrides: Overrides::default(),
            method: find("fbvh-certified").expect("listed"),
            size: (32, 24),
            camera: CameraOptions::default(),
            picture: Picture::Phong,
            light: LightOptions::default(),
            device,
        };
        let out = folder.join("f-%02d.png").display().to_string().parse().expect("numbered");
        Order {
            drawing,
            frames: Some(0..4),
            every: 1,
            out,
            sheet: None,
            force: false,
            in_turn: false,
        }
    }

    fn frames(folder: &Path) -> Vec<Vec<u8>> {
        (0..4).map(|n| fs::read(folder.join(format!("f-{n:02}.png"))).expect("drawn")).collect()
    }

    /// The pictures do not know in what order, by how many threads or in how many runs they were made.
    fn same_frames_however_made(device: &Device, name: &str) {
        let folders = ["piped", "in-turn", "resumed"].map(|way| scratch(&format!("{name}-{way}")));
        let [piped, in_turn, resumed] = &folders;
        let order = |folder: &Path| order("tornado:300", device.clone(), folder);
        animate(&order(piped)).expect("drawn");
        animate(&Order { in_turn: true, ..order(in_turn) }).expect("drawn");
        assert_eq!(frames(piped), frames(in_turn));
        let distinct = frames(piped);
        assert!(distinct.windows(2).all(|pair| pair[0] != pair[1]), "the scene moves");

        // Interrupted: two frames, one of them of another size, and half of a third.
        let mut other = order(resumed);
        other.drawing.size = (16, 12);
        animate(&Order { frames: Some(0..1), ..other }).expect("drawn");
        animate(&Order { frames: Some(2..3), ..order(resumed) }).expect("drawn");
        let third = resumed.join("f-02.png");
        let before = fs::metadata(&third).and_then(|data| data.modified()).expect("a file");
        fs::write(resumed.join("f-03.png"), &distinct[3][..distinct[3].len() / 2])
            .expect("written");
        animate(&order(resumed)).expect("drawn");
        assert_eq!(frames(resumed), distinct);
        let after = fs::metadata(&third).and_then(|data| data.modified()).expect("a file");
        assert_eq!(before, after, "a frame that was there was drawn again");
        assert!(resumed.join("f-00.json").is_file());
        for folder in folders {
            fs::remove_dir_all(folder).expect("removable");
        }
    }

    #[test]
    fn the_cpu_draws_the_same_frames_however_made() {
        same_frames_however_made(&Device::Cpu, "animate-cpu");
    }

    #[test]
    fn an_adapter_draws_the_same_frames_however_made() {
        if Gpu::for_test().is_none() {
            return;
        }
        same_frames_however_made(&Device::Adapter(AdapterChoice::Environment), "animate-gpu");
    }

    #[test]
    fn light_is_the_same_however_frames_are_made() {
        if Gpu::for_test().is_none() {
            return;
        }
        let folders = ["piped", "in-turn", "plain"].map(|way| scratch(&format!("lit-{way}")));
        let lit = |folder: &Path, line: &str, in_turn| {
            let device = Device::Adapter(AdapterChoice::Environment);
            let mut order = order("tornado:100", device, folder);
            order.drawing.light = options(line);
            animate(&Order { frames: Some(3..5), in_turn, ..order }).expect("drawn");
            fs::read(folder.join("f-04.png")).expect("drawn")
        };
        let [piped, in_turn, plain] = &folders;
        let picture = lit(piped, "--shadows", false);
        assert_eq!(lit(in_turn, "--shadows", true), picture);
        assert_ne!(lit(plain, "--samples 1", false), picture, "there is no shadow");
        for folder in folders {
            fs::remove_dir_all(folder).expect("removable");
        }
    }

    #[test]
    fn a_broken_file_is_named_and_the_others_are_drawn() {
        let folder = scratch("animate-broken");
        for number in 0..4 {
            let radius = if number == 1 { "much" } else { "1" };
            let table = format!("x,y,z,radius\n{number},0,0,{radius}\n");
            fs::write(folder.join(format!("p{number}.csv")), table).expect("written");
        }
        let scene = folder.join("p%d.csv").display().to_string();
        let error = animate(&order(&scene, Device::Cpu, &folder)).expect_err("one is broken");
        assert_eq!(error.to_string(), "1 of 4 frames could not be drawn");
        let there = |number: u32| folder.join(format!("f-{number:02}.png")).is_file();
        assert_eq!([0, 1, 2, 3].map(there), [true, false, true, true]);
        let report = fs::read_to_string(folder.join("f-00.json")).expect("written");
        assert!(report.contains("p1.csv, line 2"), "{report}");

        let mut beyond = order(&scene, Device::Cpu, &folder);
        beyond.frames = Some(7..9);
        let error = animate(&beyond).expect_err("there are none").to_string();
        assert!(error.starts_with("frames 7..9: needed some of"), "{error}");
        fs::remove_dir_all(folder).expect("removable");
    }
}
