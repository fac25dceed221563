//! Which C library a program needs.

/// The newest version of glibc that a program's symbols name.
pub(super) fn needed(program: &[u8]) -> String {
    const NAME: &[u8] = b"GLIBC_";
    let versions = program.windows(NAME.len()).enumerate().filter(|(_, window)| *window == NAME);
    let newest = versions.filter_map(|(at, _)| version(&program[at + NAME.len()..])).max();
    newest.map_or_else(
        || "no glibc".to_owned(),
        |(major, minor)| format!("glibc {major}.{minor} or later"),
    )
}

/// `2.34` at the start of a text.
fn version(text: &[u8]) -> Option<(u32, u32)> {
    let end = text.iter().position(|byte| !byte.is_ascii_digit() && *byte != b'.')?;
    let (major, minor) = std::str::from_utf8(&text[..end]).ok()?.split_once('.')?;
    let minor = minor.split('.').next()?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_version_counts() {
        let program = b"..GLIBC_2.9\0GLIBC_2.34\0GLIBC_2.2.5\0GLIBC_PRIVATE\0";
        assert_eq!(needed(program), "glibc 2.34 or later");
        assert_eq!(needed(b"nothing"), "no glibc");
    }
}
