//! The quick values of every stability case: each method fails where it is stated to, and nowhere
//! else, and reports it where it is stated to.

use bench_scenes::cases;
use experiments::stability::case_result::CaseResult;
use experiments::stability::fixture::Fixture;
use experiments::stability::limits::expected;
use experiments::stability::outcome::Outcome;
use harness::configuration::Configuration;
use harness::configuration::variants::stability_configurations;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;

use super::{on_gpu, terms_of};

pub(super) fn trials() -> Vec<Trial> {
    let mut trials: Vec<_> = stability_configurations()
        .into_iter()
        .filter(|configuration| configuration.options.is_empty())
        .map(|configuration| {
            let name = format!("stability::{}", configuration.name);
            on_gpu(name, move |gpu| is_as_stated(gpu, &configuration))
        })
        .collect();
    for (method, cases) in LARGEST {
        let name = format!("stability::largest_values::{method}");
        trials.push(on_gpu(name, move |gpu| is_as_stated_in_the_largest(gpu, method, cases)));
    }
    trials.push(on_gpu("stability::canary".to_owned(), notices_a_broken_promise));
    trials
}

fn is_as_stated(gpu: &Gpu, configuration: &Configuration) -> Result<(), Failed> {
    let mut fixture = Fixture::new(Some(gpu), [configuration.clone()]);
    let mut wrong = String::new();
    for case in cases() {
        for &value in case.quick {
            let needed = expected(&configuration.name, case, value);
            for found in fixture.run(case, value, |_| None)? {
                if found.outcome != needed {
                    wrong += &format!("\n  needed {needed:?}, found {found:?}");
                }
            }
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// A thousand balls and more over each ray: rays are suspended over many dispatches, and each has to advance.
const LARGEST: &[(&str, &[&str])] = &[
    ("fbvh-certified", &["coincident", "overlapping"]),
    ("kanamori-robust", &["coincident", "overlapping"]),
    ("illes-robust", &["coincident", "overlapping"]),
    ("illes", &["coincident", "overlapping"]),
    ("illes-rebuilt", &["coincident", "overlapping"]),
    ("illes-exact+30", &["common-entry"]),
];

/// At a case's largest value everything is as stated.
fn is_as_stated_in_the_largest(gpu: &Gpu, name: &str, known: &[&str]) -> Result<(), Failed> {
    let configuration =
        stability_configurations().into_iter().find(|configuration| configuration.name == name);
    let mut fixture = Fixture::new(Some(gpu), [configuration.ok_or("no such configuration")?]);
    for case in cases().iter().filter(|case| known.contains(&case.name)) {
        let most = *case.values.last().ok_or("a case without values")?;
        let needed = expected(name, case, most);
        for found in fixture.run(case, most, |_| None)? {
            if found.outcome != needed || found.clear == 0 {
                return Err(format!("needed {needed:?}, found {found:?}").into());
            }
        }
    }
    Ok(())
}

/// Depth peeling as published, held to the promise of its variant, is caught where points coincide.
fn notices_a_broken_promise(gpu: &Gpu) -> Result<(), Failed> {
    let find = |name: &str| {
        stability_configurations().into_iter().find(|configuration| configuration.name == name)
    };
    let published = find("kanamori").ok_or("no configuration is called kanamori")?;
    let case = cases().iter().find(|case| case.name == "coincident").ok_or("no such case")?;
    let outcome = |terms| -> Result<Vec<Outcome>, Failed> {
        let fixture = &mut Fixture::holding(Some(gpu), [(published.clone(), terms)]);
        let results: Vec<CaseResult> = fixture.run(case, 2.0, |_| None)?;
        Ok(results.iter().map(|result| result.outcome).collect())
    };
    let found = (outcome(terms_of("kanamori")?)?, outcome(terms_of("kanamori-robust")?)?);
    if found != (vec![Outcome::SilentlyWrong], vec![Outcome::Broken]) {
        return Err(format!("needed SilentlyWrong, then Broken, found {found:?}").into());
    }
    Ok(())
}
