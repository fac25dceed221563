//! Lit pictures: POV-Ray's own shading in the same light, as a whole process.

use std::time::Instant;

use glam::Vec3;
use metaball_core::{Scene, SurfaceColors, View};
use metaball_light::{Effects, Lamp, Surface};

use super::blob::{Look, scene_text, vector};
use super::job::Job;
use super::log::{clocks, count};
use crate::tables::peers::effect::LitEffect;
use harness::measure::milliseconds;

/// A view of a scene in some light.
#[derive(Debug)]
pub struct LitPicture {
    effect: LitEffect,
    job: Job,
}

/// What a picture took; times are milliseconds by the wall's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitCost {
    /// From the start of the process to its end.
    pub process: f64,
    /// For parsing and tracing, by its own clock.
    pub work: f64,
    /// Rays of its radiosity; 0 without.
    pub occlusion_rays: u64,
}

impl LitPicture {
    /// Writes the scene down. The field is that of α = 2 whatever the scene's kernel is.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn new(
        scene: &Scene,
        view: &View,
        effect: LitEffect,
        threads: usize,
    ) -> anyhow::Result<Self> {
        let look = look(scene, effect, &effect.effects(view.camera())?);
        Ok(Self { effect, job: Job::new(&scene_text(scene, view, &look), view, threads)? })
    }

    /// Draws the scene, and reads what it took.
    ///
    /// # Errors
    /// When it fails, with its own words, or does not say how long it took.
    pub fn draw(&self) -> anyhow::Result<LitCost> {
        let start = Instant::now();
        let log = self.job.draw(&[])?;
        let process = milliseconds(start.elapsed());
        let clock = |heading| clocks(&log, heading).map(|(wall, _)| wall);
        let mut work = clock("Parse Time:")? + clock("Trace Time:")?;
        let mut occlusion_rays = 0;
        if self.effect == LitEffect::Occlusion {
            work += clock("Radiosity Time:")?;
            occlusion_rays = count(&log, "Radiosity sample rays shot:")?;
        }
        Ok(LitCost { process, work, occlusion_rays })
    }

    /// Linear light of each pixel that was drawn last, 0 to 1, row by row from the top left.
    ///
    /// # Errors
    /// When there is no picture of the size.
    pub fn light(&self) -> anyhow::Result<Vec<Vec3>> {
        let picture = self.job.picture()?;
        let share = |channel: u16| f32::from(channel) / f32::from(u16::MAX);
        Ok(picture.pixels().map(|color| Vec3::from(color.0.map(share))).collect())
    }
}

/// The effect in POV-Ray's own terms.
fn look(scene: &Scene, effect: LitEffect, effects: &Effects) -> Look {
    let settings = match effect {
        LitEffect::Shadows => String::new(),
        // No ray is too faint to be followed; the primary one counts as a level.
        LitEffect::Mirrors => {
            format!("max_trace_level {} adc_bailout 0", effects.bounces + 1)
        }
        LitEffect::Occlusion => {
            format!("radiosity {{ count {} recursion_limit 1 }}", LitEffect::OCCLUSION_RAYS)
        }
    };
    let around = match effect {
        LitEffect::Occlusion => "background { rgb 1 }".to_owned(),
        _ => effects.lamps.iter().map(|lamp| lamp_text(scene, lamp)).collect(),
    };
    let reflectivity = match effects.surface {
        Surface::Opaque { reflectivity } => reflectivity,
        Surface::SeeThrough { .. } | Surface::Fluid { .. } => 0.0,
    };
    // What a mirror reflects at normal incidence it does not scatter.
    let scattered = 1.0 - reflectivity;
    let highlight = scattered * HIGHLIGHT;
    let reflection = if reflectivity > 0.0 {
        // Schlick's approximation.
        format!("reflection {{ rgb {reflectivity:e}, rgb 1 falloff 5 }}")
    } else {
        String::new()
    };
    let color = vector(SurfaceColors::UNCOLORED.as_dvec3());
    let surface = format!(
        "pigment {{ rgb {color} }}\nfinish {{ ambient 0 emission 0 diffuse {scattered:e} \
         phong {highlight:e} phong_size 48 {reflection} }}"
    );
    Look { settings, around, surface }
}

/// Phong's highlight as metaball-light has it, with an exponent of 48.
const HIGHLIGHT: f32 = 0.22;

/// Parallel light from a plane outside of the scene.
fn lamp_text(scene: &Scene, lamp: &Lamp) -> String {
    let bounds = scene.bounds();
    let target = bounds.center().as_dvec3();
    let distance = 4.0 * f64::from(bounds.extent().length());
    let position = target + distance * lamp.toward.as_dvec3().normalize();
    format!(
        "light_source {{ {} rgb {} parallel point_at {} }}\n",
        vector(position),
        vector(lamp.color.as_dvec3()),
        vector(target)
    )
}
