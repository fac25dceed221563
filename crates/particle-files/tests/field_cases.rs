//! Files with the faults that people met: those of `../shared/field-cases`, where that folder stands
//! beside the checkout.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use particle_files::{Loaded, Overrides, ReadOptions, load};
use serde_json::Value;

/// Cases that have their balls in `expected_balls.json`.
const WITH_BALLS: [&str; 40] = [
    "P01", "P03", "P04", "P05", "P06", "P07", "P08", "P10", "P11", "P13", "P14", "P15", "P16",
    "P17", "P18", "P20", "P21", "P23", "P31", "P35", "P42", "C00", "C01", "C02", "C03", "C05",
    "C06", "C09", "C13", "C17", "X01", "X02", "X05", "X07", "X08", "X09c", "X10", "X20", "X23",
    "O09",
];

/// Cases with a column `radius`, which the list of balls has as the support radius.
const WITH_RADII: [&str; 3] = ["V03", "V07", "V08"];

/// Cases with this many balls: file and count.
const WITH_COUNTS: [(&str, usize); 20] = [
    ("v16_neg.csv", 2),
    ("x03_bare.xyz", 5),
    ("x07b_utf16.xyz", 3),
    ("x13_lammps.xyz", 3),
    ("x14_dup.xyz", 3),
    ("x15_utm.csv", 64),
    ("x16_nm.csv", 3),
    ("x18_one.xyz", 1),
    ("x24_zero.xyz", 0),
    ("v01_paraview.csv", 3),
    ("v04_noradius.csv", 3),
    ("v06_de.csv", 3),
    ("v13_nohead.csv", 3),
    ("p22_martini.pdb", 7),
    ("p26_pqr.pqr", 3),
    ("p30_water.pdb", 6),
    ("p40b_oneindent.pdb", 6),
    ("p43_lower.pdb", 6),
    ("c07_fract.cif", 2),
    ("o01.gro", 3),
];

/// Cases that are refused: file, and what the error says.
const REFUSED: [(&str, &[&str]); 14] = [
    ("x11_nocomment.xyz", &["line 5", "needed 3 particles", "after 2", "line 2 is the comment"]),
    ("x17_nan.xyz", &["line 4, column 2 (x)", "\"nan\""]),
    ("x19_trunc.xyz", &["line 6", "needed 5 particles", "after 3"]),
    ("v06b_quoted.csv", &["line 2", "decimal comma"]),
    ("v10_zero.csv", &["line 3, radius", "above 0, found 0"]),
    ("v14b_zero.csv", &["empty file"]),
    ("v14c_zero.xyz", &["empty file"]),
    ("v14d_zero.pdb", &["empty file"]),
    ("v14e_zero.cif", &["empty file"]),
    ("v17_weak.csv", &["line 2", "the threshold 0.25", "support_radius"]),
    ("o10.pdb.bz2", &["gzip or zstd, found bzip2"]),
    (
        "p09_coordstars.pdb",
        &["line 6, column 31 (x)", "\"********\"", "save the file as mmCIF or XYZ"],
    ),
    ("p29_free.pdb", &["line 1, column 31 (x)", "columns 31 to 38"]),
    ("o07_trunc.pdb.gz", &["o07_trunc.pdb.gz"]),
];

/// Cases whose notes say something: file, and what.
const NOTED: [(&str, &[&str]); 14] = [
    ("x13_lammps.xyz", &["types, not elements"]),
    ("x27_outlier.csv", &["leaves out 1 particle far from the others", "--frame-all"]),
    ("x30_nm.xyz", &["closer than atoms in ångströms", "--units nm"]),
    ("v09_diameter.csv", &["\"Diameter\", halved"]),
    ("v13_nohead.csv", &["no line of names", "--columns"]),
    ("v04_noradius.csv", &["twice the median distance", "--radius"]),
    ("p10_nmr.pdb", &["PDB", "5 atoms", "1 frame after the first"]),
    ("p11_altloc.pdb", &["2 atoms at alternative places"]),
    ("p13_microhet.pdb", &["2 atoms at alternative places"]),
    ("p20_cryst1.pdb", &["the periodic cell: CRYST1 in line 2"]),
    ("p22_martini.pdb", &["taken as particles", "coarse-grained", "support radius"]),
    ("p23_tip4p.pdb", &["1 virtual site (MW)"]),
    ("p35_vmdframes.pdb", &["1 frame after the first"]),
    ("c15_really_cif.pdb", &["mmCIF by its content"]),
];

