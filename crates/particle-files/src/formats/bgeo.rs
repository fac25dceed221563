//! BGEO of Houdini before version 12, as Partio and SPlisHSPlasH write it: points and their attributes,
//! the most significant byte of numbers first.

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::table::{Table, Values, Words, component};
use crate::text::word;

pub(super) const READER: Reader = Reader {
    name: "BGEO",
    endings: &["bgeo"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(MAGIC) || is_newer(bytes),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

const MAGIC: &[u8] = b"BgeoV";

/// Bytes of x, y, z and w.
const POSITION: usize = 16;

/// Whether it is of Houdini 12 and later, which writes another format: JSON as text or as bytes.
fn is_newer(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(64)];
    start.starts_with(b"\x7fNSJb")
        || start.starts_with(b"[") && word(start).contains("\"fileversion\"")
}

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    if is_newer(bytes) {
        let flaw = Flaw::needed("BGEO of version 5", "that of Houdini 12 and later, which is JSON");
        return Err(flaw.or("write .bgeo with Partio, or convert the points to .ply or .csv"));
    }
    let mut cursor = Cursor::new(bytes, MAGIC.len(), ByteOrder::Big);
    let version = cursor.i32("the version")?;
    if version != 5 {
        return Err(Flaw::needed("version 5 of BGEO", version).at_byte(MAGIC.len()));
    }
    let points = cursor.count("the number of points")?;
    // Primitives, groups of points, groups of primitives.
    cursor.take(12, "the header")?;
    let count = cursor.count("the number of attributes of points")?;
    // Attributes of vertices, of primitives, and of all.
    cursor.take(12, "the header")?;
    let mut attributes = Vec::new();
    for _ in 0..count {
        attributes.push(Attribute::of(&mut cursor)?);
    }
    let size =
        attributes.iter().fold(POSITION, |size, attribute| size.saturating_add(4 * attribute.size));
    let at = cursor.at();
    let bytes = cursor.take_all(points, size, &counted(points, "point"))?;
    let numbers = |offset: usize, kind| {
        let bytes = bytes.get(offset..).unwrap_or_default();
        Numbers::new(bytes, kind, ByteOrder::Big, size, points)
    };
    let [Some(x), Some(y), Some(z), Some(w)] = [0, 4, 8, 12].map(|at| numbers(at, NumberType::F32))
    else {
        return Ok(Table::default());
    };
    let positions = binary::positions([x, y, z]).map_err(|flaw| flaw.at_byte(at))?;
    let weighted = (0..points).filter(|index| w.get(*index) != 1.0).count();
    if weighted > 0 {
        notes.left_out(format!("weights w other than 1 of {}", counted(weighted, "point")));
    }
    let mut table = Table { positions, ..Table::default() };
    let mut offset = POSITION;
    for attribute in attributes {
        for index in 0..attribute.size.min(Attribute::COMPONENTS) {
            let name = component(&attribute.name, index, attribute.size);
            if let Some(numbers) = numbers(offset + 4 * index, attribute.kind)
                && request.wanted.wants(&name)
            {
                table.add(name, attribute.values(numbers.to_vec()));
            }
        }
        offset += 4 * attribute.size;
    }
    Ok(table)
}

/// What every point has.
struct Attribute {
    name: String,
    /// How many numbers of 4 bytes.
    size: usize,
    kind: NumberType,
    /// The texts that its numbers stand for.
    texts: Option<Vec<String>>,
}

impl Attribute {
    /// More components than these become no columns.
    const COMPONENTS: usize = 16;

    fn of(cursor: &mut Cursor<'_>) -> Result<Self, Flaw> {
        let name = text(cursor)?;
        let at = cursor.at();
        let size = cursor.number(NumberType::U16, "the size of an attribute")? as usize;
        let kind = cursor.i32("the type of an attribute")?;
        let (number, texts) = match kind {
            // Floats and vectors, integers: with as many defaults.
            0 | 5 => (NumberType::F32, None),
            1 => (NumberType::I32, None),
            4 => {
                let mut texts = Vec::new();
                for _ in 0..cursor.count("the number of texts")? {
                    texts.push(text(cursor)?);
                }
                (NumberType::I32, Some(texts))
            }
            _ => {
                let needed = format!("a type 0, 1, 4 or 5 of the attribute {name:?}");
                return Err(Flaw::needed(&needed, kind).at_byte(at));
            }
        };
        if texts.is_none() {
            cursor.take_all(size, 4, "the defaults of an attribute")?;
        }
        Ok(Self { name, size, kind: number, texts })
    }

