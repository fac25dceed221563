//! Particles of more than one periodic cell.

use glam::{DMat3, DVec3, I64Vec3};

use crate::balls::Radii;
use crate::cell::Cell;
use crate::error::Flaw;
use crate::notes::counted;
use crate::options::ReadOptions;
use crate::particles::{Particles, Sizes};

/// The particles of as many cells as are asked for, one cell now; wrapped into it where it is to go on
/// across its faces.
pub(crate) fn repeated(particles: Particles, options: &ReadOptions) -> Result<Particles, Flaw> {
    if options.repeat.is_none() && !options.periodic {
        return Ok(particles);
    }
    let cell = particles.cell.ok_or_else(|| {
        Flaw::needed("a periodic cell to repeat", "none in the file")
            .or("an extended XYZ file says it by Lattice, a PDB file by CRYST1")
    })?;
    let mut particles = match options.repeat {
        Some(times) => several(particles, &cell, times)?,
        None => particles,
    };
    if options.periodic {
        wrap(&mut particles);
        particles.is_periodic = true;
        if let Some(cell) = &particles.cell {
            let edges = cell.periodic.iter().filter(|periodic| **periodic).count();
            particles.notes.changed(format!(
                "wrapped into the periodic cell, and goes on across the faces of {} of it",
                counted(edges, "edge")
            ));
        }
    }
    Ok(particles)
}

/// So many copies along each edge.
fn several(particles: Particles, cell: &Cell, times: [u32; 3]) -> Result<Particles, Flaw> {
    let [a, b, c] = times.map(|times| times as usize);
    let copies = a.checked_mul(b).and_then(|ab| ab.checked_mul(c));
    let count = copies.and_then(|copies| copies.checked_mul(particles.len()));
    if count.is_none_or(|count| count > u32::MAX as usize) {
        let needed = format!("at most {} particles in all cells", u32::MAX);
        return Err(Flaw::needed(&needed, format_args!("{} in {a} × {b} × {c}", particles.len())));
    }
    let [along_a, along_b, along_c] = cell.edges;
    let shift = |copy: usize| {
        let (i, j, k) = (copy % a, copy / a % b, copy / (a * b));
        i as f64 * along_a + j as f64 * along_b + k as f64 * along_c
    };
    let copies = a * b * c;
    let all = 0..particles.len();
    let indices: Vec<usize> = (0..copies).flat_map(|_| all.clone()).collect();
    let positions = (0..copies)
        .flat_map(|copy| particles.positions.iter().map(move |position| position + shift(copy)))
        .collect();
    let mut repeated = particles.at(&indices);
    repeated.positions = positions;
    repeated.cell =
        Some(Cell { edges: [a as f64 * along_a, b as f64 * along_b, c as f64 * along_c], ..*cell });
    repeated.notes.changed(format!("drawn {a} × {b} × {c} times"));
    Ok(repeated)
}

/// Into the cell along its periodic edges.
fn wrap(particles: &mut Particles) {
    let Some(cell) = particles.cell else { return };
    let edges = DMat3::from_cols(cell.edges[0], cell.edges[1], cell.edges[2]);
    let inverse = edges.inverse();
    for position in &mut particles.positions {
        let parts = inverse * (*position - cell.origin);
        let mut whole = parts.floor();
        for axis in 0..3 {
            if !cell.periodic[axis] {
                whole[axis] = 0.0;
            }
        }
        // What is in the cell stays as the file says it.
        if whole != DVec3::ZERO {
            *position -= edges * whole;
        }
    }
}

/// The images, in neighbouring cells, of particles in this one whose supports reach into it: each with
/// the index of its particle.
pub(crate) fn images(positions: &[DVec3], radii: &Radii<'_>, cell: &Cell) -> Vec<(usize, DVec3)> {
    let edges = DMat3::from_cols(cell.edges[0], cell.edges[1], cell.edges[2]);
    let inverse = edges.inverse();
    // The distances between opposite faces are 1 over the lengths of the inverse's rows.
    let rows = inverse.transpose();
    let lengths = DVec3::new(rows.x_axis.length(), rows.y_axis.length(), rows.z_axis.length());
    let mut images = Vec::new();
    for (index, position) in positions.iter().enumerate() {
        let parts = inverse * (position - cell.origin);
        // A little more than R, so that no rounding leaves out what touches a face.
        let reach = 1.000_001 * f64::from(radii.get(index)) * lengths;
        let mut from = (-parts - reach).ceil().as_i64vec3();
        let mut to = (1.0 - parts + reach).floor().as_i64vec3();
        for axis in 0..3 {
            if !cell.periodic[axis] {
                (from[axis], to[axis]) = (0, 0);
            }
        }
        for i in from.x..=to.x {
            for j in from.y..=to.y {
                for k in from.z..=to.z {
                    let shift = I64Vec3::new(i, j, k);
                    if shift != I64Vec3::ZERO {
                        images.push((index, position + edges * shift.as_dvec3()));
                    }
                }
            }
        }
    }
    images
}

