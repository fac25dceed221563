//! What is tried for stability: all methods, and options of theirs that bear on where they fail.

use illes_fraglist::Piece;

use super::Configuration;
use crate::methods::{Method, methods};
use crate::technique::Technique;

/// All of them, in the order of tables: variants follow their method, with a name in which
/// the option follows a plus.
pub fn stability_configurations() -> Vec<Configuration> {
    let with_variant =
        |method: &'static Method| std::iter::once(method.into()).chain(variant(method));
    methods().iter().flat_map(with_variant).collect()
}

/// The one option of a method that is tried besides its preset.
fn variant(method: &'static Method) -> Option<Configuration> {
    match method.technique {
        Technique::Peeling(preset) => {
            let fine = Technique::Peeling(kanamori_peel::Options { threshold: 1e-6, ..preset });
            let configuration = Configuration::with(method, "threshold", "1e-6", fine);
            let name = format!("{}+fine", method.name);
            Some(configuration.called(&name, "… clipped to 1e-6"))
        }
        Technique::Fragments(preset) if preset.piece == Piece::Exact => {
            let short = illes_fraglist::Options { array_capacity: 30, ..preset };
            let configuration =
                Configuration::with(method, "array", "30", Technique::Fragments(short));
            let name = format!("{}+30", method.name);
            Some(configuration.called(&name, "… array of 30"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_comes_twice() {
        let all = stability_configurations();
        for (index, configuration) in all.iter().enumerate() {
            assert!(all[..index].iter().all(|other| other.name != configuration.name));
            assert_eq!(
                configuration.options.is_empty(),
                configuration.name == configuration.method.name
            );
        }
        assert!(all.len() > methods().len());
    }
}
