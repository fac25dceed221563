//! VTK's XML formats: pieces with points and their values, as text, in base64 or appended behind the
//! XML, compressed by zlib or not.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use glam::DVec3;
use memchr::memmem;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader as XmlReader, XmlVersion};
use rayon::prelude::*;

use super::{Reader, Request, Span};
use crate::binary::{self, ByteOrder, Cursor, NumberType, Numbers};
use crate::error::Flaw;
use crate::notes::{Notes, counted};
use crate::number::{DecimalMark, number};
use crate::table::{Table, Values, component};
use crate::text::{fields, utf8, word};

pub(super) const READER: Reader = Reader {
    name: "VTK XML",
    endings: &["vtu", "vtp", "vts", "pvtu", "pvtp", "pvd", "vtm"],
    is_text: false,
    recognizes,
    frames: |bytes| Ok(vec![Span::whole(bytes)]),
    table,
};

/// What has points of its own.
const KINDS: [&str; 3] = ["UnstructuredGrid", "PolyData", "StructuredGrid"];

/// The one compression that is read.
const ZLIB: &str = "vtkZLibDataCompressor";

/// Whether the root is near the beginning.
fn recognizes(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).trim_ascii_start();
    text.starts_with(b"<") && memmem::find(text, b"<VTKFile").is_some()
}

fn table(bytes: &[u8], _: &Span, request: &Request, notes: &mut Notes) -> Result<Table, Flaw> {
    let document = Document::of(bytes)?;
    document.check()?;
    let mut table = Table::default();
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    let mut left_out: Vec<&str> = Vec::new();
    for piece in &document.pieces {
        let before = table.len();
        if piece.points == 0 {
            continue;
        }
        table.positions.extend(document.positions(piece)?);
        for array in &piece.values {
            let names: Vec<String> = array.components().collect();
            if !names.iter().any(|name| request.wanted.wants(name)) {
                continue;
            }
            let Some(kind) = array.kind else {
                left_out.push(&array.name);
                continue;
            };
            for (name, mut numbers) in
                names.into_iter().zip(document.columns(array, kind, piece.points)?)
            {
                match columns.iter_mut().find(|(other, _)| *other == name) {
                    Some((_, all)) if all.len() == before => all.append(&mut numbers),
                    None if before == 0 => columns.push((name, numbers)),
                    _ => {}
                }
            }
        }
    }
    for (name, numbers) in columns {
        if numbers.len() != table.len() {
            notes.left_out(format!("{name:?}, which some pieces do not have"));
        } else if request.wanted.wants(&name) {
            table.add(name, Values::Numbers(numbers));
        }
    }
    if !left_out.is_empty() {
        notes.left_out(format!("arrays that are no numbers: {}", left_out.join(", ")));
    }
    if document.pieces.len() > 1 {
        notes.read(counted(document.pieces.len(), "piece"));
    }
    Ok(table)
}

/// What the XML says.
#[derive(Default)]
struct Document<'a> {
    kind: String,
    order: ByteOrder,
    /// Whether sizes before binary data have 64 bits.
    has_long_sizes: bool,
    compressor: Option<String>,
    pieces: Vec<Piece<'a>>,
    /// The files that it names instead of having points.
    others: Vec<String>,
    appended: Option<Appended<'a>>,
    /// Where arrays begin in what is appended.
    offsets: Vec<usize>,
}

/// A part with points of its own.
#[derive(Default)]
struct Piece<'a> {
    points: usize,
    positions: Option<Array<'a>>,
    values: Vec<Array<'a>>,
}

/// What stands behind the XML.
struct Appended<'a> {
    is_raw: bool,
    bytes: &'a [u8],
    /// Where it begins in the file.
    at: usize,
}

/// Values of points.
#[derive(Debug, Clone)]
struct Array<'a> {
    name: String,
    /// `None` where they are no numbers.
    kind: Option<NumberType>,
    count: usize,
    source: Data<'a>,
    /// Where it begins in the file.
    at: usize,
}

