//! How large particles are.

use crate::elements::Element;
use crate::error::Flaw;
use crate::formula::Formula;
use crate::interpret::numbers;
use crate::notes::{Notes, counted};
use crate::options::{ReadOptions, Substance};
use crate::particles::Sizes;
use crate::roles::Role;
use crate::table::Table;

/// What says how large particles are.
pub(crate) struct Sizing<'a> {
    pub(crate) table: &'a Table,
    /// Of each particle; empty where the file has none.
    pub(crate) elements: &'a [Option<Element>],
    pub(crate) substance: Substance,
    pub(crate) options: &'a ReadOptions,
    pub(crate) formula: Option<Formula>,
    /// How many units of the positions make one of the file's.
    pub(crate) scale: f64,
}

impl Sizing<'_> {
    /// What the options say, or a column, or elements, or the spacing that `spacing` finds.
    pub(crate) fn sizes(
        &self,
        spacing: impl Fn() -> Option<f64>,
        notes: &mut Notes,
    ) -> Result<Sizes, Flaw> {
        if !self.formula.is_none_or(Formula::takes_sizes) {
            return Ok(Sizes::Spacing(1.0));
        }
        if let Some(sizes) = self.asked(notes) {
            return Ok(sizes);
        }
        if let Some(sizes) = self.of_columns(notes)? {
            return Ok(sizes);
        }
        if self.substance == Substance::Molecule {
            return Ok(self.of_elements(notes));
        }
        Ok(Sizes::Spacing(self.of_spacing(spacing(), notes)))
    }

    /// Those that the options give to all.
    fn asked(&self, notes: &mut Notes) -> Option<Sizes> {
        let all = |radius: f32| vec![radius * self.scale as f32 * self.factor(); self.table.len()];
        if let Some(radius) = self.options.support_radius {
            notes.read(format!("support radius {radius} as asked for"));
            return Some(Sizes::Support(all(radius)));
        }
        let radius = self.options.radius?;
        let meaning = if self.formula.is_none() { ": each alone shows at it" } else { "" };
        notes.read(format!("radius {radius} as asked for{meaning}"));
        Some(Sizes::Shown(all(radius)))
    }

    /// Those of the first column that says some.
    fn of_columns(&self, notes: &mut Notes) -> Result<Option<Sizes>, Flaw> {
        let column = |role| numbers(&self.table.columns, role);
        let scaled = |values: &[f64], more: f64| -> Vec<f32> {
            let factor = more * self.scale * f64::from(self.factor());
            values.iter().map(|value| (factor * value) as f32).collect()
        };
        let takes_lengths = self.formula.is_some_and(Formula::takes_smoothing_lengths);
        let lengths = column(Role::SmoothingLength).filter(|_| takes_lengths);
        if let Some((name, lengths)) = lengths {
            notes.read(format!("smoothing lengths h from the column {name:?}"));
            positive(self.table, name, lengths)?;
            return Ok(Some(Sizes::Smoothing(scaled(lengths, 1.0))));
        }
        if let Some((name, radii)) = column(Role::SupportRadius) {
            notes.read(format!("support radii from the column {name:?}"));
            positive(self.table, name, radii)?;
            return Ok(Some(Sizes::Support(scaled(radii, 1.0))));
        }
        for (role, part) in [(Role::Radius, 1.0), (Role::Diameter, 0.5)] {
            let Some((name, radii)) = column(role) else { continue };
            let half = if part == 0.5 { ", halved" } else { "" };
            let meaning = match self.formula {
                None => {
                    ": each alone shows at its radius (support_radius would be where its kernel ends)"
                }
                Some(_) => "",
            };
            notes.read(format!("radii from the column {name:?}{half}{meaning}"));
            positive(self.table, name, radii)?;
            return Ok(Some(Sizes::Shown(scaled(radii, part))));
        }
        Ok(None)
    }

    /// Van der Waals radii.
    fn of_elements(&self, notes: &mut Notes) -> Sizes {
        let radii = Formula::atom_radii(self.formula);
        notes.read(format!("van der Waals radii of the elements ({})", radii.source()));
        let unknown = self.elements.iter().filter(|element| element.is_none()).count();
        if unknown > 0 {
            notes.guessed(format!(
                "{} of no known element: radius {} Å (--radius says another)",
                counted(unknown, "atom"),
                radii.unknown()
            ));
        }
        let factor = self.factor();
        Sizes::Shown(self.elements.iter().map(|element| factor * radii.of(*element)).collect())
    }

    /// The support radius of all.
    fn of_spacing(&self, spacing: Option<f64>, notes: &mut Notes) -> f32 {
        if let Some(spacing) = spacing {
            let radius = (2.0 * spacing) as f32 * self.factor();
            match self.formula {
                None => notes.guessed(format!(
                    "support radius {radius} of all: twice the median distance between neighbours (--radius \
                     or --support-radius says another)"
                )),
                Some(_) => notes.guessed(format!(
                    "spacing {}: the median distance between neighbours (--radius, half of it, or \
                     --support-radius says another)",
                    0.5 * radius
                )),
            }
            return radius;
        }
        if !self.table.is_empty() {
            notes
                .guessed("support radius 1: there is no distance to go by (--radius says another)");
        }
        self.factor()
    }

    fn factor(&self) -> f32 {
        self.options.radius_scale.unwrap_or(1.0)
    }
}

/// Refuses the first that is not above 0.
fn positive(table: &Table, name: &str, values: &[f64]) -> Result<(), Flaw> {
    match values.iter().position(|value| !(value.is_finite() && *value > 0.0)) {
        None => Ok(()),
        Some(index) => {
            let mut flaw = Flaw::needed("a finite number above 0", values[index]).at_key(name);
            flaw.location.line = table.lines.get(index);
            Err(flaw)
        }
    }
}
