//! The program's own clocks and counters, out of its output.

use anyhow::Context;

use super::PROGRAM;

/// Wall and CPU milliseconds under a heading of the log.
pub(super) fn clocks(log: &str, heading: &str) -> anyhow::Result<(f64, f64)> {
    let mut lines = log.lines().skip_while(|line| !line.trim_start().starts_with(heading));
    let wall = lines.next().and_then(|line| between(line, "(", " seconds)"));
    let cpu = lines.next().and_then(|line| between(line, "with ", " CPU-seconds"));
    let (wall, cpu) = wall.zip(cpu).with_context(|| {
        format!("{PROGRAM}: needed \"{heading} … (… seconds)\" in its output, found none")
    })?;
    Ok((1e3 * wall, 1e3 * cpu))
}

/// The number after a heading of the log.
pub(super) fn count(log: &str, heading: &str) -> anyhow::Result<u64> {
    let number = log.lines().find_map(|line| line.trim_start().strip_prefix(heading));
    let number = number.and_then(|number| number.trim().parse().ok());
    number.with_context(|| format!("{PROGRAM}: needed \"{heading} …\" in its output, found none"))
}

fn between(line: &str, before: &str, after: &str) -> Option<f64> {
    line.split_once(before)?.1.split_once(after)?.0.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_clocks_are_read() {
        let log = "  Parse Time:       0 hours  0 minutes  0 seconds (0.028 seconds)\n\
                   \x20             using 1 thread(s) with 0.025 CPU-seconds total\n\
                   Render Time:\n\
                   \x20 Trace Time:       0 hours  1 minutes  5 seconds (65.714 seconds)\n\
                   \x20             using 2 thread(s) with 125.500 CPU-seconds total\n";
        assert_eq!(clocks(log, "Parse Time:").expect("there"), (28.0, 25.0));
        assert_eq!(clocks(log, "Trace Time:").expect("there"), (65_714.0, 125_500.0));
        assert!(clocks("Trace Time: none", "Trace Time:").is_err());
    }

    #[test]
    fn its_counters_are_read() {
        let log = "Radiosity samples reused:   25148\nRadiosity sample rays shot:   13632\n";
        assert_eq!(count(log, "Radiosity sample rays shot:").expect("there"), 13_632);
        assert!(count(log, "Radiosity").is_err());
    }
}
