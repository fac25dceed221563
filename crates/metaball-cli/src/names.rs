//! Names on the command line: an unknown one is answered with the list.

use bench_scenes::Case;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use harness::configuration::Configuration;
use harness::configuration::variants::stability_configurations;
use harness::methods::{Method, find, methods};

/// A method by name.
pub(crate) fn method_parser() -> impl TypedValueParser<Value = &'static Method> {
    let names = methods().iter().map(|method| PossibleValue::new(method.name).help(method.title));
    PossibleValuesParser::new(names).map(|name| find(&name).expect("only names of methods pass"))
}

/// A method that draws pictures by name, or `auto`.
pub(crate) fn drawer_parser() -> impl TypedValueParser<Value = String> {
    let draws = |method: &&Method| method.needs_adapter() || method.technique.tree().is_some();
    let names = methods()
        .iter()
        .filter(draws)
        .map(|method| PossibleValue::new(method.name).help(method.title));
    let auto = PossibleValue::new(AUTO).help("The quickest that is right enough");
    PossibleValuesParser::new(names.chain([auto]))
}

pub(crate) const AUTO: &str = "auto";

/// The method unless another is named.
pub(crate) const DEFAULT_METHOD: &str = "fbvh-certified";

/// A stability case by name.
pub(crate) fn case_parser() -> impl TypedValueParser<Value = &'static Case> {
    let named = |name: &str| bench_scenes::cases().iter().find(|case| case.name == name);
    let names = bench_scenes::cases().iter().map(|case| PossibleValue::new(case.name));
    PossibleValuesParser::new(names)
        .map(move |name| named(&name).expect("only names of cases pass"))
}

/// A method, or one with an option turned, by name.
pub(crate) fn configuration_parser() -> impl TypedValueParser<Value = Configuration> {
    // Names on the command line live as long as the program.
    let leak = |configuration: Configuration| PossibleValue::new(&*configuration.name.leak());
    let names = stability_configurations().into_iter().map(leak);
    PossibleValuesParser::new(names).map(|name| {
        let mut all = stability_configurations().into_iter();
        all.find(|configuration| configuration.name == name)
            .expect("only names of configurations pass")
    })
}
