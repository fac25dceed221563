//! Tables of particles: CSV with a header line.
//!
//! Columns, in any order: `x,y,z,radius`, optionally `strength`, and optionally `red,green,blue`, all
//! three or none, sRGB-encoded from 0 to 1. `radius` is the support radius R.

use glam::Vec3;
use metaball_core::{Color, Metaball};

use crate::error::Flaw;
use crate::particles::Particles;

const COLUMNS: [&str; 8] = ["x", "y", "z", "radius", "strength", "red", "green", "blue"];

/// Reads a table.
pub(super) fn parse(bytes: &[u8]) -> Result<Particles, Flaw> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let header = Header::new(reader.headers().map_err(|error| flaw_of(&error, bytes))?)?;
    let mut particles = Particles::default();
    let mut colors = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| flaw_of(&error, bytes))?;
        let line = record.position().map_or(1, |position| line_of(position, bytes));
        let row = Row { header: &header, record: &record, line };
        let center = Vec3::new(row.number("x")?, row.number("y")?, row.number("z")?);
        let strength = if header.has("strength") { row.number("strength")? } else { 1.0 };
        particles.balls.push(Metaball { center, radius: row.number("radius")?, strength });
        particles.lines.push(line);
        if header.has("red") {
            let [red, green, blue] = [row.color("red")?, row.color("green")?, row.color("blue")?];
            colors.push(Color::srgb(red, green, blue));
        }
    }
    particles.colors = header.has("red").then_some(colors);
    Ok(particles)
}

/// The index of each column of [`COLUMNS`] in the file.
struct Header([Option<usize>; 8]);

impl Header {
    fn new(names: &csv::StringRecord) -> Result<Self, Flaw> {
        let mut header = Self([None; 8]);
        for (index, name) in names.iter().enumerate() {
            let flaw = |problem: String| Flaw::new(problem).at_line(1).at_column(index + 1);
            let known = COLUMNS.iter().position(|known| name.eq_ignore_ascii_case(known));
            let Some(known) = known else {
                return Err(flaw(format!("needed one of {}, found {name:?}", COLUMNS.join(", "))));
            };
            if header.0[known].replace(index).is_some() {
                return Err(flaw(format!("needed each column once, found {name:?} again")));
            }
        }
        let colored = COLUMNS[5..].iter().any(|name| header.has(name));
        let needed = COLUMNS[..4].iter().chain(if colored { &COLUMNS[5..] } else { &[] });
        for name in needed {
            if !header.has(name) {
                let found = names.iter().collect::<Vec<_>>().join(",");
                let needed = format!("a column {name:?} in the header");
                return Err(Flaw::needed(&needed, format_args!("{found:?}")).at_line(1));
            }
        }
        Ok(header)
    }

    fn index(&self, name: &str) -> Option<usize> {
        let known = COLUMNS.iter().position(|known| *known == name)?;
        self.0[known]
    }

    fn has(&self, name: &str) -> bool {
        self.index(name).is_some()
    }
}

struct Row<'a> {
    header: &'a Header,
    record: &'a csv::StringRecord,
    line: usize,
}

impl Row<'_> {
    fn number(&self, name: &str) -> Result<f32, Flaw> {
        let index = self.header.index(name).unwrap_or(usize::MAX);
        let field = self.record.get(index).unwrap_or_default();
        field
            .parse()
            .ok()
            .filter(|number: &f32| number.is_finite())
            .ok_or_else(|| self.flaw(name, "a finite number", field))
    }

    /// A channel as eight bits.
    fn color(&self, name: &str) -> Result<u8, Flaw> {
        let value = self.number(name)?;
        if (0.0..=1.0).contains(&value) {
            Ok((255.0 * value).round() as u8)
        } else {
            Err(self.flaw(name, "a colour channel from 0 to 1", &value.to_string()))
        }
    }

    fn flaw(&self, name: &str, needed: &str, found: &str) -> Flaw {
        let column = self.header.index(name).map_or(0, |index| index + 1);
        Flaw::needed(needed, format_args!("{found:?}"))
            .at_line(self.line)
            .at_column(column)
            .at_key(name)
    }
}

