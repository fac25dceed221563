//! Fields of simulations and of other programs, against their own formulas.

use std::f64::consts::PI;
use std::path::PathBuf;

use glam::DVec3;
use metaball_core::{Kernel, Scene};
use particle_files::{
    ByFormula, FormulaOptions, LoadError, Notes, Overrides, PackedFrames, Particles, Preset,
    ReadOptions, Sequence, Sizes, Substance, load, parse,
};

/// Ethanol, and two atoms that other programs have other radii for.
const MOLECULE: &str = "11\nethanol, sodium chloride\n\
    C 0.0072 -0.5687 0.0\nC -1.2854 0.2499 0.0\nO 1.1304 0.3147 0.0\nH 0.0392 -1.1972 0.8900\n\
    H 0.0392 -1.1972 -0.8900\nH -1.3175 0.8784 0.8900\nH -1.3175 0.8784 -0.8900\n\
    H -2.1422 -0.4239 0.0\nH 1.9857 -0.1365 0.0\nNa 3.5 1.2 0.3\nCl 4.9 -0.9 0.8\n";

fn by_preset(preset: Preset) -> FormulaOptions {
    FormulaOptions { preset: Some(preset), ..FormulaOptions::default() }
}

fn sph() -> FormulaOptions {
    FormulaOptions { sph: true, ..FormulaOptions::default() }
}

fn read(name: &str, text: &str, formula: FormulaOptions) -> Result<Particles, LoadError> {
    parse(name, text.as_bytes(), &ReadOptions { formula, ..ReadOptions::default() })
}

fn applied(
    particles: Particles,
    formula: FormulaOptions,
    kernel: Option<Kernel>,
) -> Result<ByFormula, LoadError> {
    formula.formula()?.expect("one is asked for").apply(particles, kernel, None)
}

fn scene_of(made: ByFormula) -> Scene {
    made.particles.into_scene(made.kernel, made.threshold).expect("legal")
}

fn molecule(formula: FormulaOptions, kernel: Option<Kernel>) -> Scene {
    let particles = read("a.xyz", MOLECULE, formula).expect("legal");
    scene_of(applied(particles, formula, kernel).expect("legal"))
}

/// The positions and elements of the molecule.
fn atoms() -> Vec<(&'static str, DVec3)> {
    let atom = |line: &'static str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |index: usize| words[index].parse::<f64>().expect("a number");
        (words[0], DVec3::new(number(1), number(2), number(3)))
    };
    MOLECULE.lines().skip(2).map(atom).collect()
}

/// The field of a scene.
fn field(scene: &Scene, at: DVec3) -> f64 {
    let share = |ball: metaball_core::Metaball| {
        let squared = (at - ball.center.as_dvec3()).length_squared();
        let ratio = squared / f64::from(ball.radius).powi(2);
        f64::from(ball.strength) * scene.kernel().value(ratio)
    };
    scene.balls().map(share).sum()
}

/// Points of a grid around the molecule.
fn grid() -> impl Iterator<Item = DVec3> {
    let steps = |from: i32, to: i32| (from..to).map(|step| f64::from(step) * 0.47 + 0.013);
    steps(-8, 14).flat_map(move |x| {
        steps(-8, 8).flat_map(move |y| steps(-8, 8).map(move |z| DVec3::new(x, y, z)))
    })
}

/// Asserts that a field is the program's Gaussians (amplitude, standard deviation, cut in them) less what each is
/// at its cut, and that it would not pass without that or for another width.
fn assert_gaussians(scene: &Scene, of_atom: impl Fn(&str) -> (f64, f64, f64)) {
    let (mut worst, mut unlowered, mut wider) = (0.0_f64, 0.0_f64, 0.0_f64);
    for at in grid() {
        let (mut program, mut lowering, mut of_wider) = (0.0, 0.0, 0.0);
        for (element, center) in atoms() {
            let (amplitude, deviation, cut) = of_atom(element);
            let distance = at.distance(center);
            if distance <= cut * deviation {
                program += amplitude * (-distance.powi(2) / (2.0 * deviation.powi(2))).exp();
                of_wider += amplitude * (-distance.powi(2) / (2.02 * deviation.powi(2))).exp();
                lowering += amplitude * (-0.5 * cut * cut).exp();
            }
        }
        let own = field(scene, at);
        let relative = |expected: f64| (own - expected).abs() / program.max(1e-30);
        worst = worst.max(relative(program - lowering));
        unlowered = unlowered.max(relative(program));
        wider = wider.max(relative(of_wider - lowering));
    }
    assert!(worst < 1e-5, "{worst}");
    assert!(unlowered > 1e-3 && wider > 1e-3, "{unlowered} {wider}");
}