/// The folder, or a word that the test did not run.
fn cases() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-cases");
    if !folder.is_dir() {
        eprintln!("not run: there is no {}", folder.display());
        return None;
    }
    Some(folder)
}

fn get(folder: &Path, file: &str) -> Result<Loaded, String> {
    let path = folder.join(file);
    load(&path, &ReadOptions::default(), &Overrides::default())
        .map_err(|error| format!("{file}: {error}"))
}

static EXPECTED: LazyLock<Value> = LazyLock::new(|| {
    let path = cases().expect("the folder is there").join("expected_balls.json");
    let text = std::fs::read_to_string(path).expect("the balls are there");
    serde_json::from_str(&text).expect("JSON")
});

/// x, y, z, support radius and strength of each ball.
fn balls_of(loaded: &Loaded) -> Vec<[f64; 5]> {
    let scene = &loaded.scene;
    let ball = |index: usize| {
        let ball = scene.ball(index);
        let [x, y, z] = (ball.center.as_dvec3() + scene.origin()).to_array();
        [x, y, z, ball.radius.into(), ball.strength.into()]
    };
    (0..scene.len()).map(ball).collect()
}

/// The first difference that is more than rounding to f32 (6e-8 of a number) and to the five digits of the
/// list, if there is one.
fn difference(found: &[[f64; 5]], expected: &Value) -> Option<String> {
    let expected = expected.as_array()?;
    if found.len() != expected.len() {
        return Some(format!("needed {} balls, found {}", expected.len(), found.len()));
    }
    let differs = |(ball, expected): &(&[f64; 5], &Value)| {
        let each = ball.iter().enumerate();
        each.into_iter().any(|(index, number)| {
            let expected = expected[index].as_f64();
            !expected.is_some_and(|e| (number - e).abs() <= 6e-8 * e.abs() + 1e-5)
        })
    };
    let (ball, expected) = found.iter().zip(expected).find(differs)?;
    Some(format!("needed the ball {expected}, found {ball:?}"))
}

#[test]
fn balls_are_the_expected_ones() {
    let Some(folder) = cases() else { return };
    let mut failures = Vec::new();
    let cases = WITH_BALLS.map(|case| (case, 1.0)).into_iter();
    for (case, factor) in cases.chain(WITH_RADII.map(|case| (case, std::f64::consts::SQRT_2))) {
        let expected = &EXPECTED[case];
        let file = expected["file"].as_str().unwrap_or_else(|| panic!("{case} has a file"));
        match get(&folder, file) {
            Ok(loaded) => {
                let mut found = balls_of(&loaded);
                found.iter_mut().for_each(|ball| ball[3] /= factor);
                failures
                    .extend(difference(&found, &expected["balls"]).map(|d| format!("{file}: {d}")));
                // The comparison sees a ball that is a little larger.
                let mut other = found;
                other[0][3] += 1e-4;
                assert!(difference(&other, &expected["balls"]).is_some(), "{case}");
            }
            Err(message) => failures.push(message),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn as_many_balls_as_the_file_has() {
    let Some(folder) = cases() else { return };
    for (file, count) in WITH_COUNTS {
        let loaded = get(&folder, file).unwrap_or_else(|message| panic!("{message}"));
        assert_eq!(loaded.scene.len(), count, "{file}");
    }
}

#[test]
fn refusals_say_where_and_what() {
    let Some(folder) = cases() else { return };
    for (file, words) in REFUSED {
        let message = get(&folder, file).expect_err(file);
        for word in words {
            assert!(message.contains(word), "{message} has no {word:?}");
        }
    }
}

#[test]
fn notes_say_what_was_decided() {
    let Some(folder) = cases() else { return };
    for (file, words) in NOTED {
        let loaded = get(&folder, file).unwrap_or_else(|message| panic!("{message}"));
        let notes: Vec<&str> = loaded.notes.iter().map(|note| note.text.as_str()).collect();
        let notes = notes.join("; ");
        for word in words {
            assert!(notes.contains(word), "{file}: {notes:?} has no {word:?}");
        }
    }
}
