//! Primary rays: POV-Ray's own clocks, and depths out of its colours.

use image::Rgb;
use metaball_core::{Hit, Scene, Verdict, View};
use picture_files::HitImage;

use super::blob::{Look, scene_text, vector};
use super::job::Job;
use super::log::clocks;
use crate::tables::peers::contender::{Contender, Times};

/// Periods of the fine channel over the range of the coarse one. A step of 16 bits in the coarse one
/// is a sixteenth of a period, so the period is never uncertain.
const PERIODS: f64 = 4096.0;

/// A view of a scene, in white, or in colours that tell its depth.
#[derive(Debug)]
pub struct Primary<'a> {
    view: &'a View,
    /// No surface is deeper than this.
    range: f64,
    job: Job,
}

impl<'a> Primary<'a> {
    /// Writes the scene down. The field is that of α = 2 whatever the scene's kernel is.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn new(scene: &Scene, view: &'a View, threads: usize) -> anyhow::Result<Self> {
        let range = range(scene, view);
        let job = Job::new(&scene_text(scene, view, &look(view, range)), view, threads)?;
        Ok(Self { view, range, job })
    }
}

impl Contender for Primary<'_> {
    /// In white. Before the first ray it parses the scene and makes the blob's hierarchy.
    fn time(&self) -> anyhow::Result<Times> {
        let log = self.job.draw(&[])?;
        let (prepare, _) = clocks(&log, "Parse Time:")?;
        let (trace, trace_cpu) = clocks(&log, "Trace Time:")?;
        Ok(Times { prepare, trace, trace_cpu })
    }

    /// Draws the scene anew with its depth for a colour, and reads the hits off the picture, without
    /// normals. Distances are along POV-Ray's own rays, which are f64.
    fn hits(&self) -> anyhow::Result<HitImage> {
        self.job.draw(&["Depth"])?;
        let picture = self.job.picture()?;
        let (width, height) = picture.dimensions();
        let camera = self.view.camera();
        let forward = camera.forward().as_dvec3().normalize();
        let hit = |(column, row, color): (u32, u32, &Rgb<u16>)| {
            depth_of(*color, self.range).map_or(Hit::MISS, |depth| {
                let direction = camera.exact_direction(column, row, width, height);
                let t = (depth / direction.dot(forward)) as f32;
                Hit { verdict: Verdict::Hit, t, ..Hit::MISS }
            })
        };
        let hits = picture.enumerate_pixels().map(hit).collect();
        Ok(HitImage { width, height, hits, has_normals: false })
    }
}

/// The depth beyond which there is no ball, with a margin for the coarse channel's last step.
fn range(scene: &Scene, view: &View) -> f64 {
    let eye = view.camera().eye().as_dvec3();
    let reach = scene
        .supports()
        .iter()
        .map(|support| support.center.as_dvec3().distance(eye) + f64::from(support.radius));
    1.01 * reach.fold(0.0, f64::max).max(f64::from(f32::MIN_POSITIVE))
}

/// White, or with `Depth` declared blue where there is a surface, red the depth over the range, and
/// green its fraction at [`PERIODS`] periods.
fn look(view: &View, range: f64) -> Look {
    let camera = view.camera();
    let eye = vector(camera.eye().as_dvec3());
    let gradient = vector(camera.forward().as_dvec3().normalize());
    let channel = |from: &str, to: &str, period: f64| {
        format!(
            "[1 gradient {gradient} color_map {{ [0 rgb {from}] [1 rgb {to}] }} scale {period:e}]"
        )
    };
    // The average of two pigments is half of either.
    let coarse = channel("<0,0,2>", "<2,0,2>", range);
    let fine = channel("<0,0,0>", "<0,2,0>", range / PERIODS);
    let surface = format!(
        "#ifdef (Depth)\n\
         pigment {{ average pigment_map {{\n{coarse}\n{fine}\n}} translate {eye} }}\n\
         #else\npigment {{ rgb 1 }}\n#end\n\
         finish {{ emission 1 ambient 0 diffuse 0 }}"
    );
    Look { surface, ..Look::default() }
}

