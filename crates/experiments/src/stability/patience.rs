//! Who rests: a method that took long at an easier value of a case is not run at the harder ones,
//! unless it promises to be right everywhere.

use super::cell::{Cell, Outcome};
use harness::configuration::Configuration;
use harness::judge::promise::Promise;
use harness::numbers::tick;

/// Seconds after which a method rests. Twice as many balls over one point cost a published method some
/// eight times as much: its next value takes a minute or two.
pub(super) const PATIENCE_S: f64 = 10.0;

/// Why a configuration is not run at the next value of a case, by the cells of the easier ones. A method
/// that promises to be right everywhere always is: only so is it known where its limits are.
pub(super) fn rests<'a>(
    easier: impl Iterator<Item = &'a Cell>,
    configuration: &Configuration,
) -> Option<String> {
    if configuration.technique.terms().promise == Promise::Always {
        return None;
    }
    let mut of_configuration = easier.filter(|cell| cell.method == configuration.name);
    let tiring = of_configuration
        .find(|cell| cell.outcome != Outcome::Untried && cell.seconds > PATIENCE_S)?;
    Some(format!("not run: took {:.0} s at {}", tiring.seconds, tick(tiring.value)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::configuration::variants::stability_configurations;

    #[test]
    fn only_the_slow_rest_and_none_that_promises_everything() {
        let all = stability_configurations();
        let find = |name: &str| {
            all.iter().find(|configuration| configuration.name == name).expect("known")
        };
        for (name, seconds, is_tired) in [
            ("kanamori", 2.0 * PATIENCE_S, true),
            ("kanamori", 0.5 * PATIENCE_S, false),
            ("kanamori-robust", 2.0 * PATIENCE_S, false),
        ] {
            let refused = Cell::refused("overlapping", 140.0, name, String::new());
            let cells = [Cell { seconds, ..refused }];
            let reason = rests(cells.iter(), find(name));
            assert_eq!(reason.is_some(), is_tired, "{name}: {reason:?}");
            assert!(reason.is_none_or(|reason| reason == "not run: took 20 s at 140"));
            // Nobody rests for another's slowness.
            assert_eq!(rests(cells.iter(), find("illes")), None);
        }
    }
}
