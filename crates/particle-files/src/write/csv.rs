//! Tables with commas.

use std::io::{self, Write};

use crate::table::{Table, Values};

/// A line of names, then a line for each particle.
pub(super) fn write(table: &Table, to: &mut impl Write) -> io::Result<()> {
    write!(to, "x,y,z")?;
    for column in &table.columns {
        write!(to, ",{}", quoted(&column.name))?;
    }
    writeln!(to)?;
    for (index, position) in table.positions.iter().enumerate() {
        write!(to, "{},{},{}", position.x, position.y, position.z)?;
        for column in &table.columns {
            match &column.values {
                Values::Numbers(numbers) if numbers[index].is_nan() => write!(to, ",")?,
                Values::Numbers(numbers) => write!(to, ",{}", numbers[index])?,
                Values::Words(words) => write!(to, ",{}", quoted(words.get(index)))?,
            }
        }
        writeln!(to)?;
    }
    Ok(())
}

/// A field in quotes, if it would be another without them.
fn quoted(word: &str) -> String {
    let word = word.replace(['\n', '\r'], " ");
    if word.contains([',', ';', '"', '\t']) || word.starts_with(['#', '%', ' ']) {
        format!("\"{}\"", word.replace('"', "\"\""))
    } else {
        word
    }
}