fn radius_in(list: &[(&str, f64)], element: &str) -> f64 {
    list.iter().find(|(name, _)| *name == element).expect("listed").1
}

#[test]
fn quicksurf_is_vmds_density() {
    const RADII: [(&str, f64); 5] =
        [("C", 1.7), ("O", 1.52), ("H", 1.0), ("Na", 1.36), ("Cl", 2.27)];
    let scene = molecule(by_preset(Preset::QuickSurf), None);
    assert_gaussians(&scene, |element| (1.0, radius_in(&RADII, element), 4.0));
    // An atom alone shows where exp(−d²/2r²) is 0.5.
    let shown = scene.kernel().core_radius(&scene.ball(0), scene.threshold()).expect("it shows");
    assert!((shown - 1.7 * (2.0 * 2.0_f64.ln()).sqrt()).abs() < 1e-5, "{shown}");
    let low = molecule(by_preset(Preset::QuickSurf), Kernel::gaussian(2.0).ok());
    assert_gaussians(&low, |element| (1.0, radius_in(&RADII, element), 2.0));
}

#[test]
fn gaussian_surface_is_mol_stars_density() {
    const RADII: [(&str, f64); 5] =
        [("C", 1.7), ("O", 1.52), ("H", 1.1), ("Na", 2.27), ("Cl", 1.75)];
    let exponent = |smoothness: f64, offset: f64, cut: f64| {
        move |element: &str| {
            let radius = radius_in(&RADII, element) + offset;
            (1.0, radius / (2.0 * smoothness).sqrt(), cut)
        }
    };
    let scene = molecule(by_preset(Preset::GaussianSurface), None);
    // 2 r are 3.4641 deviations, to hundredths.
    assert_gaussians(&scene, exponent(1.5, 0.0, 3.46));
    let shown = scene.kernel().core_radius(&scene.ball(2), scene.threshold()).expect("it shows");
    assert!((shown - 1.52).abs() < 1e-5, "{shown}");
    let options = FormulaOptions {
        smoothness: Some(2.0),
        radius_offset: Some(0.3),
        ..by_preset(Preset::GaussianSurface)
    };
    assert_gaussians(&molecule(options, None), exponent(2.0, 0.3, 4.0));
}

#[test]
fn molmap_is_chimeraxs_density() {
    const NUMBERS: [(&str, f64); 5] =
        [("C", 6.0), ("O", 8.0), ("H", 1.0), ("Na", 11.0), ("Cl", 17.0)];
    let options = FormulaOptions { resolution: Some(3.0), ..by_preset(Preset::Molmap) };
    let scene = molecule(options, None);
    let deviation = 3.0 / (PI * 2.0_f64.sqrt());
    let amplitude = |number: f64| number * (2.0 * PI).powf(-1.5) * deviation.powi(-3);
    let of_atom = |element: &str| (amplitude(radius_in(&NUMBERS, element)), deviation, 4.0);
    assert_gaussians(&molecule(options, Kernel::gaussian(4.0).ok()), of_atom);

    // The level: 95 % of what all points of the map have is above it.
    let (least, most) =
        atoms().iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), atom| {
            (a.min(atom.1), b.max(atom.1))
        });
    let counts = (most - least + 18.0).ceil().as_uvec3();
    let (mut total, mut above) = (0.0, 0.0);
    for x in 0..counts.x {
        for y in 0..counts.y {
            for z in 0..counts.z {
                let at = least - 9.0 + DVec3::new(x.into(), y.into(), z.into());
                let density: f64 = atoms()
                    .iter()
                    .map(|(element, center)| {
                        let squared = at.distance_squared(*center) / (deviation * deviation);
                        let within = squared <= 25.0;
                        if within { of_atom(element).0 * (-0.5 * squared).exp() } else { 0.0 }
                    })
                    .sum();
                total += density;
                if density >= f64::from(scene.threshold()) * (1.0 - 1e-6) {
                    above += density;
                }
            }
        }
    }
    let part = above / total;
    assert!((0.95..0.96).contains(&part), "{part}");
}

