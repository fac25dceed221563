//! How quickly pictures come: from opening a scene to the first one, and while the camera turns by a
//! degree each time, at 1280 × 720, without a window. Scenes are named as `metaball render` names them:
//!
//! `cargo run --release -p viewer --example turning -- molecule tornado-128k`

use std::error::Error;
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use metaball::{BoxError, Overrides, ReadOptions};
use viewer::{Content, Opener, Painting, Stage, Start, Subject, Threads, Viewer};

const SIZE: (u32, u32) = (1280, 720);
const TURNS: usize = 90;

struct Bench;

impl Opener for Bench {
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError> {
        let bench = bench_scenes::load_as(spec, reading, &Overrides::default())?;
        Ok(Subject {
            spec: spec.to_owned(),
            name: bench.name,
            camera: bench.camera,
            notes: None,
            legend: None,
            inputs: Vec::new(),
            reading: reading.clone(),
            content: Content::Still(bench.scene),
        })
    }
}

#[allow(clippy::print_stdout, reason = "this is what it is run for")]
fn main() -> Result<(), Box<dyn Error>> {
    println!("scene, balls, first picture ms, pictures a second, columns of the last, sharp ms");
    for spec in std::env::args().skip(1) {
        let begin = Instant::now();
        let mut viewer =
            Viewer::new(Arc::new(Bench), Arc::new(Threads), start(&spec), &(Arc::new(|| ()) as _));
        next(&mut viewer, false)?;
        let first = begin.elapsed();
        let mut times = Vec::new();
        let mut columns = 0;
        for _ in 0..TURNS {
            let begin = Instant::now();
            let pose = viewer.pose().ok_or("a pose")?;
            viewer.set_pose(pose.orbited(1f64.to_radians(), 0.0));
            columns = next(&mut viewer, true)?.view.width();
            times.push(begin.elapsed());
        }
        let sharp = loop {
            let painting = next(&mut viewer, false)?;
            if painting.stage == Stage::Sharp {
                break painting.time;
            }
        };
        times.sort();
        let rate = 1.0 / times[TURNS / 2].as_secs_f64();
        let (balls, first, sharp) =
            (viewer.model().ok_or("a model")?.scene().len(), ms(first), ms(sharp));
        println!("{spec}, {balls}, {first:.0}, {rate:.0}, {columns}, {sharp:.0}");
    }
    Ok(())
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// The next picture.
fn next(viewer: &mut Viewer, held: bool) -> Result<&Painting, Box<dyn Error>> {
    let before = viewer.paintings();
    while viewer.paintings() == before {
        viewer.draw(SIZE, held);
        sleep(Duration::from_micros(200));
        viewer.hear();
        if let Some(failure) = viewer.failure() {
            return Err(failure.into());
        }
    }
    Ok(viewer.painting().ok_or("a picture")?)
}

fn start(spec: &str) -> Start {
    Start { spec: Some(spec.to_owned()), ..Start::default() }
}
