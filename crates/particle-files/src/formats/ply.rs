//! PLY: elements whose properties a header lists, as text or binary. Particles are the element `vertex`.

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::DecimalMark;
use crate::roles::Role;
use crate::rows::{Becomes, Field, Rows, Separator, Width};
use crate::table::{Table, Values};
use crate::text::{fields, first_line, word};

pub(super) const READER: Reader = Reader {
    name: "PLY",
    endings: &["ply"],
    is_text: false,
    recognizes: |bytes| bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r"),
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

fn table(bytes: &[u8], _: &Span, request: &Request, _: &mut Notes) -> Result<Table, Flaw> {
    let header = Header::of(bytes)?;
    let at = header.elements.iter().position(|element| element.name == "vertex");
    let Some(at) = at else {
        let names: Vec<&str> = header.elements.iter().map(|e| e.name.as_str()).collect();
        return Err(Flaw::needed("an element vertex", format_args!("{:?}", names.join(", "))));
    };
    let (before, vertex) = (&header.elements[..at], &header.elements[at]);
    let axes = vertex.axes()?;
    match header.order {
        Some(order) => {
            let mut cursor = Cursor::new(bytes, header.end, order);
            before.iter().try_for_each(|element| element.skip(&mut cursor))?;
            of_binary(&mut cursor, vertex, axes, request)
        }
        None => of_text(&bytes[header.end..], &header, before, vertex, axes, request),
    }
}

/// What a header says.
struct Header {
    /// `None` where elements are text.
    order: Option<ByteOrder>,
    elements: Vec<Element>,
    /// The first byte after it, and its line.
    end: usize,
    end_line: usize,
}

/// Things of one sort.
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
    line: usize,
}

struct Property {
    name: String,
    kind: NumberType,
    /// The type of its count, where it is a list.
    list: Option<NumberType>,
    line: usize,
}

impl Header {
    fn of(bytes: &[u8]) -> Result<Self, Flaw> {
        let (_, mut rest) = first_line(bytes);
        let mut header = Self { order: None, elements: Vec::new(), end: 0, end_line: 0 };
        let mut has_format = false;
        for line in 2.. {
            if rest.is_empty() {
                return Err(Flaw::needed("the line end_header", "the end of the file"));
            }
            let (text, behind) = first_line(rest);
            rest = behind;
            let words: Vec<String> = fields(text).map(|field| word(field).into_owned()).collect();
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            match words[..] {
                ["format", format, ..] => {
                    header.order = order(format).map_err(|flaw| flaw.at_line(line))?;
                    has_format = true;
                }
                ["end_header"] => {
                    (header.end, header.end_line) = (bytes.len() - rest.len(), line);
                    break;
                }
                [] | ["comment" | "obj_info", ..] => {}
                _ => header.add(&words, line).map_err(|flaw| flaw.at_line(line))?,
            }
        }
        if !has_format {
            return Err(Flaw::needed("a line format", "none"));
        }
        Ok(header)
    }

    /// Takes in a line about an element or a property.
    fn add(&mut self, words: &[&str], line: usize) -> Result<(), Flaw> {
        match (words, self.elements.last_mut()) {
            (["element", name, count], _) => {
                let count = count.parse().map_err(|_| {
                    Flaw::needed(&format!("the count of {name}"), format_args!("{count:?}"))
                })?;
                let name = (*name).to_owned();
                self.elements.push(Element { name, count, properties: Vec::new(), line });
            }
            (["property", "list", count, kind, name], Some(element)) => {
                let (list, kind) = (Some(number_type(count)?), number_type(kind)?);
                element.properties.push(Property { name: (*name).to_owned(), kind, list, line });
            }
            (["property", kind, name], Some(element)) => {
                let kind = number_type(kind)?;
                element.properties.push(Property {
                    name: (*name).to_owned(),
                    kind,
                    list: None,
                    line,
                });
            }
            _ => {
                let needed = "element NAME COUNT, property TYPE NAME, comment or end_header";
                return Err(Flaw::needed(needed, format_args!("{:?}", words.join(" "))));
            }
        }
        Ok(())
    }
}