    fn values(&self, numbers: Vec<f64>) -> Values {
        let Some(texts) = &self.texts else { return Values::Numbers(numbers) };
        // Numbers without a text are written for none.
        let text = |number: &f64| texts.get(*number as usize).filter(|_| *number >= 0.0);
        Values::Words(numbers.iter().map(|n| text(n).map_or("", String::as_str)).collect::<Words>())
    }
}

/// A text behind its length.
fn text(cursor: &mut Cursor<'_>) -> Result<String, Flaw> {
    let length = cursor.number(NumberType::U16, "the length of a name")? as usize;
    Ok(word(cursor.take(length, "a name")?).into_owned())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    /// Two points with a radius, a velocity, an integer and a text.
    fn file(points: i32, weight: f32) -> Vec<u8> {
        let name = |name: &str| [&(name.len() as u16).to_be_bytes(), name.as_bytes()].concat();
        let int = |number: i32| number.to_be_bytes().to_vec();
        let head = |of: &str, size: u16, kind: i32| {
            [name(of), size.to_be_bytes().to_vec(), int(kind)].concat()
        };
        let floats = |numbers: &[f32]| -> Vec<u8> {
            numbers.iter().flat_map(|number| number.to_be_bytes()).collect()
        };
        [
            MAGIC.to_vec(),
            [5, points, 0, 0, 0, 4, 0, 0, 0].map(int).concat(),
            [head("pscale", 1, 0), floats(&[1.0])].concat(),
            [head("v", 3, 5), floats(&[0.0; 3])].concat(),
            [head("id", 1, 1), int(-1)].concat(),
            [head("kind", 1, 4), int(2), name("fluid"), name("wall")].concat(),
            [floats(&[1.0, 2.0, 3.0, 1.0, 0.5, 7.0, 8.0, 9.0]), int(11), int(1)].concat(),
            [floats(&[4.0, 5.0, 6.0, weight, 0.25, 0.0, 0.0, 0.0]), int(-12), int(-1)].concat(),
            vec![0, 255],
        ]
        .concat()
    }

    fn read(bytes: &[u8]) -> Result<(Table, Notes), Flaw> {
        let mut notes = Notes::default();
        let table = table(bytes, &Span::whole(bytes), &Request::default(), &mut notes)?;
        Ok((table, notes))
    }

    #[test]
    fn attributes_are_columns() {
        let (table, notes) = read(&file(2, 1.0)).expect("legal");
        assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]);
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["pscale", "v:0", "v:1", "v:2", "id", "kind"]);
        assert_eq!(table.columns[2].values, Values::Numbers(vec![8.0, 0.0]));
        assert_eq!(table.columns[4].values, Values::Numbers(vec![11.0, -12.0]));
        assert_eq!(table.columns[5].values, Values::Words(["wall", ""].into_iter().collect()));
        assert!(notes.is_empty());
        assert!(!read(&file(2, 0.5)).expect("legal").1.is_empty());
    }

    #[test]
    fn refusals_say_what_was_needed() {
        let problem = |bytes: &[u8]| read(bytes).expect_err("refused").problem;
        assert_eq!(
            problem(&file(3, 1.0)),
            "needed 120 bytes of 3 points, found the end of the file after 82"
        );
        assert!(problem(&file(i32::MAX, 1.0)).contains("2147483647 points, found the end"));
        assert!(problem(&file(-1, 1.0)).contains("the number of points, from 0 on, found -1"));
        for newer in [&b"\x7fNSJb\0\0"[..], b"[\n\t\"fileversion\",\"18.0\""] {
            assert!((READER.recognizes)(newer));
            assert!(problem(newer).contains("Houdini 12"));
        }
        let mut other = file(2, 1.0);
        other[8] = 4;
        assert_eq!(problem(&other), "needed version 5 of BGEO, found 4");
        assert!(problem(&other[..7]).contains("the version"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            let mut bytes = file(2, 1.0);
            let cut = cut.index(bytes.len());
            let at = at.index(bytes.len());
            bytes[at] = byte;
            let _ = (read(&bytes), read(&bytes[..cut]));
        }
    }
}
