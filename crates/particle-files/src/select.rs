//! Which particles of a file are kept.

use std::fmt;
use std::str::FromStr;

use crate::atom_names::WATER;
use crate::error::{Flaw, LoadError};
use crate::notes::{Notes, counted};
use crate::options::parameter;
use crate::roles::Role;
use crate::table::{Column, Table, Values};

/// Rules about which particles are kept: those of any rule to keep (all where there is none), without
/// those of any rule to drop.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Selection {
    /// Which to keep.
    pub keep: Vec<Rule>,
    /// Which to drop.
    pub drop: Vec<Rule>,
}

/// Some particles, by what a column says of them: `residue=HOH,WAT`, `type=1`, `mass=0.5..2`, or `water`
/// or `hydrogen`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// As the user writes it.
    text: String,
    column: String,
    matches: Matches,
}

#[derive(Debug, Clone, PartialEq)]
enum Matches {
    /// One of these words, or numbers.
    AnyOf(Vec<String>),
    /// A number from the first to the second, both included.
    Range(f64, f64),
}

impl FromStr for Rule {
    type Err = LoadError;

    fn from_str(text: &str) -> Result<Self, LoadError> {
        let rule = |column: &str, matches| {
            Ok(Self { text: text.to_owned(), column: column.trim().to_owned(), matches })
        };
        let words =
            |words: &[&str]| Matches::AnyOf(words.iter().map(|word| (*word).to_owned()).collect());
        match text {
            "water" => return rule("residue", words(&WATER)),
            "hydrogen" => return rule("element", words(&["H", "D", "T"])),
            _ => {}
        }
        let refused = || {
            let needed = "water, hydrogen, COLUMN=VALUE,… or COLUMN=FROM..TO";
            parameter("selection", needed, format_args!("{text:?}"))
        };
        let (column, values) = text.split_once('=').ok_or_else(refused)?;
        if column.trim().is_empty() || values.is_empty() {
            return Err(refused());
        }
        if let Some((from, to)) = values.split_once("..") {
            let bound = |bound: &str, open: f64| match bound.trim() {
                "" => Some(open),
                bound => bound.parse().ok(),
            };
            let from = bound(from, f64::NEG_INFINITY);
            let range = from.zip(bound(to, f64::INFINITY)).filter(|(from, to)| from <= to);
            let (from, to) = range.ok_or_else(refused)?;
            return rule(column, Matches::Range(from, to));
        }
        rule(column, words(&values.split(',').map(str::trim).collect::<Vec<_>>()))
    }
}

impl fmt::Display for Rule {
    /// As [`Rule::from_str`] reads it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

impl Selection {
    /// All but these.
    pub fn without(rule: Rule) -> Self {
        Self { keep: Vec::new(), drop: vec![rule] }
    }

    /// The columns that it looks at.
    pub(crate) fn columns(&self) -> Vec<String> {
        self.keep.iter().chain(&self.drop).map(|rule| rule.column.clone()).collect()
    }

