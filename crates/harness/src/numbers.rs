//! Numbers as tables show them.

/// Three digits of a quantity of everyday size.
pub fn decimal(value: f64) -> String {
    // The sum of nothing is -0.
    let value = value + 0.0;
    match value.abs() {
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 10.0 => format!("{value:.1}"),
        size if size >= 0.01 || size == 0.0 => format!("{value:.2}"),
        _ => small(value),
    }
}

/// Two digits of an error.
pub fn small(value: f64) -> String {
    if value == 0.0 || !value.is_finite() { format!("{value}") } else { format!("{value:.1e}") }
}

/// A count with its thousands apart.
pub fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A value as an axis shows it: `0.01`, `14`, `−3·10⁻⁵`.
pub fn tick(value: f64) -> String {
    let size = value.abs();
    let sign = if value < 0.0 { "\u{2212}" } else { "" };
    if size == 0.0 || (1e-2..1e4).contains(&size) {
        return format!("{sign}{size}");
    }
    let text = format!("{size:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let factor = if digits == "1" { String::new() } else { format!("{digits}·") };
    format!("{sign}{factor}10{}", superscript(exponent))
}

/// A whole number, raised.
pub fn superscript(number: &str) -> String {
    let raise = |digit: char| match digit {
        '-' => '⁻',
        '0'..='9' => {
            ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize - '0' as usize]
        }
        other => other,
    };
    number.chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [decimal(1234.5), decimal(12.34), decimal(0.5), decimal(0.0)],
            ["1234", "12.3", "0.50", "0.00"]
        );
        assert_eq!([small(1.234e-6), small(0.0), small(f64::INFINITY)], ["1.2e-6", "0", "inf"]);
        assert_eq!([grouped(0), grouped(999), grouped(307_200)], ["0", "999", "307\u{202f}200"]);
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!([0.0, 14.0, -0.1, 0.01].map(tick), ["0", "14", "\u{2212}0.1", "0.01"]);
        assert_eq!(tick(1e6), "10⁶");
        assert_eq!(tick(-3e-5), "\u{2212}3·10⁻⁵");
    }
}