/// Where the values of an array are.
#[derive(Debug, Clone)]
enum Data<'a> {
    Text(&'a [u8]),
    Base64(&'a [u8]),
    /// In what is appended, from here on.
    Appended(usize),
}

/// The part of a piece that is being read.
#[derive(PartialEq, Eq)]
enum Section {
    Points,
    PointData,
    Other,
}

impl<'a> Document<'a> {
    fn of(bytes: &'a [u8]) -> Result<Self, Flaw> {
        let mut document = Self::default();
        let (xml, appended) = split(bytes);
        let mut reader = XmlReader::from_str(utf8(xml)?);
        let mut section = Section::Other;
        let mut is_in_array = false;
        loop {
            let at = reader.buffer_position() as usize;
            let event = reader.read_event().map_err(|error| {
                Flaw::needed("XML", error).at_byte(reader.error_position() as usize)
            })?;
            let is_start = matches!(event, Event::Start(_));
            match event {
                Event::Eof => break,
                Event::Start(tag) | Event::Empty(tag) => {
                    let attributes = attributes(&tag).map_err(|flaw| flaw.at_byte(at))?;
                    match tag.name().0 {
                        "Points" => section = Section::Points,
                        "PointData" => section = Section::PointData,
                        "CellData" | "Cells" | "FieldData" | "Verts" | "Lines" | "Strips"
                        | "Polys" => section = Section::Other,
                        "DataArray" => {
                            is_in_array = is_start;
                            document.start_array(&section, &attributes, at)?;
                        }
                        "AppendedData" => {
                            let is_raw =
                                attributes.get("encoding").is_none_or(|name| name == "raw");
                            let at = bytes.len() - appended.len();
                            document.appended = Some(Appended { is_raw, bytes: appended, at });
                            break;
                        }
                        name => document.start(name, &attributes, at)?,
                    }
                }
                Event::End(tag) if tag.name().0 == "DataArray" => is_in_array = false,
                Event::Text(_) if is_in_array => {
                    let text = &bytes[at..reader.buffer_position() as usize];
                    document.add_text(&section, text);
                }
                _ => {}
            }
        }
        document.offsets.sort_unstable();
        Ok(document)
    }

    /// Takes in a tag that is not about an array.
    fn start(
        &mut self,
        name: &str,
        attributes: &HashMap<String, String>,
        at: usize,
    ) -> Result<(), Flaw> {
        let get = |key: &str| attributes.get(key).map(String::as_str);
        match name {
            "VTKFile" => {
                self.kind = get("type").unwrap_or_default().to_owned();
                self.order = match get("byte_order") {
                    Some("BigEndian") => ByteOrder::Big,
                    _ => ByteOrder::Little,
                };
                self.has_long_sizes = get("header_type") == Some("UInt64");
                self.compressor =
                    get("compressor").filter(|name| !name.is_empty()).map(str::to_owned);
            }
            "Piece" | "DataSet" => {
                self.others.extend(get("Source").or(get("file")).map(str::to_owned));
                let points = get("NumberOfPoints").map(str::trim).map_or(Ok(None), |count| {
                    count.parse().map(Some).map_err(|_| {
                        Flaw::needed("NumberOfPoints", format_args!("{count:?}")).at_byte(at)
                    })
                })?;
                let points = points.or_else(|| points_of(get("Extent")?)).unwrap_or(0);
                self.pieces.push(Piece { points, ..Piece::default() });
            }
            _ => {}
        }
        Ok(())
    }

    fn start_array(
        &mut self,
        section: &Section,
        attributes: &HashMap<String, String>,
        at: usize,
    ) -> Result<(), Flaw> {
        let get = |key: &str| attributes.get(key).map(String::as_str);
        let count = |key: &str, default: usize| match get(key) {
            None => Ok(default),
            Some(count) => count.trim().parse::<usize>().map_err(|_| {
                Flaw::needed(&format!("a count as {key}"), format_args!("{count:?}")).at_byte(at)
            }),
        };
        let source = match get("format") {
            Some("appended") => {
                let offset = count("offset", 0)?;
                self.offsets.push(offset);
                Data::Appended(offset)
            }
            Some("binary") => Data::Base64(b""),
            _ => Data::Text(b""),
        };
        let Some(piece) = self.pieces.last_mut() else { return Ok(()) };
        let components = if *section == Section::Points { 3 } else { 1 };
        let array = Array {
            name: get("Name").unwrap_or("values").to_owned(),
            kind: get("type").and_then(number_type),
            count: count("NumberOfComponents", components)?.max(1),
            source,
            at,
        };
        match section {
            Section::Points => piece.positions = Some(array),
            Section::PointData => piece.values.push(array),
            Section::Other => {}
        }
        Ok(())
    }

    /// Takes in the text of the array that was started last.
    fn add_text(&mut self, section: &Section, text: &'a [u8]) {
        let Some(piece) = self.pieces.last_mut() else { return };
        let array = match section {
            Section::Points => piece.positions.as_mut(),
            Section::PointData => piece.values.last_mut(),
            Section::Other => None,
        };
        match array.map(|array| &mut array.source) {
            Some(Data::Text(all) | Data::Base64(all)) if all.trim_ascii().is_empty() => *all = text,
            _ => {}
        }
    }

    /// Refuses what has no points of its own, or is compressed in another way.
    fn check(&self) -> Result<(), Flaw> {
        if !KINDS.contains(&self.kind.as_str()) {
            let needed = format!("a VTKFile of type {}", KINDS.join(", "));
            let flaw = Flaw::needed(&needed, format_args!("{:?}", self.kind));
            return Err(match &self.others[..] {
                [] => flaw.or("only they have points of their own"),
                others => {
                    let some: Vec<&str> = others.iter().take(5).map(String::as_str).collect();
                    let more = if others.len() > 5 { ", …" } else { "" };
                    flaw.or(format!(
                        "the points are in the files that it names: give {}{more}",
                        some.join(", ")
                    ))
                }
            });
        }
        match &self.compressor {
            Some(other) if other != ZLIB => {
                let needed = format!("no compression, or the compressor {ZLIB}");
                let flaw = Flaw::needed(&needed, format_args!("{other:?}"));
                Err(flaw.or("write the file with one of these"))
            }
            _ => Ok(()),
        }
    }

    fn positions(&self, piece: &Piece<'a>) -> Result<Vec<DVec3>, Flaw> {
        let Some(array) = &piece.positions else {
            let needed = format!("an array of {} in Points", counted(piece.points, "point"));
            return Err(Flaw::needed(&needed, "none"));
        };
        let Some(kind) = array.kind.filter(|_| array.count == 3) else {
            let found = counted(array.count, "component");
            return Err(Flaw::needed("three numbers for each point", found).at_byte(array.at));
        };
        let located = |flaw: Flaw| flaw.at_byte(array.at);
        let count = piece.points.saturating_mul(3);
        if let Data::Text(text) = array.source {
            let numbers = of_text(text, count).map_err(located)?;
            let positions = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
            return binary::finite(positions).map_err(located);
        }
        let bytes = self.bytes(array, kind, count)?;
        match [0, 1, 2].map(|axis| self.numbers(&bytes, kind, axis, 3, piece.points)) {
            [Some(x), Some(y), Some(z)] => binary::positions([x, y, z]).map_err(located),
            _ => Ok(Vec::new()),
        }
    }

    /// A column for each component.
    fn columns(
        &self,
        array: &Array<'a>,
        kind: NumberType,
        points: usize,
    ) -> Result<Vec<Vec<f64>>, Flaw> {
        let count = points.saturating_mul(array.count);
        let components = 0..array.count.min(Array::COMPONENTS);
        if let Data::Text(text) = array.source {
            let numbers =
                of_text(text, count).map_err(|flaw| flaw.at_byte(array.at).at_key(&array.name))?;
            let column = |index: usize| numbers.iter().skip(index).step_by(array.count).copied();
            return Ok(components.map(|index| column(index).collect()).collect());
        }
        let bytes = self.bytes(array, kind, count)?;
        let column = |index: usize| self.numbers(&bytes, kind, index, array.count, points);
        Ok(components.filter_map(column).map(Numbers::to_vec).collect())
    }

    /// One of so many components of every point.
    fn numbers<'b>(
        &self,
        bytes: &'b [u8],
        kind: NumberType,
        component: usize,
        components: usize,
        points: usize,
    ) -> Option<Numbers<'b>> {
        let bytes = bytes.get(component * kind.size()..).unwrap_or_default();
        Numbers::new(bytes, kind, self.order, components.checked_mul(kind.size())?, points)
    }

    /// The bytes of so many numbers of an array.
    fn bytes(
        &self,
        array: &Array<'a>,
        kind: NumberType,
        count: usize,
    ) -> Result<Cow<'a, [u8]>, Flaw> {
        let located = |flaw: Flaw| flaw.at_byte(array.at).at_key(&array.name);
        let needed = count.saturating_mul(kind.size());
        let source = match array.source {
            Data::Text(text) | Data::Base64(text) => decoded(text).map_err(located)?.into(),
            Data::Appended(offset) => self.appended(offset).map_err(located)?,
        };
        let at = match (&array.source, &self.appended) {
            (Data::Appended(offset), Some(appended)) if appended.is_raw => appended.at + offset,
            _ => array.at,
        };
        let unpacked = match &self.compressor {
            Some(_) => self.unpacked(&source, needed).map(Cow::Owned),
            None => self.plain(source, needed),
        };
        unpacked.map_err(|flaw| flaw.at_byte(at).at_key(&array.name))
    }

    /// What is appended, from an offset on.
    fn appended(&self, offset: usize) -> Result<Cow<'a, [u8]>, Flaw> {
        let none = || Flaw::needed("AppendedData", "none");
        let appended = self.appended.as_ref().ok_or_else(none)?;
        let Some(rest) = appended.bytes.get(offset..) else {
            let needed = format!("an offset up to {}", appended.bytes.len());
            return Err(Flaw::needed(&needed, offset));
        };
        if appended.is_raw {
            return Ok(rest.into());
        }
        let next = self.offsets.iter().find(|other| **other > offset);
        let end = next.map_or(rest.len(), |next| next - offset).min(rest.len());
        let end = memchr::memchr(b'<', &rest[..end]).unwrap_or(end);
        decoded(&rest[..end]).map(Cow::Owned)
    }

    /// A size before binary data.
    fn size(&self, cursor: &mut Cursor<'_>) -> Result<usize, Flaw> {
        let kind = if self.has_long_sizes { NumberType::U64 } else { NumberType::U32 };
        // Sizes above 2⁵³ are far beyond those of files.
        Ok(cursor.number(kind, "a size before data")? as usize)
    }

    /// Data behind their size.
    fn plain(&self, source: Cow<'a, [u8]>, needed: usize) -> Result<Cow<'a, [u8]>, Flaw> {
        let mut cursor = Cursor::new(&source, 0, self.order);
        let found = self.size(&mut cursor)?;
        check_size(needed, found)?;
        let start = cursor.at();
        cursor.take(needed, "data")?;
        Ok(match source {
            Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[start..][..needed]),
            Cow::Owned(mut bytes) => {
                bytes.drain(..start);
                bytes.truncate(needed);
                bytes.into()
            }
        })
    }

    /// Blocks behind their number, the size of each but the last, that of the last, and what each takes
    /// when it is compressed.
    fn unpacked(&self, source: &[u8], needed: usize) -> Result<Vec<u8>, Flaw> {
        let mut cursor = Cursor::new(source, 0, self.order);
        let [blocks, size, last] = [(); 3].map(|()| self.size(&mut cursor));
        let (blocks, size, last) = (blocks?, size?, last?);
        let last = if last == 0 { size } else { last };
        let found = size.saturating_mul(blocks.saturating_sub(1)).saturating_add(last);
        check_size(needed, if blocks == 0 { 0 } else { found })?;
        let mut packed_sizes = Vec::new();
        for _ in 0..blocks {
            packed_sizes.push(self.size(&mut cursor)?);
        }
        let mut packed = Vec::new();
        for (index, packed_size) in packed_sizes.into_iter().enumerate() {
            let size = if index + 1 == blocks { last } else { size };
            packed.push((cursor.take(packed_size, "compressed data")?, size));
        }
        let blocks: Result<Vec<Vec<u8>>, Flaw> =
            packed.par_iter().map(|(packed, size)| inflated(packed, *size)).collect();
        Ok(blocks?.concat())
    }
}

