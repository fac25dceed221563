//! Models of structures: frames that have a number in the file.

use super::{Request, Span};
use crate::error::Flaw;
use crate::notes::{Notes, counted};

/// Atoms that are drawn together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Model {
    pub(super) span: Span,
    /// The number that the file gives it.
    pub(super) number: Option<i64>,
}

/// The span that is asked for, by the model's number among those of the file or else as given. Says which
/// model it is.
pub(super) fn asked_for(
    models: impl FnOnce() -> Result<Vec<Model>, Flaw>,
    span: &Span,
    request: &Request,
    notes: &mut Notes,
) -> Result<Span, Flaw> {
    let Some(number) = request.model else { return Ok(span.clone()) };
    let models = models()?;
    let Some(model) = models.iter().find(|model| model.number == Some(number)) else {
        return Err(no_model(number, &models));
    };
    notes.read(format!("model {number}"));
    if models.len() > 1 {
        notes.left_out(counted(models.len() - 1, "other model"));
    }
    Ok(model.span.clone())
}

fn no_model(number: i64, models: &[Model]) -> Flaw {
    const SHOWN: usize = 10;
    let numbers: Vec<i64> = models.iter().filter_map(|model| model.number).collect();
    let mut words: Vec<String> = numbers.iter().take(SHOWN).map(i64::to_string).collect();
    if numbers.len() > SHOWN {
        words.push(format!("{} more", numbers.len() - SHOWN));
    }
    let found = match words.is_empty() {
        true => "models without numbers".to_owned(),
        false => format!("models {}", words.join(", ")),
    };
    Flaw::needed(&format!("a model {number}"), found).or("--frame N counts them from 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(number: Option<i64>, numbers: &[i64]) -> Result<(usize, Vec<String>), String> {
        let model = |(line, number): (usize, &i64)| Model {
            span: Span { bytes: 0..1, line },
            number: Some(*number),
        };
        let models = numbers.iter().enumerate().map(model).collect();
        let request = Request { model: number, ..Request::default() };
        let mut notes = Notes::default();
        let given = Span { bytes: 0..1, line: 77 };
        let span = asked_for(|| Ok(models), &given, &request, &mut notes);
        let span = span.map_err(|flaw| flaw.problem)?;
        Ok((span.line, notes.iter().map(|note| note.text.clone()).collect()))
    }

    #[test]
    fn models_go_by_their_numbers() {
        assert_eq!(asked(None, &[3, 5]), Ok((77, vec![])));
        let notes = vec!["model 5".to_owned(), "1 other model".to_owned()];
        assert_eq!(asked(Some(5), &[3, 5]), Ok((1, notes)));
        let refused = |numbers: &[i64]| asked(Some(1), numbers).expect_err("refused");
        assert!(refused(&[3, 5]).starts_with("needed a model 1, found models 3, 5; --frame N"));
        assert!(refused(&[]).contains("found models without numbers"));
        let many: Vec<i64> = (2..14).collect();
        assert!(refused(&many).contains("found models 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 2 more"));
    }
}
