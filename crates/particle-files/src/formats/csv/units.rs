//! Units that the names of a table's columns have.

use super::axis_of;
use super::top::number_of;
use crate::notes::Notes;
use crate::roles::Role;
use crate::table::{Table, Values};
use crate::units::Unit;

/// Units of length in metres.
const LENGTHS: &[(&str, f64)] = &[
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("um", 1e-6),
    ("µm", 1e-6),
    ("μm", 1e-6),
    ("nm", 1e-9),
    ("km", 1e3),
    ("angstrom", 1e-10),
    ("Å", 1e-10),
    ("A", 1e-10),
];

/// The unit of length that a name has in brackets, or behind a low line or a slash, with its metres.
fn unit_of(name: &str) -> Option<(&'static str, f64)> {
    let name = name.trim().trim_end_matches([']', ')', '}']);
    let (_, unit) = name.rsplit_once(['[', '(', '{', '_', '/'])?;
    LENGTHS.iter().copied().find(|(own, _)| *own == unit.trim())
}

/// The unit of the coordinates by the name of x, and sizes brought to it, where their names say that they
/// have another.
pub(super) fn of_coordinates(names: &[String], table: &mut Table, notes: &mut Notes) {
    let x = names.iter().find(|name| axis_of(name) == Some(0));
    let Some((unit, metres)) = x.and_then(|name| unit_of(name)) else { return };
    table.unit = match unit {
        "nm" => Some(Unit::Nanometre),
        "angstrom" | "Å" | "A" => Some(Unit::Angstrom),
        "m" => Some(Unit::Metre),
        _ => None,
    };
    for column in &mut table.columns {
        let is_size = matches!(
            Role::of(&column.name),
            Some(Role::Radius | Role::Diameter | Role::SupportRadius | Role::SmoothingLength)
        );
        let own = unit_of(&column.name).filter(|(_, own)| is_size && *own != metres);
        if let (Some((own, own_metres)), Values::Numbers(numbers)) = (own, &mut column.values) {
            numbers.iter_mut().for_each(|number| *number *= own_metres / metres);
            notes.changed(format!("{:?} from {own} to {unit}, as x is in", column.name));
        }
    }
}

/// Whether the fields below names are units: none is a number, all are short, and one is a length.
pub(super) fn are_units(row: &[String]) -> bool {
    let bare = |field: &String| field.trim_matches(['[', ']', '(', ')', ' ']).to_owned();
    row.len() >= 3
        && row.iter().all(|field| number_of(field).is_none() && field.chars().count() <= 12)
        && row.iter().any(|field| LENGTHS.iter().any(|(unit, _)| *unit == bare(field)))
}

/// Puts units in brackets behind the names.
pub(super) fn add(names: &mut [String], units: &[String]) {
    for (name, unit) in names.iter_mut().zip(units) {
        let unit = unit.trim_matches(['[', ']', '(', ')', ' ']);
        if !unit.is_empty() && !name.is_empty() {
            *name = format!("{name} [{unit}]");
        }
    }
}
