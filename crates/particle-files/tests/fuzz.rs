//! Broken files of every format: no input panics, takes more than a second a megabyte, or memory beyond four
//! times its size.
//!
//! The suite tries 3,000 inputs a format; `FUZZ_INPUTS=1000000 cargo test --release -p particle-files --test
//! fuzz` a million.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use particle_files::{DEFAULT_KERNEL, DEFAULT_THRESHOLD, Format, ReadOptions, parse};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What any input may take: tables of names, threads' stacks of work, messages.
const FLOOR: usize = 1 << 20;

/// Words that parsers stumble over.
const WORDS: &[&[u8]] = &[
    b"-1",
    b"0",
    b"4294967296",
    b"18446744073709551616",
    b"99999999999",
    b"1e999",
    b"-1e-999",
    b"nan",
    b"inf",
    b"\n",
    b"\r",
    b"\r\n",
    b"\t",
    b" ",
    b",",
    b";",
    b"\"",
    b"'",
    b"#",
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\xc5",
    b"loop_\n",
    b"data_x\n",
    b"_atom_site.Cartn_x ",
    b"?",
    b".",
    b";\n",
    b"ATOM  ",
    b"HETATM",
    b"MODEL",
    b"ENDMDL\n",
    b"END\n",
    b"CRYST1",
    b"Properties=",
    b"pos:R:3",
    b"Lattice=\"",
    b"ITEM: TIMESTEP\n",
    b"ITEM: ATOMS x y z\n",
    b"ITEM: NUMBER OF ATOMS\n",
    b"<DataArray ",
    b"</VTKFile>",
    b"offset=\"",
    b"NumberOfPoints=\"",
    b"element vertex ",
    b"property list uchar int x\n",
    b"end_header\n",
    b"POINTS ",
    b"SCALARS ",
    b"BINARY\n",
    b"\x80\0\0\0",
    b"\x7f\xff\xff\xff",
    b"\xff\xff\xff\xff",
    b"'shape': (",
    b"'descr': '",
    b"x,y,z,radius\n",
];

/// Numbers that look random and are the same in every run.
struct Random(u64);

impl Random {
    /// Below `end`; 0 where that is 0. (Steele, Lea and Flood 2014, SplitMix.)
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        if end == 0 { 0 } else { (bits % end as u64) as usize }
    }
}

/// A good file, with a few things wrong.
fn broken(seed: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(8) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let word = WORDS[random.below(WORDS.len())];
                drop(bytes.splice(at..end, word.iter().copied()));
            }
            3 => {
                let again = bytes[at..end].to_vec();
                let at = random.below(bytes.len() + 1);
                drop(bytes.splice(at..at, again));
            }
            4 => {
                let from = random.below(other.len());
                drop(bytes.splice(at.., other[from..].iter().copied()));
            }
            5 => {
                let word = WORDS[random.below(WORDS.len())];
                drop(bytes.splice(at..at, word.iter().copied()));
            }
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = random.below(256) as u8;
                }
            }
        }
    }
    bytes
}

/// Reads an input to the scene, as `render` does.
fn read(bytes: &[u8]) {
    if let Ok(particles) = parse("input", bytes, &ReadOptions::default()) {
        let _ = particles.into_scene(DEFAULT_KERNEL, DEFAULT_THRESHOLD);
    }
}

/// Memory is counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is wrong with reading an input.
fn fault(bytes: &[u8], reads: impl Fn(&[u8])) -> Option<String> {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let start = Instant::now();
    if catch_unwind(AssertUnwindSafe(|| reads(bytes))).is_err() {
        return Some("panicked".to_owned());
    }
    let (taken, used) = (start.elapsed(), MEMORY.peak_usage().saturating_sub(before));
    // A busy machine can stop any process for a while.
    let allowed = Duration::from_secs(2) + Duration::from_micros(bytes.len() as u64);
    if taken > allowed {
        return Some(format!("took {taken:?}"));
    }
    (used > 4 * bytes.len() + FLOOR).then(|| format!("took {used} bytes of memory"))
}

/// Good files, each with its name.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds");
    let mut seeds: Vec<_> = fs::read_dir(folder)
        .expect("the folder of seeds")
        .map(|entry| {
            let path = entry.expect("a file").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            (name, fs::read(&path).expect("a seed"))
        })
        .collect();
    seeds.sort();
    seeds
}

#[test]
fn no_input_breaks_a_reader() {
    let _alone = alone();
    let inputs = std::env::var("FUZZ_INPUTS").map_or(3000, |count| count.parse().expect("a count"));
    let seeds = seeds();
    let mut random = Random(1);
    for (name, seed) in &seeds {
        for input in 0..inputs {
            let other = &seeds[random.below(seeds.len())].1;
            let bytes = match input % 16 {
                0 => (0..random.below(200)).map(|_| random.below(256) as u8).collect(),
                _ => broken(seed, other, &mut random),
            };
            if let Some(fault) = fault(&bytes, read) {
                let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("broken-{name}"));
                fs::write(&kept, &bytes).expect("the target folder is writable");
                panic!("input {input} of {name} {fault}; it is in {}", kept.display());
            }
        }
    }
}

/// Every seed is a good file, and every format has one.
#[test]
fn every_format_has_a_seed() {
    let _alone = alone();
    let seeds = seeds();
    for (name, bytes) in &seeds {
        let particles = parse(name, bytes, &ReadOptions::default());
        let particles = particles.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!particles.is_empty(), "{name}");
    }
    for format in Format::all() {
        let has =
            |ending: &&&str| seeds.iter().any(|(name, _)| name.ends_with(&format!(".{ending}")));
        assert!(format.endings().iter().find(has).is_some(), "{format} has no seed");
    }
}

/// The canary: readers that are too slow, too greedy, or panic are found.
#[test]
fn bad_readers_are_found() {
    let _alone = alone();
    assert_eq!(fault(b"", |_| panic!("on purpose")).as_deref(), Some("panicked"));
    let greedy = fault(b"", |_| drop(std::hint::black_box(vec![1_u8; 4 * FLOOR])));
    assert!(greedy.is_some_and(|fault| fault.contains("memory")));
    let slow = fault(b"", |_| std::thread::sleep(Duration::from_millis(2100)));
    assert!(slow.is_some_and(|fault| fault.contains("took 2.")));
    assert_eq!(fault(b"x,y,z\n1,2,3\n", read), None);
}