/// The depth that a colour encodes; `None` where nothing was hit.
fn depth_of(Rgb([coarse, fine, blue]): Rgb<u16>, range: f64) -> Option<f64> {
    let share = |channel: u16| f64::from(channel) / f64::from(u16::MAX);
    let (coarse, fine) = (share(coarse), share(fine));
    let period = (coarse * PERIODS - fine).round();
    (share(blue) > 0.5).then(|| range * (period + fine) / PERIODS)
}

#[cfg(test)]
mod tests {
    use fbvh::{Options, Tracer, Tree};
    use glam::Vec3;
    use metaball_core::reference::Oracle;
    use metaball_core::{Camera, Kernel, Metaball};

    use super::*;
    use crate::console;
    use crate::tables::peers::povray::Povray;

    /// Two balls joined, with a bite out of one and a dent in the other.
    fn bitten() -> Scene {
        let ball = |[x, y, z, radius, strength]: [f32; 5]| Metaball {
            center: Vec3::new(x, y, z),
            radius,
            strength,
        };
        let balls = [
            [-0.45, 0.0, 0.0, 1.0, 1.0],
            [0.45, 0.1, 0.0, 1.1, 1.2],
            [-0.6, 0.3, 0.7, 0.7, -1.5],
            [0.8, -0.2, 0.6, 0.6, -0.4],
        ];
        Scene::new(balls.map(ball), Kernel::QUARTIC, 0.3).expect("legal")
    }

    /// Pixels on which hits are right, and on which they are not, where the truth is clear.
    fn count(scene: &Scene, view: &View, hits: &[Hit]) -> [usize; 2] {
        let truths = Oracle::new(scene).first_hits(&view.rays());
        let mut counts = [0; 2];
        for (truth, hit) in truths.iter().zip(hits).filter(|(truth, _)| truth.margin > 1e-3) {
            let is_near = !hit.is_hit() || (f64::from(hit.t) - truth.t).abs() < 1e-3;
            counts[usize::from(hit.verdict != truth.verdict || !is_near)] += 1;
        }
        counts
    }

    /// An independent program takes away what we do.
    #[test]
    fn negative_balls_are_its_negative_components() {
        let scene = bitten();
        let camera = Camera::look_at(Vec3::new(0.4, 0.9, 4.0), Vec3::ZERO, Vec3::Y, 38.0);
        let view = View::new(camera.expect("legal"), 96, 72).expect("a size");
        let whole = scene.balls().filter(|ball| !ball.is_negative());
        let whole = Scene::new(whole, scene.kernel(), scene.threshold()).expect("legal");
        let tree = Tree::build(&scene, &Options::certified()).expect("a tree");
        let ours = Tracer::new(&tree, &scene).picture_hits(&view.rays(), 96);
        assert_eq!(count(&scene, &view, &ours)[1], 0);
        if Povray::find().expect("it runs where it is there").is_none() {
            console::note("skipped: POV-Ray is not installed");
            return;
        }
        let theirs = |scene| {
            let drawn = Primary::new(scene, &view, 1).expect("written").hits();
            drawn.expect("drawn").hits
        };
        let [right, wrong] = count(&scene, &view, &theirs(&scene));
        assert!(right > 6_000 && wrong == 0, "{right} right, {wrong} wrong");
        let [_, wrong] = count(&scene, &view, &theirs(&whole));
        assert!(wrong > 200, "{wrong} wrong where nothing is taken away");
    }

    #[test]
    fn depths_survive_two_channels() {
        let range = 7.5;
        for step in 0..100_000 {
            let depth = range * (f64::from(step) + 0.37) / 100_000.0;
            let channel = |share: f64| (share * 65_535.0).round() as u16;
            let (coarse, fine) = (depth / range, (depth / range * PERIODS).fract());
            let color = Rgb([channel(coarse), channel(fine), u16::MAX]);
            let found = depth_of(color, range).expect("blue");
            // Half a step of the fine channel.
            assert!((found - depth).abs() <= range / PERIODS / 65_535.0, "{depth} {found}");
        }
        assert_eq!(depth_of(Rgb([9, 9, 0]), range), None);
    }
}
