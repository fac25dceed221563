//! Rays of one query that are answered together, those that go the same way side by side.

use metaball_core::{HostTracer, Ray, RayQuery, SurfaceHit};

/// Rays with their answers, and what sorting them takes; kept from wave to wave for its memory.
#[derive(Debug, Default)]
pub(super) struct Wave {
    pub(super) rays: Vec<Ray>,
    pub(super) answers: Vec<SurfaceHit>,
    /// For each ray, the cell of its direction.
    cells: Vec<u8>,
    /// For each ray in the order of directions: its index.
    order: Vec<u32>,
    sorted: Vec<Ray>,
    sorted_answers: Vec<SurfaceHit>,
}

/// Directions in cells: eight octants, each of a square of so many by so many.
const ACROSS: usize = 4;
const CELLS: usize = 8 * ACROSS * ACROSS;
const _: () = assert!(CELLS <= 1 << u8::BITS, "a cell is a byte");

impl Wave {
    pub(super) fn clear(&mut self) {
        self.rays.clear();
    }

    /// Begins a wave of paths' rays.
    pub(super) fn send(&mut self, sent: &[(u32, Ray)]) {
        self.rays.clear();
        self.rays.extend(sent.iter().map(|(_, ray)| ray));
    }

    /// Takes answers that are known.
    pub(super) fn take(&mut self, answers: &[SurfaceHit]) {
        self.answers.clear();
        self.answers.extend_from_slice(answers);
    }

    /// Answers rays that are neighbours as they are, such as those from the eye.
    pub(super) fn answer<T: HostTracer>(
        &mut self,
        tracer: &T,
        query: RayQuery,
        scratch: &mut T::Scratch,
    ) {
        self.answers.resize(self.rays.len(), SurfaceHit::MISS);
        tracer.answer(query, &self.rays, scratch, &mut self.answers);
    }

    /// Answers rays that go anywhere: in the order of their directions, which packets need.
    pub(super) fn answer_by_direction<T: HostTracer>(
        &mut self,
        tracer: &T,
        query: RayQuery,
        scratch: &mut T::Scratch,
    ) {
        self.sort();
        self.sorted_answers.resize(self.rays.len(), SurfaceHit::MISS);
        tracer.answer(query, &self.sorted, scratch, &mut self.sorted_answers);
        self.answers.resize(self.rays.len(), SurfaceHit::MISS);
        for (&index, answer) in self.order.iter().zip(&self.sorted_answers) {
            self.answers[index as usize] = *answer;
        }
    }

    /// By counting, which keeps the order of rays in a cell: they begin near each other.
    fn sort(&mut self) {
        self.cells.clear();
        self.cells.extend(self.rays.iter().map(cell));
        let mut next = [0u32; CELLS + 1];
        for &cell in &self.cells {
            next[usize::from(cell) + 1] += 1;
        }
        for index in 0..CELLS {
            next[index + 1] += next[index];
        }
        self.order.resize(self.rays.len(), 0);
        for (index, &cell) in (0..).zip(&self.cells) {
            let slot = &mut next[usize::from(cell)];
            self.order[*slot as usize] = index;
            *slot += 1;
        }
        self.sorted.clear();
        self.sorted.extend(self.order.iter().map(|&index| self.rays[index as usize]));
    }
}

/// The cell of a ray's direction on the octahedron.
fn cell(ray: &Ray) -> u8 {
    let direction = ray.direction;
    let octant =
        (0..3).fold(0, |octant, axis| 2 * octant + usize::from(direction[axis].is_sign_negative()));
    let size = direction.abs();
    let along = |x: f32| ((x / size.element_sum() * ACROSS as f32) as usize).min(ACROSS - 1);
    ((octant * ACROSS + along(size.x)) * ACROSS + along(size.y)) as u8
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn rays_are_sorted_by_octant_and_keep_their_order() {
        let mut wave = Wave::default();
        for index in 0..1000u32 {
            let angle = index as f32;
            let direction = Vec3::new(angle.sin(), (0.7 * angle).cos(), (0.3 * angle).sin());
            wave.rays.push(Ray::new(Vec3::splat(angle), direction.normalize()));
        }
        wave.sort();
        let mut seen = wave.order.clone();
        seen.sort_unstable();
        assert!(seen.iter().copied().eq(0..1000));
        let cells: Vec<_> = wave.sorted.iter().map(cell).collect();
        assert!(cells.is_sorted() && cells.first() != cells.last());
        let in_cell = wave.order.windows(2).zip(cells.windows(2));
        assert!(in_cell.into_iter().all(|(order, cell)| cell[0] != cell[1] || order[0] < order[1]));
    }
}
