//! What is asked of `cargo xtask bench`.

/// Rounds without `--rounds`.
const ROUNDS: usize = 5;

/// The arguments, understood.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Options {
    /// Whatever git takes for a commit.
    pub(super) against: Option<String>,
    /// Times that each bench is run on each side.
    pub(super) rounds: usize,
    /// Regular expressions, of which a bench has one in its name; all benches where there are none.
    filters: Vec<String>,
}

impl Options {
    /// Reads the arguments after `bench`.
    pub(super) fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self { against: None, rounds: ROUNDS, filters: Vec::new() };
        let mut arguments = arguments.iter();
        while let Some(argument) = arguments.next() {
            let (name, value) = match argument.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (argument.as_str(), None),
            };
            let mut value = || {
                let value = value.clone().or_else(|| arguments.next().cloned());
                value.ok_or_else(|| format!("bench: needed a value after {name}, found none"))
            };
            match name {
                "--against" => options.against = Some(value()?),
                "--rounds" => options.rounds = count(&value()?)?,
                _ if name.starts_with('-') => {
                    let known = "--against COMMIT, --rounds N or names of benches";
                    return Err(format!("bench: needed {known}, found {argument}"));
                }
                _ => options.filters.push(argument.clone()),
            }
        }
        Ok(options)
    }

    /// One regular expression for all filters.
    pub(super) fn filter(&self) -> String {
        match &self.filters[..] {
            [] => String::new(),
            [one] => one.clone(),
            several => several.iter().map(|one| format!("(?:{one})")).collect::<Vec<_>>().join("|"),
        }
    }
}

fn count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| *count > 0);
    count.ok_or_else(|| format!("bench: --rounds needed a number from 1 on, found {text}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Options, String> {
        let words: Vec<_> = line.split_whitespace().map(str::to_owned).collect();
        Options::parse(&words)
    }

    #[test]
    fn arguments_are_read() {
        let options = parse("trace/fbvh --against HEAD~3 --rounds=7 build").expect("legal");
        assert_eq!((options.against.as_deref(), options.rounds), (Some("HEAD~3"), 7));
        assert_eq!(options.filter(), "(?:trace/fbvh)|(?:build)");
        let options = parse("").expect("legal");
        assert_eq!((options.against.as_deref(), options.filter().as_str()), (None, ""));
        assert_eq!(parse("--against=v1 a=b").expect("legal").filter(), "a=b");
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (line, named) in [
            ("--against", "--against"),
            ("--rounds 0", "found 0"),
            ("--rounds many", "found many"),
            ("--agianst=x", "found --agianst=x"),
        ] {
            let error = parse(line).expect_err(line);
            assert!(error.contains(named), "{error}");
        }
    }
}
