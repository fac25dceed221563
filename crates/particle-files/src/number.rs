//! Numbers as programs write them.

/// What separates a number's whole part from the rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum DecimalMark {
    #[default]
    Point,
    Comma,
}

/// The number of a field, blanks around it left out: decimal, with an exponent after `e`, Fortran's `d`
/// or `*^`. `None` for anything else; NaN and the infinities are numbers.
pub(crate) fn number(field: &[u8], mark: DecimalMark) -> Option<f64> {
    let field = field.trim_ascii();
    let text = std::str::from_utf8(field).ok()?;
    if mark == DecimalMark::Comma {
        return if text.contains('.') { None } else { plain(&text.replace(',', ".")) };
    }
    plain(text)
}

fn plain(text: &str) -> Option<f64> {
    match text.parse() {
        Ok(number) => Some(number),
        Err(_) => with_other_exponent(text)?.parse().ok(),
    }
}

/// The same with `e` before its exponent: `1.5D-3`, `1.5*^-3`.
fn with_other_exponent(text: &str) -> Option<String> {
    let (mantissa, exponent) = text.split_once("*^").or_else(|| text.split_once(['d', 'D']))?;
    let digits = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
    let is_number = mantissa.ends_with(|last: char| last.is_ascii_digit() || last == '.')
        && !digits.is_empty()
        && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| format!("{mantissa}e{exponent}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_of_all_programs_are_read() {
        let read = |text: &str| number(text.as_bytes(), DecimalMark::Point);
        for text in [" 1.2e-6", "1.2D-6 ", "1.2d-06", "1.2*^-6", "0.0000012", "+12E-7"] {
            assert_eq!(read(text), Some(1.2e-6), "{text}");
        }
        for text in ["", "e5", "d5", "1.2d", "1.2*^", "0x1p3", "1,5", "H", "1.2d+-5", "1 2"] {
            assert_eq!(read(text), None, "{text}");
        }
        assert!(read("nan").is_some_and(f64::is_nan));
    }

    #[test]
    fn a_decimal_comma_is_read_where_it_is_asked_for() {
        let read = |text: &str| number(text.as_bytes(), DecimalMark::Comma);
        assert_eq!(read("-1,5e3"), Some(-1500.0));
        assert_eq!(read("7"), Some(7.0));
        assert_eq!(read("1.5"), None);
        assert_eq!(read("1,500,000"), None);
    }
}