    /// The particles that are kept.
    pub(crate) fn of(&self, table: Table, notes: &mut Notes) -> Result<Table, Flaw> {
        if self.keep.is_empty() && self.drop.is_empty() {
            return Ok(table);
        }
        let mut kept = vec![self.keep.is_empty(); table.len()];
        for (rules, keeps) in [(&self.keep, true), (&self.drop, false)] {
            for rule in rules {
                let found = rule.of(&table)?;
                let mut count = 0;
                for index in found {
                    kept[index] = keeps;
                    count += 1;
                }
                let text = format!("{} of {}", counted(count, "particle"), rule.text);
                match keeps {
                    true => notes.read(format!("keeps {text}")),
                    false => notes.left_out(format!("drops {text}")),
                }
            }
        }
        let indices: Vec<usize> = (0..table.len()).filter(|index| kept[*index]).collect();
        notes.read(format!("{} of {} are left", indices.len(), counted(table.len(), "particle")));
        Ok(table.at(&indices))
    }
}

impl Rule {
    /// The indices of its particles.
    fn of(&self, table: &Table) -> Result<Vec<usize>, Flaw> {
        let column = column_for(table, &self.column, &format!("for {:?}", self.text))?;
        let indices = 0..column.values.len();
        Ok(match (&self.matches, &column.values) {
            (Matches::AnyOf(wanted), Values::Words(words)) => {
                let is_wanted = |word: &String| wanted.iter().any(|wanted| same(wanted, word));
                let each: Vec<bool> = words.different().iter().map(is_wanted).collect();
                indices.filter(|index| each[words.indices()[*index] as usize]).collect()
            }
            (Matches::AnyOf(wanted), Values::Numbers(numbers)) => {
                let wanted: Vec<f64> = wanted.iter().filter_map(|text| text.parse().ok()).collect();
                indices.filter(|index| wanted.contains(&numbers[*index])).collect()
            }
            (Matches::Range(from, to), values) => {
                let within = |number: f64| number >= *from && number <= *to;
                let number = |index: usize| match values {
                    Values::Numbers(numbers) => Some(numbers[index]),
                    Values::Words(words) => words.get(index).parse().ok(),
                };
                indices.filter(|index| number(*index).is_some_and(within)).collect()
            }
        })
    }
}

/// Capitals count only where a word has both kinds: `hoh` is `HOH`.
fn same(wanted: &str, word: &str) -> bool {
    wanted.eq_ignore_ascii_case(word)
}

/// The column of that name, or else of the role that the name has; the flaw says what it is needed for.
pub(crate) fn column_for<'a>(
    table: &'a Table,
    name: &str,
    purpose: &str,
) -> Result<&'a Column, Flaw> {
    let by_role = || {
        let role = Role::of(name)?;
        table.columns.iter().find(|column| Role::of(&column.name) == Some(role))
    };
    table.column(name).or_else(by_role).ok_or_else(|| {
        let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
        let found = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        Flaw::needed(&format!("a column {name:?} {purpose}"), found)
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn table() -> Table {
        let mut table = Table { positions: vec![DVec3::ZERO; 4], ..Table::default() };
        table.add("resname", Values::Words(["ALA", "HOH", "Hoh", "ALA"].into_iter().collect()));
        table.add("mass", Values::Numbers(vec![1.0, 2.0, 3.0, f64::NAN]));
        table
    }

    fn left(keep: &[&str], drop: &[&str]) -> Result<Vec<usize>, String> {
        let rules =
            |texts: &[&str]| texts.iter().map(|text| text.parse()).collect::<Result<_, _>>();
        let selection = Selection {
            keep: rules(keep).map_err(|error: LoadError| error.to_string())?,
            drop: rules(drop).map_err(|error: LoadError| error.to_string())?,
        };
        let mut table = table();
        table.add("index", Values::Numbers(vec![0.0, 1.0, 2.0, 3.0]));
        let left = selection.of(table, &mut Notes::default()).map_err(|flaw| flaw.problem)?;
        match left.column("index").map(|column| &column.values) {
            Some(Values::Numbers(left)) => Ok(left.iter().map(|index| *index as usize).collect()),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn rules_choose_particles() {
        assert_eq!(left(&[], &["water"]), Ok(vec![0, 3]));
        assert_eq!(left(&["residue=ala"], &[]), Ok(vec![0, 3]));
        assert_eq!(left(&["mass=..2"], &[]), Ok(vec![0, 1]));
        assert_eq!(left(&["mass=2..", "mass=1"], &["resname=HOH"]), Ok(vec![0]));
        assert_eq!(left(&["mass=7"], &[]), Ok(vec![]));
    }

    #[test]
    fn what_is_no_rule_is_refused() {
        for text in ["", "waters", "=1", "mass=", "mass=2..1", "mass=a..b"] {
            let message = left(&[text], &[]).expect_err("refused");
            assert!(message.starts_with("selection: needed water, hydrogen"), "{message}");
        }
        let message = left(&["chain=A"], &[]).expect_err("refused");
        assert_eq!(
            message,
            "needed a column \"chain\" for \"chain=A\", found resname, mass, index"
        );
    }
}
