//! The command that opens a window: `view`.

use std::sync::Arc;

use bench_scenes::{BenchScene, Moving, inputs, load_as};
use clap::Args;
use metaball::{AnimatedScene, BoxError, Overrides, Picture, ReadOptions};
use metaball_core::Color;
use viewer::{Content, Look, Opener, Start, Subject, open_window};

use crate::camera::CameraArgs;
use crate::clip::ClipArgs;
use crate::light::LightArgs;
use crate::picture::{color_of, picture_on_cpu};
use crate::reading::ReadingArgs;
use crate::shared::FieldArgs;

/// What a window begins with.
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// A known name, a generator such as scattered:50000, or a file; what moves, such as splash,
    /// tornado:4000 or particles-%04d.xyz, has a timeline. A file may be dropped onto the window too.
    scene: Option<String>,
    /// What the picture shows: phong, normal, depth or color.
    #[arg(long, value_name = "WHAT", default_value = "phong", value_parser = picture_on_cpu)]
    picture: Picture,
    /// One colour for all balls, sRGB, 0 to 1; the scene's own, or white, when left out.
    #[arg(long, value_name = "R,G,B", value_parser = color_of, conflicts_with = "color_by")]
    color: Option<Color>,
    #[command(flatten)]
    reading: ReadingArgs,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    light: LightArgs,
}

impl ViewArgs {
    pub(crate) fn run(self) -> anyhow::Result<()> {
        Ok(open_window(Arc::new(Scenes), self.start()?)?)
    }

    fn start(self) -> anyhow::Result<Start> {
        let Self { scene, picture, color, reading, field, camera, clip, light } = self;
        Ok(Start {
            spec: scene,
            reading: reading.options(),
            field: Overrides { color, ..field.overrides() },
            viewpoint: camera.viewpoint(),
            look: Look { picture, clip: clip.clip()?, light: light.options() },
        })
    }
}

/// Opens what the other commands take: what `animate` alone knows, and numbered files, with all their
/// frames.
struct Scenes;

impl Opener for Scenes {
    fn open(&self, spec: &str, reading: &ReadOptions) -> Result<Subject, BoxError> {
        let found = match load_as(spec, reading, &Overrides::default()) {
            Ok(still) => return Ok(subject_of(spec, reading, still)),
            Err(found) => found,
        };
        match Moving::load_as(spec, reading, &Overrides::default()) {
            Ok(moving) => Ok(subject_that_moves(spec, reading, moving)),
            Err(_) => Err(found.into()),
        }
    }
}

fn subject_of(spec: &str, reading: &ReadOptions, still: BenchScene) -> Subject {
    let file = still.file;
    Subject {
        spec: spec.to_owned(),
        name: still.name,
        camera: still.camera,
        legend: file.as_ref().and_then(|file| file.legend.clone()),
        notes: file.map(|file| file.notes),
        inputs: inputs(spec).into_iter().chain(reading.topology.clone()).collect(),
        reading: reading.clone(),
        content: Content::Still(still.scene),
    }
}

fn subject_that_moves(spec: &str, reading: &ReadOptions, moving: Moving) -> Subject {
    Subject {
        spec: spec.to_owned(),
        name: moving.name.clone(),
        camera: moving.camera,
        notes: moving.notes().cloned(),
        legend: None,
        inputs: inputs(spec).into_iter().chain(reading.topology.clone()).collect(),
        reading: reading.clone(),
        content: Content::Moving(Box::new(moving)),
    }
}

#[cfg(test)]
mod tests {
    use viewer::CommandLine;

    use super::*;
    use crate::{Cli, Command};
    use clap::Parser;

    fn started(words: &[String]) -> Start {
        let Ok(Cli { command: Command::View(view) }) = Cli::try_parse_from(words) else {
            panic!("a legal command line: {words:?}")
        };
        view.start().expect("legal")
    }

    /// What the window writes as a command line is read as what it shows.
    #[test]
    fn command_lines_are_read_as_they_were_meant() {
        for line in [
            "metaball view molecule",
            "metaball view b.xyz --as particles --radius 2 --radius-scale 0.5 --units nm --frame 3 \
             --model -1 --topology a.pdb --columns x,y,z --keep chain=A --keep water --drop mass=1..2 \
             --color-by charge=-1..1 --repeat 2,1,1 --periodic --frame-all",
            "metaball view b.csv --support-radius 0.1 --color 0.2,0.5,1 --kernel wyvill --threshold 0.4 \
             --eye -1.5,2e-7,3 --look-at 5460000.25,0,-1 --up 0,0.1,1 --fov 33.3 --picture normal \
             --clip 1,0,0,-0.5 --clip-box -1,-2,-3,1,2,3",
            "metaball view tornado:4000 --kernel power --exponent 3 --shadows --lamp -1,1,0.3 --lamp 0,1,0 \
             --lamp-size 7 --ambient-occlusion 4 --occlusion-reach 2.5 --reflections 2 \
             --reflectivity 0.4 --floor tiles --environment sky.hdr --cel 3 --depth-cue 0.5 --samples 9 \
             --seed 3 --exposure -1",
            "metaball view splash --refraction 1.33 --absorption 2,1,0 --bounces 4 --floor plain",
            "metaball view splash --opacity 0.4",
        ] {
            let words: Vec<_> = line.split_whitespace().map(str::to_owned).collect();
            let wanted = started(&words);
            let spec = wanted.spec.clone().expect("named");
            let written = CommandLine::new(&["metaball", "view", &spec])
                .reading(&wanted.reading)
                .field(&wanted.field)
                .viewpoint(&wanted.viewpoint)
                .picture(wanted.look.picture)
                .clip(&wanted.look.clip)
                .light(&wanted.look.light);
            let found = started(written.words());
            assert_eq!(format!("{found:?}"), format!("{wanted:?}"), "{written}");
        }
    }
}
