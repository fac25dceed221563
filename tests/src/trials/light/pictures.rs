//! Pictures of the path tracer: the same from the same seed, from any method as far as primary rays go, and
//! refused beyond.

use experiments::lit_twins::floor_below;
use glam::Vec3;
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::Gpu;
use metaball_light::gpu::PathTracer;
use metaball_light::{Effects, Environment, Surface};

use super::CERTIFIED;
use crate::trials::{load, on_adapter, on_gpu, view_of};

pub(super) fn trials() -> Vec<Trial> {
    vec![
        on_gpu("light::same_seed_same_picture".to_owned(), same_seed_same_picture),
        on_gpu("light::what_is_not_given_is_refused".to_owned(), what_is_not_given_is_refused),
        on_gpu("light::one_surface_is_enough".to_owned(), one_surface_is_enough),
    ]
}

fn same_seed_same_picture(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let view = view_of(&bench)?;
    let film = |seed| {
        let effects = Effects {
            surface: Surface::Fluid { refraction: 1.33, absorption: Vec3::ONE },
            bounces: 4,
            environment: Environment::Sky,
            ..Effects::phong(&bench.camera)
        };
        let mut renderer = on_adapter(CERTIFIED)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects, 2, seed)?;
        tracer.add_sample(renderer.as_mut())?;
        tracer.add_sample(renderer.as_mut())?;
        Ok::<_, Failed>(tracer.film()?)
    };
    let first = film(1)?;
    if first != film(1)? {
        return Err("one seed, two pictures".into());
    }
    if first == film(2)? {
        return Err("two seeds, one picture: nothing is sampled".into());
    }
    Ok(())
}

/// What ends at the first surface is drawn from any method's primary hits: as from free rays where every
/// ray goes through its pixel's middle, and nearly so where samples are spread.
fn one_surface_is_enough(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("colors-100")?;
    let view = view_of(&bench)?;
    let effects = Effects {
        surface: Surface::Opaque { reflectivity: 0.3 },
        floor: Some(floor_below(&bench.scene)),
        ..Effects::phong(&bench.camera)
    };
    let film = |method, samples| {
        let mut renderer = on_adapter(method)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects.clone(), samples, 7)?;
        for _ in 0..samples {
            tracer.add_sample(renderer.as_mut())?;
        }
        Ok::<_, Failed>(tracer.film()?.light)
    };
    for (samples, tolerance) in [(1, 1e-3), (16, 0.02)] {
        let wanted = film(CERTIFIED, samples)?;
        for method in ["kanamori-robust", "illes-exact"] {
            let found = film(method, samples)?;
            let apart: f32 =
                found.iter().zip(&wanted).map(|(a, b)| (*a - *b).abs().max_element()).sum();
            let mean = apart / wanted.len() as f32;
            if mean > tolerance {
                return Err(format!("{method}, {samples} samples: {mean} apart").into());
            }
        }
    }
    let darkness = vec![Vec3::ZERO; view.pixels()];
    if film(CERTIFIED, 1)?.iter().zip(&darkness).all(|(a, b)| (*a - *b).length() < 0.02) {
        return Err("there is nothing to compare".into());
    }
    Ok(())
}

fn what_is_not_given_is_refused(gpu: &Gpu) -> Result<(), Failed> {
    let bench = load("two-merging")?;
    let view = view_of(&bench)?;
    let fluid = Surface::Fluid { refraction: 1.33, absorption: Vec3::ZERO };
    let phong = Effects::phong(&bench.camera);
    let refused = [
        ("illes", Effects { shadows: true, ..phong.clone() }),
        ("kanamori", Effects { bounces: 1, ..phong.clone() }),
        ("fbvh", Effects { surface: fluid, ..phong.clone() }),
        ("fbvh-certified", Effects { surface: Surface::SeeThrough { opacity: 0.5 }, ..phong }),
    ];
    for (method, effects) in refused {
        let mut renderer = on_adapter(method)?;
        renderer.build(gpu, &bench.scene)?;
        let mut tracer = PathTracer::new(gpu, &bench.scene, &view, effects, 1, 0)?;
        match tracer.add_sample(renderer.as_mut()) {
            Err(error) if error.to_string().starts_with(&format!("method {method}: needed")) => {}
            outcome => return Err(format!("{method}: needed a refusal, found {outcome:?}").into()),
        }
    }
    Ok(())
}
