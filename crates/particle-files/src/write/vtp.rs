//! VTK's XML format of points (PolyData).

use std::io::{self, Write};

use super::numbers_of;
use crate::notes::Notes;
use crate::table::Table;

/// Points, a vertex for each, and the columns of numbers, as little-endian arrays behind the description
/// (`AppendedData`, `raw`), each after its length in bytes as u64.
pub(super) fn write(table: &Table, to: &mut impl Write, notes: &mut Notes) -> io::Result<()> {
    let columns = numbers_of(table, notes);
    let count = table.len();
    let mut offset = 0;
    let mut array = |attributes: &str, bytes: usize| {
        let start = offset;
        offset += 8 + bytes;
        format!("<DataArray {attributes} format=\"appended\" offset=\"{start}\"/>\n")
    };
    let points = array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", 24 * count);
    let data: String = columns
        .iter()
        .map(|(name, _)| array(&format!("type=\"Float64\" Name=\"{}\"", escaped(name)), 8 * count))
        .collect();
    let verts = array("type=\"Int64\" Name=\"connectivity\"", 8 * count)
        + &array("type=\"Int64\" Name=\"offsets\"", 8 * count);
    write!(
        to,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{count}\" \
         NumberOfVerts=\"{count}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n\
         <PointData>\n{data}</PointData>\n<Points>\n{points}</Points>\n<Verts>\n{verts}</Verts>\n\
         </Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_"
    )?;
    to.write_all(&(24 * count as u64).to_le_bytes())?;
    for position in &table.positions {
        position.to_array().iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))?;
    }
    let length = (8 * count as u64).to_le_bytes();
    for (_, values) in columns {
        to.write_all(&length)?;
        values.iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))?;
    }
    for first in [0, 1] {
        to.write_all(&length)?;
        (first..first + count as i64).try_for_each(|index| to.write_all(&index.to_le_bytes()))?;
    }
    to.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
