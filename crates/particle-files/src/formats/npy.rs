//! NPY: an array of NumPy.
//!
//! An array of n rows of three numbers has positions, of four also radii; one of records has columns by
//! the names of their fields.

use glam::DVec3;

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, NumberType, Numbers};
use crate::error::Flaw;
use crate::notes::Notes;
use crate::roles::Role;
use crate::table::{Table, Values, Words, component};
use crate::text::word;

pub(super) const READER: Reader = Reader {
    name: "NPY",
    endings: &["npy"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(MAGIC),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

const MAGIC: &[u8] = b"\x93NUMPY";

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let array = Array::of(bytes)?;
    match (&array.kind, &array.shape[..]) {
        (Kind::Number(_), [_, 3]) => {
            array.positions().map(|positions| Table { positions, ..Table::default() })
        }
        (Kind::Number(_), [_, 4]) => {
            notes.guessed("rows of four numbers: taken as x, y, z, radius");
            let mut table = Table { positions: array.positions()?, ..Table::default() };
            table.add("radius", Values::Numbers(array.column(3)));
            Ok(table)
        }
        (Kind::Record(_), [_]) => array.table(request),
        _ => {
            let needed =
                "an array of shape (n, 3), of shape (n, 4), the last the radius, or of n records";
            let flaw = Flaw::needed(needed, array.described());
            Err(flaw
                .or("other columns go with positions in an NPZ file, each as an array of its name"))
        }
    }
}

/// An array.
pub(super) struct Array<'a> {
    kind: Kind,
    pub(super) shape: Vec<usize>,
    /// Whether neighbours in memory differ in their first index.
    is_fortran: bool,
    data: &'a [u8],
    /// Where the data begin.
    at: usize,
}

/// What an array has elements of.
#[derive(Debug, Clone, PartialEq)]
enum Kind {
    Number(Number),
    Record(Vec<Field>),
}

/// A number of a type, in a byte order.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Number {
    kind: NumberType,
    order: ByteOrder,
}

/// A field of a record.
#[derive(Debug, Clone, PartialEq)]
struct Field {
    name: String,
    kind: FieldKind,
    /// Bytes in every record.
    size: usize,
}

/// What a field has.
#[derive(Debug, Clone, Copy, PartialEq)]
enum FieldKind {
    /// So many numbers.
    Numbers(Number, usize),
    /// A text, of letters of 32 bits in this order or of one byte each.
    Text(Option<ByteOrder>),
    Other,
}

/// More numbers than these are a picture in each record, not columns.
const COMPONENTS: usize = 16;

