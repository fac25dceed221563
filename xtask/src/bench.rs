//! `cargo xtask bench`: times the workspace's criterion benches, here alone or in turn with another commit.

mod checkout;
mod comparison;
mod json;
mod options;
mod programs;
mod samples;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use self::comparison::Comparison;
use self::options::Options;
use self::programs::Program;
use self::samples::{Round, Sides};
use crate::run::say;

/// The repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
/// What another commit is checked out and built in, and where criterion writes.
const SCRATCH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/bench");
/// Every sample, for whoever doubts the medians.
const SAMPLES: &str = "out/bench/samples.csv";

/// A checkout and its benches.
struct Side {
    /// How people name the commit.
    commit: String,
    programs: BTreeMap<String, Program>,
}

/// Builds the benches of both sides, times them in turn, prints what came out, and writes all samples.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let options = Options::parse(arguments)?;
    let scratch = PathBuf::from(SCRATCH);
    let against = options.against.as_deref().map(|commit| other(commit, &scratch)).transpose()?;
    let here = Side {
        commit: checkout::here(Path::new(ROOT))?,
        programs: programs::build(Path::new(ROOT), None)?,
    };
    let sides = Sides { here, against };
    let filter = options.filter();
    let chosen = chosen(&sides, &filter)?;

    let mut rounds = Vec::new();
    for round in 1..=options.rounds {
        say(&format!("── round {round} of {}", options.rounds));
        rounds.push(time(&sides, &chosen, &filter, round % 2 == 0)?);
    }
    let commits = sides.map(|side| side.commit.as_str());
    samples::write(Path::new(SAMPLES), &commits, &rounds)?;
    say(&Comparison::new(&rounds).text(&commits));
    say(&format!("Every sample: {SAMPLES}"));
    Ok(())
}

/// A commit checked out and built below the target folder, in one of its own: in ours cargo would take the
/// two checkouts' packages for the same, and call the one fresh that the other has built.
fn other(commit: &str, scratch: &Path) -> Result<Side, String> {
    let source = scratch.join("source");
    let commit = checkout::at(Path::new(ROOT), commit, &source)?;
    say(&format!("── building the benches of {commit} in {}", source.display()));
    let programs = programs::build(&source, Some(&scratch.join("build")))?;
    Ok(Side { commit, programs })
}

/// Names of programs of either side in which a bench passes the filter.
fn chosen(sides: &Sides<Side>, filter: &str) -> Result<BTreeSet<String>, String> {
    let mut chosen = BTreeSet::new();
    for side in sides.iter() {
        for (name, program) in &side.programs {
            if program.has_bench(filter)? {
                chosen.insert(name.clone());
            }
        }
    }
    if chosen.is_empty() {
        return Err(format!("bench: needed a bench that \"{filter}\" is in, found none"));
    }
    Ok(chosen)
}

/// Runs each program on one side, then on the other: first here, or last here.
fn time(
    sides: &Sides<Side>,
    chosen: &BTreeSet<String>,
    filter: &str,
    is_here_last: bool,
) -> Result<Sides<Round>, String> {
    let mut times = sides.map(|_| Round::new());
    for name in chosen {
        let mut turns: Vec<_> = sides.iter().zip(times.iter_mut()).collect();
        if is_here_last {
            turns.reverse();
        }
        for (side, times) in turns {
            let Some(program) = side.programs.get(name) else { continue };
            say(&format!("{name} of {}", side.commit));
            times.extend(measured(program, filter)?);
        }
    }
    Ok(times)
}

/// A program's samples, by way of a folder that is empty before.
fn measured(program: &Program, filter: &str) -> Result<Round, String> {
    let home = Path::new(SCRATCH).join("criterion");
    if home.exists() {
        fs::remove_dir_all(&home).map_err(|error| format!("{}: {error}", home.display()))?;
    }
    program.run(filter, &home)?;
    samples::read(&home)
}