fn flaw_of(error: &csv::Error, bytes: &[u8]) -> Flaw {
    let flaw = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Flaw::needed(&format!("{expected_len} fields as in the header"), len)
        }
        csv::ErrorKind::Utf8 { err, .. } => {
            Flaw::needed("UTF-8 text", "other bytes").at_column(err.field() + 1)
        }
        _ => Flaw::new(error.to_string()),
    };
    match error.position() {
        Some(position) => flaw.at_line(line_of(position, bytes)),
        None => flaw,
    }
}

/// The line of a record, counted from 1. The reader's own position is where the last record ended:
/// empty lines between them are still to be counted.
fn line_of(position: &csv::Position, bytes: &[u8]) -> usize {
    let rest = bytes.get(position.byte() as usize..).unwrap_or_default();
    let skipped = rest.iter().take_while(|byte| matches!(byte, b'\r' | b'\n'));
    position.line() as usize + skipped.filter(|byte| **byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn refusal(text: &str) -> String {
        parse(text.as_bytes()).expect_err("refused").in_file("balls.csv").to_string()
    }

    #[test]
    fn columns_come_in_any_order() {
        let text = "blue, radius,x,y,z,green,red,Strength\n1, 2,3,4,5,0.5,0,6\n";
        let particles = parse(text.as_bytes()).expect("legal");
        let ball = Metaball { center: Vec3::new(3.0, 4.0, 5.0), radius: 2.0, strength: 6.0 };
        assert_eq!(particles.balls, [ball]);
        assert_eq!(particles.colors, Some(vec![Color::srgb(0, 128, 255)]));
        assert_eq!(particles.lines, [2]);
    }

    #[test]
    fn no_rows_are_no_balls() {
        assert_eq!(parse(b"x,y,z,radius\n").expect("legal"), Particles::default());
    }

    #[test]
    fn refusals_name_line_and_column() {
        assert_eq!(
            refusal("x,y,z,radius\n1,2,3,4\n1,2,3,four\n"),
            "balls.csv, line 3, column 4 (radius): needed a finite number, found \"four\""
        );
        assert_eq!(
            refusal("x,y,z,radius,mass\n"),
            "balls.csv, line 1, column 5: needed one of x, y, z, radius, strength, red, green, \
             blue, found \"mass\""
        );
        assert_eq!(
            refusal("x,y,radius\n"),
            "balls.csv, line 1: needed a column \"z\" in the header, found \"x,y,radius\""
        );
        assert_eq!(
            refusal("x,y,z,radius\n\n1,2,3\n"),
            "balls.csv, line 3: needed 4 fields as in the header, found 3"
        );
        assert!(refusal("x,y,z,radius,red\n").contains("needed a column \"green\""));
        assert!(refusal("x,x\n").ends_with("needed each column once, found \"x\" again"));
        assert!(refusal("x,y,z,radius,red,green,blue\n0,0,0,1,255,0,0\n").ends_with(
            "line 2, column 5 (red): needed a colour channel from 0 to 1, found \"255\""
        ));
        assert!(refusal("").contains("needed a column \"x\""));
        assert!(refusal("x,y,z,radius\n1,1,1,nan\n").contains("found \"nan\""));
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in any::<Vec<u8>>()) {
            let _ = parse(&bytes);
        }

        #[test]
        fn no_rows_panic(rows in "x,y,z,radius(,strength)?(,red,green,blue)?\n([-0-9.e,\"\n]{0,40})") {
            let _ = parse(rows.as_bytes());
        }

        /// What a table says is what is read: f32 numbers print so that they read back exactly.
        #[test]
        fn tables_read_back(balls in prop::collection::vec(prop::array::uniform4(-1e6f32..1e6), 0..20)) {
            let rows: Vec<String> =
                balls.iter().map(|[x, y, z, radius]| format!("{radius},{x},{y},{z}\n")).collect();
            let particles = parse(format!("radius,x,y,z\n{}", rows.concat()).as_bytes());
            let expected: Vec<_> = balls
                .iter()
                .map(|&[x, y, z, radius]| Metaball::new(Vec3::new(x, y, z), radius))
                .collect();
            prop_assert_eq!(particles.expect("legal").balls, expected);
        }
    }
}