fn check_size(needed: usize, found: usize) -> Result<(), Flaw> {
    if needed == found {
        return Ok(());
    }
    Err(Flaw::needed(&format!("{} of data", counted(needed, "byte")), found))
}

/// A zlib stream of so many bytes.
fn inflated(packed: &[u8], size: usize) -> Result<Vec<u8>, Flaw> {
    let mut bytes = Vec::new();
    let read = ZlibDecoder::new(packed).take(size as u64 + 1).read_to_end(&mut bytes);
    let needed = format!("a zlib stream of {}", counted(size, "byte"));
    match read {
        Err(error) => Err(Flaw::needed(&needed, error)),
        Ok(found) if found != size => Err(Flaw::needed(&needed, format_args!("one of {found}"))),
        Ok(_) => Ok(bytes),
    }
}

/// The XML up to what is appended, with its tag, and what follows the `_` behind that.
fn split(bytes: &[u8]) -> (&[u8], &[u8]) {
    let tag = memmem::find(bytes, b"<AppendedData");
    let end = tag.and_then(|tag| Some(tag + memchr::memchr(b'>', &bytes[tag..])? + 1));
    let Some(end) = end else { return (bytes, b"") };
    let rest = &bytes[end..];
    let mark = memchr::memchr(b'_', rest).map_or(rest.len(), |mark| mark + 1);
    (&bytes[..end], &rest[mark..])
}

