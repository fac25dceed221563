//! Both sides of every bench: medians, and their ratio.

use std::collections::BTreeSet;

use super::samples::{Round, Sample, Sides};

/// Every bench of either side.
pub(super) struct Comparison {
    lines: Vec<Line>,
}

/// A bench; times are nanoseconds of an iteration.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    name: String,
    /// Medians over all samples of all rounds; none where a side has no such bench.
    here: Option<f64>,
    against: Option<f64>,
    ratio: Option<Ratio>,
}

/// Our time over the other's: ratios of the medians of a round, since a machine that drifts between rounds
/// leaves these alone.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ratio {
    /// The middle one.
    median: f64,
    least: f64,
    greatest: f64,
}

impl Comparison {
    /// Of all rounds.
    pub(super) fn new(rounds: &[Sides<Round>]) -> Self {
        let rounds_of_either = rounds.iter().flat_map(Sides::iter);
        let names: BTreeSet<&String> = rounds_of_either.flat_map(|round| round.keys()).collect();
        Self { lines: names.into_iter().map(|name| Line::new(name, rounds)).collect() }
    }

    /// A table for a person.
    pub(super) fn text(&self, commits: &Sides<&str>) -> String {
        let mut rows = vec![match commits.against {
            Some(against) => {
                let here = format!("here ({})", commits.here);
                vec!["bench".into(), here, against.into(), "ratio".into(), "over rounds".into()]
            }
            None => vec!["bench".to_owned(), format!("here ({})", commits.here)],
        }];
        rows.extend(self.lines.iter().map(|line| line.cells(commits)));
        aligned(&rows)
    }
}

impl Line {
    fn new(name: &str, rounds: &[Sides<Round>]) -> Self {
        let of = |side: Option<&Round>| side.and_then(|round| round.get(name)).cloned();
        let here: Vec<_> = rounds.iter().filter_map(|round| of(Some(&round.here))).collect();
        let against: Vec<_> =
            rounds.iter().filter_map(|round| of(round.against.as_ref())).collect();
        let pairs = here.iter().zip(&against);
        let ratios = pairs.filter_map(|(here, against)| Some(median(here)? / median(against)?));
        let ratio = Ratio::of(ratios.collect());
        let (here, against) = (median(&here.concat()), median(&against.concat()));
        Self { name: name.to_owned(), here, against, ratio }
    }

    fn cells(&self, commits: &Sides<&str>) -> Vec<String> {
        let time = |median: Option<f64>| median.map_or_else(|| "no such bench".to_owned(), time);
        let mut cells = vec![self.name.clone(), time(self.here)];
        if commits.against.is_some() {
            cells.push(time(self.against));
        }
        if let Some(Ratio { median, least, greatest }) = self.ratio {
            cells.extend([format!("{median:.3}"), format!("{least:.3} to {greatest:.3}")]);
        }
        cells
    }
}

impl Ratio {
    /// Of the ratios of all rounds.
    fn of(mut ratios: Vec<f64>) -> Option<Self> {
        let median = middle(&mut ratios)?;
        Some(Self { median, least: *ratios.first()?, greatest: *ratios.last()? })
    }
}

/// Nanoseconds of an iteration.
fn median(samples: &[Sample]) -> Option<f64> {
    let times = samples.iter().map(|sample| sample.nanoseconds / sample.iterations);
    middle(&mut times.collect::<Vec<_>>())
}

/// The median of numbers, which it sorts.
fn middle(numbers: &mut [f64]) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    let (low, high) = (numbers.len().checked_sub(1)? / 2, numbers.len() / 2);
    Some(0.5 * (numbers[low] + numbers[high]))
}

/// A time with its unit, to four digits.
fn time(nanoseconds: f64) -> String {
    let units = [(1e9, "s"), (1e6, "ms"), (1e3, "µs")];
    let (scale, unit) =
        units.into_iter().find(|(scale, _)| nanoseconds >= *scale).unwrap_or((1.0, "ns"));
    let value = nanoseconds / scale;
    let digits = if value >= 100.0 { 1 } else { 2 };
    format!("{value:.digits$} {unit}")
}

/// Columns side by side: the first to the left, numbers to the right.
fn aligned(rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
    };
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let width = width(column).unwrap_or(0);
            if column == 0 { format!("{cell:width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ")
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round(name: &str, times: &[f64]) -> Round {
        let sample = |time: &f64| Sample { iterations: 2.0, nanoseconds: 2.0 * time };
        Round::from([(name.to_owned(), times.iter().map(sample).collect())])
    }

    /// Twice the work is twice the time, whichever side does it; a machine that becomes three times as slow
    /// changes nothing, be it in the middle of a comparison.
    #[test]
    fn a_slower_side_is_told_apart() {
        let [fast, slow] = [[1e6, 1.1e6, 1.2e6], [2e6, 2.2e6, 2.4e6]];
        let drifted = |times: [f64; 3], by: f64| times.map(|time| by * time);
        let rounds = |here: [f64; 3], against: [f64; 3]| {
            [1.0, 1.0, 3.0].map(|by| Sides {
                here: round("a", &drifted(here, by)),
                against: Some(round("a", &drifted(against, by))),
            })
        };
        for (rounds, expected) in
            [(rounds(slow, fast), 2.0), (rounds(fast, slow), 0.5), (rounds(fast, fast), 1.0)]
        {
            let ratio = Comparison::new(&rounds).lines[0].ratio.expect("both");
            for found in [ratio.median, ratio.least, ratio.greatest] {
                assert!((found - expected).abs() < 1e-12, "{ratio:?}");
            }
        }
    }

    #[test]
    fn the_range_is_that_of_the_rounds() {
        let sides = |here, against| Sides {
            here: round("a", &[here]),
            against: Some(round("a", &[against])),
        };
        let ratio = Comparison::new(&[sides(1.0, 2.0), sides(3.0, 2.0), sides(2.0, 2.0)]).lines[0]
            .ratio
            .expect("both");
        assert_eq!(ratio, Ratio { median: 1.0, least: 0.5, greatest: 1.5 });
    }

    #[test]
    fn a_bench_of_one_side_is_said() {
        let sides = Sides { here: round("new", &[1.0]), against: Some(round("old", &[1.0])) };
        let commits = Sides { here: "abc", against: Some("def") };
        let text = Comparison::new(&[sides]).text(&commits);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[1].starts_with("new") && lines[1].ends_with("no such bench"), "{text}");
        assert!(lines[2].starts_with("old") && lines[2].contains("no such bench"), "{text}");
    }

    #[test]
    fn times_have_units() {
        let times = [3.25, 4_500.0, 123_456_000.0, 2e9].map(time);
        assert_eq!(times, ["3.25 ns", "4.50 µs", "123.5 ms", "2.00 s"]);
    }
}
