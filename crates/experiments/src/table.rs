//! A table for the terminal and for a page: one list of columns, two printers.

use crate::console;
use crate::html::{escape, section};

/// A table of plain text.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it is about.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// A cell for each column. A row that is too short ends with the reason why the rest is missing.
    pub rows: Vec<Vec<String>>,
}

/// A column of a [`Table`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    name: &'static str,
    unit: &'static str,
    is_text: bool,
}

impl Column {
    /// Of words.
    pub const fn text(name: &'static str) -> Self {
        Self { name, unit: "", is_text: true }
    }

    /// Of numbers.
    pub const fn number(name: &'static str) -> Self {
        Self { name, unit: "", is_text: false }
    }

    /// The same with a unit, or what else explains the numbers.
    #[must_use]
    pub const fn of(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    fn heading(&self) -> String {
        if self.unit.is_empty() {
            self.name.to_owned()
        } else {
            format!("{} {}", self.name, self.unit)
        }
    }

    fn class(&self) -> &'static str {
        if self.is_text { " class=\"text\"" } else { "" }
    }
}

impl Table {
    /// The table without its title, for the terminal.
    pub fn text(&self) -> String {
        let headings: Vec<_> = self.columns.iter().map(Column::heading).collect();
        let headings: Vec<_> = headings.iter().map(String::as_str).collect();
        console::table(&headings, &self.rows)
    }

    /// The table under its title, for a page. A rule parts rows whose first cells differ.
    pub fn html(&self) -> String {
        let heading = |column: &Column| {
            let unit = match column.unit {
                "" => String::new(),
                unit => format!("<small>{}</small>", escape(unit)),
            };
            format!("<th{}>{}{unit}</th>", column.class(), escape(column.name))
        };
        let row = |(index, cells): (usize, &Vec<String>)| {
            let missing = self.columns.len().saturating_sub(cells.len());
            let cell = |(column, text): (usize, &String)| {
                let text = escape(text);
                if missing > 0 && column + 1 == cells.len() {
                    format!("<td class=\"reason\" colspan=\"{}\">{text}</td>", missing + 1)
                } else {
                    format!("<td{}>{text}</td>", self.columns[column].class())
                }
            };
            let continues = index > 0 && self.rows[index - 1].first() == cells.first();
            let first = if continues { "" } else { " class=\"first\"" };
            format!("<tr{first}>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
        };
        let headings: String = self.columns.iter().map(heading).collect();
        let rows: String = self.rows.iter().enumerate().map(row).collect();
        section(&self.title, &headings, &rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_say_what_is_not_there() {
        let rows = vec![
            vec!["a".to_owned(), "1".to_owned(), "2".to_owned()],
            vec!["a".to_owned(), "too <large>".to_owned()],
            vec!["b".to_owned(), "3".to_owned(), "4".to_owned()],
        ];
        let columns =
            vec![Column::text("scene"), Column::number("time").of("ms"), Column::number("n")];
        let table = Table { title: "T".to_owned(), columns, rows };
        let html = table.html();
        let headings = "<th class=\"text\">scene</th><th>time<small>ms</small></th><th>n</th>";
        assert!(html.contains(headings), "{html}");
        let reason =
            "<tr><td class=\"text\">a</td><td class=\"reason\" colspan=\"2\">too &lt;large&gt;";
        assert!(html.contains(reason), "{html}");
        assert_eq!(html.matches("class=\"first\"").count(), 2, "a, and b");
        assert!(table.text().starts_with("scene      time ms  n\na                1  2\n"));
    }
}
