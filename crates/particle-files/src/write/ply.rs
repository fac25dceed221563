//! Binary PLY.

use std::io::{self, Write};

use super::{numbers_of, one_word};
use crate::notes::Notes;
use crate::table::Table;

/// A header, then x, y, z and the columns of numbers as little-endian f64.
pub(super) fn write(table: &Table, to: &mut impl Write, notes: &mut Notes) -> io::Result<()> {
    let columns = numbers_of(table, notes);
    write!(to, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", table.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(to, "property double {axis}")?;
    }
    for (name, _) in &columns {
        // A colon is no part of a word elsewhere, but is one here.
        let name: Vec<String> = name.split(':').map(one_word).collect();
        writeln!(to, "property double {}", name.join(":"))?;
    }
    writeln!(to, "end_header")?;
    for (index, position) in table.positions.iter().enumerate() {
        position.to_array().iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))?;
        columns.iter().try_for_each(|(_, values)| to.write_all(&values[index].to_le_bytes()))?;
    }
    Ok(())
}
