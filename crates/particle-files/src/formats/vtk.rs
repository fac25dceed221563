//! Legacy VTK: points with values, as text or as numbers whose most significant byte comes first.

use glam::DVec3;

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, NumberType, Numbers};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::table::{Table, Values, component};
use crate::text::{fields, first_line, word};

pub(super) const READER: Reader = Reader {
    name: "legacy VTK",
    endings: &["vtk"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(MAGIC),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

const MAGIC: &[u8] = b"# vtk DataFile";

/// What has points of its own.
const DATASETS: [&str; 3] = ["POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID"];

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let mut parser = Parser { bytes, at: 0, is_binary: false, has_offsets: false };
    parser.header()?;
    let mut file =
        File { table: Table::default(), request, scope: Scope::None, left_out: Vec::new() };
    let mut has_points = false;
    while let Some(line) = parser.next_line() {
        has_points |= line.keyword == "POINTS";
        file.add(&mut parser, &line)?;
    }
    if !has_points {
        return Err(Flaw::needed("POINTS", "none"));
    }
    if !file.left_out.is_empty() {
        notes.left_out(format!("arrays that are no numbers: {}", file.left_out.join(", ")));
    }
    Ok(file.table)
}

/// What values belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Scope {
    None,
    Points,
    /// So many cells.
    Cells(usize),
}

/// What was read so far.
struct File<'a> {
    table: Table,
    request: &'a Request,
    scope: Scope,
    /// Arrays that are no numbers.
    left_out: Vec<String>,
}

/// A line with a keyword.
struct Line {
    keyword: String,
    /// What follows it.
    words: Vec<String>,
    at: usize,
}

impl Line {
    fn word(&self, index: usize) -> &str {
        self.words.get(index).map_or("", String::as_str)
    }

    fn count(&self, index: usize, parser: &Parser<'_>) -> Result<usize, Flaw> {
        self.word(index).parse().map_err(|_| {
            let needed = format!("a count behind {}", self.keyword);
            Flaw::needed(&needed, format_args!("{:?}", self.words.join(" ")))
                .at_line(parser.line_of(self.at))
        })
    }
}

