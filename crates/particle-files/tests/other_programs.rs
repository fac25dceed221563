//! Files that other programs wrote, all of the same twelve particles: VTK 9.7, plyfile 1.1, NumPy 2.4,
//! OVITO 3.17 and MDAnalysis 2.11. `points.bgeo` was written after the description of Partio.

use std::path::{Path, PathBuf};

use glam::DVec3;
use particle_files::{Note, ReadOptions, Table, Unit, Values, read, read_table};

fn seed(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds").join(name)
}

fn get(name: &str, options: &ReadOptions) -> Table {
    read_table(seed(name), options).unwrap_or_else(|error| panic!("{name}: {error}")).0
}

/// Where a particle is.
fn position(index: usize) -> DVec3 {
    let (molecule, atom) = (index / 3, index % 3);
    let thousandths = [
        1237 * molecule % 2000 + 96 * atom,
        733 * molecule % 2000 + 57 * atom * atom,
        401 * molecule % 2000 + 31 * atom,
    ];
    DVec3::from_array(thousandths.map(|number| number as f64 / 1000.0))
}

/// The greatest distance of a particle from where it should be, shifted along all axes.
fn distance(table: &Table, scale: f64, shift: f64) -> f64 {
    assert_eq!(table.len(), 12);
    let distance = |(index, read): (usize, &DVec3)| {
        (*read - scale * (position(index) + DVec3::splat(shift))).length()
    };
    table.positions.iter().enumerate().map(distance).fold(0.0, f64::max)
}

fn numbers<'a>(table: &'a Table, name: &str) -> &'a [f64] {
    match table.column(name).map(|column| &column.values) {
        Some(Values::Numbers(numbers)) => numbers,
        other => panic!("needed numbers of {name}, found {other:?}"),
    }
}

#[test]
fn particles_with_radii() {
    for (name, column, scale) in [
        ("binary.vtk", "radius", 1.0),
        ("text.vtk", "radius", 1.0),
        ("raw.vtp", "radius", 1.0),
        ("packed.vtu", "radius", 1.0),
        ("little.ply", "radius", 1.0),
        ("big.ply", "radius", 1.0),
        ("text.ply", "radius", 1.0),
        ("rows.npy", "radius", 1.0),
        ("records.npy", "radius", 1.0),
        ("stored.npz", "radius", 1.0),
        ("deflated.npz", "radius", 1.0),
        ("points.bgeo", "radius", 1.0),
        ("scaled.lammpstrj", "radius", 1.0),
        ("sphere.data", "diameter", 2.0),
    ] {
        let table = get(name, &ReadOptions::default());
        // Some hold positions in f32, or in ten digits.
        let found = distance(&table, 1.0, 0.0);
        assert!(found < 2e-7, "{name}: {found}");
        // The canary: a shift of all by a thousandth is found.
        assert!(distance(&table, 1.0, 0.001) > 1e-3);
        for (index, radius) in numbers(&table, column).iter().enumerate() {
            assert!((radius - scale * 0.125 * (index + 1) as f64).abs() < 1e-7, "{name}: {radius}");
        }
    }
}

#[test]
fn values_of_several_components() {
    for name in ["binary.vtk", "text.vtk", "raw.vtp", "packed.vtu", "deflated.npz", "points.bgeo"] {
        let table = get(name, &ReadOptions::default());
        let expected: Vec<f64> = (0..12).map(|index| -f64::from(index)).collect();
        assert_eq!(numbers(&table, "velocity:1"), expected, "{name}");
    }
}

#[test]
fn cells() {
    for name in ["scaled.lammpstrj", "sphere.data"] {
        let cell = get(name, &ReadOptions::default()).cell.expect("a cell");
        let edges = [[3.0, 0.0, 0.0], [0.5, 3.0, 0.0], [0.25, 0.5, 3.0]].map(DVec3::from_array);
        assert_eq!((cell.origin, cell.edges), (DVec3::NEG_ONE, edges), "{name}");
    }
    let dump = get("scaled.lammpstrj", &ReadOptions::default()).cell.expect("a cell");
    assert_eq!(dump.periodic, [true, true, false]);
    for (name, scale) in [("md.xtc", 0.1), ("md.trr", 0.1), ("md.dcd", 1.0)] {
        let cell = get(name, &ReadOptions::default()).cell.expect("a cell");
        let lengths = cell.edges.map(|edge| (edge.length() / scale * 1e4).round() / 1e4);
        assert_eq!(lengths, [30.0, 31.0, 32.0], "{name}");
        let cosine = cell.edges[0].normalize().dot(cell.edges[1].normalize());
        assert!((cosine - 0.5).abs() < 1e-6, "{name}: {cosine}");
    }
}

#[test]
fn frames_of_trajectories() {
    for (name, unit) in
        [("md.xtc", Unit::Nanometre), ("md.trr", Unit::Nanometre), ("md.dcd", Unit::Angstrom)]
    {
        for frame in 0..2 {
            let options = ReadOptions { frame: Some(frame), ..ReadOptions::default() };
            let table = get(name, &options);
            let found = distance(&table, 1.0, 0.25 * f64::from(frame));
            assert!(found < 2e-7, "{name}: {found}");
            assert_eq!(table.unit, Some(unit));
        }
        let none = ReadOptions { frame: Some(2), ..ReadOptions::default() };
        let error = read_table(seed(name), &none).expect_err("refused").to_string();
        assert!(error.contains("needed a number from 0 to 1, found 2"), "{error}");
    }
}

#[test]
fn a_topology_says_what_the_particles_of_a_trajectory_are() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("topology");
    std::fs::create_dir_all(&folder).expect("the target folder is writable");
    let write = |count: usize| {
        let path = folder.join(format!("{count}.xyz"));
        let atoms = "O 0 0 0\nH 1 0 0\nH 0 1 0\n".repeat(count / 3);
        std::fs::write(&path, format!("{count}\n\n{atoms}")).expect("the folder is writable");
        path
    };
    let with = |count| ReadOptions { topology: Some(write(count)), ..ReadOptions::default() };
    let table = get("md.xtc", &with(12));
    assert!(distance(&table, 1.0, 0.0) < 2e-7);
    let expected: Vec<&str> = ["O", "H", "H"].repeat(4);
    let Some(Values::Words(words)) = table.column("species").map(|column| &column.values) else {
        panic!("needed words");
    };
    assert_eq!(words.iter().collect::<Vec<_>>(), expected);

    // As a molecule, it is in ångströms.
    let molecule = ReadOptions { substance: Some("molecule".parse().expect("legal")), ..with(12) };
    let particles = read(seed("md.xtc"), &molecule).expect("legal");
    assert!(particles.colors.is_some());
    assert!((particles.positions[5] - 10.0 * position(5)).length() < 2e-6);

    let error = read(seed("md.xtc"), &with(9)).expect_err("refused").to_string();
    assert!(
        error.contains("needed 9 atoms as ") && error.ends_with("9.xyz has, found 12"),
        "{error}"
    );
    let notes = read(seed("md.xtc"), &ReadOptions::default()).expect("legal").notes;
    assert!(notes.iter().map(Note::to_string).any(|note| note.contains("--topology FILE")));
}