impl Particles {
    /// The particles at these indices, in that order, perhaps some several times.
    fn at(self, indices: &[usize]) -> Self {
        let floats = |values: &Vec<f32>| indices.iter().map(|index| values[*index]).collect();
        let sizes = match &self.sizes {
            Sizes::Support(radii) => Sizes::Support(floats(radii)),
            Sizes::Shown(radii) => Sizes::Shown(floats(radii)),
            Sizes::Smoothing(lengths) => Sizes::Smoothing(floats(lengths)),
            Sizes::Spacing(radius) => Sizes::Spacing(*radius),
        };
        Self {
            positions: indices.iter().map(|index| self.positions[*index]).collect(),
            sizes,
            strengths: self.strengths.as_ref().map(floats),
            colors: self.colors.as_ref().map(|all| indices.iter().map(|i| all[*i]).collect()),
            columns: self.columns.iter().map(|column| column.at(indices)).collect(),
            lines: self.lines.at(indices),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use metaball_core::Kernel;
    use proptest::prelude::*;

    use super::*;
    use crate::options::ReadOptions;
    use crate::read::parse;

    fn read(text: &str, options: &ReadOptions) -> Particles {
        parse("a.xyz", text.as_bytes(), options).expect("legal")
    }

    const CELL: &str = "2\nLattice=\"4 0 0 1 4 0 0 0 5\" Properties=pos:R:3:support_radius:R:1\n\
                        0.5 0.5 0.5 1\n9 2 2 1.5\n";

    #[test]
    fn cells_are_repeated() {
        let options = ReadOptions { repeat: Some([2, 1, 2]), ..ReadOptions::default() };
        let particles = read(CELL, &options);
        assert_eq!(particles.len(), 8);
        assert_eq!(particles.positions[2], DVec3::new(4.5, 0.5, 0.5));
        assert_eq!(particles.positions[4], DVec3::new(0.5, 0.5, 5.5));
        let cell = particles.cell.expect("a lattice");
        assert_eq!((cell.edges[0].x, cell.edges[1].y, cell.edges[2].z), (8.0, 4.0, 10.0));
        let none = parse("a.xyz", b"1\n\nH 0 0 0\n", &options).expect_err("refused").to_string();
        assert!(none.contains("needed a periodic cell to repeat, found none"), "{none}");
    }

    #[test]
    fn particles_are_wrapped_into_the_cell() {
        let options = ReadOptions { periodic: true, ..ReadOptions::default() };
        let particles = read(CELL, &options);
        assert_eq!(particles.positions, [DVec3::splat(0.5), DVec3::new(1.0, 2.0, 2.0)]);
    }

    /// Sum of the quartic of all balls at a point.
    fn field(scene: &metaball_core::Scene, point: DVec3) -> f64 {
        let share = |ball: metaball_core::Metaball| {
            let squared = (point - ball.center.as_dvec3()).length_squared();
            (1.0 - squared / f64::from(ball.radius).powi(2)).max(0.0).powi(2)
        };
        scene.balls().map(share).sum()
    }

    proptest! {
        /// With its images a cell has the field of the infinite lattice, here of 7³ cells.
        #[test]
        fn the_field_goes_on_across_faces(
            parts in prop::collection::vec(prop::array::uniform3(0.0f64..1.0), 1..5),
            at in prop::array::uniform3(0.0f64..1.0),
            radius in 0.2f64..8.0,
        ) {
            let cell = Cell::new([DVec3::new(4.0, 0.0, 0.0), DVec3::new(1.0, 4.0, 0.0), DVec3::new(-1.0, 0.5, 5.0)])
                .expect("a cell");
            let place = |parts: &[f64; 3]| -> DVec3 {
                (0..3).map(|axis| parts[axis] * cell.edges[axis]).sum()
            };
            let particles = Particles {
                positions: parts.iter().map(place).collect(),
                sizes: Sizes::Spacing(radius as f32),
                cell: Some(cell),
                ..Particles::default()
            };
            let scene = |particles: Particles| {
                particles.into_scene(Kernel::QUARTIC, 0.25).expect("legal")
            };
            let periodic = scene(Particles { is_periodic: true, ..particles.clone() });
            let mut all = several(particles.clone(), &cell, [7; 3]).expect("few");
            all.positions.iter_mut().for_each(|p| *p -= 3.0 * (cell.edges[0] + cell.edges[1] + cell.edges[2]));
            let point = place(&at);
            let expected = field(&scene(all), point);
            // Centres are rounded to f32, twice 6e-8 of up to 28, over radii of at least 0.2.
            prop_assert!((field(&periodic, point) - expected).abs() < 1e-3 * (1.0 + expected));
            // The canary: without images the field near a face is another.
            if radius > 4.0 {
                prop_assert!(field(&scene(particles), point) < expected - 1e-3);
            }
        }
    }
}
