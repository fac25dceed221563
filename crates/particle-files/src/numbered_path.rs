//! File names with a number in them: `frame-%04d.xyz`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::error::LoadError;

/// The path of a file for each number, as C prints them: the file's name has one `%d`, or `%04d`
/// for at least four digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NumberedPath {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl NumberedPath {
    /// The file of that number.
    pub fn path(&self, number: u32) -> PathBuf {
        let Self { folder, before, digits, after } = self;
        folder.join(format!("{before}{number:0digits$}{after}"))
    }

    /// The numbers of the files that are there, rising.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn numbers(&self) -> Result<Vec<u32>, LoadError> {
        let here = Path::new(".");
        let folder = if self.folder.as_os_str().is_empty() { here } else { &self.folder };
        let refused = |source| LoadError::Read { file: folder.display().to_string(), source };
        let mut numbers = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(refused)? {
            let name = entry.map_err(refused)?.file_name();
            numbers.extend(name.to_str().and_then(|name| self.number(name)));
        }
        numbers.sort_unstable();
        Ok(numbers)
    }

    /// The number in a file's name, if it is written as this path writes it.
    fn number(&self, name: &str) -> Option<u32> {
        let text = name.strip_prefix(&self.before)?.strip_suffix(&self.after)?;
        let number = text.parse().ok()?;
        let digits = self.digits;
        (format!("{number:0digits$}") == text).then_some(number)
    }
}

impl FromStr for NumberedPath {
    type Err = LoadError;

    /// Needs one `%d` or `%0Nd` in the file's name, and no other `%`.
    fn from_str(text: &str) -> Result<Self, LoadError> {
        let refused = || LoadError::Parameter {
            name: "numbered file".to_owned(),
            needed: "a file name with one number in it, such as frame-%04d.png".to_owned(),
            found: format!("{text:?}"),
        };
        let path = Path::new(text);
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(refused)?;
        let (before, rest) = name.split_once('%').ok_or_else(refused)?;
        let (digits, after) = rest.split_once('d').ok_or_else(refused)?;
        let digits = match digits.strip_prefix('0') {
            Some(digits) => digits.parse().ok().filter(|digits| *digits <= 10),
            None => digits.is_empty().then_some(1),
        };
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        match digits {
            Some(digits) if !after.contains('%') => {
                Ok(Self { folder, before: before.to_owned(), digits, after: after.to_owned() })
            }
            _ => Err(refused()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(text: &str) -> NumberedPath {
        text.parse().expect("legal")
    }

    #[test]
    fn numbers_are_written_as_in_c() {
        assert_eq!(numbered("out/f-%04d.png").path(7), Path::new("out/f-0007.png"));
        assert_eq!(numbered("%d.xyz.gz").path(12345), Path::new("12345.xyz.gz"));
        assert_eq!(numbered("a%02d").path(123), Path::new("a123"));
        assert_eq!(numbered("100% done/f%d.xyz").path(1), Path::new("100% done/f1.xyz"));
        for text in ["a.png", "a%", "a%4d", "a%s.png", "%d%d", "a%0d", "a%099d", "%d/a.png", ""] {
            let error = text.parse::<NumberedPath>().expect_err("refused").to_string();
            assert!(error.contains("needed a file name with one number in it"), "{error}");
        }
    }

    #[test]
    fn numbers_are_read_as_they_are_written() {
        let numbered = numbered("f%03d.xyz");
        assert_eq!(numbered.number("f012.xyz"), Some(12));
        assert_eq!(numbered.number("f1234.xyz"), Some(1234));
        for other in ["f12.xyz", "f+12.xyz", "f012.xyz.gz", "g012.xyz", "f.xyz", "f0123.xyz"] {
            assert_eq!(numbered.number(other), None, "{other}");
        }
    }
}
