//! What the short list of `auto` costs: the quickest of its candidates against the quickest of all
//! configurations that were measured.

use super::plan::Purpose;
use super::record::Group;
use harness::auto::choice::Errors;
use harness::configuration::{label, sweeps};
use harness::record::{Measured, Record};

/// A scene and an error, with the two that keep it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row<'a> {
    pub(super) scene: &'a str,
    pub(super) max_error: f64,
    /// The quickest of `auto`'s candidates; `None` where none is right enough.
    pub(super) listed: Option<(&'a Record, f64)>,
    /// The quickest of all configurations, and its milliseconds.
    pub(super) best: (&'a Record, f64),
}

impl Row<'_> {
    /// Time of the listed one over that of the best.
    pub(super) fn ratio(&self) -> Option<f64> {
        self.listed.map(|(_, ms)| ms / self.best.1)
    }
}

/// Errors that are allowed: the default of `auto`, and one that cubics may keep.
const ERRORS: [f64; 2] = [harness::auto::MAX_ERROR, 0.05];

/// Every scene of the charts of error, for each error that any configuration keeps there. R is the chart's:
/// the smallest support radius at the hit.
pub(super) fn rows(groups: &[Group]) -> Vec<Row<'_>> {
    let candidates: Vec<_> =
        sweeps::candidates().into_iter().map(|configuration| configuration.name).collect();
    let is_listed = |record: &Record| candidates.contains(&label(&record.method, &record.options));
    let of_errors = groups.iter().filter(|group| group.purpose == Purpose::Error);
    let row = |group, max_error| {
        let best = quickest(group, max_error, |_| true)?;
        let listed = quickest(group, max_error, is_listed);
        Some(Row { scene: &group.spec, max_error, listed, best })
    };
    of_errors.flat_map(|group| ERRORS.into_iter().filter_map(move |e| row(group, e))).collect()
}

fn quickest(
    group: &Group,
    max_error: f64,
    takes_part: impl Fn(&Record) -> bool,
) -> Option<(&Record, f64)> {
    let records = group.records.iter().filter(|record| takes_part(record));
    let measured = records.filter_map(|record| Some((record, record.measured.as_ref()?)));
    let right_enough = measured.filter(|(_, measured)| errors(measured).keep(max_error));
    right_enough
        .map(|(record, measured)| (record, measured.frame_ms.median))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

fn errors(measured: &Measured) -> Errors {
    let accuracy = &measured.accuracy;
    let undecided = usize::try_from(measured.undecided_pixels).unwrap_or(usize::MAX);
    Errors {
        rays: accuracy.rays,
        wrong: accuracy.wrong_verdicts().saturating_add(undecided),
        p99: accuracy.t_error_over_radius.map_or(0.0, |error| error.p99),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::measured_as;

    #[test]
    fn a_setting_that_is_not_listed_shows_what_the_list_costs() {
        let mut unlisted = measured_as("one", "fbvh", 5.0, 0);
        unlisted.options.insert("leaf size".to_owned(), "4".to_owned());
        let wrong = measured_as("one", "illes", 1.0, 1);
        let group = Group {
            purpose: Purpose::Error,
            spec: "one".to_owned(),
            balls: 2,
            density: 1.0,
            supports_per_ray: 1.0,
            remarks: Vec::new(),
            records: vec![wrong, measured_as("one", "fbvh", 6.0, 0), unlisted],
        };
        let groups = [group];
        let rows = rows(&groups);
        assert_eq!(rows.len(), ERRORS.len());
        assert_eq!(rows[0].best.1, 5.0, "the quickest is wrong and out");
        assert_eq!(rows[0].ratio(), Some(1.2));
    }
}