impl<'a> Array<'a> {
    /// The array of a file.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, Flaw> {
        let cut = || Flaw::needed("an NPY header", "the end of the file").at_byte(bytes.len());
        let version = *bytes.get(6).ok_or_else(cut)?;
        let (length, start) = match (version, bytes.get(8..)) {
            (1, Some(&[a, b, ..])) => (usize::from(u16::from_le_bytes([a, b])), 10),
            (2 | 3, Some(&[a, b, c, d, ..])) => (u32::from_le_bytes([a, b, c, d]) as usize, 12),
            (1..=3, _) => return Err(cut()),
            _ => return Err(Flaw::needed("version 1, 2 or 3 of NPY", version).at_byte(6)),
        };
        let header = bytes.get(start..).and_then(|rest| rest.get(..length)).ok_or_else(cut)?;
        let at = start + length;
        let header = Literal::of(header).map_err(|flaw| flaw.at_byte(start))?;
        let entry = |key: &str| header.entry(key).map_err(|flaw| flaw.at_byte(start));
        let kind = Kind::of(entry("descr")?).map_err(|flaw| flaw.at_byte(start))?;
        let shape: Option<Vec<usize>> = entry("shape")?.items().map(Literal::count).collect();
        let shape =
            shape.ok_or_else(|| Flaw::needed("a shape of counts", "another").at_byte(start))?;
        let is_fortran = *entry("fortran_order")? == Literal::Name("True".to_owned());
        let array = Self { kind, shape, is_fortran, data: &bytes[at..], at };
        array.check()?;
        Ok(array)
    }

    /// Refuses data that are not as long as the shape says.
    fn check(&self) -> Result<(), Flaw> {
        let size = self.kind.size();
        let needed = self.shape.iter().try_fold(size, |size, count| size.checked_mul(*count));
        if needed == Some(self.data.len()) {
            return Ok(());
        }
        let needed = needed.map_or("far too many".to_owned(), |bytes| bytes.to_string());
        let needed = format!("{needed} bytes of {}", self.described());
        Err(Flaw::needed(&needed, self.data.len()).at_byte(self.at))
    }

    /// Its shape and what it has elements of.
    pub(super) fn described(&self) -> String {
        let shape: Vec<String> = self.shape.iter().map(usize::to_string).collect();
        let kind = match &self.kind {
            Kind::Number(number) => format!("{:?}", number.kind).to_lowercase(),
            Kind::Record(fields) => {
                let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
                format!("records of {}", names.join(", "))
            }
        };
        let comma = if shape.len() == 1 { "," } else { "" };
        format!("shape ({}{comma}) of {kind}", shape.join(", "))
    }

    /// How many numbers an element along the first axis has; `None` where these are no numbers in rows.
    pub(super) fn components(&self) -> Option<usize> {
        match (&self.kind, &self.shape[..]) {
            (Kind::Number(_), [_]) => Some(1),
            (Kind::Number(_), [_, components]) => Some(*components),
            _ => None,
        }
    }

    /// The numbers of a column of an array of numbers in rows.
    pub(super) fn numbers(&self, column: usize) -> Option<Numbers<'a>> {
        let Kind::Number(Number { kind, order }) = self.kind else { return None };
        let (rows, columns) = (*self.shape.first()?, self.components()?);
        let size = kind.size();
        let (offset, stride) = match self.is_fortran {
            true => (column.checked_mul(rows)?.checked_mul(size)?, size),
            false => (column * size, columns.checked_mul(size)?),
        };
        Numbers::new(self.data.get(offset..)?, kind, order, stride, rows)
    }

    /// A column of an array of numbers in rows.
    pub(super) fn column(&self, column: usize) -> Vec<f64> {
        self.numbers(column).map(Numbers::to_vec).unwrap_or_default()
    }

    /// The first three columns of an array of numbers in rows.
    pub(super) fn positions(&self) -> Result<Vec<DVec3>, Flaw> {
        match [0, 1, 2].map(|axis| self.numbers(axis)) {
            [Some(x), Some(y), Some(z)] => {
                binary::positions([x, y, z]).map_err(|flaw| flaw.at_byte(self.at))
            }
            _ => Ok(Vec::new()),
        }
    }

    /// Records with their fields as columns.
    fn table(&self, request: &Request) -> Result<Table, Flaw> {
        let Kind::Record(fields) = &self.kind else { return Ok(Table::default()) };
        let (size, count) = (self.kind.size(), self.shape.first().copied().unwrap_or(0));
        let mut columns = Vec::new();
        let mut offset = 0_usize;
        for field in fields {
            let bytes = self.data.get(offset..).unwrap_or_default();
            match field.kind {
                FieldKind::Numbers(Number { kind, order }, components) => {
                    for index in 0..components {
                        let bytes = bytes.get(index * kind.size()..).unwrap_or_default();
                        let numbers = Numbers::new(bytes, kind, order, size, count);
                        let name = component(&field.name, index, components);
                        columns.extend(numbers.map(|numbers| (name, Column::Numbers(numbers))));
                    }
                }
                FieldKind::Text(wide) if request.wanted.wants(&field.name) => {
                    let texts = bytes.chunks(size.max(1)).filter_map(|of| of.get(..field.size));
                    let mut words = Words::default();
                    texts.take(count).for_each(|text| words.push(&text_of(text, wide)));
                    columns.push((field.name.clone(), Column::Words(words)));
                }
                FieldKind::Text(_) | FieldKind::Other => {}
            }
            offset = offset.saturating_add(field.size);
        }
        let axis = |axis: usize| {
            columns.iter().find_map(|(name, column)| match column {
                Column::Numbers(numbers) if Role::of(name)?.axis()? == axis => Some(*numbers),
                _ => None,
            })
        };
        let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(axis) else {
            let needed = "records with fields x, y and z, or a field pos of three numbers";
            return Err(Flaw::needed(needed, self.described()));
        };
        let positions = binary::positions([x, y, z]).map_err(|flaw| flaw.at_byte(self.at))?;
        let mut table = Table { positions, ..Table::default() };
        for (name, column) in columns {
            let is_axis = Role::of(&name).and_then(Role::axis).is_some();
            if is_axis || !request.wanted.wants(&name) {
                continue;
            }
            match column {
                Column::Numbers(numbers) => table.add(name, Values::Numbers(numbers.to_vec())),
                Column::Words(words) => table.add(name, Values::Words(words)),
            }
        }
        Ok(table)
    }
}