/// A block of fluid: spacing, cells along each edge, and columns behind.
fn block(count: u32, columns: &str, values: &str) -> String {
    let mut text = format!("x,y,z{columns}\n");
    for index in 0..count.pow(3) {
        let place = [index % count, index / count % count, index / (count * count)];
        let [x, y, z] = place.map(|step| 0.1 * f64::from(step));
        text += &format!("{x},{y},{z}{values}\n");
    }
    text
}

/// The least and the greatest field at points around the middle of a block.
fn fields_inside(scene: &Scene, middle: f64) -> (f64, f64) {
    let steps = || (0..6).map(|step| middle + 0.02 * f64::from(step));
    let points =
        steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))));
    points.fold((f64::INFINITY, 0.0), |(least, most), at| {
        let field = field(scene, at);
        (least.min(field), most.max(field))
    })
}

#[test]
fn a_filled_fluid_has_the_field_one() {
    let kernels =
        [(Kernel::CubicSpline, 0.02), (Kernel::QuinticSpline, 0.02), (Kernel::WendlandC2, 0.02)];
    // h of 1.3 spacings; a metre's cube of water weighs 1000.
    let with_numbers = block(13, ",mass,rho,h", ",1,1000,0.13");
    let bare = block(13, "", "");
    for (kernel, allowed) in kernels {
        for text in [&with_numbers, &bare] {
            let made = applied(read("a.csv", text, sph()).expect("legal"), sph(), Some(kernel));
            let scene = scene_of(made.expect("legal"));
            assert_eq!((scene.kernel(), scene.threshold()), (kernel, 0.5));
            let (least, most) = fields_inside(&scene, 0.6);
            assert!(least > 1.0 - allowed && most < 1.0 + allowed, "{kernel}: {least} to {most}");
            // Its surface is at the face, half a spacing before the first layer, or near by: where neighbours
            // give volumes, those at the face are larger.
            let across = |x: f64| field(&scene, DVec3::new(x, 0.6, 0.6)) - 0.5;
            assert!(across(-0.1) < 0.0 && across(0.0) > 0.0, "{kernel}");
        }
    }
    // The canary: h taken for R has another field.
    let options = FormulaOptions { support_per_h: Some(1.0), ..sph() };
    let made = applied(read("a.csv", &with_numbers, options).expect("legal"), options, None);
    let (least, _) = fields_inside(&scene_of(made.expect("legal")), 0.6);
    assert!(least < 0.9, "{least}");
}