impl File<'_> {
    /// Takes in what follows a keyword.
    fn add(&mut self, parser: &mut Parser<'_>, line: &Line) -> Result<(), Flaw> {
        let kind = |index: usize| parser.kind(line, index);
        match line.keyword.as_str() {
            "POINTS" => {
                let (count, kind) = (line.count(0, parser)?, kind(1)?);
                self.table.positions = parser.positions(count, kind)?;
            }
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                let (count, size) = (line.count(0, parser)?, line.count(1, parser)?);
                if parser.has_offsets {
                    for count in [count, size] {
                        let Some(line) = parser.next_line() else { break };
                        let kind = parser.kind(&line, 0)?;
                        parser.skip(count, kind, &line.keyword)?;
                    }
                } else {
                    parser.skip(size, NumberType::I32, &line.keyword)?;
                }
            }
            "CELL_TYPES" => {
                parser.skip(line.count(0, parser)?, NumberType::I32, &line.keyword)?;
            }
            "METADATA" => parser.skip_to_blank_line(),
            "POINT_DATA" => {
                let (count, found) = (line.count(0, parser)?, self.table.len());
                if count != found {
                    let needed = format!("values for {count} points as POINT_DATA says");
                    let found = counted(found, "point");
                    let flaw = Flaw::needed(&needed, found);
                    return Err(flaw.at_line(parser.line_of(line.at)));
                }
                self.scope = Scope::Points;
            }
            "CELL_DATA" => self.scope = Scope::Cells(line.count(0, parser)?),
            "DIMENSIONS" => {}
            "LOOKUP_TABLE" => {
                let count = line.count(1, parser)?.saturating_mul(4);
                parser.skip(count, NumberType::U8, &line.keyword)?;
            }
            "FIELD" => self.fields(parser, line)?,
            "COLOR_SCALARS" => {
                let kind = if parser.is_binary { NumberType::U8 } else { NumberType::F32 };
                let components = line.count(1, parser)?;
                let tuples = self.tuples(parser, line)?;
                self.colors(parser, components, tuples, kind)?;
            }
            _ => {
                let (components, at_kind) = attribute(line).ok_or_else(|| parser.unknown(line))?;
                let (tuples, kind) = (self.tuples(parser, line)?, kind(at_kind)?);
                if line.keyword == "SCALARS" {
                    parser.skip_lookup_table();
                }
                let array = Array { name: line.word(0), components, tuples, kind };
                self.values(parser, &array, self.scope == Scope::Points)?;
            }
        }
        Ok(())
    }

    /// How many tuples an attribute has.
    fn tuples(&self, parser: &Parser<'_>, line: &Line) -> Result<usize, Flaw> {
        match self.scope {
            Scope::Points => Ok(self.table.len()),
            Scope::Cells(count) => Ok(count),
            Scope::None => {
                let needed = format!("POINT_DATA or CELL_DATA before {}", line.keyword);
                Err(Flaw::needed(&needed, "none").at_line(parser.line_of(line.at)))
            }
        }
    }

    /// The arrays of a FIELD.
    fn fields(&mut self, parser: &mut Parser<'_>, line: &Line) -> Result<(), Flaw> {
        for _ in 0..line.count(1, parser)? {
            let mut array = parser.next_line();
            // Between arrays there may be what is known of the one before.
            while array.as_ref().is_some_and(|line| line.keyword == "METADATA") {
                parser.skip_to_blank_line();
                array = parser.next_line();
            }
            let Some(array) = array else {
                let needed = format!("{} of FIELD", counted(line.count(1, parser)?, "array"));
                return Err(Flaw::needed(&needed, "the end of the file"));
            };
            let (components, tuples) = (array.count(0, parser)?, array.count(1, parser)?);
            if array.word(2) == "string" {
                parser.skip_strings(components.saturating_mul(tuples), &array.keyword)?;
                self.left_out.push(unescaped(&array.keyword));
                continue;
            }
            let kind = parser.kind(&array, 2)?;
            let is_of_points = self.scope == Scope::Points && tuples == self.table.len();
            let array = Array { name: &array.keyword, components, tuples, kind };
            self.values(parser, &array, is_of_points)?;
        }
        Ok(())
    }

    /// The values of an array, which become columns where they are of points and wanted.
    fn values(
        &mut self,
        parser: &mut Parser<'_>,
        array: &Array<'_>,
        are_of_points: bool,
    ) -> Result<(), Flaw> {
        let Array { components, tuples, kind, .. } = *array;
        let name = unescaped(array.name);
        let names: Vec<String> =
            (0..components.min(16)).map(|index| component(&name, index, components)).collect();
        let is_wanted = |name: &String| self.request.wanted.wants(name);
        let count = tuples.saturating_mul(components);
        if !are_of_points || components > 16 || !names.iter().any(is_wanted) {
            return parser.skip(count, kind, &name);
        }
        let columns = parser.columns(components, tuples, kind, &name)?;
        for (name, column) in names.into_iter().zip(columns) {
            if self.request.wanted.wants(&name) {
                self.table.add(name, Values::Numbers(column));
            }
        }
        Ok(())
    }

    /// Colours: red, green and blue, as bytes or as numbers up to 1.
    fn colors(
        &mut self,
        parser: &mut Parser<'_>,
        components: usize,
        tuples: usize,
        kind: NumberType,
    ) -> Result<(), Flaw> {
        if self.scope != Scope::Points || !(3..=4).contains(&components) {
            return parser.skip(tuples.saturating_mul(components), kind, "COLOR_SCALARS");
        }
        let columns = parser.columns(components, tuples, kind, "COLOR_SCALARS")?;
        for (name, column) in ["red", "green", "blue"].into_iter().zip(columns) {
            self.table.add(name, Values::Numbers(column));
        }
        Ok(())
    }
}

/// An array of values.
struct Array<'a> {
    name: &'a str,
    components: usize,
    tuples: usize,
    kind: NumberType,
}

/// How many components an attribute has, and which word behind its keyword is their type.
fn attribute(line: &Line) -> Option<(usize, usize)> {
    match line.keyword.as_str() {
        "SCALARS" => Some((line.word(2).parse().unwrap_or(1), 1)),
        "VECTORS" | "NORMALS" => Some((3, 1)),
        "TENSORS" => Some((9, 1)),
        "TENSORS6" => Some((6, 1)),
        "GLOBAL_IDS" | "PEDIGREE_IDS" => Some((1, 1)),
        "TEXTURE_COORDINATES" => Some((line.word(1).parse().ok()?, 2)),
        _ => None,
    }
}

