//! Extended XYZ.

use std::io::{self, Write};

use glam::DVec3;

use super::one_word;
use crate::cell::Cell;
use crate::notes::{Notes, counted};
use crate::roles::Role;
use crate::table::{Column, Table, Values};

/// A count, a comment with the cell and the columns, and a line for each particle.
pub(super) fn write(table: &Table, to: &mut impl Write, notes: &mut Notes) -> io::Result<()> {
    writeln!(to, "{}", table.len())?;
    if let Some(cell) = &table.cell {
        write!(to, "{} ", lattice(cell))?;
    }
    let is_species = |column: &&Column| {
        Role::of(&column.name) == Some(Role::Element) && matches!(column.values, Values::Words(_))
    };
    let species = table.columns.iter().find(is_species);
    let others: Vec<&Column> = table
        .columns
        .iter()
        .filter(|column| species.is_none_or(|species| !std::ptr::eq(*column, species)))
        .collect();
    let first = if species.is_some() { "species:S:1:" } else { "" };
    writeln!(to, "Properties={first}pos:R:3{}", properties(&others))?;
    let mut joined = 0;
    for (index, position) in table.positions.iter().enumerate() {
        if let Some(Column { values: Values::Words(words), .. }) = species {
            write!(to, "{} ", blankless(words.get(index), &mut joined))?;
        }
        write!(to, "{} {} {}", position.x, position.y, position.z)?;
        for column in &others {
            match &column.values {
                Values::Numbers(numbers) => write!(to, " {}", numbers[index])?,
                Values::Words(words) => {
                    write!(to, " {}", blankless(words.get(index), &mut joined))?;
                }
            }
        }
        writeln!(to)?;
    }
    if joined > 0 {
        notes.changed(format!("{} with blanks or empty: written with _", counted(joined, "word")));
    }
    Ok(())
}

fn lattice(cell: &Cell) -> String {
    let numbers = |points: &[DVec3]| {
        let numbers = points.iter().flat_map(DVec3::to_array);
        numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
    };
    let flags = cell.periodic.map(|periodic| if periodic { "T" } else { "F" }).join(" ");
    let (edges, origin) = (numbers(&cell.edges), numbers(&[cell.origin]));
    format!("Lattice=\"{edges}\" Origin=\"{origin}\" pbc=\"{flags}\"")
}

/// `:name:type:count` for each column; components `name:0`, `name:1`, … that follow each other are one.
fn properties(columns: &[&Column]) -> String {
    let mut properties = String::new();
    let mut rest = columns;
    while let Some(column) = rest.first() {
        let kind = match column.values {
            Values::Numbers(_) => "R",
            Values::Words(_) => "S",
        };
        let base = column.name.strip_suffix(":0").filter(|_| kind == "R");
        let components = base.map_or(1, |base| {
            let is_next = |(index, column): (usize, &&&Column)| {
                column.name == format!("{base}:{index}")
                    && matches!(column.values, Values::Numbers(_))
            };
            rest.iter().enumerate().take_while(|pair| is_next((pair.0, &pair.1))).count()
        });
        // A single component keeps its name.
        let name = if components > 1 { base.unwrap_or(&column.name) } else { &column.name };
        properties.push_str(&format!(":{}:{kind}:{components}", one_word(name)));
        rest = &rest[components..];
    }
    properties
}

fn blankless(word: &str, joined: &mut usize) -> String {
    let one = if word.is_empty() { "_".to_owned() } else { word.replace(char::is_whitespace, "_") };
    *joined += usize::from(one != word);
    one
}
