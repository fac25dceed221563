//! The binary `metaball`.

use std::process::ExitCode;

fn main() -> ExitCode {
    metaball_cli::run()
}