/// The number of points of `x0 x1 y0 y1 z0 z1`.
fn points_of(extent: &str) -> Option<usize> {
    let numbers: Vec<i64> = extent.split_whitespace().map_while(|n| n.parse().ok()).collect();
    let along =
        |[low, high]: [i64; 2]| usize::try_from(high.checked_sub(low)?.checked_add(1)?).ok();
    let &[x0, x1, y0, y1, z0, z1] = &numbers[..] else { return None };
    along([x0, x1])?.checked_mul(along([y0, y1])?)?.checked_mul(along([z0, z1])?)
}

fn attributes(tag: &BytesStart<'_>) -> Result<HashMap<String, String>, Flaw> {
    let attribute = |attribute: Result<quick_xml::events::attributes::Attribute<'_>, _>| {
        let attribute = attribute.map_err(|error| Flaw::needed("attributes", error))?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        let value = value.map_err(|error| Flaw::needed("attributes", error))?;
        Ok((attribute.key.0.to_owned(), value.into_owned()))
    };
    tag.attributes().map(attribute).collect()
}

fn number_type(name: &str) -> Option<NumberType> {
    Some(match name {
        "Int8" => NumberType::I8,
        "UInt8" => NumberType::U8,
        "Int16" => NumberType::I16,
        "UInt16" => NumberType::U16,
        "Int32" => NumberType::I32,
        "UInt32" => NumberType::U32,
        "Int64" => NumberType::I64,
        "UInt64" => NumberType::U64,
        "Float32" => NumberType::F32,
        "Float64" => NumberType::F64,
        _ => return None,
    })
}

