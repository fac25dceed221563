//! Names of files and folders in a line of prose.

use crate::prose::Line;
use crate::tree::Tree;

/// What a text calls a file or folder of the repository.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Name {
    pub(crate) path: String,
    /// Whether it can only be meant from the text's own folder.
    pub(crate) is_link: bool,
}

/// Endings of files that stand in the repository and nowhere else.
const SOURCES: [&str; 3] = [".rs", ".wgsl", ".md"];

/// The names in a line of a file.
pub(crate) fn in_line(tree: &Tree, file: &str, line: &Line) -> Vec<Name> {
    let mut names = Vec::new();
    let (text, targets) = if file.ends_with(".md") && !line.is_code {
        without_links(&line.text)
    } else {
        (line.text.clone(), Vec::new())
    };
    for target in targets.iter().filter(|target| !target.contains("://")) {
        let path = target.split('#').next().unwrap_or_default().to_owned();
        if !path.is_empty() {
            names.push(Name { path, is_link: true });
        }
    }
    // Odd pieces stand between backticks.
    for (index, piece) in text.split('`').enumerate() {
        let is_span = line.is_code || index % 2 == 1;
        for word in piece.split(|letter: char| !is_of_path(letter)).filter(|word| is_path(word)) {
            for path in alternatives(word.trim_matches(['.', ',', ':', '-']).trim_end_matches('/'))
            {
                let is_source = !line.is_code && SOURCES.iter().any(|end| path.ends_with(end));
                let is_rooted = is_span && tree.has_root(&path) && word.contains('/');
                if is_source || is_rooted {
                    names.push(Name { path, is_link: false });
                }
            }
        }
    }
    names
}

/// A line of Markdown without its links, and their targets.
fn without_links(text: &str) -> (String, Vec<String>) {
    let mut prose = String::new();
    let mut targets = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("](")
        && let Some((target, after)) = after.split_once(')')
    {
        // The words of a link are explained by its target.
        prose += before.rsplit_once('[').map_or(before, |(before, _)| before);
        targets.push(target.to_owned());
        rest = after;
    }
    (prose + rest, targets)
}

/// Whether a letter can stand in a path, a pattern or an address.
fn is_of_path(letter: char) -> bool {
    letter.is_alphanumeric() || "_-./{},*…<>%~:$".contains(letter)
}

/// Whether a word is no address, absolute path or pattern.
fn is_path(word: &str) -> bool {
    let is_pattern = word.contains(['*', '…', '<', '>', '%', '~', '$']) || word.contains("NN");
    !is_pattern && !word.contains("://") && !word.starts_with('/')
}

/// The paths that a word with braces stands for, or those between its commas.
fn alternatives(word: &str) -> Vec<String> {
    let braces = word.split_once('{').and_then(|(before, rest)| {
        let (inside, after) = rest.split_once('}')?;
        Some((before, inside, after))
    });
    match braces {
        Some((before, inside, after)) => {
            inside.split(',').map(|choice| format!("{before}{choice}{after}")).collect()
        }
        // A line may be named behind a colon.
        None => word.split([',', ':']).filter(|path| !path.is_empty()).map(str::to_owned).collect(),
    }
}
