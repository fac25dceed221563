//! Particles as their file says them, before anything is decided: positions, and a column for all else.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::DVec3;

use crate::cell::Cell;
use crate::error::{Flaw, LoadError};
use crate::notes::counted;
use crate::roles::Role;
use crate::units::Unit;

/// One frame of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// Centres, in the file's own coordinates and unit.
    pub positions: Vec<DVec3>,
    /// What else is said of each particle, each as long as `positions`.
    pub columns: Vec<Column>,
    /// Where each particle stands.
    pub lines: Lines,
    /// The periodic cell, in the same coordinates.
    pub cell: Option<Cell>,
    /// The unit of lengths, where the format has one.
    pub unit: Option<Unit>,
    /// Whether the format is one of atoms.
    pub atoms: bool,
}

/// The name of a component of something that has so many: `velocity:0`.
pub(crate) fn component(name: &str, component: usize, count: usize) -> String {
    if count == 1 { name.to_owned() } else { format!("{name}:{component}") }
}

/// Something that a file says of each particle.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// As the file calls it, or as formats of fixed columns are read: `element`, `name`, `residue`,
    /// `residue_number`, `chain`, `charge`.
    pub name: String,
    /// A value for each particle.
    pub values: Values,
}

/// The values of a [`Column`].
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; NaN where the file has none.
    Numbers(Vec<f64>),
    /// Words.
    Words(Words),
}

/// Many words, of which few differ.
#[derive(Debug, Clone, Default)]
pub struct Words {
    different: Vec<String>,
    /// For each particle the index of its word.
    indices: Vec<u32>,
    index_of: HashMap<String, u32>,
}

impl Table {
    /// The table of columns of one length, as data frames have them; those of coordinates, known by their names,
    /// become the positions.
    ///
    /// # Errors
    /// When a column has another length than the first, or an axis has no column of numbers.
    pub fn of_columns(columns: Vec<Column>) -> Result<Self, LoadError> {
        let count = columns.first().map_or(0, |column| column.values.len());
        if let Some(other) = columns.iter().find(|column| column.values.len() != count) {
            let needed = format!("{count} values as {:?} has", columns[0].name);
            return Err(Flaw::needed(&needed, other.values.len()).at_key(&other.name).into());
        }
        let mut axes: [Option<Vec<f64>>; 3] = [None, None, None];
        let mut others = Vec::new();
        for column in columns {
            let axis = Role::of(&column.name).and_then(Role::axis);
            match (axis, column.values) {
                (Some(axis), Values::Numbers(numbers)) if axes[axis].is_none() => {
                    axes[axis] = Some(numbers);
                }
                (_, values) => others.push(Column { name: column.name, values }),
            }
        }
        let [Some(x), Some(y), Some(z)] = axes else {
            let names: Vec<&str> = others.iter().map(|column| column.name.as_str()).collect();
            let found = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(Flaw::needed("columns x, y and z of numbers", found).into());
        };
        let positions = x.into_iter().zip(y).zip(z).map(|((x, y), z)| DVec3::new(x, y, z));
        Ok(Self { positions: positions.collect(), columns: others, ..Self::default() })
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The column of that name, capitals or not.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name.eq_ignore_ascii_case(name))
    }

    /// How many particles there are, in words.
    pub(crate) fn counted(&self) -> String {
        counted(self.len(), if self.atoms { "atom" } else { "particle" })
    }

    /// Adds a column.
    pub(crate) fn add(&mut self, name: impl Into<String>, values: Values) {
        debug_assert_eq!(values.len(), self.len(), "a value for each particle");
        self.columns.push(Column { name: name.into(), values });
    }

    /// The particles at these indices.
    #[must_use]
    pub(crate) fn at(&self, indices: &[usize]) -> Self {
        Self {
            positions: indices.iter().map(|index| self.positions[*index]).collect(),
            columns: self.columns.iter().map(|column| column.at(indices)).collect(),
            lines: self.lines.at(indices),
            ..*self
        }
    }
}

impl Column {
    /// The values at these indices.
    pub(crate) fn at(&self, indices: &[usize]) -> Self {
        let values = match &self.values {
            Values::Numbers(numbers) => {
                Values::Numbers(indices.iter().map(|index| numbers[*index]).collect())
            }
            Values::Words(words) => Values::Words(words.at(indices)),
        };
        Self { name: self.name.clone(), values }
    }
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Words(words) => words.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value of a particle as text: a number in the fewest digits that read back to it.
    pub fn text(&self, index: usize) -> Cow<'_, str> {
        match self {
            Self::Numbers(numbers) => numbers[index].to_string().into(),
            Self::Words(words) => words.get(index).into(),
        }
    }

    /// Puts the values of another part of the file behind these.
    pub(crate) fn append(&mut self, other: Self) {
        match (self, other) {
            (Self::Numbers(numbers), Self::Numbers(mut others)) => numbers.append(&mut others),
            (Self::Words(words), Self::Words(others)) => words.append(&others),
            (mine, _) => unreachable!("parts of one column are of one sort: {mine:?}"),
        }
    }
}

impl Words {
    /// Number of words.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there is no word.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// The word of a particle. Panics when there is none, as slices do.
    pub fn get(&self, index: usize) -> &str {
        &self.different[self.indices[index] as usize]
    }

