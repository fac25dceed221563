//! From columns to particles: what they are, how large and of what colour.

use metaball_core::Color;

use crate::coloring;
use crate::elements::{Element, element_of_label, is_ghost};
use crate::error::Flaw;
use crate::formula::Formula;
use crate::notes::{Notes, counted};
use crate::options::{ReadOptions, Substance};
use crate::particles::Particles;
use crate::roles::Role;
use crate::sizes::Sizing;
use crate::spacing::median_spacing;
use crate::table::{Column, Table, Values};
use crate::units::Unit;

/// The particles of a frame, whose field a formula may make.
pub(crate) fn particles(
    table: Table,
    options: &ReadOptions,
    formula: Option<Formula>,
    mut notes: Notes,
) -> Result<Particles, Flaw> {
    let table = options.selection.of(table, &mut notes)?;
    let mut table = without_ghosts(table, options, &mut notes);
    let elements = elements_of(&table.columns);
    let spacing = std::cell::OnceCell::new();
    let spaced = |table: &Table| *spacing.get_or_init(|| median_spacing(&table.positions));
    let unit = options.units.or(table.unit);
    let to_angstroms = unit.map_or(1.0, Unit::angstroms);
    let is_fluid = options.substance.is_none() && formula.is_some_and(Formula::is_of_fluids);
    let substance = match is_fluid {
        true => Substance::Particles,
        false => substance(&table, &elements, options, to_angstroms, &spaced, &mut notes)?,
    };
    let mut scale = 1.0;
    if substance == Substance::Molecule && to_angstroms != 1.0 {
        scale = to_angstroms;
        notes.changed(format!("lengths from {} to ångströms", unit.unwrap_or(Unit::Angstrom)));
        table.positions.iter_mut().for_each(|position| *position *= scale);
        table.cell = table.cell.map(|cell| cell.scaled(scale));
    }
    let spaced = || spaced(&table).map(|spacing| spacing * scale);
    let sizing = Sizing { table: &table, elements: &elements, substance, options, formula, scale };
    let sizes = sizing.sizes(spaced, &mut notes)?;
    let strengths =
        numbers(&table.columns, Role::Strength).map(|(_, q)| q.iter().map(|q| *q as f32).collect());
    let (mut colors, legend) = match &options.color_by {
        Some(by) => {
            let (colors, legend) = coloring::colors(&table, by, &mut notes)?;
            (Some(colors), Some(legend))
        }
        None => (colors_of_columns(&table, &mut notes)?, None),
    };
    if colors.is_none() && substance == Substance::Molecule {
        colors = Some(
            elements
                .iter()
                .map(|element| element.map_or(coloring::UNKNOWN, Element::color))
                .collect(),
        );
    }
    Ok(Particles {
        sizes,
        strengths,
        colors,
        legend,
        positions: table.positions,
        columns: table.columns,
        cell: table.cell,
        is_periodic: false,
        file: None,
        lines: table.lines,
        notes,
    })
}

/// The first column of a role.
pub(crate) fn column_of(columns: &[Column], role: Role) -> Option<&Column> {
    columns.iter().find(|column| Role::of(&column.name) == Some(role))
}

/// The first column of a role, if it is one of numbers.
pub(crate) fn numbers(columns: &[Column], role: Role) -> Option<(&str, &[f64])> {
    match column_of(columns, role)? {
        Column { name, values: Values::Numbers(numbers) } => Some((name, numbers)),
        _ => None,
    }
}

/// The particles without ghosts, if all others are elements.
fn without_ghosts(table: Table, options: &ReadOptions, notes: &mut Notes) -> Table {
    let Some(Values::Words(words)) =
        column_of(&table.columns, Role::Element).map(|column| &column.values)
    else {
        return table;
    };
    let is_atom = |word: &String| element_of_label(word).is_some();
    let each: Vec<bool> = words.different().iter().map(|word| is_ghost(word)).collect();
    let are_atoms = || words.different().iter().all(|word| is_ghost(word) || is_atom(word));
    let atoms = words.different().iter().filter(|word| is_atom(word)).count();
    let is_kept = options.substance == Some(Substance::Particles) || table.atoms;
    if is_kept || atoms == 0 || !each.contains(&true) || !are_atoms() {
        return table;
    }
    let name = words.different().iter().find(|word| is_ghost(word)).cloned().unwrap_or_default();
    let is_ghost = |index: &usize| each[words.indices()[*index] as usize];
    let kept: Vec<usize> = (0..table.len()).filter(|index| !is_ghost(index)).collect();
    let ghosts = counted(table.len() - kept.len(), "ghost atom");
    notes.left_out(format!("{ghosts} ({name}; --as particles draws all)"));
    table.at(&kept)
}

/// The element of each particle, by the column of elements; empty where there is none.
pub(crate) fn elements_of(columns: &[Column]) -> Vec<Option<Element>> {
    match column_of(columns, Role::Element).map(|column| &column.values) {
        Some(Values::Words(words)) => {
            let each: Vec<_> =
                words.different().iter().map(|word| element_of_label(word)).collect();
            words.indices().iter().map(|index| each[*index as usize]).collect()
        }
        Some(Values::Numbers(numbers)) => {
            let element = |number: &f64| element_of_label(&number.to_string());
            numbers.iter().map(element).collect()
        }
        None => Vec::new(),
    }
}