/// A column of records.
enum Column<'a> {
    Numbers(Numbers<'a>),
    Words(Words),
}

/// A text that zeros fill up.
fn text_of(bytes: &[u8], wide: Option<ByteOrder>) -> String {
    let Some(order) = wide else {
        let end = memchr::memchr(0, bytes).unwrap_or(bytes.len());
        return word(&bytes[..end]).into_owned();
    };
    let letters = bytes.as_chunks::<4>().0.iter().map(|letter| match order {
        ByteOrder::Little => u32::from_le_bytes(*letter),
        ByteOrder::Big => u32::from_be_bytes(*letter),
    });
    let letters = letters.take_while(|letter| *letter != 0);
    letters.map(|letter| char::from_u32(letter).unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

impl Number {
    /// Of a description such as `<f8`.
    fn of(text: &str) -> Option<Self> {
        let (order, kind) = match text.split_at_checked(1)? {
            (">", kind) => (ByteOrder::Big, kind),
            ("<" | "|" | "=", kind) => (ByteOrder::Little, kind),
            _ => (ByteOrder::Little, text),
        };
        let kind = match kind {
            "i1" => NumberType::I8,
            "u1" | "b1" => NumberType::U8,
            "i2" => NumberType::I16,
            "u2" => NumberType::U16,
            "i4" => NumberType::I32,
            "u4" => NumberType::U32,
            "i8" => NumberType::I64,
            "u8" => NumberType::U64,
            "f4" => NumberType::F32,
            "f8" => NumberType::F64,
            _ => return None,
        };
        Some(Self { kind, order })
    }
}

impl Kind {
    fn of(literal: &Literal) -> Result<Self, Flaw> {
        match literal {
            Literal::Text(text) => match Number::of(text) {
                Some(number) => Ok(Self::Number(number)),
                None => {
                    let flaw = Flaw::needed("numbers such as <f4 or <f8", format_args!("{text:?}"));
                    Err(flaw.or("save positions.astype('<f8')"))
                }
            },
            _ => literal.items().map(Field::of).collect::<Result<_, _>>().map(Self::Record),
        }
    }

    /// Bytes of an element.
    fn size(&self) -> usize {
        match self {
            Self::Number(number) => number.kind.size(),
            Self::Record(fields) => {
                fields.iter().fold(0, |size, field| size.saturating_add(field.size))
            }
        }
    }
}

impl Field {
    /// Of `('name', '<f4')` or `('name', '<f4', (3,))`.
    fn of(literal: &Literal) -> Result<Self, Flaw> {
        let flaw =
            || Flaw::needed("fields ('name', 'type') of records", format_args!("{literal:?}"));
        let mut items = literal.items();
        let (name, kind) = (items.next().ok_or_else(flaw)?, items.next().ok_or_else(flaw)?);
        // A field may have a title beside its name.
        let (Literal::Text(name), Literal::Text(kind)) =
            (name.items().last().unwrap_or(name), kind)
        else {
            return Err(flaw());
        };
        let shape: Option<Vec<usize>> = match items.next() {
            Some(shape @ Literal::Number(_)) => shape.count().map(|count| vec![count]),
            Some(shape) => shape.items().map(Literal::count).collect(),
            None => Some(vec![1]),
        };
        let count = shape.ok_or_else(flaw)?.into_iter().try_fold(1_usize, usize::checked_mul);
        let count = count.ok_or_else(flaw)?;
        let number = Number::of(kind);
        let size = match number {
            Some(number) => number.kind.size(),
            None => size_of_other(kind).ok_or_else(flaw)?,
        };
        let size = size.checked_mul(count).ok_or_else(flaw)?;
        let letter = kind.trim_start_matches(['<', '>', '|', '=']).chars().next();
        let kind = match (number, letter, count) {
            (Some(number), _, ..=COMPONENTS) => FieldKind::Numbers(number, count),
            (None, Some('S' | 'a'), 1) => FieldKind::Text(None),
            (None, Some('U'), 1) if kind.starts_with('>') => FieldKind::Text(Some(ByteOrder::Big)),
            (None, Some('U'), 1) => FieldKind::Text(Some(ByteOrder::Little)),
            _ => FieldKind::Other,
        };
        Ok(Self { name: name.clone(), kind, size })
    }
}

/// Bytes of an element that is no number that is read: text, gaps, complex numbers.
fn size_of_other(kind: &str) -> Option<usize> {
    let kind = kind.trim_start_matches(['<', '>', '|', '=']);
    let (letter, count) = kind.split_at_checked(1)?;
    let count: usize = count.split('[').next()?.parse().ok()?;
    match letter {
        "U" => count.checked_mul(4),
        "S" | "V" | "a" | "f" | "c" | "M" | "m" => Some(count),
        _ => None,
    }
}

/// What Python writes for a value.
#[derive(Debug, Clone, PartialEq)]
enum Literal {
    Text(String),
    Number(usize),
    /// True, False, None.
    Name(String),
    /// The items of a tuple or a list; the keys and values of a dictionary.
    Items(Vec<Self>),
}

impl Literal {
    /// How deep values may stand in each other: a dictionary, its list, a field, its shape, and some more.
    const DEPTH: usize = 8;

    fn of(bytes: &[u8]) -> Result<Self, Flaw> {
        let text = word(bytes);
        let mut rest = text.trim_start();
        Self::parse(&mut rest, Self::DEPTH).ok_or_else(|| {
            let start: String = text.chars().take(60).collect();
            Flaw::needed("a dictionary of Python", format_args!("{start:?}"))
        })
    }

    fn parse(rest: &mut &str, depth: usize) -> Option<Self> {
        let text = rest.trim_start();
        let first = text.chars().next()?;
        let (value, behind) = match first {
            '\'' | '"' => {
                let (inside, behind) = text[1..].split_once(first)?;
                (Self::Text(inside.to_owned()), behind)
            }
            '(' | '[' | '{' => {
                let mut items = Vec::new();
                let mut inside = text[1..].trim_start();
                while !inside.starts_with([')', ']', '}']) {
                    items.push(Self::parse(&mut inside, depth.checked_sub(1)?)?);
                    inside = inside.trim_start().trim_start_matches([',', ':']).trim_start();
                }
                (Self::Items(items), &inside[1..])
            }
            _ => {
                let end = text.find(|c: char| !c.is_alphanumeric())?;
                let (word, behind) = text.split_at_checked(end).filter(|_| end > 0)?;
                let number = word.trim_end_matches('L').parse().map(Self::Number);
                (number.unwrap_or_else(|_| Self::Name(word.to_owned())), behind)
            }
        };
        *rest = behind;
        Some(value)
    }

    fn items(&self) -> std::slice::Iter<'_, Self> {
        match self {
            Self::Items(items) => items.iter(),
            _ => [].iter(),
        }
    }

    fn count(&self) -> Option<usize> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The value behind a key of a dictionary.
    fn entry(&self, key: &str) -> Result<&Self, Flaw> {
        let is_key = |item: &&Self| matches!(item, Self::Text(text) if text == key);
        let mut items = self.items();
        items
            .find(is_key)
            .and_then(|_| items.next())
            .ok_or_else(|| Flaw::needed(&format!("the entry {key:?} of the header"), "none"))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A file of that version.
    pub(crate) fn file(
        version: u8,
        descr: &str,
        is_fortran: bool,
        shape: &str,
        data: &[u8],
    ) -> Vec<u8> {
        let order = if is_fortran { "True" } else { "False" };
        let header =
            format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}      \n");
        let mut bytes = [MAGIC, &[version, 0]].concat();
        match version {
            1 => bytes.extend((header.len() as u16).to_le_bytes()),
            _ => bytes.extend((header.len() as u32).to_le_bytes()),
        }
        [&bytes, header.as_bytes(), data].concat()
    }

    fn read(bytes: &[u8]) -> Result<Table, Flaw> {
        table(bytes, &Span::whole(bytes), &Request::default(), &mut Notes::default())
    }

    fn refusal(bytes: &[u8]) -> String {
        read(bytes).expect_err("refused").in_file("a.npy").to_string()
    }

    const POSITIONS: [DVec3; 2] = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)];

    #[test]
    fn every_type_order_and_version_is_read() {
        let rows = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0_f64];
        let columns = [1.0, 4.0, 2.0, 5.0, 3.0, 6.0_f64];
        let little: Vec<u8> = rows.map(f64::to_le_bytes).concat();
        for bytes in [
            file(1, "'<f8'", false, "(2, 3)", &little),
            file(2, "'<f8'", false, "(2L, 3L)", &little),
            file(3, "'<f8'", true, "(2, 3)", &columns.map(f64::to_le_bytes).concat()),
            file(1, "'>f4'", false, "(2, 3)", &rows.map(|n| (n as f32).to_be_bytes()).concat()),
            file(1, "'<i4'", false, "(2, 3)", &rows.map(|n| (n as i32).to_le_bytes()).concat()),
            file(1, "'|u1'", true, "(2, 3)", &columns.map(|n| n as u8)),
        ] {
            assert_eq!(read(&bytes).expect("legal").positions, POSITIONS);
        }
    }

    #[test]
    fn the_fourth_column_is_the_radius() {
        let rows = [1.0, 2.0, 3.0, 0.5, 4.0, 5.0, 6.0, 0.25_f32].map(f32::to_le_bytes).concat();
        let table = read(&file(1, "'<f4'", false, "(2, 4)", &rows)).expect("legal");
        assert_eq!(table.positions, POSITIONS);
        let radii = Values::Numbers(vec![0.5, 0.25]);
        assert_eq!(table.column("radius").map(|column| &column.values), Some(&radii));
    }

    #[test]
    fn fields_of_records_are_columns() {
        let record = |x: f32, [y, z]: [f64; 2], v: [i16; 2]| {
            let mut bytes = b"O\0\0\0".to_vec();
            bytes.extend([u32::from('Å'), 0].map(u32::to_le_bytes).concat());
            bytes.extend(x.to_le_bytes());
            bytes.extend([y, z].map(f64::to_be_bytes).concat());
            bytes.extend(v.map(i16::to_le_bytes).concat());
            bytes
        };
        let data = [record(1.0, [2.0, 3.0], [7, 8]), record(4.0, [5.0, 6.0], [-9, 10])].concat();
        let descr = "[('name', '|S4'), ('kind', '<U2'), ('x', '<f4'), ('y', '>f8'), (('Z', 'z'), '>f8'), ('v', '<i2', (2,))]";
        let table = read(&file(1, descr, false, "(2,)", &data)).expect("legal");
        assert_eq!(table.positions, POSITIONS);
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["name", "kind", "v:0", "v:1"]);
        assert_eq!(table.columns[2].values, Values::Numbers(vec![7.0, -9.0]));
        let words = |word| Values::Words([word; 2].into_iter().collect());
        assert_eq!(table.columns[0].values, words("O"));
        assert_eq!(table.columns[1].values, words("Å"));

        let data = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0_f32].map(f32::to_le_bytes).concat();
        let descr = "[('pos', '<f4', (3,))]";
        let table = read(&file(1, descr, false, "(2,)", &data)).expect("legal");
        assert_eq!(table.positions, POSITIONS);
    }

    #[test]
    fn refusals_say_both_numbers_and_shapes() {
        let with = |descr, shape| refusal(&file(1, descr, false, shape, &[0; 40]));
        assert_eq!(
            with("'<f4'", "(2, 3)"),
            "a.npy, byte 76: needed 24 bytes of shape (2, 3) of f32, found 40"
        );
        assert!(with("'<f4'", "(2, 5)").contains("found shape (2, 5) of f32; other columns go"));
        assert!(with("'<f4'", "(10,)").contains("found shape (10,) of f32"));
        assert!(with("'<f8'", "(99999999999, 99999999999)").contains("far too many bytes"));
        assert!(with("'|O'", "(5,)").contains("needed numbers such as <f4 or <f8, found \"|O\""));
        assert!(
            with("[('a', '<f4'), ('b', '<f4')]", "(5,)")
                .contains("found shape (5,) of records of a, b")
        );
        assert!(with("'<f4'", "(2, -3)").contains("needed a dictionary of Python"));
        assert!(refusal(b"\x93NUMPY\x04\0").contains("needed version 1, 2 or 3"));
        assert!(refusal(b"\x93NUMPY\x01\0\xff\xff{").contains("needed an NPY header"));
        let nan = [0.0, f32::NAN, 0.0].map(f32::to_le_bytes).concat();
        assert!(
            refusal(&file(1, "'<f4'", false, "(1, 3)", &nan))
                .contains("finite coordinates of particle 0")
        );
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            for mut bytes in [
                file(1, "'<f4'", false, "(2, 3)", &[0; 24]),
                file(2, "[('x', '<f4'), ('y', '<f4'), ('z', '<f4', (1,))]", true, "(2,)", &[0; 24]),
            ] {
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                let _ = (read(&bytes), read(&bytes[..cut]));
            }
        }

        #[test]
        fn no_header_panics(text in "[{}()\\[\\],:' a-z0-9<>]{0,60}") {
            let _ = Literal::of(text.as_bytes());
            let _ = read(&file(1, &text, false, "(1, 3)", &[0; 12]));
            let _ = read(&file(1, "'<f4'", false, &text, &[0; 12]));
        }
    }
}
