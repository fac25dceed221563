//! The known scenes as users get them.

use bench_scenes::{BenchScene, Kind, Overrides, generators, known, load, mean_overlap};
use glam::DVec3;
use metaball_core::{Color, Kernel, Scene};
use particle_files::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, kernel_named};

fn scene(spec: &str) -> BenchScene {
    load(spec, &Overrides::default()).expect("a known scene")
}

#[test]
fn known_scenes_have_what_they_promise() {
    for known in known() {
        let made = scene(known.name);
        assert_eq!((made.name.as_str(), made.kind), (known.name, known.kind));
        if known.small {
            assert!(made.scene.len() <= 300, "{} is not small", known.name);
        } else {
            let cameras = if known.name.starts_with("mud") { 3 } else { 8 };
            assert_eq!((made.path.len(), made.path[0]), (cameras, made.camera), "{}", known.name);
        }
    }
}

#[test]
fn the_real_inputs_are_complete() {
    let counts = [("molecule", 5_547), ("molecule-large", 165_175), ("dam-break", 30_720)];
    for (name, balls) in counts {
        let scene = scene(name).scene;
        assert_eq!(scene.len(), balls);
        assert_eq!((scene.kernel(), scene.threshold()), (DEFAULT_KERNEL, DEFAULT_THRESHOLD));
        assert_eq!(scene.colors().is_some(), name != "dam-break");
    }
}

/// A protein has hydrogen, carbon, nitrogen, oxygen and sulphur. A reader that takes names for
/// symbols also finds calcium (Cα), cadmium (Cδ) or mercury (Hγ): another colour for each.
#[test]
fn the_molecule_is_a_protein() {
    let scene = scene("molecule").scene;
    let mut colors: Vec<_> =
        scene.colors().expect("coloured").iter().map(|color| color.to_srgb()).collect();
    colors.sort_unstable();
    colors.dedup();
    let expected = [[48, 80, 248], [144, 144, 144], [255, 13, 13], [255, 255, 48], [255, 255, 255]];
    assert_eq!(colors, expected);
}

#[test]
fn dense_scenes_are_dense() {
    for name in ["tornado-4k", "tornado-128k", "pool-10k"] {
        // Set over the balls that it is measured over, up to a pair or two.
        assert!((mean_overlap(&scene(name).scene) - 45.0).abs() < 0.05, "{name}");
    }
    assert!((mean_overlap(&scene("scattered-30k").scene) - 1.3).abs() < 0.05);
}

fn field(scene: &Scene, point: DVec3) -> f64 {
    let balls = scene.balls().map(|ball| {
        let radius = f64::from(ball.radius);
        let squared = point.distance_squared(ball.center.as_dvec3()) / (radius * radius);
        f64::from(ball.strength) * scene.kernel().value(squared)
    });
    balls.sum()
}

/// Every ray of a clear scene misses by a wide margin, or starts inside by one, or goes through the
/// surface to where the field is far above T.
#[test]
fn clear_scenes_have_no_grazing_rays() {
    const MARGIN: f64 = 1.1;
    let mut clear = 0;
    for known in known().iter().filter(|known| known.kind == Kind::Clear) {
        clear += 1;
        let BenchScene { scene, camera, .. } = scene(known.name);
        let threshold = f64::from(scene.threshold());
        let eye = camera.eye().as_dvec3();
        let pixels = (0..32).flat_map(|row| (0..64).map(move |column| (column, row)));
        let most: Vec<f64> = pixels
            .map(|(column, row)| {
                let direction = camera.exact_direction(column, row, 64, 32);
                let along = (0..600).map(|step| 0.01 * f64::from(step));
                along.map(|t| field(&scene, eye + t * direction)).fold(0.0, f64::max)
            })
            .collect();
        let all_hit = most.iter().all(|most| *most > MARGIN * threshold);
        let all_miss = most.iter().all(|most| *most < threshold / MARGIN);
        assert!(all_hit || all_miss, "{}", known.name);
    }
    assert_eq!(clear, 4);
}

#[test]
fn overrides_replace_kernel_and_threshold() {
    let with = |kernel: Option<Kernel>, exponent, threshold| {
        load("random-200", &Overrides { kernel, exponent, threshold, color: None })
    };
    let quartic = with(Some(Kernel::QUARTIC), None, Some(0.1)).expect("legal").scene;
    assert_eq!((quartic.kernel(), quartic.threshold()), (Kernel::QUARTIC, 0.1));
    let sixth = with(Some(Kernel::QUARTIC), Some(6), None).expect("legal").scene;
    assert_eq!(sixth.kernel(), kernel_named("power-6", None).expect("legal"));
    assert_eq!(
        with(None, Some(3), None).expect_err("Wyvill's kernel").to_string(),
        "kernel exponent: needed the kernel power, found \"wyvill\""
    );
    assert_eq!(
        with(None, None, Some(0.0)).expect_err("no threshold").to_string(),
        "threshold: needed a finite number above 0, found 0"
    );
}

#[test]
fn an_override_colours_every_ball() {
    let red = Color::srgb(255, 0, 0);
    for spec in ["random-200", "molecule"] {
        let overrides = Overrides { color: Some(red), ..Overrides::default() };
        let scene = load(spec, &overrides).expect("legal").scene;
        let colors = scene.colors().expect("coloured");
        assert!(colors.len() == scene.len() && colors.iter().all(|color| *color == red));
    }
}

#[test]
fn unknown_names_get_the_list() {
    let message = load("molecul", &Overrides::default()).expect_err("no scene").to_string();
    for name in known().iter().map(|known| known.name).chain(generators().iter().map(|g| g.name)) {
        assert!(message.contains(name), "{name} is not in {message}");
    }
    assert!(message.starts_with("\"molecul\" is no scene. Needed one of"));
}

#[test]
fn the_readme_lists_every_scene() {
    let readme = include_str!("../README.md");
    for name in known().iter().map(|known| known.name) {
        assert!(readme.contains(&format!("| `{name}` |")), "{name} is not in README.md");
    }
    for name in generators().iter().map(|generator| generator.name) {
        assert!(readme.contains(&format!("| `{name}:N` |")), "{name} is not in README.md");
    }
    for name in bench_scenes::moving().iter().map(|(name, _)| name) {
        assert!(readme.contains(&format!("`{name}`")), "{name} is not in README.md");
    }
    for name in bench_scenes::cases().iter().map(|case| case.name) {
        assert!(readme.contains(&format!("| `{name}` |")), "{name} is not in README.md");
    }
}
