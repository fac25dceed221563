//! Kanamori et al. 2008: the three special cases of section 7 in both variants, and the error of
//! section 6.

use bench_scenes::Case;
use harness::judge::{Judge, Ruling};
use harness::renderer::Renderer;
use kanamori_peel::Options;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_core::reference::Oracle;
use metaball_core::{Hit, Metaball, Ray, Verdict, View};

use super::agreement::pass;
use super::{draw, load, on_gpu, renderer, terms_of, view_of};

/// What must become of a case, besides that no promise is broken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// Every clear ray has its own right answer.
    Right,
    /// Some rays are late or miss, and nothing reports it.
    SilentlyWrong,
    /// Some rays show a support instead of the surface and are marked so, and nothing else is wrong.
    Fallback,
}

pub(super) fn trials() -> Vec<Trial> {
    use Outcome::{Fallback, Right, SilentlyWrong};
    let cases = [
        // Figure 9a: one index is returned, the other ball is lost, and nothing reports it: the check that
        // would is left out, for its cost.
        ("coincident", 2.0, SilentlyWrong, Right),
        ("coincident", 14.0, SilentlyWrong, Right),
        // Figure 9b: a list of 14, and none. The supports drawn are marked.
        ("overlapping", 14.0, Right, Right),
        ("overlapping", 15.0, Fallback, Right),
        ("overlapping", 65.0, Fallback, Right),
        // Figure 9c: peeling continues until it ends; the search skips them.
        ("veiled", 65.0, Right, Right),
        ("veiled", 140.0, Right, Right),
    ];
    let mut trials = Vec::new();
    for (case, value, published, robust) in cases {
        for (method, outcome) in [("kanamori", published), ("kanamori-robust", robust)] {
            let name = format!("peeling::special_case::{case}={value}::{method}");
            trials.push(on_gpu(name, move |gpu| special_case(gpu, case, value, method, outcome)));
        }
    }
    for case in bench_scenes::cases() {
        let name = format!("peeling::every_value::{}::kanamori-robust", case.name);
        trials.push(on_gpu(name, move |gpu| every_value(gpu, case)));
    }
    trials.push(on_gpu("peeling::error_of_figure_1::kanamori".to_owned(), error_of_figure_1));
    trials
}

/// The robust variant has the oracle's verdict on every clear ray of every value of a case. At a
/// threshold of 1e-12 the surface is 1e-6 of a radius inside the rims, which f32 cannot tell from
/// outside: there, and only there, it may be undecided. Negative balls it refuses.
fn every_value(gpu: &Gpu, case: &Case) -> Result<(), Failed> {
    let mut renderer = renderer("kanamori-robust")?;
    for &value in case.values {
        let made = case.scene(value)?;
        let view = View::new(made.camera, 24, 18)?;
        let drawn = draw(gpu, &mut renderer, &made.scene, &view);
        if let Some(ball) = made.scene.negative_ball() {
            let refusal = drawn.err().and_then(|refusal| refusal.message().map(str::to_owned));
            if !refusal.as_ref().is_some_and(|words| words.contains(&ball.to_string())) {
                return Err(format!("{}: {refusal:?} for {ball}", made.name).into());
            }
            continue;
        }
        let picture = drawn?;
        let truths = Oracle::new(&made.scene).first_hits(&picture.rays);
        for (pixel, (truth, hit)) in truths.iter().zip(&picture.hits).enumerate() {
            let may_be_undecided =
                hit.verdict == Verdict::Undecided && made.scene.threshold() < 1e-11;
            if truth.verdict != hit.verdict && !truth.is_ambiguous() && !may_be_undecided {
                let case = &made.name;
                return Err(format!("{case}, pixel {pixel}: {truth:?} against {hit:?}").into());
            }
        }
    }
    Ok(())
}

