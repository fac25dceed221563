//! NumPy arrays, format version 1.0 or 2.0 (NEP 1).

use std::io::{self, Write};

use crate::table::{Table, Values};

/// An n × 3 array of f64; or, where there are columns, a structured one with a field for each.
pub(super) fn write(table: &Table, to: &mut impl Write) -> io::Result<()> {
    let count = table.len();
    if table.columns.is_empty() {
        head(&format!("'<f8', 'fortran_order': False, 'shape': ({count}, 3)"), to)?;
        return table.positions.iter().try_for_each(|position| {
            position.to_array().iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))
        });
    }
    let widths: Vec<usize> = table.columns.iter().map(|column| width(&column.values)).collect();
    let mut fields: Vec<String> = ["x", "y", "z"].map(|axis| format!("('{axis}', '<f8')")).to_vec();
    for (column, width) in table.columns.iter().zip(&widths) {
        let name = column.name.replace(['\'', '\\', '\n'], "_");
        fields.push(match column.values {
            Values::Numbers(_) => format!("('{name}', '<f8')"),
            Values::Words(_) => format!("('{name}', '<U{width}')"),
        });
    }
    head(&format!("[{}], 'fortran_order': False, 'shape': ({count},)", fields.join(", ")), to)?;
    for (index, position) in table.positions.iter().enumerate() {
        position.to_array().iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))?;
        for (column, width) in table.columns.iter().zip(&widths) {
            match &column.values {
                Values::Numbers(numbers) => to.write_all(&numbers[index].to_le_bytes())?,
                Values::Words(words) => {
                    let letters = words.get(index).chars().map(u32::from);
                    let padded = letters.chain(std::iter::repeat(0)).take(*width);
                    padded
                        .into_iter()
                        .try_for_each(|letter| to.write_all(&letter.to_le_bytes()))?;
                }
            }
        }
    }
    Ok(())
}

/// Letters of the longest word, at least one.
fn width(values: &Values) -> usize {
    match values {
        Values::Numbers(_) => 0,
        Values::Words(words) => {
            words.different().iter().map(|word| word.chars().count()).max().unwrap_or(0).max(1)
        }
    }
}

/// Magic, version, and the description, padded so that data starts at a multiple of 64 bytes.
fn head(description: &str, to: &mut impl Write) -> io::Result<()> {
    let text = format!("{{'descr': {description}, }}");
    // Version 2 has a length of four bytes, and is for descriptions that two cannot hold.
    let is_long = text.len() + 128 > usize::from(u16::MAX);
    let before = if is_long { 12 } else { 10 };
    let length = (before + text.len() + 1).next_multiple_of(64) - before;
    to.write_all(b"\x93NUMPY")?;
    if is_long {
        to.write_all(&[2, 0])?;
        to.write_all(&(length as u32).to_le_bytes())?;
    } else {
        to.write_all(&[1, 0])?;
        to.write_all(&(length as u16).to_le_bytes())?;
    }
    writeln!(to, "{text:<width$}", width = length - 1)
}
