//! What the ending of a path says of a file's format.

use std::path::Path;

use crate::PictureFileError;
use crate::target::Target;

/// The format that the ending of a path names, whatever its case; a device or a pipe without any has
/// the first of those that there are.
///
/// # Errors
/// When it is none of these. `needed` lists them.
pub(crate) fn named_format<F: Copy>(
    path: &Path,
    formats: &[(&str, F)],
    needed: &'static str,
) -> Result<F, PictureFileError> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    let named = formats.iter().find(|(known, _)| ending.as_deref() == Some(*known));
    let only = formats.first().filter(|_| ending.is_none() && Target::is_stream(path));
    named.or(only).map(|(_, format)| *format).ok_or_else(|| PictureFileError::Content {
        path: path.to_owned(),
        needed,
        found: ending.map_or_else(|| "no ending".to_owned(), |ending| format!(".{ending}")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_name_formats() {
        let named = |path: &str| {
            let format = named_format(Path::new(path), &[("a", 1), ("b", 2)], "an .a or .b");
            format.map_err(|error| error.to_string())
        };
        assert_eq!((named("x.a"), named("x.a.B")), (Ok(1), Ok(2)));
        assert_eq!(named("x.b.c"), Err("x.b.c: needed an .a or .b, found .c".to_owned()));
        for path in ["x", ".b", "b"] {
            assert_eq!(named(path), Err(format!("{path}: needed an .a or .b, found no ending")));
        }
        if cfg!(unix) {
            assert_eq!(named("/dev/null"), Ok(1));
        }
    }
}
