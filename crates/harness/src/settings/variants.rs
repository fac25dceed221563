//! Who is tried for stability: all methods, and options of theirs that bear on where they fail.

use illes_fraglist::Piece;

use super::{Knobs, Setting};
use crate::methods::{METHODS, Method};

/// All of them, in the order of tables: variants stand behind their method, with a name in which
/// the option stands behind a plus.
pub fn entrants() -> Vec<Setting> {
    METHODS
        .iter()
        .flat_map(|method| std::iter::once(method.into()).chain(variant(method)))
        .collect()
}

/// The one option of a method that is tried beside its preset.
fn variant(method: &'static Method) -> Option<Setting> {
    match method.name {
        "kanamori" => {
            let fine = kanamori_peel::Options { threshold: 1e-6, ..Default::default() };
            let setting = Setting::with(method, "threshold", "1e-6", Knobs::Peeling(fine));
            Some(setting.called("kanamori+fine", "… clipped to 1e-6"))
        }
        "illes-exact" => {
            let piece = Piece::Exact;
            let short = illes_fraglist::Options { piece, array_capacity: 30, ..Default::default() };
            let setting = Setting::with(method, "array", "30", Knobs::Fragments(short));
            Some(setting.called("illes-exact+30", "… array of 30"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_comes_twice() {
        let all = entrants();
        for (index, entrant) in all.iter().enumerate() {
            assert!(all[..index].iter().all(|other| other.name != entrant.name));
            assert_eq!(entrant.options.is_empty(), entrant.name == entrant.method.name);
        }
        assert!(all.len() > METHODS.len());
    }
}
