//! The quickest setting of each method with knobs, and what its speed costs.

use super::plan::Purpose;
use super::record::Group;
use harness::methods::methods;
use harness::record::{Measured, Record};

/// A method on a scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row<'a> {
    pub(super) scene: &'a str,
    pub(super) method: &'static str,
    pub(super) preset: Setting<'a>,
    /// Of all settings.
    pub(super) quickest: Setting<'a>,
    /// Of those that are wrong on no more rays than the preset.
    pub(super) quickest_as_right: Setting<'a>,
}

/// A setting's time and wrong verdicts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setting<'a> {
    pub(super) record: &'a Record,
    pub(super) ms: f64,
    /// Wrong or open verdicts.
    pub(super) wrong: u64,
}

impl Row<'_> {
    /// Whether the quickest setting is wrong on rays that the preset answers.
    pub(super) fn buys_speed_with_verdicts(&self) -> bool {
        self.quickest.wrong > self.preset.wrong
    }
}

/// Every method of which more than the preset was measured, scene by scene.
pub(super) fn rows(groups: &[Group]) -> Vec<Row<'_>> {
    let of_errors = groups.iter().filter(|group| group.purpose == Purpose::Error);
    let rows = |group| methods().iter().filter_map(move |method| row(group, method.name));
    of_errors.flat_map(rows).collect()
}

fn row<'a>(group: &'a Group, method: &'static str) -> Option<Row<'a>> {
    let records = group.records.iter().filter(|record| record.method == method);
    let settings: Vec<_> = records.filter_map(setting).collect();
    let preset = *settings.iter().find(|setting| setting.record.options.is_empty())?;
    let quickest = |most: u64| {
        let right = settings.iter().filter(move |setting| setting.wrong <= most);
        right.copied().min_by(|a, b| a.ms.total_cmp(&b.ms))
    };
    let (quickest, quickest_as_right) = (quickest(u64::MAX)?, quickest(preset.wrong)?);
    let scene = group.spec.as_str();
    let row = Row { scene, method, preset, quickest, quickest_as_right };
    (settings.len() > 1).then_some(row)
}

fn setting(record: &Record) -> Option<Setting<'_>> {
    let Measured { accuracy, undecided_pixels, frame_ms, .. } = record.measured.as_ref()?;
    let wrong = (accuracy.wrong_verdicts() as u64).saturating_add(*undecided_pixels);
    Some(Setting { record, ms: frame_ms.median, wrong })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::measured_as;

    #[test]
    fn speed_that_costs_verdicts_is_told_from_speed_that_costs_none() {
        let set = |ms, wrong, option: &str| {
            let mut record = measured_as("one", "fbvh", ms, wrong);
            record.options.insert(option.to_owned(), "4".to_owned());
            record
        };
        let group = Group {
            purpose: Purpose::Error,
            spec: "one".to_owned(),
            balls: 2,
            density: 1.0,
            supports_per_ray: 1.0,
            remarks: Vec::new(),
            records: vec![
                measured_as("one", "fbvh", 6.0, 3),
                set(4.0, 3, "leaf size"),
                set(2.0, 9, "tolerance"),
                measured_as("one", "illes", 1.0, 1),
            ],
        };
        let groups = [group];
        let rows = rows(&groups);
        assert_eq!(rows.len(), 1, "illes has its preset alone");
        let [preset, quickest, as_right] =
            [rows[0].preset, rows[0].quickest, rows[0].quickest_as_right]
                .map(|set| (set.ms, set.wrong));
        assert_eq!((preset, quickest, as_right), ((6.0, 3), (2.0, 9), (4.0, 3)));
        assert!(rows[0].buys_speed_with_verdicts());
        let mut right = groups[0].clone();
        right.records.remove(2);
        let groups = [right];
        assert!(!super::rows(&groups)[0].buys_speed_with_verdicts());
    }
}