fn order(format: &str) -> Result<Option<ByteOrder>, Flaw> {
    match format {
        "ascii" => Ok(None),
        "binary_little_endian" => Ok(Some(ByteOrder::Little)),
        "binary_big_endian" => Ok(Some(ByteOrder::Big)),
        _ => {
            let needed = "the format ascii, binary_little_endian or binary_big_endian";
            Err(Flaw::needed(needed, format_args!("{format:?}")))
        }
    }
}

fn number_type(name: &str) -> Result<NumberType, Flaw> {
    Ok(match name {
        "char" | "int8" => NumberType::I8,
        "uchar" | "uint8" => NumberType::U8,
        "short" | "int16" => NumberType::I16,
        "ushort" | "uint16" => NumberType::U16,
        "int" | "int32" => NumberType::I32,
        "uint" | "uint32" => NumberType::U32,
        "float" | "float32" => NumberType::F32,
        "double" | "float64" => NumberType::F64,
        _ => {
            let needed = "a type such as uchar, int, float or double";
            return Err(Flaw::needed(needed, format_args!("{name:?}")));
        }
    })
}

impl Element {
    /// Which of its properties are x, y and z.
    fn axes(&self) -> Result<[usize; 3], Flaw> {
        if let Some(list) = self.properties.iter().find(|property| property.list.is_some()) {
            let found = format!("the list {:?}", list.name);
            return Err(
                Flaw::needed("properties of one number each in vertex", found).at_line(list.line)
            );
        }
        let at = |name: &str| self.properties.iter().position(|property| property.name == name);
        match ["x", "y", "z"].map(at) {
            [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
            _ => {
                let names: Vec<&str> = self.properties.iter().map(|p| p.name.as_str()).collect();
                let found = format!("{:?}", names.join(" "));
                Err(Flaw::needed("properties x, y and z of vertex", found).at_line(self.line))
            }
        }
    }

    /// Bytes of one, without lists.
    fn size(&self) -> usize {
        self.properties.iter().map(|property| property.kind.size()).sum()
    }

    /// Goes behind the bytes of all.
    fn skip(&self, cursor: &mut Cursor<'_>) -> Result<(), Flaw> {
        if self.properties.iter().all(|property| property.list.is_none()) {
            return cursor.take_all(self.count, self.size(), &self.name).map(|_| ());
        }
        for _ in 0..self.count {
            for property in &self.properties {
                let count = match property.list {
                    // A count that is not finite or below 0 becomes 0.
                    Some(kind) => cursor.number(kind, &property.name)? as usize,
                    None => 1,
                };
                cursor.take_all(count, property.kind.size(), &property.name)?;
            }
        }
        Ok(())
    }

    /// What its columns are called: colours by their usual names.
    fn names(&self) -> Vec<String> {
        let has = |name: &str| self.properties.iter().any(|property| property.name == name);
        let are_colors = ["r", "g", "b"].into_iter().all(has);
        let name = |property: &Property| {
            let name = property.name.strip_prefix("diffuse_").unwrap_or(&property.name);
            match name {
                "r" if are_colors => "red".to_owned(),
                "g" if are_colors => "green".to_owned(),
                "b" if are_colors => "blue".to_owned(),
                _ => name.to_owned(),
            }
        };
        self.properties.iter().map(name).collect()
    }
}

fn of_binary(
    cursor: &mut Cursor<'_>,
    vertex: &Element,
    axes: [usize; 3],
    request: &Request,
) -> Result<Table, Flaw> {
    let (size, count, at) = (vertex.size(), vertex.count, cursor.at());
    let what = counted(count, "vertex").replace("vertexs", "vertices");
    let bytes = cursor.take_all(count, size, &what)?;
    let mut offset = 0;
    let mut numbers = Vec::with_capacity(vertex.properties.len());
    for property in &vertex.properties {
        let bytes = bytes.get(offset..).unwrap_or_default();
        numbers.extend(Numbers::new(bytes, property.kind, cursor.order, size, count));
        offset += property.kind.size();
    }
    let positions = binary::positions(axes.map(|axis| numbers[axis]));
    let positions = positions.map_err(|flaw| flaw.at_byte(at))?;
    let mut table = Table { positions, ..Table::default() };
    for (index, name) in vertex.names().into_iter().enumerate() {
        if !axes.contains(&index) && request.wanted.wants(&name) {
            table.add(name, Values::Numbers(numbers[index].to_vec()));
        }
    }
    Ok(table)
}

/// Every thing stands on a line of its own.
fn of_text(
    text: &[u8],
    header: &Header,
    before: &[Element],
    vertex: &Element,
    axes: [usize; 3],
    request: &Request,
) -> Result<Table, Flaw> {
    let skipped = before.iter().fold(0_usize, |sum, element| sum.saturating_add(element.count));
    let start = after_lines(text, skipped);
    let rows = &text[start..][..after_lines(&text[start..], vertex.count)];
    let first_line = header.end_line + 1 + memchr::memchr_iter(b'\n', &text[..start]).count();
    let field = |(index, name): (usize, String)| {
        let becomes = match axes.iter().position(|axis| *axis == index) {
            Some(axis) => Becomes::Coordinate(axis),
            None if !request.wanted.wants(&name) => Becomes::Nothing,
            None if Role::of(&name).is_some_and(Role::is_word) => Becomes::Word,
            None => Becomes::Number,
        };
        Field { name, becomes }
    };
    let rows_of = Rows {
        separator: Separator::Blanks,
        mark: DecimalMark::Point,
        fields: vertex.names().into_iter().enumerate().map(field).collect(),
        width: Width::Exactly,
        skips: Some(b""),
    };
    let table = rows_of.read(rows, first_line)?;
    if table.len() != vertex.count {
        let needed = format!("{} lines of vertex as line {} says", vertex.count, vertex.line);
        let flaw = Flaw::needed(&needed, table.len());
        return Err(flaw.at_line(first_line + table.len()));
    }
    Ok(table)
}

/// Where so many lines end, or the text does.
fn after_lines(text: &[u8], count: usize) -> usize {
    match count.checked_sub(1) {
        None => 0,
        Some(last) => memchr::memchr_iter(b'\n', text).nth(last).map_or(text.len(), |end| end + 1),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;

    const HEADER: &str = "comment made by hand\nelement face 2\nproperty list uchar int \
        vertex_indices\nproperty uchar flag\nelement extra 1\nproperty short a\nelement vertex 2\n\
        property double z\nproperty float x\nproperty float32 y\nproperty uchar red\nproperty uchar \
        green\nproperty uchar blue\nproperty float radius\nelement edge 1\nproperty int a\nend_header\n";

    const ROWS: &str = "3 0 1 2 7\n0 8\n-5\n3 1 2 255 0 51 0.5\n-3.5 -1e0 2 0 1 2 0.25\n9\n";

    fn text() -> Vec<u8> {
        format!("ply\nformat ascii 1.0\n{HEADER}{ROWS}").into_bytes()
    }

    /// The same as [`text`], in bytes.
    fn binary(order: ByteOrder) -> Vec<u8> {
        let name = if order == ByteOrder::Big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{name}_endian 1.0\n{HEADER}").into_bytes();
        let mut put = |number: &[u8]| {
            let mut number = number.to_vec();
            if order == ByteOrder::Little {
                number.reverse();
            }
            bytes.extend(number);
        };
        put(&[3]);
        [0, 1, 2_i32].iter().for_each(|index| put(&index.to_be_bytes()));
        [7, 0, 8].iter().for_each(|byte| put(&[*byte]));
        put(&(-5_i16).to_be_bytes());
        for (z, x, y, color, radius) in
            [(3.0_f64, 1.0_f32, 2.0_f32, [255, 0, 51], 0.5_f32), (-3.5, -1.0, 2.0, [0, 1, 2], 0.25)]
        {
            put(&z.to_be_bytes());
            put(&x.to_be_bytes());
            put(&y.to_be_bytes());
            color.iter().for_each(|byte| put(&[*byte]));
            put(&radius.to_be_bytes());
        }
        put(&9_i32.to_be_bytes());
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Table, Flaw> {
        table(bytes, &Span::whole(bytes), &Request::default(), &mut Notes::default())
    }

    fn refusal(bytes: &[u8]) -> String {
        read(bytes).expect_err("refused").in_file("a.ply").to_string()
    }

    #[test]
    fn vertices_are_found_between_other_elements() {
        for bytes in [text(), binary(ByteOrder::Little), binary(ByteOrder::Big)] {
            let table = read(&bytes).expect("legal");
            assert_eq!(table.positions, [DVec3::new(1.0, 2.0, 3.0), DVec3::new(-1.0, 2.0, -3.5)]);
            let columns = [("red", [255.0, 0.0]), ("blue", [51.0, 2.0]), ("radius", [0.5, 0.25])];
            for (name, numbers) in columns {
                let values = table.column(name).map(|column| &column.values);
                assert_eq!(values, Some(&Values::Numbers(numbers.to_vec())), "{name}");
            }
        }
    }

    #[test]
    fn short_names_of_colours_are_known_where_all_three_are_there() {
        let bytes = |names: [&str; 3]| {
            let [r, g, b] = names;
            format!(
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty \
                 float z\nproperty float {r}\nproperty float {g}\nproperty float {b}\nend_header\n\
                 0 0 0 1 2 3\n"
            )
        };
        let names = |names| -> Vec<String> {
            let table = read(bytes(names).as_bytes()).expect("legal");
            table.columns.into_iter().map(|column| column.name).collect()
        };
        assert_eq!(names(["r", "g", "b"]), ["red", "green", "blue"]);
        assert_eq!(names(["diffuse_red", "r", "g"]), ["red", "r", "g"]);
    }

    #[test]
    fn refusals_say_both_numbers_and_the_place() {
        let with = |from: &str, to: &str| {
            let text = String::from_utf8(text()).expect("text");
            refusal(text.replace(from, to).as_bytes())
        };
        let cut = text();
        let cut = &cut[..cut.len() - "-3.5 -1e0 2 0 1 2 0.25\n9\n".len()];
        assert_eq!(
            refusal(cut),
            "a.ply, line 24: needed 2 lines of vertex as line 9 says, found 1"
        );
        assert_eq!(
            with("3 1 2 255", "3 one 2 255"),
            "a.ply, line 23, column 2 (x): needed a finite number, found \"one\""
        );
        assert!(with("element vertex 2", "element vertex two").contains("the count of vertex"));
        assert!(with("double z", "double depth").contains("needed properties x, y and z"));
        assert!(with("double z", "quad z").contains("line 10: needed a type such as"));
        assert!(with("float radius", "list uchar float radius").contains("the list \"radius\""));
        assert!(with("element vertex", "element point").contains("needed an element vertex"));
        assert!(with("end_header", "end").contains("comment or end_header"));
        assert!(with("ascii", "text").contains("line 2: needed the format"));
        let bytes = binary(ByteOrder::Little);
        assert!(
            refusal(&bytes[..bytes.len() - 20]).contains("needed 46 bytes of 2 vertices, found")
        );
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            for mut bytes in [text(), binary(ByteOrder::Little), binary(ByteOrder::Big)] {
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                let _ = (read(&bytes), read(&bytes[..cut]));
            }
        }
    }
}