/// Whether the words for elements are the numbers from 1 on that simulation programs give their types.
fn are_types(table: &Table) -> bool {
    let Some(Values::Words(words)) =
        column_of(&table.columns, Role::Element).map(|column| &column.values)
    else {
        return false;
    };
    let mut numbers: Vec<usize> =
        words.different().iter().filter_map(|word| word.parse().ok()).collect();
    numbers.sort_unstable();
    numbers.len() > 1
        && numbers.len() == words.different().len()
        && numbers.iter().copied().eq(1..=numbers.len())
}

/// What the particles are.
fn substance(
    table: &Table,
    elements: &[Option<Element>],
    options: &ReadOptions,
    to_angstroms: f64,
    spacing: &impl Fn(&Table) -> Option<f64>,
    notes: &mut Notes,
) -> Result<Substance, Flaw> {
    let unknown = elements.iter().position(Option::is_none);
    if let Some(substance) = options.substance {
        if substance == Substance::Molecule
            && (elements.is_empty() || unknown.is_some())
            && !table.atoms
        {
            let line = unknown.and_then(|index| table.lines.get(index));
            let found = match (column_of(&table.columns, Role::Element), unknown) {
                (Some(column), Some(index)) => format!("{:?}", column.values.text(index)),
                _ => "none".to_owned(),
            };
            let mut flaw = Flaw::needed("an element for every atom of a molecule", found);
            flaw.location.line = line;
            return Err(flaw);
        }
        return Ok(substance);
    }
    if table.atoms {
        let known = elements.iter().flatten().count();
        if 2 * known >= table.len() {
            return Ok(Substance::Molecule);
        }
        notes.guessed(format!(
            "taken as particles: {} of {} have a known element, as in coarse-grained models \
             (--as molecule says otherwise)",
            known,
            counted(table.len(), "atom")
        ));
        return Ok(Substance::Particles);
    }
    if elements.is_empty() || unknown.is_some() {
        if let (Some(index), Some(column)) = (unknown, column_of(&table.columns, Role::Element)) {
            notes.guessed(format!(
                "taken as particles: {:?} is no element (--as molecule needs elements)",
                column.values.text(index)
            ));
        }
        return Ok(Substance::Particles);
    }
    if are_types(table) {
        notes.guessed(
            "taken as particles: numbers from 1 on are types, not elements (--as molecule takes them as \
             atomic numbers)",
        );
        return Ok(Substance::Particles);
    }
    let spacing = spacing(table).map(|spacing| spacing * to_angstroms);
    match spacing {
        Some(spacing) if !are_apart(elements, spacing) => {
            notes.guessed(format!(
                "taken as particles: neighbours {spacing:.3} apart are closer than atoms in ångströms are \
                 (--units nm or --as molecule says otherwise)"
            ));
            Ok(Substance::Particles)
        }
        _ => {
            notes.guessed("taken as a molecule: all are elements (--as particles says otherwise)");
            Ok(Substance::Molecule)
        }
    }
}

/// Whether particles so far apart, in ångströms, can be atoms: the shortest bonds (H–H, C≡O) have 0.6 of
/// the van der Waals radii of their atoms.
fn are_apart(elements: &[Option<Element>], spacing: f64) -> bool {
    let radii = elements.iter().flatten().map(|element| f64::from(element.van_der_waals_radius()));
    spacing > 0.4 * radii.sum::<f64>() / elements.len() as f64
}

/// The colours of columns red, green and blue: sRGB-encoded, from 0 to 1, or from 0 to 255.
fn colors_of_columns(table: &Table, notes: &mut Notes) -> Result<Option<Vec<Color>>, Flaw> {
    let channels = [Role::Red, Role::Green, Role::Blue].map(|role| numbers(&table.columns, role));
    let [Some(red), Some(green), Some(blue)] = channels else {
        let missing = channels.iter().position(Option::is_none);
        return match (channels.iter().any(Option::is_some), missing) {
            (true, Some(missing)) => {
                let needed = format!(
                    "a column {:?} beside the other two",
                    ["red", "green", "blue"][missing]
                );
                Err(Flaw::needed(&needed, "none"))
            }
            _ => Ok(None),
        };
    };
    let greatest =
        [red, green, blue].iter().flat_map(|(_, values)| *values).copied().fold(0.0, f64::max);
    let most = if greatest > 1.0 { 255.0 } else { 1.0 };
    if most == 255.0 {
        notes.guessed("colours from 0 to 255, since one is above 1");
    }
    for (name, values) in [red, green, blue] {
        if let Some(index) = values.iter().position(|value| !(0.0..=most).contains(value)) {
            let needed = format!("a colour channel from 0 to {most}");
            let mut flaw = Flaw::needed(&needed, values[index]).at_key(name);
            flaw.location.line = table.lines.get(index);
            return Err(flaw);
        }
    }
    let byte = |value: f64| (255.0 * value / most).round() as u8;
    let colors = red.1.iter().zip(green.1).zip(blue.1);
    let colors =
        colors.map(|((red, green), blue)| Color::srgb(byte(*red), byte(*green), byte(*blue)));
    Ok(Some(colors.collect()))
}
