//! A method of one's own among those of the workspace: `cargo run -- compare random-200 --methods
//! sphere-tracer,fbvh-certified`. `docs/add-a-method.md` walks through it.

mod sphere_tracer;

use std::process::ExitCode;

use metaball_cli::{Method, Own, Promise, Stop, Technique};

use crate::sphere_tracer::{SphereTracer, TOLERANCE};

/// What the tables say of it, and what it is held to.
const SPHERE_TRACER: Method = Method {
    name: "sphere-tracer",
    title: "Sphere tracing",
    paper: "Hart 1996, with local bounds of the slope",
    about: "Steps along the ray as far as the field's slope allows; every ball is evaluated at each step.",
    technique: Technique::Own(Own {
        make: |counting| Box::new(SphereTracer::new(counting)),
        promise: Promise::Always,
        stop: Stop::Residual(TOLERANCE as f64),
        refuses: |_| None,
    }),
};

fn main() -> ExitCode {
    metaball_cli::run_with([SPHERE_TRACER])
}