/// A name whose special characters are written as `%` and two hexadecimal digits.
fn unescaped(name: &str) -> String {
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name.as_bytes();
    while let Some((first, behind)) = rest.split_first() {
        let code = behind.get(..2).and_then(|code| std::str::from_utf8(code).ok());
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) if *first == b'%' => (rest = &behind[2..], bytes.push(byte)).1,
            _ => (rest = behind, bytes.push(*first)).1,
        }
    }
    word(&bytes).into_owned()
}

/// Where the reading of a file is.
struct Parser<'a> {
    bytes: &'a [u8],
    at: usize,
    is_binary: bool,
    /// Whether cells are written as offsets and connectivity, as from version 5 on.
    has_offsets: bool,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    fn line_of(&self, at: usize) -> usize {
        1 + memchr::memchr_iter(b'\n', &self.bytes[..at]).count()
    }

    /// A flaw at the line that comes next, or at its byte where lines mean nothing.
    fn flaw(&self, flaw: Flaw) -> Flaw {
        if self.is_binary { flaw.at_byte(self.at) } else { flaw.at_line(self.line_of(self.at)) }
    }

    /// The first four lines.
    fn header(&mut self) -> Result<(), Flaw> {
        let (first, rest) = first_line(self.bytes);
        let version = fields(first).last().unwrap_or_default();
        self.has_offsets = word(version)
            .split('.')
            .next()
            .and_then(|major| major.parse().ok())
            .is_some_and(|major: u32| major >= 5);
        let (_, rest) = first_line(rest);
        self.at = self.bytes.len() - rest.len();
        let kind = self.next_line().map(|line| line.keyword).unwrap_or_default();
        self.is_binary = match kind.as_str() {
            "ASCII" => false,
            "BINARY" => true,
            _ => {
                let flaw = Flaw::needed("ASCII or BINARY", format_args!("{kind:?}"));
                return Err(flaw.at_line(3));
            }
        };
        let dataset = self.next_line();
        let dataset = dataset.as_ref().map_or("", |line| line.word(0));
        if !DATASETS.contains(&dataset) {
            let needed = format!("DATASET and one of {}", DATASETS.join(", "));
            let flaw = Flaw::needed(&needed, format_args!("{dataset:?}")).at_line(4);
            return Err(flaw.or("only they have points of their own"));
        }
        Ok(())
    }

    /// The next line that is not blank.
    fn next_line(&mut self) -> Option<Line> {
        loop {
            if self.rest().is_empty() {
                return None;
            }
            let at = self.at;
            let (line, rest) = first_line(self.rest());
            self.at = self.bytes.len() - rest.len();
            let mut words = fields(line).map(|field| word(field).into_owned());
            if let Some(keyword) = words.next() {
                return Some(Line { keyword, words: words.collect(), at });
            }
        }
    }

    fn skip_to_blank_line(&mut self) {
        loop {
            let (line, rest) = first_line(self.rest());
            self.at = self.bytes.len() - rest.len();
            if line.trim_ascii().is_empty() {
                return;
            }
        }
    }

    /// The line that says by which table scalars have colours.
    fn skip_lookup_table(&mut self) {
        let (line, rest) = first_line(self.rest());
        if fields(line).next() == Some(b"LOOKUP_TABLE") {
            self.at = self.bytes.len() - rest.len();
        }
    }

    /// The type that a word behind a keyword names.
    fn kind(&self, line: &Line, index: usize) -> Result<NumberType, Flaw> {
        Ok(match line.word(index) {
            "char" | "signed_char" | "vtktypeint8" => NumberType::I8,
            "unsigned_char" | "vtktypeuint8" => NumberType::U8,
            "short" | "vtktypeint16" => NumberType::I16,
            "unsigned_short" | "vtktypeuint16" => NumberType::U16,
            "int" | "vtkIdType" | "vtktypeint32" => NumberType::I32,
            "unsigned_int" | "vtktypeuint32" => NumberType::U32,
            "long" | "vtktypeint64" => NumberType::I64,
            "unsigned_long" | "vtktypeuint64" => NumberType::U64,
            "float" => NumberType::F32,
            "double" => NumberType::F64,
            _ => {
                let needed = format!("a type of numbers, such as float, for {}", line.keyword);
                let found = format_args!("{:?}", line.words.join(" "));
                return Err(Flaw::needed(&needed, found).at_line(self.line_of(line.at)));
            }
        })
    }

    fn unknown(&self, line: &Line) -> Flaw {
        let flaw = Flaw::needed(
            "a keyword such as POINTS, POINT_DATA or SCALARS",
            format_args!("{:?}", line.keyword),
        );
        let is_number = number(line.keyword.as_bytes(), DecimalMark::Point).is_some();
        let flaw = flaw.at_line(self.line_of(line.at));
        if is_number { flaw.or("there are more numbers than were announced") } else { flaw }
    }

    /// The bytes of binary numbers.
    fn take(&mut self, count: usize, kind: NumberType, what: &str) -> Result<&'a [u8], Flaw> {
        let mut cursor = binary::Cursor::new(self.bytes, self.at, ByteOrder::Big);
        let taken = cursor.take_all(count, kind.size(), what)?;
        self.at = cursor.at();
        Ok(taken)
    }

    /// Hands so many numbers that are written as text to a function, with their indices.
    fn text(
        &mut self,
        count: usize,
        what: &str,
        mut each: impl FnMut(usize, &[u8]) -> Result<(), Flaw>,
    ) -> Result<(), Flaw> {
        for index in 0..count {
            let rest = self.rest();
            let start = rest.len() - rest.trim_ascii_start().len();
            let end = rest[start..].iter().position(u8::is_ascii_whitespace);
            let end = end.map_or(rest.len(), |end| start + end);
            if start == end {
                let needed = format!("{} of {what}", counted(count, "number"));
                let found = format!("the end of the file after {index}");
                return Err(self.flaw(Flaw::needed(&needed, found)));
            }
            each(index, &rest[start..end]).map_err(|flaw| {
                let key = flaw.at_line(self.line_of(self.at + start));
                if what == "POINTS" { key } else { key.at_key(what) }
            })?;
            self.at += end;
        }
        Ok(())
    }

    fn skip(&mut self, count: usize, kind: NumberType, what: &str) -> Result<(), Flaw> {
        match self.is_binary {
            true => self.take(count, kind, what).map(|_| ()),
            false => self.text(count, what, |_, _| Ok(())),
        }
    }

    /// Goes behind so many texts: lines, or bytes behind their length.
    fn skip_strings(&mut self, count: usize, what: &str) -> Result<(), Flaw> {
        for index in 0..count {
            if self.rest().is_empty() {
                let needed = format!("{} of {what}", counted(count, "text"));
                let found = format!("the end of the file after {index}");
                return Err(self.flaw(Flaw::needed(&needed, found)));
            }
            if self.is_binary {
                self.skip_string(what)?;
            } else {
                let (_, rest) = first_line(self.rest());
                self.at = self.bytes.len() - rest.len();
            }
        }
        Ok(())
    }

    /// Goes behind a text and its length, whose first two bits say how many bytes it has.
    fn skip_string(&mut self, what: &str) -> Result<(), Flaw> {
        let mut cursor = binary::Cursor::new(self.bytes, self.at, ByteOrder::Big);
        let first = self.rest().first().copied().unwrap_or_default();
        let size = [8, 4, 2, 1][usize::from(first >> 6)];
        let bytes = cursor.take(size, what)?;
        let length = bytes.iter().fold(0_u64, |length, byte| length << 8 | u64::from(*byte));
        let length = length & (u64::MAX >> (64 - 8 * size + 2));
        cursor.take(usize::try_from(length).unwrap_or(usize::MAX), what)?;
        self.at = cursor.at();
        Ok(())
    }

    fn positions(&mut self, count: usize, kind: NumberType) -> Result<Vec<DVec3>, Flaw> {
        let size = kind.size();
        if self.is_binary {
            let at = self.at;
            let bytes = self.take(count.saturating_mul(3), kind, "POINTS")?;
            let axis = |axis: usize| {
                let bytes = bytes.get(axis * size..).unwrap_or_default();
                Numbers::new(bytes, kind, ByteOrder::Big, 3 * size, count)
            };
            let [Some(x), Some(y), Some(z)] = [0, 1, 2].map(axis) else { return Ok(Vec::new()) };
            return binary::positions([x, y, z]).map_err(|flaw| flaw.at_byte(at));
        }
        let mut positions: Vec<DVec3> = Vec::new();
        let mut position = DVec3::ZERO;
        self.text(count.saturating_mul(3), "POINTS", |index, field| {
            let number = finite_number(field)?;
            position[index % 3] = number;
            if index % 3 == 2 {
                positions.push(position);
            }
            Ok(())
        })?;
        Ok(positions)
    }

    /// The columns of so many tuples of so many components.
    fn columns(
        &mut self,
        components: usize,
        tuples: usize,
        kind: NumberType,
        what: &str,
    ) -> Result<Vec<Vec<f64>>, Flaw> {
        let (count, size) = (tuples.saturating_mul(components), kind.size());
        if self.is_binary {
            let bytes = self.take(count, kind, what)?;
            let column = |index: usize| {
                let bytes = bytes.get(index * size..)?;
                Numbers::new(bytes, kind, ByteOrder::Big, components * size, tuples)
            };
            return Ok((0..components).filter_map(column).map(Numbers::to_vec).collect());
        }
        let mut columns = vec![Vec::new(); components];
        self.text(count, what, |index, field| {
            let number = number(field, DecimalMark::Point);
            let number = number.ok_or_else(|| no_number("a number", field))?;
            columns[index % components].push(number);
            Ok(())
        })?;
        Ok(columns)
    }
}