#[test]
fn splashsurf_is_its_density() {
    // Not regular: the second column of digits moves each particle.
    let mut points = Vec::new();
    for index in 0..512_u32 {
        let place = [index % 8, index / 8 % 8, index / 64];
        let moved = |step: u32, axis: u32| {
            let noise = f64::from((index * 7919 + axis * 104_729) % 1000) / 1000.0;
            f64::from(step) + 0.3 * noise
        };
        let [x, y, z] = place;
        points.push(DVec3::new(moved(x, 0), moved(y, 1), moved(z, 2)));
    }
    let mut text = "x,y,z,radius\n".to_owned();
    for point in &points {
        text += &format!("{},{},{},0.5\n", point.x, point.y, point.z);
    }
    let options = by_preset(Preset::Splashsurf);
    let made = applied(read("a.csv", &text, options).expect("legal"), options, None);
    let scene = scene_of(made.expect("legal"));
    assert_eq!((scene.kernel(), scene.threshold()), (Kernel::CubicSpline, 0.6));
    // splashsurf's spline with a support of 2·2·0.5, in q = 2r/R.
    let spline = |distance: f64| {
        let (support, q) = (2.0_f64, 2.0 * distance / 2.0);
        let shape = match q {
            q if q < 1.0 => 3.0 / (2.0 * PI) * (2.0 / 3.0 - q * q + 0.5 * q.powi(3)),
            q if q < 2.0 => (2.0 - q).powi(3) / (4.0 * PI),
            _ => 0.0,
        };
        8.0 / support.powi(3) * shape
    };
    let sum = |at: DVec3| points.iter().map(|point| spline(point.distance(at))).sum::<f64>();
    let volumes: Vec<f64> = points.iter().map(|point| 1.0 / sum(*point)).collect();
    let (mut worst, mut without) = (0.0_f64, 0.0_f64);
    for step in 0..400 {
        let at =
            DVec3::new(-0.9, -0.7, -0.5) + f64::from(step) * DVec3::new(0.0231, 0.0217, 0.0209);
        let shares = points.iter().zip(&volumes);
        let program: f64 = shares.map(|(point, volume)| volume * spline(point.distance(at))).sum();
        if program > 1e-3 {
            let own = field(&scene, at);
            worst = worst.max((own - program).abs() / program);
            without = without.max((own - sum(at)).abs() / program);
        }
    }
    assert!(worst < 1e-5 && without > 1e-2, "{worst} {without}");
}

/// Where the surface goes on across the faces of a cell, so do neighbours.
#[test]
fn volumes_know_neighbouring_cells() {
    let mut text = "64\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=pos:R:3\n".to_owned();
    for index in 0..64 {
        text += &format!("{} {} {}\n", index % 4, index / 4 % 4, index / 16);
    }
    let made = |periodic: bool| {
        let options = ReadOptions { formula: sph(), periodic, ..ReadOptions::default() };
        let particles = parse("a.xyz", text.as_bytes(), &options).expect("legal");
        let made = applied(particles, sph(), None).expect("legal");
        made.particles.strengths.expect("strengths")
    };
    let (periodic, open) = (made(true), made(false));
    assert!(periodic.iter().all(|strength| (strength / periodic[0] - 1.0).abs() < 1e-6));
    assert!(open[0] > 1.5 * periodic[0] && (open[21] - periodic[21]).abs() < 0.2 * periodic[21]);
}

/// A file of that content in a folder for one test.
fn write(folder: &str, name: &str, text: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(folder);
    std::fs::create_dir_all(&folder).expect("the target folder is writable");
    let file = folder.join(name);
    std::fs::write(&file, text).expect("the target folder is writable");
    file
}

/// A scene file names a formula, and options and overrides say otherwise: other balls then, not other kernels on
/// the same.
#[test]
fn kernels_and_thresholds_of_formulas_are_replaced() {
    write("formula-replaced", "a.xyz", MOLECULE);
    let scene_file = "particles = 'a.xyz'\npreset = 'gaussian-surface'\nsmoothness = 2.0\n";
    let scene_file = write("formula-replaced", "a.toml", scene_file);
    // Kernel, hundredths of the support radius of carbon, threshold.
    let radius = |formula: FormulaOptions, overrides: Overrides| {
        let options = ReadOptions { formula, ..ReadOptions::default() };
        let scene = load(&scene_file, &options, &overrides).expect("legal").scene;
        (scene.kernel().to_string(), (100.0 * scene.ball(0).radius).round(), scene.threshold())
    };
    let own = radius(FormulaOptions::default(), Overrides::default());
    let isovalue = |exponent: f64, cut: f64| ((-exponent).exp() - (-0.5 * cut * cut).exp()) as f32;
    assert_eq!(own, ("gaussian-4".to_owned(), 340.0, isovalue(2.0, 4.0)));
    let softer = FormulaOptions { smoothness: Some(0.5), ..FormulaOptions::default() };
    let softer = radius(softer, Overrides::default());
    assert_eq!(softer, ("gaussian-2".to_owned(), 340.0, isovalue(0.5, 2.0)));
    let kernel = Kernel::gaussian(3.0).ok();
    let nearer = radius(FormulaOptions::default(), Overrides { kernel, ..Overrides::default() });
    assert_eq!(nearer, ("gaussian-3".to_owned(), 255.0, isovalue(2.0, 3.0)));
    let lower = Overrides { threshold: Some(0.1), ..Overrides::default() };
    assert_eq!(radius(FormulaOptions::default(), lower).2, 0.1);
    let (kernel, of_vmd, _) = radius(by_preset(Preset::QuickSurf), Overrides::default());
    assert_eq!((kernel.as_str(), of_vmd), ("gaussian-4", 680.0));

    let options = ReadOptions::default();
    let wyvill = Overrides { kernel: Some(Kernel::Wyvill), ..Overrides::default() };
    let refused = load(&scene_file, &options, &wyvill).expect_err("refused").to_string();
    assert!(refused.contains("needed a Gaussian for gaussian-surface"), "{refused}");
}