    /// The words that there are, in the order in which they first come.
    pub fn different(&self) -> &[String] {
        &self.different
    }

    /// For each particle the index of its word in [`Words::different`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// All words, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> {
        self.indices.iter().map(|index| self.different[*index as usize].as_str())
    }

    /// The last particle's word.
    pub(crate) fn push(&mut self, word: &str) {
        // Particles that stand together often share their word.
        let last = self.indices.last().copied();
        let index = last.filter(|index| self.different[*index as usize] == word);
        let index = index.unwrap_or_else(|| self.index_of(word));
        self.indices.push(index);
    }

    fn index_of(&mut self, word: &str) -> u32 {
        if let Some(index) = self.index_of.get(word) {
            return *index;
        }
        // Positions have 24 bytes, so that memory ends before indices do.
        let index = self.different.len() as u32;
        self.different.push(word.to_owned());
        self.index_of.insert(word.to_owned(), index);
        index
    }

    pub(crate) fn append(&mut self, others: &Self) {
        let indices: Vec<u32> = others.different.iter().map(|word| self.index_of(word)).collect();
        self.indices.extend(others.indices.iter().map(|index| indices[*index as usize]));
    }

    fn at(&self, indices: &[usize]) -> Self {
        let mut words = Self::default();
        indices.iter().for_each(|index| words.push(self.get(*index)));
        words
    }
}

impl PartialEq for Words {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl<'a> FromIterator<&'a str> for Words {
    fn from_iter<I: IntoIterator<Item = &'a str>>(iterator: I) -> Self {
        let mut words = Self::default();
        iterator.into_iter().for_each(|word| words.push(word));
        words
    }
}

/// The line of each particle, counted from 1.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Lines {
    /// The file has no lines.
    #[default]
    None,
    /// One after the other, without gaps, from this one.
    From(usize),
    /// One for each particle.
    Each(Vec<usize>),
}

impl Lines {
    /// The line of a particle.
    pub fn get(&self, index: usize) -> Option<usize> {
        match self {
            Self::None => None,
            Self::From(first) => Some(first + index),
            Self::Each(lines) => lines.get(index).copied(),
        }
    }

    /// The next particle's line, after so many.
    pub(crate) fn push(&mut self, count: usize, line: usize) {
        match self {
            Self::None if count == 0 => *self = Self::From(line),
            Self::From(first) if *first + count == line => {}
            Self::Each(lines) => lines.push(line),
            Self::None => {}
            Self::From(first) => {
                let lines = (*first..*first + count).chain([line]).collect();
                *self = Self::Each(lines);
            }
        }
    }

    /// Puts the lines of so many others behind those of so many of mine.
    pub(crate) fn append(&mut self, mine: usize, others: &Self, count: usize) {
        (0..count)
            .filter_map(|index| Some((index, others.get(index)?)))
            .for_each(|(index, line)| self.push(mine + index, line));
    }

    /// The lines at these indices.
    pub(crate) fn at(&self, indices: &[usize]) -> Self {
        match self {
            Self::None => Self::None,
            _ => Self::Each(indices.iter().filter_map(|index| self.get(*index)).collect()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_coordinates_become_positions() {
        let column = |name: &str, numbers: &[f64]| Column {
            name: name.to_owned(),
            values: Values::Numbers(numbers.to_vec()),
        };
        let (x, y, z) =
            (column("Pos X", &[1.0, 2.0]), column("y", &[3.0; 2]), column("z", &[4.0; 2]));
        let all = vec![column("mass", &[5.0; 2]), z.clone(), x.clone(), y.clone()];
        let table = Table::of_columns(all).expect("three axes");
        assert_eq!(table.positions, [DVec3::new(1.0, 3.0, 4.0), DVec3::new(2.0, 3.0, 4.0)]);
        assert_eq!(table.columns, [column("mass", &[5.0; 2])]);
        let refused = |columns| Table::of_columns(columns).expect_err("refused").to_string();
        assert_eq!(
            refused(vec![x.clone(), z.clone()]),
            "needed columns x, y and z of numbers, found none"
        );
        let longer = refused(vec![x, y, z, column("mass", &[1.0; 3])]);
        assert!(longer.contains("mass") && longer.ends_with("found 3"), "{longer}");
    }

    #[test]
    fn lines_without_gaps_are_one_number() {
        let mut lines = Lines::default();
        for (count, line) in [(0, 3), (1, 4), (2, 5)] {
            lines.push(count, line);
        }
        assert_eq!(lines, Lines::From(3));
        let mut joined = lines.clone();
        joined.append(3, &Lines::From(6), 2);
        assert_eq!(joined, Lines::From(3));
        lines.push(3, 9);
        assert_eq!(lines, Lines::Each(vec![3, 4, 5, 9]));
        assert_eq!((lines.get(3), lines.get(4)), (Some(9), None));
    }

    #[test]
    fn words_are_kept_once() {
        let mut words: Words = ["O", "H", "H", "O"].into_iter().collect();
        words.append(&["C", "H"].into_iter().collect());
        assert_eq!(words.different(), ["O", "H", "C"]);
        assert_eq!(words.iter().collect::<Vec<_>>(), ["O", "H", "H", "O", "C", "H"]);
        assert_eq!(words.at(&[4, 0]), ["C", "O"].into_iter().collect());
    }
}