fn special_case(
    gpu: &Gpu,
    case: &str,
    value: f64,
    method: &str,
    needed: Outcome,
) -> Result<(), Failed> {
    let mut cases = bench_scenes::cases().iter();
    let case = cases.find(|known| known.name == case).ok_or("no such case")?;
    let scene = case.scene(value)?;
    let mut renderer = renderer(method)?;
    let picture = draw(gpu, &mut renderer, &scene.scene, &view_of(&scene)?)?;
    let oracle = Oracle::new(&scene.scene);
    let judge = Judge::new(&scene.scene, &oracle, &picture.rays);
    let terms = terms_of(method)?;
    pass(&judge.judge(&picture.hits, &terms))?;
    let is_excused =
        |(ray, hit): &(usize, &Hit)| judge.rule(*ray, hit, &terms) == Ok(Ruling::Excused);
    let excused = picture.hits.iter().enumerate().filter(is_excused);
    let (marked, silent): (Vec<_>, Vec<_>) = excused.partition(|(_, hit)| hit.fallback);
    let found = match (marked.len(), silent.len()) {
        (0, 0) => Outcome::Right,
        (0, _) => Outcome::SilentlyWrong,
        (_, 0) => Outcome::Fallback,
        both => return Err(format!("needed {needed:?}, found (marked, silent) {both:?}").into()),
    };
    if found != needed {
        return Err(format!("needed {needed:?}, found {found:?}: {marked:?}, {silent:?}").into());
    }
    // Section 7: "we instead treat the ray-sphere intersection as a ray-isosurface intersection".
    for (ray, hit) in marked {
        let Ray { origin, direction, .. } = picture.rays[ray];
        let point = origin.as_dvec3() + f64::from(hit.t) * direction.as_dvec3();
        let distance = |ball: Metaball| {
            (point.distance(ball.center.as_dvec3()) / f64::from(ball.radius) - 1.0).abs()
        };
        // A dozen roundings of numbers up to the five radii between the eye and a support's far end.
        if scene.scene.balls().map(distance).fold(f64::MAX, f64::min)
            > 64.0 * f64::from(f32::EPSILON)
        {
            return Err(format!("pixel {ray}: {hit:?} is on no support").into());
        }
    }
    Ok(())
}

/// The relative root mean square error of t on 1,000 random balls of random radii, over the rays that
/// hit: at most the paper's 0.7 % with the default threshold. It must rise with the threshold, or it
/// would not be the clipping's.
fn error_of_figure_1(gpu: &Gpu) -> Result<(), Failed> {
    let scene = load("random:1000")?;
    let view = view_of(&scene)?;
    let oracle = Oracle::new(&scene.scene);
    let mut truths = None;
    let mut errors = Vec::new();
    for threshold in [1e-4, Options::default().threshold, 0.1] {
        let options = Options { threshold, ..Options::default() };
        let peeling = kanamori_peel::Renderer::new("kanamori", options, false);
        let mut renderer = Renderer::Adapter(Box::new(peeling));
        let picture = draw(gpu, &mut renderer, &scene.scene, &view)?;
        let truths = truths.get_or_insert_with(|| oracle.first_hits(&picture.rays));
        let both = truths.iter().zip(&picture.hits).filter(|(truth, hit)| {
            !truth.is_ambiguous() && truth.verdict == Verdict::Hit && hit.verdict == Verdict::Hit
        });
        let relative = both.map(|(truth, hit)| f64::from(hit.t) / truth.t - 1.0);
        let squares: Vec<_> = relative.map(|error| error * error).collect();
        if squares.len() < 500 {
            return Err(format!("{} rays hit: the test tests nothing", squares.len()).into());
        }
        errors.push((squares.iter().sum::<f64>() / squares.len() as f64).sqrt());
    }
    if errors[1] > 0.007 || errors[2] <= errors[1] || errors[1] <= errors[0] {
        return Err(format!("at thresholds 1e-4, 1e-3 and 0.1: {errors:?}").into());
    }
    Ok(())
}
