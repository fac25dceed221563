//! What is tried.

use std::time::Duration;

use bench_scenes::{BenchScene, Overrides, load};
use libtest_mimic::{Failed, Trial};
use metaball::{Backend, DrawOptions, Viewpoint, draw};

use crate::display::{self, Outcome, Viewed};

type Test = fn() -> Outcome<()>;

pub(crate) fn all() -> Vec<Trial> {
    let tests: [(&str, Test); 4] = [
        ("the_window_shows_what_render_draws", shows),
        ("a_drag_turns_it", turns),
        ("closing_while_reading_ends_within_a_second", closes),
        ("a_broken_file_leaves_a_window", broken),
    ];
    let is_there = display::is_there();
    let trial = |(name, test): (&str, Test)| {
        let run = move || test().map_err(|error| Failed::from(error.to_string()));
        Trial::test(name, run).with_ignored_flag(!is_there)
    };
    tests.into_iter().map(trial).collect()
}

/// The axes are painted over this many pixels of the picture, at most.
const AXES: usize = 4000;

fn differing(viewed: &Viewed, bench: &BenchScene) -> Outcome<Option<usize>> {
    let screen = viewed.screen()?;
    let Some((columns, rows)) = screen.picture().filter(|size| size.0 > 600 && size.1 > 400) else {
        return Ok(None);
    };
    let options = DrawOptions {
        size: (columns as u32, rows as u32),
        viewpoint: Viewpoint::default(),
        backend: Backend::Cpu,
        ..DrawOptions::default()
    };
    let wanted = draw(&bench.scene, &bench.camera, &options)?;
    Ok(Some(screen.differing((columns, rows), &wanted.image.rgba)))
}

fn molecule() -> Outcome<BenchScene> {
    Ok(load("molecule", &Overrides::default())?)
}

/// Until its picture is that of `render`.
fn until_drawn(viewed: &mut Viewed, bench: &BenchScene) -> Outcome<()> {
    viewed.until(|viewed| Ok(differing(viewed, bench)?.filter(|differ| *differ < AXES)))?;
    Ok(())
}

fn shows() -> Outcome<()> {
    let mut viewed = Viewed::run(&["molecule"])?;
    let window = viewed.window()?;
    until_drawn(&mut viewed, &molecule()?)?;
    let (status, time) = viewed.close(window)?;
    assert!(status.success(), "{status}");
    assert!(time < Duration::from_secs(1), "{time:?}");
    Ok(())
}

fn turns() -> Outcome<()> {
    let mut viewed = Viewed::run(&["molecule"])?;
    viewed.window()?;
    let bench = molecule()?;
    until_drawn(&mut viewed, &bench)?;
    viewed.drag((400, 300), (600, 350))?;
    let turned = |differ: &usize| *differ > 20 * AXES;
    viewed.until(|viewed| Ok(differing(viewed, &bench)?.filter(turned)))?;
    Ok(())
}

fn closes() -> Outcome<()> {
    let mut viewed = Viewed::run(&["scattered:3000000"])?;
    let window = viewed.window()?;
    let (status, time) = viewed.close(window)?;
    assert!(status.success(), "{status}");
    assert!(time < Duration::from_secs(1), "{time:?}");
    Ok(())
}

fn broken() -> Outcome<()> {
    let mut viewed = Viewed::run(&["nowhere.xyz"])?;
    let window = viewed.window()?;
    std::thread::sleep(Duration::from_millis(500));
    let (status, _) = viewed.close(window)?;
    assert!(status.success(), "{status}");
    Ok(())
}
