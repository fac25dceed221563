//! Slices of rays on one thread, as light sends them.

use metaball_core::{HostTracer, Ray, RayQuery, SurfaceHit};

use super::certified::{self, Crossing, PacketScratch, UNDECIDED};
use super::{Search, Tracer};
use crate::Field;

/// What a thread keeps from call to call of a [`Tracer`](HostTracer::answer), for its memory.
pub struct TraceScratch(PacketScratch);

impl<F: Field> HostTracer for Tracer<'_, F> {
    type Scratch = TraceScratch;

    fn scratch(&self) -> TraceScratch {
        TraceScratch(PacketScratch::new())
    }

    fn answers(&self, query: RayQuery) -> bool {
        query != RayQuery::Exit || matches!(self.search, Search::Certified)
    }

    /// Through a certified tree, rays that go to the same octant go in packets of eight. A query that
    /// the tree does not answer leaves every ray undecided.
    fn answer(
        &self,
        query: RayQuery,
        rays: &[Ray],
        TraceScratch(scratch): &mut TraceScratch,
        answers: &mut [SurfaceHit],
    ) {
        assert_eq!(rays.len(), answers.len(), "an answer a ray");
        match (&self.search, query) {
            (Search::Published(_), RayQuery::Exit) => answers.fill(UNDECIDED),
            (Search::Published(options), _) => {
                let published = self.published(options);
                for (ray, answer) in rays.iter().zip(answers) {
                    *answer = match query {
                        RayQuery::AnyHit => published.any(ray),
                        _ => published.hit(ray, &mut ()),
                    };
                }
            }
            (Search::Certified, RayQuery::Exit) => {
                let query = self.query(Crossing::Exit, false);
                for (ray, answer) in rays.iter().zip(answers) {
                    *answer = self.tree.first_exit(&query, ray, scratch.single());
                }
            }
            (Search::Certified, _) => {
                let query = self.query(Crossing::Entry, query == RayQuery::AnyHit);
                let mut rest = answers;
                for packet in certified::packets(rays) {
                    let (answers, others) = rest.split_at_mut(packet.len());
                    self.tree.first_crossings(&query, packet, scratch, answers);
                    rest = others;
                }
            }
        }
    }

    fn clearance(&self, ray: &Ray, found: &SurfaceHit) -> f32 {
        let tolerance = match &self.search {
            Search::Published(options) => Some(options.tolerance),
            Search::Certified => None,
        };
        self.tree.clearance(ray, found, tolerance)
    }

    fn balls_near(&self, found: &SurfaceHit) -> &[u32] {
        self.tree.leaf_of(found).map_or(&[], |leaf| self.tree.tree.list(leaf))
    }
}
