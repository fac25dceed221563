//! Colours by what a file says of its particles.

use std::fmt;
use std::str::FromStr;

use metaball_core::Color;

use crate::elements::{Element, element_of_label};
use crate::error::{Flaw, LoadError};
use crate::notes::{Notes, counted};
use crate::options::parameter;
use crate::roles::Role;
use crate::select::column_for;
use crate::table::{Table, Values};

/// The colour of atoms of no known element, and of particles without a value.
pub(crate) const UNKNOWN: Color = Color::srgb(190, 190, 190);

/// Colours that are easily told apart (Okabe and Ito 2008, without black), for words.
const PALETTE: [Color; 7] = [
    Color::srgb(230, 159, 0),
    Color::srgb(86, 180, 233),
    Color::srgb(0, 158, 115),
    Color::srgb(240, 228, 66),
    Color::srgb(0, 114, 178),
    Color::srgb(213, 94, 0),
    Color::srgb(204, 121, 167),
];

/// What colours say.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// The column's name.
    pub title: String,
    /// The entries.
    pub scale: Scale,
}

/// How a [`Legend`] goes from values to colours.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// Viridis (Smith and van der Walt 2015) from the first value to the second.
    Numbers(f64, f64),
    /// A colour for each word.
    Words(Vec<(String, Color)>),
}

/// A column that gives particles their colours.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorBy {
    /// The column's name.
    pub name: String,
    /// The values at both ends of the colour map; the least and the greatest where this is `None`.
    pub range: Option<(f64, f64)>,
}

impl FromStr for ColorBy {
    type Err = LoadError;

    /// `NAME` or `NAME=FROM..TO`.
    fn from_str(text: &str) -> Result<Self, LoadError> {
        let refused = || parameter("color by", "NAME or NAME=FROM..TO", format_args!("{text:?}"));
        let Some((name, range)) = text.split_once('=') else {
            return Ok(Self { name: text.to_owned(), range: None });
        };
        let (from, to) = range.split_once("..").ok_or_else(refused)?;
        let from: f64 = from.trim().parse().map_err(|_| refused())?;
        let to: f64 = to.trim().parse().map_err(|_| refused())?;
        if name.is_empty() || !(from.is_finite() && to.is_finite() && from < to) {
            return Err(refused());
        }
        Ok(Self { name: name.to_owned(), range: Some((from, to)) })
    }
}

impl fmt::Display for ColorBy {
    /// As [`ColorBy::from_str`] reads it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.range {
            Some((from, to)) => write!(formatter, "{}={from}..{to}", self.name),
            None => formatter.write_str(&self.name),
        }
    }
}

/// The colours of particles by a column, and what they say.
pub(crate) fn colors(
    table: &Table,
    by: &ColorBy,
    notes: &mut Notes,
) -> Result<(Vec<Color>, Legend), Flaw> {
    let column = column_for(table, &by.name, "to colour by")?;
    let (colors, scale) = match &column.values {
        Values::Numbers(numbers) => {
            let (from, to) = by.range.unwrap_or_else(|| range_of(numbers));
            notes.read(format!("colours by {:?} from {from} to {to}", column.name));
            let missing = numbers.iter().filter(|number| number.is_nan()).count();
            if missing > 0 {
                notes.guessed(format!("{} without a value are grey", counted(missing, "particle")));
            }
            let at = |number: &f64| color_at(*number, from, to);
            (numbers.iter().map(at).collect(), Scale::Numbers(from, to))
        }
        Values::Words(words) => {
            let is_element = Role::of(&column.name) == Some(Role::Element);
            let of_word = |(index, word): (usize, &String)| match is_element {
                true => element_of_label(word).map_or(UNKNOWN, Element::color),
                false => PALETTE[index % PALETTE.len()],
            };
            let each: Vec<Color> = words.different().iter().enumerate().map(of_word).collect();
            notes.read(format!("colours by {:?}", column.name));
            if !is_element && each.len() > PALETTE.len() {
                let colors = PALETTE.len();
                notes.guessed(format!("{} words share {colors} colours", each.len()));
            }
            let colors = words.indices().iter().map(|index| each[*index as usize]).collect();
            (colors, Scale::Words(words.different().iter().cloned().zip(each).collect()))
        }
    };
    Ok((colors, Legend { title: column.name.clone(), scale }))
}

/// The least and the greatest number that is one.
fn range_of(numbers: &[f64]) -> (f64, f64) {
    let finite = || numbers.iter().copied().filter(|number| number.is_finite());
    let (from, to) =
        (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    match from < to {
        true => (from, to),
        false if from.is_finite() => (from - 0.5, from + 0.5),
        false => (0.0, 1.0),
    }
}

/// The colour of a value; beyond the ends that of the end, grey where it is NaN.
fn color_at(number: f64, from: f64, to: f64) -> Color {
    if number.is_nan() {
        return UNKNOWN;
    }
    let part = ((number - from) / (to - from)).clamp(0.0, 1.0);
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_continuous(part);
    Color::srgb(r, g, b)
}

impl Legend {
    /// The colour that a value has in the legend, from its least (0) to its greatest (1).
    pub fn color_at(part: f64) -> Color {
        color_at(part, 0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn colored(values: Values, by: &str) -> (Vec<Color>, Scale) {
        let mut table = Table { positions: vec![DVec3::ZERO; values.len()], ..Table::default() };
        table.add("value", values);
        let by = by.parse().expect("legal");
        let (colors, legend) = colors(&table, &by, &mut Notes::default()).expect("legal");
        (colors, legend.scale)
    }

    #[test]
    fn numbers_have_the_colours_of_a_map() {
        let numbers = Values::Numbers(vec![3.0, 1.0, f64::NAN, 2.0]);
        let (colors, scale) = colored(numbers.clone(), "value");
        assert_eq!(scale, Scale::Numbers(1.0, 3.0));
        let ends = [Legend::color_at(1.0), Legend::color_at(0.0), UNKNOWN, Legend::color_at(0.5)];
        assert_eq!(colors, ends);
        let (colors, _) = colored(numbers, "value=2..3");
        assert_eq!(colors[1], colors[3]);
    }

    #[test]
    fn words_have_a_colour_each() {
        let words = Values::Words(["A", "B", "A"].into_iter().collect());
        let (colors, scale) = colored(words, "VALUE");
        assert!(colors[0] == colors[2] && colors[0] != colors[1]);
        assert_eq!(scale, Scale::Words(vec![("A".into(), colors[0]), ("B".into(), colors[1])]));
    }

    #[test]
    fn what_is_no_column_is_refused() {
        let table = Table::default();
        let by = "mass".parse().expect("legal");
        let flaw = colors(&table, &by, &mut Notes::default()).expect_err("refused");
        assert_eq!(flaw.problem, "needed a column \"mass\" to colour by, found none");
        for text in ["mass=", "mass=1", "mass=2..1", "=1..2", "mass=a..b"] {
            assert!(text.parse::<ColorBy>().is_err(), "{text}");
        }
    }
}
