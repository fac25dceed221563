//! What is printed: results on standard output, the rest on standard
//! error.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::io::{IsTerminal, Write};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use harness::configuration::Configuration;
use harness::progress::Progress;
use harness::record::{Adapter, Record};
use indicatif::{HumanDuration, ProgressStyle};
use metaball_core::gpu::{AdapterChoice, Gpu};

/// One line of results. A reader who has seen enough and closed the pipe is no error.
pub fn line(text: &str) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// One line about how things went, on standard error.
pub fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Does work that has no steps. After a second a terminal shows that it goes on, and for how long.
pub fn while_working<T>(doing: &str, work: impl FnOnce() -> T) -> T {
    let (done, is_done) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            if is_done.recv_timeout(Duration::from_secs(1)) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
            let spinner = indicatif::ProgressBar::new_spinner().with_message(doing.to_owned());
            let spinner = match style {
                Ok(style) => spinner.with_style(style),
                Err(_) => spinner,
            };
            spinner.enable_steady_tick(Duration::from_millis(200));
            // The other end is closed, whatever becomes of the work.
            let _ = is_done.recv();
            spinner.finish_and_clear();
        });
        let _closed_at_the_end = done;
        work()
    })
}

/// Opens an adapter, and prints which.
///
/// # Errors
/// When there is none of that kind.
pub fn open_adapter(choice: &AdapterChoice) -> anyhow::Result<Gpu> {
    let gpu = Gpu::new(choice)?;
    note(&gpu.report().to_string());
    Ok(gpu)
}

/// Opens the adapter, if one is wanted and there is any, and prints what draws. Without it those of the
/// configurations are left that need none, and the others are named.
///
/// # Errors
/// When there are adapters and none is the one chosen, or it does not open.
pub fn open_adapter_if_any<'a>(
    choice: Option<&AdapterChoice>,
    configurations: impl IntoIterator<Item = &'a Configuration>,
) -> anyhow::Result<Option<Gpu>> {
    let gpu = choice.map(Gpu::find).transpose()?.flatten();
    let (mut on_cpu, mut left_out) = (BTreeSet::new(), BTreeSet::new());
    for configuration in configurations {
        let name = configuration.method.name;
        if !configuration.needs_adapter() {
            on_cpu.insert(name);
        } else if gpu.is_none() {
            left_out.insert(name);
        }
    }
    match &gpu {
        Some(gpu) => note(&gpu.report().to_string()),
        None if choice.is_some() => note("adapter     none on this machine"),
        None => note("adapter     none asked for"),
    }
    let list = |names: BTreeSet<&str>| names.into_iter().collect::<Vec<_>>().join(", ");
    if !on_cpu.is_empty() {
        note(&format!("cpu         {}: {}", Adapter::cpu(), list(on_cpu)));
    }
    if !left_out.is_empty() {
        note(&format!("left out    {}: they need a graphics adapter", list(left_out)));
    }
    Ok(gpu)
}

/// A bar that counts steps of known number; without a terminal, one line for each stage.
pub struct ProgressBar {
    bar: indicatif::ProgressBar,
    watched: bool,
    start: Instant,
    /// Steps that were done before.
    skipped: Cell<u64>,
}

impl ProgressBar {
    /// A bar of so many steps.
    pub fn new(steps: u64) -> Self {
        let bar = indicatif::ProgressBar::new(steps);
        let template = "{elapsed_precise} {wide_bar:.cyan} {percent:>3} % {pos}/{len}  {msg:60!}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let watched = std::io::stderr().is_terminal();
        if watched {
            bar.enable_steady_tick(Duration::from_millis(200));
        }
        Self { bar, watched, start: Instant::now(), skipped: Cell::new(0) }
    }

    /// Shows what begins now, and how long all is likely to take yet.
    pub fn stage(&self, text: String) {
        let text = self.with_time_left(text);
        if self.watched {
            self.bar.set_message(text);
        } else {
            note(&text);
        }
    }