/// Frames of a sequence have one support radius by their spacing, and one threshold that a formula finds.
#[test]
fn frames_have_the_numbers_of_the_first() {
    let frames = |resolution: Option<f64>, preset, sph| {
        let formula = FormulaOptions { sph, preset, resolution, ..FormulaOptions::default() };
        let options = ReadOptions { formula, ..ReadOptions::default() };
        let files = write("formula-frames", "f%d.xyz", "");
        let sequence = Sequence::open(&files, &options, &Overrides::default()).expect("legal");
        [0, 1].map(|number| sequence.frame(number).expect("legal"))
    };
    write("formula-frames", "f0.xyz", MOLECULE);
    write("formula-frames", "f1.xyz", &MOLECULE.replace("C 0.0072", "C 0.4072"));
    let [first, second] = frames(Some(2.0), Some(Preset::Molmap), false);
    assert_eq!(first.threshold(), second.threshold());
    let [first, second] = frames(None, None, true);
    assert_eq!(first.common_radius(), second.common_radius());
    assert!(first.strengths() != second.strengths());
}

fn said(notes: &Notes) -> String {
    notes.iter().map(|note| format!("{note}\n")).collect()
}

#[test]
fn what_was_taken_is_said() {
    let text = "x,y,z,mass,Rhop [kg/m^3],h\n0,0,0,1,1000,0.13\n0.1,0,0,1,1000,0.13\n";
    let made = applied(read("a.csv", text, sph()).expect("legal"), sph(), None).expect("legal");
    let notes = said(&made.particles.notes);
    for part in [
        "smoothing lengths h from the column \"h\"",
        "cubic-spline of support radii R = 2 h: 0.26",
        "--support-per-h 1",
        "m from the column \"mass\", ρ from the column \"Rhop [kg/m^3]\"",
        "T = 0.5",
    ] {
        assert!(notes.contains(part), "{part} is not in {notes}");
    }
    let bare = read("a.csv", "x,y,z\n0,0,0\n0.5,0,0\n", sph()).expect("legal");
    let made = applied(bare, sph(), None).expect("legal");
    let notes = said(&made.particles.notes);
    for part in ["spacing 0.5", "R = 2.600 spacings: 1.3", "by neighbours, with equal masses"] {
        assert!(notes.contains(part), "{part} is not in {notes}");
    }
}

