//! Who is tried: all methods, and options of theirs that bear on where they fail.

use metaball_core::gpu::IsoRenderer;

use crate::judge::promise::{Promise, promise_of};
use crate::judge::{Stop, Terms};
use crate::methods::{METHODS, Method};
use crate::score::WRONG_FRONT;

/// A method, or a method with an option turned.
#[derive(Debug, Clone, Copy)]
pub struct Entrant {
    /// The method's name; an option stands behind a plus.
    pub name: &'static str,
    /// Name in headings.
    pub title: &'static str,
    /// What it is held to.
    pub terms: Terms,
    make: Make,
}

#[derive(Debug, Clone, Copy)]
enum Make {
    Method(&'static Method),
    Variant(fn(&'static str) -> Box<dyn IsoRenderer>),
}

impl Entrant {
    /// A renderer that does not count its work.
    pub fn renderer(&self) -> Box<dyn IsoRenderer> {
        match self.make {
            Make::Method(method) => (method.make)(false),
            Make::Variant(make) => make(self.name),
        }
    }

    /// The |Δt|/R that 99 of 100 hits keep within: the reach of a default root finder, or where a
    /// cubic stands for the field, that of a wrong front.
    pub fn tolerance(&self) -> f64 {
        match self.terms.promise {
            Promise::Fragments { piece, .. } if !piece.is_exact() => WRONG_FRONT,
            _ => 1e-3,
        }
    }
}

/// All of them, in the order of tables: variants stand behind their method.
pub fn entrants() -> Vec<Entrant> {
    let mut all = Vec::new();
    for method in METHODS {
        let terms = Terms::of(promise_of(method.name));
        let (name, title) = (method.name, method.title);
        all.push(Entrant { name, title, terms, make: Make::Method(method) });
        all.extend(variants(method.name));
    }
    all
}

/// Options of a method.
fn variants(method: &str) -> Vec<Entrant> {
    let variant = |name, title, promise, make| {
        let terms = Terms::of(promise);
        Entrant { name, title, terms, make: Make::Variant(make) }
    };
    match method {
        "kanamori" => {
            let mut fine =
                variant("kanamori+fine", "… clipped to 1e-6", promise_of("kanamori"), {
                    |name| {
                        let options =
                            kanamori_peel::Options { threshold: 1e-6, ..Default::default() };
                        Box::new(kanamori_peel::Renderer::new(name, options, false))
                    }
                });
            // Half the threshold, times two radii, and ten roundings of a distance of a few radii.
            fine.terms.stop = Stop::Distance(1e-5);
            vec![fine]
        }
        "illes-exact" => {
            let exact = Promise::Fragments { piece: illes_fraglist::Piece::Exact, room: 30 };
            vec![variant("illes-exact+30", "… array of 30", exact, |name| {
                let piece = illes_fraglist::Piece::Exact;
                let options = illes_fraglist::Options { piece, room: 30, ..Default::default() };
                Box::new(illes_fraglist::Renderer::new(name, options, false))
            })]
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn renderers_know_their_names_and_no_name_comes_twice() {
        let all = entrants();
        for (index, entrant) in all.iter().enumerate() {
            assert_eq!(entrant.renderer().name(), entrant.name);
            assert!(all[..index].iter().all(|other| other.name != entrant.name));
        }
        assert!(all.len() > METHODS.len());
    }
}
