//! Programs that read the arrays that ours reads: balls and rays in, hits and clocks out.

use std::fs;
use std::process::Command;

use anyhow::Context;
use metaball_core::{Metaball, Ray, Scene, View};
use picture_files::{HitImage, read_hits};
use tempfile::TempDir;

use super::contender::{Contender, Times};

const HITS_FILE: &str = "hits.npy";

/// A program, and the arrays of a view of a scene in a temporary folder that goes with it.
#[derive(Debug)]
pub(super) struct ArrayJob {
    /// Words that start the program.
    program: Vec<String>,
    /// What it is told: threshold, width, height, threads, and one number of its own.
    arguments: [String; 5],
    size: (u32, u32),
    folder: TempDir,
}

impl ArrayJob {
    /// Writes the arrays: five f32 a ball (centre, R, q) and eight a ray (origin, `t_min`, direction,
    /// `t_max`), in this machine's byte order. The last argument means what the program says it does.
    ///
    /// # Errors
    /// When they cannot be written.
    pub(super) fn new(
        program: &[&str],
        scene: &Scene,
        view: &View,
        threads: usize,
        own: f64,
    ) -> anyhow::Result<Self> {
        let folder = TempDir::new().context("cannot make a temporary folder")?;
        let write = |name, numbers: &mut dyn Iterator<Item = f32>| {
            let bytes: Vec<u8> = numbers.flat_map(f32::to_ne_bytes).collect();
            let what = || format!("cannot write {name} to the temporary folder");
            fs::write(folder.path().join(name), bytes).with_context(what)
        };
        write("balls.f32", &mut scene.balls().flat_map(ball_numbers))?;
        write("rays.f32", &mut view.rays().iter().flat_map(ray_numbers))?;
        let size = (view.width(), view.height());
        let arguments = [
            format!("{:e}", scene.threshold()),
            size.0.to_string(),
            size.1.to_string(),
            threads.to_string(),
            own.to_string(),
        ];
        let program = program.iter().map(|&word| word.to_owned()).collect();
        Ok(Self { program, arguments, size, folder })
    }
}

impl Contender for ArrayJob {
    fn time(&self) -> anyhow::Result<Times> {
        let (program, first) = self.program.split_first().context("no program")?;
        let mut command = Command::new(program);
        command.args(first).args(&self.arguments).current_dir(self.folder.path());
        let output = command.output().with_context(|| format!("cannot run {program}"))?;
        let complaint = String::from_utf8_lossy(&output.stderr);
        let complaint = complaint.trim().lines().last().unwrap_or_default();
        anyhow::ensure!(output.status.success(), "{}: {complaint}", output.status);
        times(&String::from_utf8_lossy(&output.stdout))
    }

    fn hits(&self) -> anyhow::Result<HitImage> {
        let image = read_hits(&self.folder.path().join(HITS_FILE))?;
        let found = (image.width, image.height);
        anyhow::ensure!(found == self.size, "hits: needed {:?}, found {found:?}", self.size);
        Ok(image)
    }
}

fn ball_numbers(ball: Metaball) -> [f32; 5] {
    let [x, y, z] = ball.center.to_array();
    [x, y, z, ball.radius, ball.strength]
}

fn ray_numbers(ray: &Ray) -> [f32; 8] {
    let [x, y, z] = ray.origin.to_array();
    let [dx, dy, dz] = ray.direction.to_array();
    [x, y, z, ray.t_min, dx, dy, dz, ray.t_max]
}

/// A program's clocks: lines of a name and milliseconds.
fn times(text: &str) -> anyhow::Result<Times> {
    let clock = |name: &str| {
        let words = text.lines().filter_map(|line| line.split_once(' '));
        let mut numbers = words.filter(|(word, _)| *word == name);
        let number = numbers.find_map(|(_, number)| number.trim().parse().ok());
        number.with_context(|| format!("needed \"{name} …\" in its output, found \"{text}\""))
    };
    Ok(Times { prepare: clock("prepare")?, trace: clock("trace")?, trace_cpu: clock("processor")? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_are_read() {
        let found = times("a warning\nprepare 1.5\ntrace 20\nprocessor 38.25\n").expect("clocks");
        assert_eq!(found, Times { prepare: 1.5, trace: 20.0, trace_cpu: 38.25 });
        let error = times("prepare 1.5\ntrace none\n").expect_err("no clock");
        assert!(error.to_string().contains("\"trace …\""), "{error}");
    }
}