fn finite_number(field: &[u8]) -> Result<f64, Flaw> {
    let number = number(field, DecimalMark::Point).filter(|number| number.is_finite());
    number.ok_or_else(|| no_number("a finite number", field))
}

fn no_number(needed: &str, field: &[u8]) -> Flaw {
    Flaw::needed(needed, format_args!("{:?}", word(field)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TEXT: &str = "# vtk DataFile Version 4.2\nparticles\nASCII\nDATASET POLYDATA\n\
        FIELD FieldData 1\nTIME 1 1 double\n0.5\nPOINTS 3 float\n0 0 0 1 0 0\n0 1\n0.5\nMETADATA\n\
        INFORMATION 0\n\nVERTICES 3 6\n1 0\n1 1 1 2\nCELL_DATA 3\nSCALARS cell int 1\n\
        LOOKUP_TABLE default\n1 2 3\nPOINT_DATA 3\nSCALARS radius float\nLOOKUP_TABLE default\n\
        1 2 nan\nVECTORS vel%20ocity double\n1 2 3 4 5 6 7 8 9\nCOLOR_SCALARS rgb 3\n\
        1 0 0 0 1 0 0 0 1\nFIELD FieldData 3\nnames 1 3 string\na b\n\nc\npressure 1 3 int\n7 8 9\nMETADATA\nINFORMATION 0\n\n\
        id 1 3 vtkIdType\n0 1 2\n";

    fn read(bytes: &[u8]) -> Result<Table, Flaw> {
        table(bytes, &Span::whole(bytes), &Request::default(), &mut Notes::default())
    }

    fn refusal(bytes: &[u8]) -> String {
        read(bytes).expect_err("refused").in_file("a.vtk").to_string()
    }

    fn numbers<'a>(table: &'a Table, name: &str) -> &'a [f64] {
        match table.column(name).map(|column| &column.values) {
            Some(Values::Numbers(numbers)) => numbers,
            other => panic!("needed numbers of {name}, found {other:?}"),
        }
    }

    fn binary() -> Vec<u8> {
        announcing("2")
    }

    /// Two points with a scalar, binary, as version 5 writes it; their announced number is given.
    fn announcing(points: &str) -> Vec<u8> {
        let header = "# vtk DataFile Version 5.1\n\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
        let mut bytes = format!("{header}POINTS {points} double\n").into_bytes();
        bytes.extend([0.1, 0.0, 0.0, 1.0, 2.0, 3.0_f64].map(f64::to_be_bytes).concat());
        bytes.extend(b"\nCELLS 3 2\nOFFSETS vtktypeint64\n");
        bytes.extend([0, 1, 2_i64].map(i64::to_be_bytes).concat());
        bytes.extend(b"\nCONNECTIVITY vtktypeint64\n");
        bytes.extend([10, 1_i64].map(i64::to_be_bytes).concat());
        bytes.extend(b"\nCELL_TYPES 2\n");
        bytes.extend([1, 1_i32].map(i32::to_be_bytes).concat());
        bytes.extend(b"\nPOINT_DATA 2\nSCALARS h float\nLOOKUP_TABLE default\n");
        bytes.extend([0.5, 0.25_f32].map(f32::to_be_bytes).concat());
        bytes.extend(b"\nFIELD FieldData 3\nkind 2 2 short\n");
        bytes.extend([1, 2, -3, 4_i16].map(i16::to_be_bytes).concat());
        bytes.extend(b"\n");
        bytes.extend(b"names 1 2 string\n\xc2ab");
        bytes.extend([&(1_u16 << 15 | 70).to_be_bytes()[..], &[b'c'; 70]].concat());
        bytes.extend(b"\nlast 1 2 int\n");
        bytes.extend([5, 6_i32].map(i32::to_be_bytes).concat());
        bytes
    }

    #[test]
    fn text_has_points_and_their_values() {
        let table = read(TEXT.as_bytes()).expect("legal");
        assert_eq!(table.positions, [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.0, 0.5)]);
        assert_eq!(numbers(&table, "radius")[..2], [1.0, 2.0]);
        assert_eq!(numbers(&table, "vel ocity:2"), [3.0, 6.0, 9.0]);
        assert_eq!(numbers(&table, "green"), [0.0, 1.0, 0.0]);
        assert_eq!(numbers(&table, "pressure"), [7.0, 8.0, 9.0]);
        assert_eq!(numbers(&table, "id"), [0.0, 1.0, 2.0]);
        assert!(table.column("cell").is_none() && table.column("TIME").is_none());
    }

    #[test]
    fn binary_numbers_begin_with_their_most_significant_byte() {
        let table = read(&binary()).expect("legal");
        assert_eq!(table.positions, [DVec3::new(0.1, 0.0, 0.0), DVec3::new(1.0, 2.0, 3.0)]);
        assert_eq!(numbers(&table, "h"), [0.5, 0.25]);
        assert_eq!(numbers(&table, "kind:0"), [1.0, -3.0]);
        assert_eq!(numbers(&table, "last"), [5.0, 6.0]);
    }

    #[test]
    fn refusals_say_both_numbers_and_the_place() {
        let text = |from: &str, to: &str| refusal(TEXT.replace(from, to).as_bytes());
        assert_eq!(
            text("0.5\nMETADATA\nINFORMATION 0\n\nVERT", "x\nVERT"),
            "a.vtk, line 11: needed a finite number, found \"x\""
        );
        assert!(text("POINTS 3", "POINTS 2").contains("more numbers than were announced"));
        assert_eq!(
            text("POINT_DATA 3", "POINT_DATA 4"),
            "a.vtk, line 22: needed values for 4 points as POINT_DATA says, found 3 points"
        );
        assert!(text("POLYDATA", "STRUCTURED_POINTS").contains("needed DATASET and one of"));
        assert!(text("ASCII", "TEXT").starts_with("a.vtk, line 3: needed ASCII or BINARY"));
        assert!(text("id 1 3 vtkIdType", "id 1 3 words").contains("needed a type of numbers"));
        assert!(text("id 1 3 vtkIdType", "id 1 5 string").contains("needed 5 texts of id, found"));
        let cut = &TEXT[..TEXT.find("0 1\n0.5\nMETA").expect("is there")];
        assert!(refusal(cut.as_bytes()).contains("needed 9 numbers of POINTS, found the end"));
        for points in ["999999999999", "9999999999999999999"] {
            assert!(
                refusal(&announcing(points)).contains("POINTS, found the end of the file after")
            );
        }
        assert!(refusal(b"# vtk DataFile\n\nASCII\nDATASET POLYDATA\n").contains("needed POINTS"));
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            for mut bytes in [TEXT.as_bytes().to_vec(), binary()] {
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                let _ = (read(&bytes), read(&bytes[..cut]));
            }
        }

        #[test]
        fn no_line_panics(text in "(POINTS|CELLS|FIELD|SCALARS|METADATA|LOOKUP_TABLE|COLOR_SCALARS|POINT_DATA| |[0-9]{1,20}|float|\n|a){0,24}") {
            let _ = read(format!("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n{text}").as_bytes());
            let _ = read(format!("# vtk DataFile Version 5.0\n\nBINARY\nDATASET POLYDATA\n{text}").as_bytes());
        }
    }
}
