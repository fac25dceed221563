//! A method of one's own among those of the workspace, on an adapter and on the CPU: `cargo run -- compare
//! random-200 --methods sphere-tracer,sphere-tracer-cpu,fbvh-certified`. `docs/add-a-method.md` walks
//! through it.

mod sphere_tracer;
mod sphere_tracer_cpu;

use std::process::ExitCode;

use metaball_cli::{Method, Own, Promise, Renderer, Stop, Technique};

use crate::sphere_tracer::{SphereTracer, TOLERANCE};
use crate::sphere_tracer_cpu::{SphereTracerCpu, refuses};

/// What the tables say of it, and what it is held to.
const SPHERE_TRACER: Method = Method {
    name: "sphere-tracer",
    title: "Sphere tracing",
    paper: "Hart 1996, with local bounds of the slope",
    about: "Steps along the ray as far as the field's slope allows; every ball is evaluated at each step.",
    technique: Technique::Own(Own {
        make: |counting| Renderer::Adapter(Box::new(SphereTracer::new(counting))),
        promise: Promise::Always,
        stop: Stop::Residual(TOLERANCE as f64),
        refuses: |_| None,
    }),
};

/// The same on the CPU.
const SPHERE_TRACER_CPU: Method = Method {
    name: "sphere-tracer-cpu",
    title: "Sphere tracing on the CPU",
    about: "The same in f64 on the CPU's threads; needs no adapter.",
    technique: Technique::Own(Own {
        make: |_| Renderer::Host(Box::new(SphereTracerCpu)),
        promise: Promise::Always,
        stop: Stop::Residual(TOLERANCE as f64),
        refuses,
    }),
    ..SPHERE_TRACER
};

fn main() -> ExitCode {
    metaball_cli::run_with([SPHERE_TRACER, SPHERE_TRACER_CPU])
}
