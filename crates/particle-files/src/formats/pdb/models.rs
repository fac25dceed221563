//! Models and frames of PDB files and their relatives.

use super::line::{Kind, kind};
use crate::error::Flaw;
use crate::formats::Span;
use crate::formats::models::Model;
use crate::text::{fields, first_line};

/// The models of a file that have atoms: from a line `MODEL`, or from the last one's end, to a line
/// `ENDMDL`, to the `END` that programs write behind each frame, or to the next `MODEL`.
pub(crate) fn models(bytes: &[u8]) -> Result<Vec<Model>, Flaw> {
    let begun = |at: usize, line| Model { span: Span { bytes: at..at, line }, number: None };
    let mut models = Vec::new();
    let mut current = begun(0, 1);
    let mut has_atoms = false;
    let mut rest = bytes;
    for number in 1.. {
        let (line, behind) = first_line(rest);
        let (start, end) = (bytes.len() - rest.len(), bytes.len() - behind.len());
        let kind = kind(line).map_err(|flaw| flaw.at_line(number))?;
        let next = match kind {
            Kind::Model if has_atoms => Some(begun(start, number)),
            Kind::End => Some(begun(end, number + 1)),
            _ => None,
        };
        if let Some(next) = next {
            current.span.bytes.end = next.span.bytes.start;
            let ended = std::mem::replace(&mut current, next);
            models.extend(std::mem::take(&mut has_atoms).then_some(ended));
        }
        match kind {
            Kind::Model => current.number = number_of(line),
            Kind::Atom => has_atoms = true,
            Kind::End | Kind::Other => {}
        }
        if behind.is_empty() {
            break;
        }
        rest = behind;
    }
    current.span.bytes.end = bytes.len();
    models.extend(has_atoms.then_some(current));
    match models.is_empty() {
        false => Ok(models),
        true => Err(Flaw::needed("atoms: lines that begin with ATOM or HETATM", "none")
            .or("atoms in another format are read too, as mmCIF or XYZ")),
    }
}

/// The number in a line `MODEL`, in whatever columns.
fn number_of(line: &[u8]) -> Option<i64> {
    let line = line.trim_ascii_start();
    let number = fields(&line[b"MODEL".len()..]).next()?;
    std::str::from_utf8(number).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ATOM: &str = "ATOM      1  N   ALA A   1       0.000   0.000   0.000\n";

    fn found(text: &str) -> Vec<(Option<i64>, usize, usize)> {
        let text = text.replace("ATOM\n", ATOM);
        let models = models(text.as_bytes()).expect("atoms");
        let atoms = |model: &Model| text[model.span.bytes.clone()].matches("ATOM").count();
        models.iter().map(|model| (model.number, model.span.line, atoms(model))).collect()
    }

    #[test]
    fn models_and_frames_are_found_however_they_end() {
        assert_eq!(found("ATOM\nATOM\n"), [(None, 1, 2)]);
        assert_eq!(found("ATOM\nTER\nATOM\nEND"), [(None, 1, 2)]);
        let ended = "MODEL        1\nATOM\nENDMDL\nMODEL        2\nATOM\nATOM\nENDMDL\nEND\n";
        assert_eq!(found(ended), [(Some(1), 1, 1), (Some(2), 4, 2)]);
        let not_ended = "TITLE\nMODEL 1\nATOM\nMODEL     7\nATOM\nMASTER\n";
        assert_eq!(found(not_ended), [(Some(1), 1, 1), (Some(7), 4, 1)]);
        let frames = "CRYST1\nATOM\nEND\nATOM\nEND\n";
        assert_eq!(found(frames), [(None, 1, 1), (None, 4, 1)]);
        let both = "MODEL 1\nATOM\nENDMDL\nEND\nMODEL 2\nATOM\nENDMDL\nEND\n";
        assert_eq!(found(both), [(Some(1), 1, 1), (Some(2), 5, 1)]);
        let empty = "MODEL 1\nENDMDL\nMODEL 2\nATOM\nENDMDL\nCONECT    1    2\nEND\n";
        assert_eq!(found(empty), [(Some(2), 3, 1)]);
        assert_eq!(found("model\nATOM\nendmdl\nATOM\n"), [(None, 1, 1), (None, 4, 1)]);
    }

    #[test]
    fn a_file_without_atoms_says_so() {
        let flaw = models(b"REMARK nothing\nEND\n").expect_err("refused");
        assert!(flaw.problem.contains("lines that begin with ATOM or HETATM, found none"));
    }
}
