//! A thin front: sets the machine up, then runs cargo or the program `metaball`.
//!
//! `cargo xtask test` passes the tests; all other arguments go to the binary `metaball` in
//! release mode: `cargo xtask compare`, `cargo xtask render molecule`.

mod adapter;
mod run;
mod test;

use std::process::ExitCode;

const HELP: &str = "\
cargo xtask test                 formatting, lints, all tests, packages and documentation
cargo xtask setup                makes sure that a Vulkan adapter exists, and does nothing else
cargo xtask <command> [...]      sets up, then runs `metaball <command> [...]` in release mode:
                                 compare, score, diff, chart, stability, certify, render,
                                 animate, tables, scenes, methods; `help` lists them

Both set the machine up first: where no Vulkan adapter is found on Debian or Ubuntu, and with the
rights to do so, they install Mesa's software one. With --cpu none is needed.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.first().map(String::as_str) {
        None => {
            run::say(HELP);
            return ExitCode::from(2);
        }
        Some("setup") => adapter::ensure().map(|_| ()),
        Some("test") => test::run(&arguments[1..]),
        Some("help" | "--help" | "-h") => {
            run::say(HELP);
            run::metaball(&["--help".to_owned()])
        }
        // These need no adapter.
        Some("scenes" | "methods" | "score" | "diff") => run::metaball(&arguments),
        Some(_) if arguments.iter().any(|argument| argument == "--cpu") => {
            run::metaball(&arguments)
        }
        Some(_) => adapter::ensure().and_then(|_| run::metaball(&arguments)),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            run::complain(&failure);
            ExitCode::FAILURE
        }
    }
}
