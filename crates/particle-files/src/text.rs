//! Bytes as text.

use crate::error::Flaw;

/// The bytes as text.
pub(crate) fn text(bytes: &[u8]) -> Result<&str, Flaw> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        Flaw::needed("UTF-8 text", "other bytes").at_line(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_bytes_than_text_are_located() {
        let flaw = text(b"one\ntwo\n\xff").expect_err("refused");
        assert_eq!(flaw.location.line, Some(3));
    }
}
