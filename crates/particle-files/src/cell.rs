//! Periodic cells.

use glam::DVec3;
use metaball_core::{Clip, ClipError};

/// The cell that a simulation repeats: a parallelepiped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// A corner, in the coordinates of the particles.
    pub origin: DVec3,
    /// The edges from that corner.
    pub edges: [DVec3; 3],
    /// Along which edges it repeats.
    pub periodic: [bool; 3],
}

impl Cell {
    /// A cell from the origin that repeats along all three edges; `None` where they span no volume.
    pub fn new(edges: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = edges;
        let volume = a.cross(b).dot(c);
        let sound =
            edges.iter().all(|edge| edge.is_finite()) && volume != 0.0 && volume.is_finite();
        sound.then_some(Self { origin: DVec3::ZERO, edges, periodic: [true; 3] })
    }

    /// The cell of edge lengths a, b, c and the angles α (between b and c), β (a, c), γ (a, b) in
    /// degrees, a along x and b in the plane of x and y, as crystallographers write it. `None` where
    /// they make none.
    pub fn of_lengths_and_angles(lengths: [f64; 3], angles: [f64; 3]) -> Option<Self> {
        // Right angles are common and shall give zeros.
        let cosine = |degrees: f64| if degrees == 90.0 { 0.0 } else { degrees.to_radians().cos() };
        let sine = |degrees: f64| if degrees == 90.0 { 1.0 } else { degrees.to_radians().sin() };
        let ([a, b, c], [alpha, beta, gamma]) = (lengths, angles);
        let x = cosine(beta);
        let y = (cosine(alpha) - cosine(beta) * cosine(gamma)) / sine(gamma);
        let z = 1.0 - x * x - y * y;
        let is_angle = |angle: &f64| *angle > 0.0 && *angle < 180.0;
        let is_length = |length: &f64| *length > 0.0;
        if !(z > 0.0 && lengths.iter().all(is_length) && angles.iter().all(is_angle)) {
            return None;
        }
        Self::new([
            DVec3::new(a, 0.0, 0.0),
            b * DVec3::new(cosine(gamma), sine(gamma), 0.0),
            c * DVec3::new(x, y, z.sqrt()),
        ])
    }

    /// The region between the faces across which it repeats, in the same coordinates.
    ///
    /// # Errors
    /// When the edges are too long or too short for f32.
    pub fn region(&self) -> Result<Clip, ClipError> {
        let [a, b, c] = self.edges;
        let mut region = Clip::default();
        for (axis, normal) in [b.cross(c), c.cross(a), a.cross(b)].into_iter().enumerate() {
            if !self.periodic[axis] {
                continue;
            }
            // Outwards at the far face, whichever hand the edges have; what is rounded is the normal
            // alone, and each face goes through its corner.
            let outward = normal.normalize() * normal.dot(self.edges[axis]).signum();
            let rounded = outward.as_vec3();
            let height = |corner: DVec3| rounded.as_dvec3().dot(corner);
            let far = height(self.origin + self.edges[axis]);
            region = region.and_plane(rounded, far)?.and_plane(-rounded, -height(self.origin))?;
        }
        Ok(region)
    }

    /// The same in another unit of length.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        let edges = self.edges.map(|edge| factor * edge);
        Self { origin: factor * self.origin, edges, ..self }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::Ray;

    use super::*;

    #[test]
    fn lengths_and_angles_make_edges() {
        let cube = Cell::of_lengths_and_angles([2.0, 3.0, 4.0], [90.0; 3]).expect("a cell");
        let [a, b, c] = cube.edges;
        assert_eq!((a, b, c), (2.0 * DVec3::X, 3.0 * DVec3::Y, 4.0 * DVec3::Z));
        let hexagonal = Cell::of_lengths_and_angles([1.0; 3], [90.0, 90.0, 120.0]).expect("a cell");
        assert!((hexagonal.edges[1] - DVec3::new(-0.5, 0.75_f64.sqrt(), 0.0)).length() < 1e-15);
        let region = cube.region().expect("a region");
        let x = Ray::new(Vec3::new(-1.0, 1.0, 1.0), Vec3::X);
        assert_eq!((region.section(&x).ray.t_min, region.section(&x).ray.t_max), (1.0, 3.0));
        let open = Cell { periodic: [false; 3], ..cube };
        assert!(open.region().expect("a region").is_all());
        for (lengths, angles) in [
            ([0.0, 1.0, 1.0], [90.0; 3]),
            ([1.0; 3], [60.0, 60.0, 150.0]),
            ([f64::NAN, 1.0, 1.0], [90.0; 3]),
            ([1.0; 3], [90.0, 90.0, 0.0]),
            ([1.0; 3], [90.0, 200.0, 90.0]),
        ] {
            assert_eq!(Cell::of_lengths_and_angles(lengths, angles), None);
        }
    }
}
