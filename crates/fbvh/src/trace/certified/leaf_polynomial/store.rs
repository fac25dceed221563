//! The polynomials of a tree's leaves, made when rays ask for them.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::LeafPolynomial;
use super::cells::Cells;

/// Polynomials of leaves, shared by all threads. Which leaves have one, and which one, changes no answer.
#[derive(Debug, Default)]
pub(in crate::trace) struct Polynomials(OnceLock<Box<[Slot]>>);

/// The polynomials of a leaf, as far as they have been made; `None` for one that decides too little.
#[derive(Debug, Default)]
struct Slot {
    /// Rays that have asked.
    rays: AtomicU32,
    coarse: OnceLock<Option<Box<LeafPolynomial>>>,
    fine: OnceLock<Option<Box<LeafPolynomial>>>,
}

/// Lists of fewer balls are searched faster as they are.
const LEAST_BALLS: usize = 32;

/// Rays that have to ask before a polynomial is made: what making it takes is as much as it saves so many.
const RAYS_FOR_COARSE: u32 = 64;
const RAYS_FOR_FINE: u32 = 512;

impl Polynomials {
    /// The best polynomial of a leaf of so many, with so long a list; made by `make` when so many rays have
    /// asked that it pays. `rays` more ask now.
    pub(super) fn get(
        &self,
        (leaf, leaves): (usize, usize),
        balls: usize,
        rays: u32,
        make: impl Fn(Cells) -> Option<LeafPolynomial>,
    ) -> Option<&LeafPolynomial> {
        if balls < LEAST_BALLS {
            return None;
        }
        let slots = self.0.get_or_init(|| (0..leaves).map(|_| Slot::default()).collect());
        let Slot { rays: asked, coarse, fine } = &slots[leaf];
        if let Some(fine) = fine.get() {
            return fine.as_deref().or_else(|| coarse.get()?.as_deref());
        }
        let asked = asked.fetch_add(rays, Ordering::Relaxed).saturating_add(rays);
        if asked >= RAYS_FOR_FINE {
            let fine = fine.get_or_init(|| make(Cells::FINE).map(Box::new));
            return fine.as_deref().or_else(|| coarse.get()?.as_deref());
        }
        if asked >= RAYS_FOR_COARSE {
            return coarse.get_or_init(|| make(Cells::COARSE).map(Box::new)).as_deref();
        }
        None
    }
}

#[cfg(test)]
impl Polynomials {
    /// How many leaves have a fine polynomial.
    pub(super) fn fine(&self) -> usize {
        let slots = self.0.get().into_iter().flatten();
        slots.filter(|slot| slot.fine.get().is_some_and(Option::is_some)).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asked by few rays, or with a short list, there is none; then a coarse one; then a fine one, or the
    /// coarse one where the fine one is too little.
    #[test]
    fn a_polynomial_is_made_when_it_pays() {
        let made = |cells: Cells| {
            let error = 1.0 / cells.along as f32;
            Some(LeafPolynomial::constant(error))
        };
        let error = |found: Option<&LeafPolynomial>| found.map(|found| found.error);
        let polynomials = Polynomials::default();
        let get = |leaf, balls, rays| error(polynomials.get((leaf, 3), balls, rays, made));
        assert_eq!(get(0, LEAST_BALLS - 1, 10_000), None);
        assert_eq!(get(0, LEAST_BALLS, RAYS_FOR_COARSE - 1), None);
        assert_eq!(get(0, LEAST_BALLS, 1), Some(0.5));
        assert_eq!(get(0, LEAST_BALLS, RAYS_FOR_FINE - RAYS_FOR_COARSE - 1), Some(0.5));
        assert_eq!(get(0, LEAST_BALLS, 1), Some(0.25));
        assert_eq!(get(0, LEAST_BALLS, u32::MAX), Some(0.25));
        assert_eq!(get(1, LEAST_BALLS, 1), None);
        let coarse_alone =
            |cells: Cells| if cells.along == Cells::COARSE.along { made(cells) } else { None };
        for (rays, wanted) in [(RAYS_FOR_COARSE, Some(0.5)), (RAYS_FOR_FINE, Some(0.5))] {
            let found = polynomials.get((2, 3), LEAST_BALLS, rays, coarse_alone);
            assert_eq!(error(found), wanted);
        }
    }
}
