//! A thin front: sets the machine up, then runs cargo or the program `metaball`.
//!
//! `cargo xtask test` passes the tests, `cargo xtask bench` times the benches; all other arguments go
//! to the binary `metaball` in release mode: `cargo xtask compare`, `cargo xtask render molecule`.

mod adapter;
mod bench;
mod device;
mod display;
mod packages;
mod python;
mod run;
mod test;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
cargo xtask test                 formatting, lints, all tests, packages, documentation, the Python
                                 package
cargo xtask python               of these the Python package alone: its wheel, pytest and mypy
cargo xtask web                  makes the viewer for browsers, a folder for any web server: out/web;
                                 with --test it is opened in Chromium and held against the library
cargo xtask bench [...]          times the criterion benches, or those that a filter names;
                                 --against COMMIT builds that commit beside and times both in
                                 turn, --rounds N (5) times; samples go to out/bench/samples.csv
cargo xtask device [...]         measures this machine's graphics processor in eight minutes; --pack
                                 makes an archive that does so on another machine, out of the
                                 program, its scenes and a script; --rehearse does it in small
cargo xtask setup                makes sure that a Vulkan adapter exists, and does nothing else
cargo xtask <command> [...]      sets up, then runs `metaball <command> [...]` in release mode:
                                 compare, score, diff, chart, stability, certify, render,
                                 animate, view, convert, tables, scenes, methods; `help` lists
                                 them

They set the machine up first: where no Vulkan adapter is found on Debian or Ubuntu, and with the
rights to do so, they install Mesa's software one; test installs Xvfb too, to test the window. With
--cpu no adapter is needed, nor for render and animate, unless --software or --adapter asks for one,
nor for view.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.first().map(String::as_str) {
        None => {
            run::say(HELP);
            return ExitCode::from(2);
        }
        Some("setup") => adapter::ensure().map(|_| ()),
        Some("bench") => bench::run(&arguments[1..]),
        Some("device") => device::run(&arguments[1..]),
        Some("test") => test::run(&arguments[1..]),
        Some("python") => python::test(),
        Some("web") => web::run(&arguments[1..]),
        Some("help" | "--help" | "-h") => {
            run::say(HELP);
            run::metaball(&["--help".to_owned()])
        }
        Some(command) if needs_adapter(command, &arguments[1..]) => {
            adapter::ensure().and_then(|_| run::metaball(&arguments))
        }
        Some(_) => run::metaball(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            run::complain(&failure);
            ExitCode::FAILURE
        }
    }
}

/// Whether a command of `metaball` draws with an adapter: the CPU draws pictures unless one is asked for.
fn needs_adapter(command: &str, arguments: &[String]) -> bool {
    let asks_for = |flags: &[&str]| {
        let name = |argument: &String| {
            argument.split('=').next().is_some_and(|name| flags.contains(&name))
        };
        arguments.iter().any(name)
    };
    match command {
        "scenes" | "methods" | "score" | "diff" | "convert" | "view" => false,
        "render" | "animate" => asks_for(&["--software", "--adapter"]),
        _ => !asks_for(&["--cpu"]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_draws_with_an_adapter_needs_one() {
        let needs = |line: &str| {
            let words: Vec<_> = line.split(' ').map(str::to_owned).collect();
            needs_adapter(&words[0], &words[1..])
        };
        assert!(needs("compare molecule") && needs("stability") && needs("render x --software"));
        assert!(needs("animate splash --adapter=llvmpipe"));
        assert!(
            !needs("compare --cpu")
                && !needs("render molecule --shadows")
                && !needs("view molecule")
        );
    }
}