    /// Shows what goes on and how long it is likely to take yet; nothing without a terminal.
    pub fn show_left(&self, doing: &str) {
        if self.watched {
            self.bar.set_message(self.with_time_left(doing.to_owned()));
        }
    }

    /// One more step is done: how many are, of how many.
    pub fn step(&self) -> (u64, u64) {
        self.advance(1);
        (self.bar.position(), self.bar.length().unwrap_or(0))
    }

    /// So many steps are done.
    pub fn advance(&self, steps: u64) {
        self.bar.inc(steps);
    }

    fn with_time_left(&self, text: String) -> String {
        match self.left() {
            Some(left) => format!("{text} ({} left)", HumanDuration(left)),
            None => text,
        }
    }

    /// At the pace of all steps so far: that of the last few is no estimate where steps differ as methods
    /// do. `None` before the first.
    fn left(&self) -> Option<Duration> {
        let done = self.bar.position().saturating_sub(self.skipped.get());
        let left = self.bar.length()?.saturating_sub(self.bar.position());
        (done > 0).then(|| self.start.elapsed().mul_f64(left as f64 / done as f64))
    }

    /// So many steps are done in all.
    pub fn reach(&self, steps: u64) {
        self.bar.set_position(steps);
    }

    /// So many steps in all were done by an earlier run, in no time.
    pub fn skip(&self, steps: u64) {
        self.skipped.set(self.skipped.get() + steps.saturating_sub(self.bar.position()));
        self.bar.set_position(steps);
    }

    /// A line that stays, above the bar.
    pub fn note(&self, text: &str) {
        self.bar.suspend(|| note(text));
    }
}

impl Progress for ProgressBar {
    fn stage(&self, text: String) {
        self.stage(text);
    }

    fn advance(&self, steps: u64) {
        self.advance(steps);
    }
}

impl Drop for ProgressBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Prints why records have no result, a line for each scene and reason.
pub fn note_reasons<'a>(records: impl IntoIterator<Item = &'a Record>) {
    for (scene, reason, methods) in reasons(records) {
        note(&format!("{scene}, {}: {reason}", methods.join(", ")));
    }
}

/// Scenes and reasons, with the methods that have no result there for that reason; each once.
fn reasons<'a>(
    records: impl IntoIterator<Item = &'a Record>,
) -> Vec<(&'a str, &'a str, Vec<&'a str>)> {
    let mut reasons: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for record in records {
        let Some(reason) = record.reason.as_deref() else { continue };
        let (scene, method) = (record.scene.as_str(), record.method.as_str());
        match reasons.iter_mut().find(|known| (known.0, known.1) == (scene, reason)) {
            Some((_, _, methods)) if methods.contains(&method) => {}
            Some((_, _, methods)) => methods.push(method),
            None => reasons.push((scene, reason, vec![method])),
        }
    }
    reasons
}

/// Columns under their headings, the first column flush left, all others flush right.
pub fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        rows.iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count())
            .chain([headings[column].chars().count()])
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<_> = (0..headings.len()).map(width).collect();
    let render = |cells: Vec<&str>| {
        let cells = cells.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let mut lines = vec![render(headings.to_vec())];
    lines.extend(rows.iter().map(|row| render(row.iter().map(String::as_str).collect())));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_earlier_run_did_says_nothing_of_the_pace() {
        let progress = ProgressBar::new(10);
        assert_eq!(progress.left(), None);
        progress.skip(6);
        assert_eq!(progress.left(), None);
        progress.reach(8);
        let (left, after) =
            (progress.left().expect("two steps are done"), progress.start.elapsed());
        assert!(left <= after, "{left:?} for two steps like those that took {after:?}");
    }

    #[test]
    fn tables_line_up() {
        let text = table(
            &["scene", "ms"],
            &[vec!["molecule".into(), "1.5".into()], vec!["é".into(), "12.5".into()]],
        );
        assert_eq!(text, "scene       ms\nmolecule   1.5\né         12.5");
    }
}
