//! XYZ and extended XYZ: a count, a comment, and one line for each particle.
//!
//! Plain lines are `species x y z`; a `Properties=` entry in the comment moves the columns and may
//! add `radius`, the support radius R. Only the first frame is read; further columns are ignored.
//! Without radii, species that are all chemical elements (symbols or atomic numbers) make a molecule.
//! Any other particles get twice the median distance between nearest neighbours as R. So do elements
//! that lie nearer together than any atoms do: a fluid of particles called W is no tungsten.

use glam::Vec3;
use metaball_core::Metaball;
use pdbtbx::Element;

use crate::elements::van_der_waals_radius;
use crate::error::Flaw;
use crate::molecule::{Atom, particles_of};
use crate::particles::Particles;
use crate::spacing::median_spacing;
use crate::text::text;

/// Reads the first frame.
pub(super) fn parse(bytes: &[u8]) -> Result<Particles, Flaw> {
    let mut lines = text(bytes)?.lines().enumerate().map(|(index, line)| (index + 1, line));
    let (_, first) = lines.next().unwrap_or((1, ""));
    let count: usize = first.trim().parse().map_err(|_| {
        Flaw::needed("the number of particles", format_args!("{first:?}")).at_line(1)
    })?;
    let columns = Columns::new(lines.next().map_or("", |(_, comment)| comment))
        .map_err(|flaw| flaw.at_line(2))?;

    let mut rows = Vec::new();
    for (line, text) in lines.take(count) {
        rows.push(columns.row(text).map_err(|flaw| flaw.at_line(line))?);
    }
    if rows.len() < count {
        let found = format!("the end of the file after {}", rows.len());
        return Err(Flaw::needed(&format!("{count} particles"), found).at_line(rows.len() + 3));
    }
    let particles = particles(&rows);
    Ok(Particles { lines: (3..count + 3).collect(), ..particles })
}

struct Row {
    element: Option<Element>,
    center: Vec3,
    radius: Option<f32>,
}

fn particles(rows: &[Row]) -> Particles {
    let balls = |radius: &dyn Fn(&Row) -> f32| Particles {
        balls: rows.iter().map(|row| Metaball::new(row.center, radius(row))).collect(),
        ..Particles::default()
    };
    if rows.iter().all(|row| row.radius.is_some()) {
        return balls(&|row| row.radius.unwrap_or_default());
    }
    let centers: Vec<Vec3> = rows.iter().map(|row| row.center).collect();
    let spacing = median_spacing(&centers);
    let atoms: Option<Vec<Atom>> =
        rows.iter().map(|row| Some(Atom { element: row.element?, center: row.center })).collect();
    match (atoms, spacing) {
        (Some(atoms), spacing) if spacing.is_none_or(|spacing| are_apart(&atoms, spacing)) => {
            particles_of(&atoms)
        }
        (_, spacing) => {
            let radius = spacing.map_or(1.0, |spacing| 2.0 * spacing);
            Particles { spacing_radius: Some(radius), ..balls(&|_| radius) }
        }
    }
}

/// Whether particles so far apart can be atoms: the shortest bonds (H–H, C≡O) have 0.6 of the van der
/// Waals radii of their atoms.
fn are_apart(atoms: &[Atom], spacing: f32) -> bool {
    let sum: f32 = atoms.iter().map(|atom| van_der_waals_radius(atom.element)).sum();
    spacing > 0.4 * sum / atoms.len() as f32
}

/// Columns counted from 0.
struct Columns {
    species: Option<usize>,
    position: usize,
    radius: Option<usize>,
}

impl Columns {
    /// From the comment line: `Properties=name:type:count:…`, perhaps in quotes.
    fn new(comment: &str) -> Result<Self, Flaw> {
        let Some((_, properties)) = comment.split_once("Properties=") else {
            return Ok(Self { species: Some(0), position: 1, radius: None });
        };
        let properties = properties.trim_start_matches('"');
        let properties = properties.split(['"', ' ', '\t']).next().unwrap_or_default();
        let (mut species, mut position, mut radius) = (None, None, None);
        let mut next = 0_usize;
        for property in properties.split(':').collect::<Vec<_>>().chunks(3) {
            let flaw =
                || Flaw::needed("Properties=name:type:count:…", format_args!("{properties:?}"));
            let &[name, kind, count] = property else { return Err(flaw()) };
            let count: usize = count.parse().map_err(|_| flaw())?;
            match (name.to_ascii_lowercase().as_str(), kind, count) {
                ("species" | "z", "S" | "I", 1) => species = Some(next),
                ("pos", "R", 3) => position = Some(next),
                ("radius", "R", 1) => radius = Some(next),
                _ => {}
            }
            next = next.checked_add(count).ok_or_else(flaw)?;
        }
        let position = position.ok_or_else(|| {
            Flaw::needed("pos:R:3 among the Properties", format_args!("{properties:?}"))
        })?;
        Ok(Self { species, position, radius })
    }