#[test]
fn what_is_missing_is_named_with_a_way_out() {
    let refused = |text: &str, options: FormulaOptions| {
        let particles = read("a.csv", text, options);
        let made = particles.and_then(|particles| applied(particles, options, None));
        made.expect_err("refused").to_string()
    };
    let bare = "x,y,z\n0,0,0\n1,0,0\n";
    let per_h = FormulaOptions { support_per_h: Some(2.0), ..sph() };
    assert!(refused(bare, per_h).contains("needed a column of smoothing lengths"));
    let mass = FormulaOptions { particle_mass: Some(1.0), ..sph() };
    assert!(refused(bare, mass).contains("equal ones cancel"));
    let molmap = FormulaOptions { resolution: Some(3.0), ..by_preset(Preset::Molmap) };
    assert!(refused(bare, molmap).contains("a.csv: needed elements for molmap"));
    assert!(refused(bare, by_preset(Preset::QuickSurf)).contains("--radius says them"));
    let negative = "x,y,z,mass,density\n0,0,0,1,1\n1,0,0,1,-1\n";
    assert_eq!(
        refused(negative, sph()),
        "a.csv, line 3, density: needed a finite number above 0, found -1; leave the particle out with \
         --drop"
    );
    let options =
        ReadOptions { formula: molmap, radius_scale: Some(2.0), ..ReadOptions::default() };
    let sized = parse("a.xyz", MOLECULE.as_bytes(), &options).expect_err("refused").to_string();
    assert!(sized.starts_with("radius scale: needed none for molmap"), "{sized}");
    let options = ReadOptions {
        formula: sph(),
        substance: Some(Substance::Molecule),
        ..ReadOptions::default()
    };
    let atoms = parse("a.xyz", MOLECULE.as_bytes(), &options).expect_err("refused").to_string();
    assert_eq!(atoms, "as: needed particles for sph and splashsurf, found molecule");
    let particles = read("a.xyz", MOLECULE, by_preset(Preset::QuickSurf)).expect("legal");
    let other = applied(particles.clone(), by_preset(Preset::QuickSurf), Some(Kernel::Wyvill));
    assert!(other.expect_err("refused").to_string().contains("needed a Gaussian for quicksurf"));
    let near = applied(particles, by_preset(Preset::QuickSurf), Kernel::gaussian(1.0).ok());
    assert!(near.expect_err("refused").to_string().contains("below the isovalue 0.5"));
}

/// The dam break of bench-scenes: a fluid that was simulated with supports of two spacings, read with those of
/// 2.6, has the field 1 inside.
#[test]
fn a_simulated_fluid_has_the_field_one() {
    let file =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../bench-scenes/data/dam-break.balls");
    let options =
        ReadOptions { formula: sph(), support_radius: Some(0.065), ..ReadOptions::default() };
    for kernel in [Kernel::CubicSpline, Kernel::WendlandC2] {
        let particles = particle_files::read(&file, &options).expect("legal");
        let positions = particles.positions.clone();
        let scene = scene_of(applied(particles, sph(), Some(kernel)).expect("legal"));
        let is_inside =
            |at: &&DVec3| at.x > 0.1 && at.y > 0.07 && at.y < 0.2 && at.z > 0.1 && at.z < 0.7;
        let mut fields: Vec<f64> = positions
            .iter()
            .step_by(97)
            .filter(is_inside)
            .map(|at| field(&scene, *at + DVec3::splat(0.004)))
            .collect();
        fields.sort_by(f64::total_cmp);
        // Beside voids and where particles pair up it is farther off.
        let part = |part: f64| fields[(part * fields.len() as f64) as usize];
        assert!(fields.len() > 50 && (part(0.5) - 1.0).abs() < 0.02, "{kernel}: {fields:?}");
        assert!(part(0.05) > 0.93 && part(0.95) < 1.08, "{kernel}: {fields:?}");
    }
}

/// Frames of the simulated splash of bench-scenes, whose supports are two spacings, with those of 2.6.
#[test]
fn frames_of_a_simulation_have_the_field_one() {
    let file =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../bench-scenes/data/splash.frames");
    let bytes = std::fs::read(file).expect("it is in the repository");
    let frames = PackedFrames::parse(&bytes).expect("legal");
    for number in [0, frames.count() / 2, frames.count() - 1] {
        let frame = frames.frame(number);
        let places: Vec<DVec3> =
            frame.positions.iter().step_by(7).map(|at| *at + DVec3::splat(0.004)).collect();
        let radii = vec![1.3 * frames.radius(); frame.len()];
        let particles = Particles { sizes: Sizes::Support(radii), ..frame };
        let scene = scene_of(applied(particles, sph(), None).expect("legal"));
        let median = |scene: &Scene| {
            let mut fields: Vec<f64> = places.iter().map(|at| field(scene, *at)).collect();
            fields.sort_by(f64::total_cmp);
            fields[fields.len() / 2]
        };
        let middle = median(&scene);
        assert!((middle - 1.0).abs() < 0.02, "frame {number}: {middle}");
        // The canary: another kernel on the same balls.
        let other = median(&scene.with_kernel(Kernel::Wyvill));
        assert!((other - 1.0).abs() > 0.1, "frame {number}: {other}");
    }
}
