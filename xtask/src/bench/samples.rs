//! Raw samples: out of criterion's files, into one of ours.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::json;

/// A batch of iterations, timed together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// How many.
    pub(super) iterations: f64,
    /// How long all of them took.
    pub(super) nanoseconds: f64,
}

/// Samples of a round on one side, by the bench's name.
pub(super) type Round = BTreeMap<String, Vec<Sample>>;

/// The same of both sides, or of ours alone.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sides<T> {
    /// What lies in the repository's folder.
    pub(super) here: T,
    /// The other commit.
    pub(super) against: Option<T>,
}

impl<T> Sides<T> {
    /// Ours first.
    pub(super) fn iter(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.here).chain(&self.against)
    }

    /// Ours first.
    pub(super) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        std::iter::once(&mut self.here).chain(&mut self.against)
    }

    /// Something of each.
    pub(super) fn map<'a, U>(&'a self, part: impl Fn(&'a T) -> U) -> Sides<U> {
        Sides { here: part(&self.here), against: self.against.as_ref().map(part) }
    }
}

/// What criterion left in its folder.
pub(super) fn read(home: &Path) -> Result<Round, String> {
    let mut round = Round::new();
    gather(home, &mut round)?;
    Ok(round)
}

/// Every folder that holds a bench's latest samples, whatever lies around it.
fn gather(folder: &Path, round: &mut Round) -> Result<(), String> {
    if folder.ends_with("new") && folder.join("sample.json").exists() {
        let text = |file: &str| {
            let path = folder.join(file);
            fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
        };
        let (name, samples) =
            bench(&text("benchmark.json")?, &text("sample.json")?).ok_or_else(|| {
                format!("{}: needed criterion's samples, found none", folder.display())
            })?;
        round.insert(name, samples);
        return Ok(());
    }
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for path in entries.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()) {
        gather(&path, round)?;
    }
    Ok(())
}

/// A bench's name and samples.
fn bench(benchmark: &str, sample: &str) -> Option<(String, Vec<Sample>)> {
    let name = json::string(benchmark, "full_id")?;
    let iterations = json::numbers(sample, "iters")?;
    let times = json::numbers(sample, "times")?;
    if times.is_empty() || iterations.len() != times.len() {
        return None;
    }
    let samples = iterations.into_iter().zip(times);
    let samples = samples.map(|(iterations, nanoseconds)| Sample { iterations, nanoseconds });
    Some((name, samples.collect()))
}

/// Writes every sample, a line each; the file appears whole.
pub(super) fn write(
    path: &Path,
    commits: &Sides<&str>,
    rounds: &[Sides<Round>],
) -> Result<(), String> {
    let partial = path.with_extension("partial");
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    folder
        .and_then(|()| fs::write(&partial, table(commits, rounds)))
        .and_then(|()| fs::rename(&partial, path))
        .map_err(|error| format!("{}: {error}", path.display()))
}

fn table(commits: &Sides<&str>, rounds: &[Sides<Round>]) -> String {
    let mut text = "bench,side,commit,round,iterations,nanoseconds\n".to_owned();
    for (number, round) in (1..).zip(rounds) {
        for ((side, commit), benches) in
            ["here", "against"].into_iter().zip(commits.iter()).zip(round.iter())
        {
            for (name, sample) in benches.iter().flat_map(|(name, samples)| {
                samples.iter().map(move |sample| (name.replace('"', "\"\""), sample))
            }) {
                let Sample { iterations, nanoseconds } = sample;
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "\"{name}\",{side},{commit},{number},{iterations},{nanoseconds}"
                );
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const BENCHMARK: &str = r#"{"group_id":"trace","function_id":"fbvh","value_str":"pool:10000",
        "full_id":"trace/fbvh/pool:10000","directory_name":"trace/fbvh/pool_10000"}"#;

    #[test]
    fn criterions_files_are_read() {
        let sample = r#"{"sampling_mode":"Flat","iters":[2.0,2.0],"times":[30.5,40.0]}"#;
        let (name, samples) = bench(BENCHMARK, sample).expect("samples");
        assert_eq!(name, "trace/fbvh/pool:10000");
        assert_eq!(samples[0], Sample { iterations: 2.0, nanoseconds: 30.5 });
        assert_eq!(samples.len(), 2);
        for bad in [r#"{"iters":[],"times":[]}"#, r#"{"iters":[1],"times":[1,2]}"#, "{}"] {
            assert_eq!(bench(BENCHMARK, bad), None, "{bad}");
        }
    }

    #[test]
    fn every_sample_is_a_line() {
        let sample = Sample { iterations: 2.0, nanoseconds: 30.5 };
        let side = Round::from([("a,b".to_owned(), vec![sample; 2])]);
        let round = Sides { here: side.clone(), against: Some(side) };
        let text = table(&Sides { here: "new", against: Some("old") }, &[round.clone(), round]);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 1 + 8);
        assert_eq!(lines[1], "\"a,b\",here,new,1,2,30.5");
        assert_eq!(lines[8], "\"a,b\",against,old,2,2,30.5");
    }
}