impl Array<'_> {
    /// More components than these become no columns.
    const COMPONENTS: usize = 16;

    /// What its columns are called.
    fn components(&self) -> impl Iterator<Item = String> {
        let count = if self.count <= Self::COMPONENTS { self.count } else { 0 };
        (0..count).map(|index| component(&self.name, index, self.count))
    }
}

/// Numbers with blanks between them, so many.
fn of_text(text: &[u8], count: usize) -> Result<Vec<f64>, Flaw> {
    let number = |field: &[u8]| {
        number(field, DecimalMark::Point)
            .ok_or_else(|| Flaw::needed("a number", format_args!("{:?}", word(field))))
    };
    let numbers = fields(text).map(number).collect::<Result<Vec<f64>, Flaw>>()?;
    match numbers.len() == count {
        true => Ok(numbers),
        false => Err(Flaw::needed(&counted(count, "number"), numbers.len())),
    }
}

/// Bytes of base64, of which several streams may follow each other.
fn decoded(text: &[u8]) -> Result<Vec<u8>, Flaw> {
    let text: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let mut rest = &text[..];
    while !rest.is_empty() {
        // A stream ends with the four characters that its first `=` is among.
        let end = memchr::memchr(b'=', rest).map_or(rest.len(), |padding| padding / 4 * 4 + 4);
        let end = end.min(rest.len());
        let decoded = STANDARD.decode_vec(&rest[..end], &mut bytes);
        decoded.map_err(|error| Flaw::needed("base64", error))?;
        rest = &rest[end..];
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;
    use proptest::prelude::*;

    use super::*;

    const POINTS: [f32; 6] = [0.5, 0.0, 0.0, 1.0, 2.0, 3.0];
    const HEIGHTS: [f64; 2] = [0.25, 0.75];

    /// How a file is written.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    enum Form {
        Text,
        Inline,
        Raw,
        Appended,
    }

    /// A file of one piece with two points and their heights; `sizes` are of 4 or 8 bytes.
    fn file(form: Form, order: ByteOrder, sizes: usize, is_packed: bool) -> Vec<u8> {
        let turned = |mut bytes: Vec<u8>| {
            if order == ByteOrder::Little {
                bytes.reverse();
            }
            bytes
        };
        let size = |size: usize| turned((size as u64).to_be_bytes()[8 - sizes..].to_vec());
        let blob = |data: &[u8]| -> [Vec<u8>; 2] {
            if !is_packed {
                return [[size(data.len()), data.to_vec()].concat(), Vec::new()];
            }
            let (first, second) = data.split_at(data.len() - 7);
            let packed = [first, second].map(|block| {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(block).and_then(|()| encoder.finish()).expect("a Vec takes all")
            });
            let lengths = [2, first.len(), 7, packed[0].len(), packed[1].len()].map(size);
            [lengths.concat(), packed.concat()]
        };
        let points: Vec<u8> =
            POINTS.iter().flat_map(|n| turned(n.to_be_bytes().to_vec())).collect();
        let heights: Vec<u8> =
            HEIGHTS.iter().flat_map(|n| turned(n.to_be_bytes().to_vec())).collect();
        let mut appended = Vec::new();
        let mut array = |text: &str, data: &[u8]| match form {
            Form::Text => format!("format=\"ascii\">\n {text}\n"),
            Form::Inline => {
                let [sizes, data] = blob(data);
                let text = STANDARD.encode(sizes) + &STANDARD.encode(data);
                format!(
                    "format=\"binary\">\n {text}\n <InformationKey name=\"a\"> 1 </InformationKey>"
                )
            }
            Form::Raw | Form::Appended => {
                let offset = appended.len();
                let [sizes, data] = blob(data);
                match form {
                    Form::Raw => appended.extend([sizes, data].concat()),
                    _ => appended.extend((STANDARD.encode(sizes) + &STANDARD.encode(data)).bytes()),
                }
                format!("format=\"appended\" offset=\"{offset}\">")
            }
        };
        let points = array("0.5 0 0 1 2\n3", &points);
        let heights = array("0.25 0.75", &heights);
        let endian = if order == ByteOrder::Big { "BigEndian" } else { "LittleEndian" };
        let compressor = if is_packed { format!(" compressor=\"{ZLIB}\"") } else { String::new() };
        let mut bytes = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{endian}\" \
             header_type=\"UInt{}\"{compressor}>\n<PolyData><FieldData><DataArray type=\"Float64\" \
             Name=\"time\" format=\"ascii\">7</DataArray></FieldData>\n<Piece NumberOfPoints=\"2\" \
             NumberOfVerts=\"0\">\n<Points><DataArray type=\"Float32\" Name=\"Points\" \
             NumberOfComponents=\"3\" {points}</DataArray></Points>\n<PointData Scalars=\"h\">\
             <DataArray type=\"Float64\" Name=\"a &lt; b\" {heights}</DataArray></PointData>\
             <CellData><DataArray type=\"Float32\" Name=\"c\" format=\"ascii\"/></CellData></Piece>\
             </PolyData>\n",
            8 * sizes
        )
        .into_bytes();
        if matches!(form, Form::Raw | Form::Appended) {
            let encoding = if form == Form::Raw { "raw" } else { "base64" };
            bytes.extend(format!("<AppendedData encoding=\"{encoding}\">\n_").bytes());
            bytes.extend(appended);
            bytes.extend(b"\n</AppendedData>");
        }
        bytes.extend(b"</VTKFile>");
        bytes
    }

    /// Files in all ways of writing.
    fn files() -> Vec<Vec<u8>> {
        let mut files = vec![file(Form::Text, ByteOrder::Little, 4, false)];
        for form in [Form::Inline, Form::Raw, Form::Appended] {
            for is_packed in [false, true] {
                files.push(file(form, ByteOrder::Little, 8, is_packed));
                files.push(file(form, ByteOrder::Big, 4, is_packed));
            }
        }
        files
    }

    fn read(bytes: &[u8]) -> Result<Table, Flaw> {
        table(bytes, &Span::whole(bytes), &Request::default(), &mut Notes::default())
    }

    fn refusal(bytes: &[u8]) -> String {
        read(bytes).expect_err("refused").in_file("a.vtp").to_string()
    }

    #[test]
    fn every_way_of_writing_gives_the_same_points() {
        for bytes in files() {
            assert!(recognizes(&bytes));
            let table = read(&bytes).expect("legal");
            assert_eq!(table.positions, [DVec3::new(0.5, 0.0, 0.0), DVec3::new(1.0, 2.0, 3.0)]);
            assert_eq!(table.columns.len(), 1);
            let heights = Values::Numbers(HEIGHTS.to_vec());
            assert_eq!(table.column("a < b").map(|column| &column.values), Some(&heights));
        }
    }

    fn text() -> String {
        String::from_utf8(file(Form::Text, ByteOrder::Little, 4, false)).expect("text")
    }

    #[test]
    fn pieces_are_joined() {
        let text = text();
        let (start, end) =
            (text.find("<Piece").expect("one"), text.find("</PolyData>").expect("one"));
        let piece = &text[start..end];
        let other = piece.replace("a &lt; b", "b").replace("0.5 0", "9 0");
        let table = read(text.replace(piece, &piece.repeat(2)).as_bytes()).expect("legal");
        assert_eq!((table.len(), table.columns.len()), (4, 1));
        let joined = text.replace(piece, &format!("{piece}{other}"));
        let mut notes = Notes::default();
        let table =
            super::table(joined.as_bytes(), &Span::whole(b""), &Request::default(), &mut notes);
        let table = table.expect("legal");
        assert_eq!((table.positions[2].x, table.columns.len()), (9.0, 0));
        assert!(notes.iter().any(|note| note.text.contains("which some pieces do not have")));
    }

    #[test]
    fn refusals_say_both_numbers_and_the_way_out() {
        let with = |from: &str, to: &str| refusal(text().replace(from, to).as_bytes());
        assert!(
            with("NumberOfPoints=\"2\"", "NumberOfPoints=\"3\"")
                .ends_with("needed 9 numbers, found 6")
        );
        assert!(with("1 2\n3", "1 two 3").contains("needed a number, found \"two\""));
        assert!(with("1 2\n3", "1 nan 3").contains("finite coordinates of particle 1"));
        assert!(with("</PointData>", "").contains("needed XML, found"));
        assert!(with("PolyData", "ImageData").contains("only they have points of their own"));
        assert!(with("<Points>", "<Cells>").contains("needed XML"));
        let many = "<VTKFile type=\"PUnstructuredGrid\"><Piece Source=\"a.vtu\"/><Piece Source=\"b.vtu\"/></VTKFile>";
        assert!(refusal(many.as_bytes()).ends_with("the files that it names: give a.vtu, b.vtu"));
        let lz4 = "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"></VTKFile>";
        assert!(refusal(lz4.as_bytes()).contains("or the compressor vtkZLibDataCompressor, found"));
        let text = |bytes: Vec<u8>, from: &[u8], to: &[u8]| {
            let at = memmem::find(&bytes, from).expect("is there");
            refusal(&[&bytes[..at], to, &bytes[at + from.len()..]].concat())
        };
        for form in [Form::Inline, Form::Raw, Form::Appended] {
            let bytes = |is_packed| file(form, ByteOrder::Little, 4, is_packed);
            for is_packed in [false, true] {
                let claim = text(
                    bytes(is_packed),
                    b"NumberOfPoints=\"2\"",
                    b"NumberOfPoints=\"99999999999\"",
                );
                assert!(claim.ends_with("needed 1199999999988 bytes of data, found 24"), "{claim}");
            }
        }
        let raw = file(Form::Raw, ByteOrder::Little, 4, false);
        let at = memmem::find(&raw, b"\n_").expect("is there");
        assert!(refusal(&raw[..at + 10]).contains("found the end of the file after 4"));
        assert!(text(raw, b"offset=\"0\"", b"offset=\"999\"").contains("needed an offset up to"));
    }

    #[test]
    fn streams_of_base64_may_follow_each_other() {
        assert_eq!(decoded(b"YQ==\n YmM= ZGVm"), Ok(b"abcdef".to_vec()));
        for text in ["====", "YQ=", "=", "YQ==YQ", "a b*d"] {
            assert!(decoded(text.as_bytes()).is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_mutated_file_panics(at: prop::sample::Index, byte: u8, cut: prop::sample::Index) {
            for mut bytes in files() {
                let cut = cut.index(bytes.len());
                let at = at.index(bytes.len());
                bytes[at] = byte;
                let _ = (read(&bytes), read(&bytes[..cut]));
            }
        }
    }
}
