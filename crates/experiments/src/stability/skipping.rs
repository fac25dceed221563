//! What is skipped: a method that took long at an easier value of a case is not run at the harder ones,
//! unless it promises to be right everywhere.

use super::case_result::CaseResult;
use super::outcome::Outcome;
use harness::configuration::Configuration;
use harness::judge::promise::Promise;
use harness::numbers::tick;

/// Seconds at one value after which a method is not run at harder ones. Twice as many balls over one point cost a published method some
/// eight times as much: its next value takes a minute or two.
pub(super) const TIME_LIMIT_S: f64 = 10.0;

/// Why a configuration is not run at the next value of a case, by its results at the easier ones. A method
/// that promises to be right everywhere always is: only so is it known where its limits are.
pub(super) fn reason_to_skip<'a>(
    easier: impl Iterator<Item = &'a CaseResult>,
    configuration: &Configuration,
) -> Option<String> {
    if configuration.technique.terms().promise == Promise::Always {
        return None;
    }
    let mut of_configuration = easier.filter(|result| result.method == configuration.name);
    let slow = of_configuration
        .find(|result| result.outcome != Outcome::Untried && result.seconds > TIME_LIMIT_S)?;
    Some(format!("not run: took {:.0} s at {}", slow.seconds, tick(slow.value)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::configuration::variants::stability_configurations;

    #[test]
    fn only_the_slow_are_skipped_and_none_that_promises_everything() {
        let all = stability_configurations();
        let find = |name: &str| {
            all.iter().find(|configuration| configuration.name == name).expect("known")
        };
        for (name, seconds, is_skipped) in [
            ("kanamori", 2.0 * TIME_LIMIT_S, true),
            ("kanamori", 0.5 * TIME_LIMIT_S, false),
            ("kanamori-robust", 2.0 * TIME_LIMIT_S, false),
        ] {
            let refused = CaseResult::refused("overlapping", 140.0, name, String::new());
            let results = [CaseResult { seconds, ..refused }];
            let reason = reason_to_skip(results.iter(), find(name));
            assert_eq!(reason.is_some(), is_skipped, "{name}: {reason:?}");
            assert!(reason.is_none_or(|reason| reason == "not run: took 20 s at 140"));
            // None is skipped for another's slowness.
            assert_eq!(reason_to_skip(results.iter(), find("illes")), None);
        }
    }
}