    fn row(&self, line: &str) -> Result<Row, Flaw> {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let number = |column: usize, name: &str| {
            let field = fields.get(column).copied().unwrap_or_default();
            field.parse().ok().filter(|number: &f32| number.is_finite()).ok_or_else(|| {
                Flaw::needed("a finite number", format_args!("{field:?}"))
                    .at_column(column + 1)
                    .at_key(name)
            })
        };
        let center = Vec3::new(
            number(self.position, "x")?,
            number(self.position + 1, "y")?,
            number(self.position + 2, "z")?,
        );
        let radius = self.radius.map(|column| number(column, "radius")).transpose()?;
        let species = self.species.and_then(|column| fields.get(column).copied());
        Ok(Row { element: species.and_then(element), center, radius })
    }
}

/// The element of a symbol or an atomic number.
fn element(species: &str) -> Option<Element> {
    match species.parse() {
        Ok(number) => Element::new(number),
        Err(_) => Element::from_symbol(species),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::SUPPORT_OVER_VAN_DER_WAALS;

    fn refusal(text: &str) -> String {
        parse(text.as_bytes()).expect_err("refused").in_file("balls.xyz").to_string()
    }

    #[test]
    fn elements_make_a_molecule() {
        let water = "3\nwater\nO 0 0 0\nH 0.96 0 0\n1 -0.24 0.93 0\n";
        let particles = parse(water.as_bytes()).expect("legal");
        // Alvarez: 1.50 Å for oxygen, 1.20 Å for hydrogen.
        let radii: Vec<f32> = particles.balls.iter().map(|ball| ball.radius).collect();
        let expected = [1.5, 1.2, 1.2].map(|radius| radius * SUPPORT_OVER_VAN_DER_WAALS);
        assert_eq!(radii, expected);
        assert_eq!(particles.colors.map(|colors| colors.len()), Some(3));
        assert_eq!(particles.lines, [3, 4, 5]);
    }

    #[test]
    fn particles_that_are_no_atoms_take_their_spacing() {
        for text in ["2\n\nbead 0 0 0\nbead 3 0 0\n", "2\n\nW 0 0 0\nW 0.1 0 0\n"] {
            let particles = parse(text.as_bytes()).expect("legal");
            assert_eq!(particles.balls[0].radius, 2.0 * particles.balls[1].center.x);
            assert_eq!(particles.colors, None);
        }
        assert_eq!(parse(b"1\n\nbead 0 0 0\n").expect("legal").balls[0].radius, 1.0);
    }

    #[test]
    fn properties_say_which_columns() {
        let text =
            "1\nLattice=\"1 0 0\" Properties=id:I:1:pos:R:3:Radius:R:1 time=0\n7 1 2 3 0.5 9\n";
        let particles = parse(text.as_bytes()).expect("legal");
        assert_eq!(particles.balls, [Metaball::new(Vec3::new(1.0, 2.0, 3.0), 0.5)]);
    }

    #[test]
    fn only_the_first_frame_is_read() {
        let particles = parse(b"1\n\nH 0 0 0\n1\n\nnonsense\n").expect("legal");
        assert_eq!(particles.balls.len(), 1);
    }

    #[test]
    fn refusals_name_line_and_column() {
        assert_eq!(
            refusal("one\n"),
            "balls.xyz, line 1: needed the number of particles, found \"one\""
        );
        assert_eq!(
            refusal("1\n\nH 0 zero 0\n"),
            "balls.xyz, line 3, column 3 (y): needed a finite number, found \"zero\""
        );
        assert_eq!(
            refusal("2\n\nH 0 0 0\n"),
            "balls.xyz, line 4: needed 2 particles, found the end of the file after 1"
        );
        assert_eq!(
            refusal("1\nProperties=species:S:1\nH\n"),
            "balls.xyz, line 2: needed pos:R:3 among the Properties, found \"species:S:1\""
        );
        assert!(refusal("1\nProperties=pos:R\n").contains("needed Properties=name:type:count"));
        assert!(refusal("").contains("needed the number of particles"));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = parse(&bytes);
        }

        #[test]
        fn no_text_panics(text in any::<String>()) {
            let _ = parse(text.as_bytes());
        }

        #[test]
        fn no_frame_panics(text in "[0-3]\n(Properties=[a-z]*:[SR]:[0-9]{1,20})?[:a-zR0-9]{0,12}\n([CHW] [-0-9.e ]{0,20}\n){0,4}") {
            let _ = parse(text.as_bytes());
        }
    }
}
