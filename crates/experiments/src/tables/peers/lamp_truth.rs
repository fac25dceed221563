//! Where the lamp shines, by the oracle: what hard shadows are held against.

use glam::{DVec3, Vec3};
use metaball_core::reference::{Oracle, Truth};
use metaball_core::{Ray, Scene, SurfaceColors, Verdict, View};
use metaball_light::Lamp;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Every fourth pixel across and down: a sixteenth of them.
const STRIDE: usize = 4;

/// Where a shadow ray starts above the surface, in least radii. Where the two do not agree, it is not
/// clear whether the lamp shines.
const STARTS: [f64; 2] = [1e-4, 3e-3];

/// The cosine below which a surface that faces the lamp is too dark to tell.
const TELLING_COSINE: f64 = 0.02;

/// Light that is none, in eight bits.
const DARK: f32 = 2.0 / 255.0;

/// Pixels of which it is clear whether the lamp lights them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LampTruth {
    pixels: Vec<LampPixel>,
    unclear: usize,
}

/// A pixel whose light is on one side of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LampPixel {
    index: usize,
    is_lit: bool,
    /// Half of the light that the lamp would bring, without a highlight; of the brightest channel.
    limit: f32,
}

/// What the eye sees in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Seen {
    /// It is not clear what.
    Unclear,
    /// Nothing, or a surface that faces away from the lamp.
    Dark,
    /// A surface that faces the lamp, which would bring it so much light: starts of shadow rays.
    Facing { starts: [DVec3; 2], light: f32 },
}

/// A picture against the oracle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct WrongLight {
    /// Pixels that were looked at: every fourth across and down.
    pub pixels: usize,
    /// Of these, where it is not clear whether the lamp shines.
    pub unclear: usize,
    /// Pixels that are lit and should not be.
    pub lit: usize,
    /// Pixels that are dark and should not be.
    pub dark: usize,
}

impl LampTruth {
    /// Of a scene in a lamp's light; on the current pool.
    pub(super) fn new(scene: &Scene, view: &View, lamp: &Lamp) -> Self {
        let oracle = Oracle::new(scene);
        let width = view.width() as usize;
        let indices: Vec<_> = (0..view.height() as usize)
            .step_by(STRIDE)
            .flat_map(|row| (0..width).step_by(STRIDE).map(move |column| row * width + column))
            .collect();
        let all = view.rays();
        let rays: Vec<_> = indices.iter().map(|&index| all[index]).collect();
        let toward = lamp.toward.as_dvec3().normalize();
        let bright = lamp.color * SurfaceColors::UNCOLORED;
        let truths = oracle.first_hits(&rays);
        let pixels: Vec<_> = (indices.par_iter().zip(rays.par_iter().zip(&truths)))
            .filter_map(|(&index, (ray, truth))| {
                let (is_lit, limit) = match Seen::new(ray, truth, toward, bright.max_element()) {
                    Seen::Unclear => return None,
                    Seen::Dark => (false, DARK),
                    Seen::Facing { starts, light } => {
                        (!is_shadowed(&oracle, starts, toward)?, 0.5 * light)
                    }
                };
                Some(LampPixel { index, is_lit, limit })
            })
            .collect();
        Self { unclear: indices.len() - pixels.len(), pixels }
    }

    /// Counts what is wrong in a picture, which has the view's pixels.
    pub(super) fn wrong(&self, light: &[Vec3]) -> WrongLight {
        let is_lit = |pixel: &LampPixel| light[pixel.index].max_element() > pixel.limit;
        let count = |lit: bool| {
            let wrong = |pixel: &&LampPixel| pixel.is_lit != lit && is_lit(pixel) == lit;
            self.pixels.iter().filter(wrong).count()
        };
        WrongLight {
            pixels: self.pixels.len() + self.unclear,
            unclear: self.unclear,
            lit: count(true),
            dark: count(false),
        }
    }
}

impl Seen {
    /// Along an eye ray; `bright` is the light of a surface that faces the lamp squarely.
    fn new(ray: &Ray, truth: &Truth, toward: DVec3, bright: f32) -> Self {
        let cosine = truth.normal.dot(toward);
        match truth.verdict {
            _ if truth.is_ambiguous() => Self::Unclear,
            Verdict::Miss => Self::Dark,
            Verdict::Hit if cosine <= 0.0 => Self::Dark,
            Verdict::Hit if cosine >= TELLING_COSINE => {
                let point = ray.origin.as_dvec3() + truth.t * ray.direction.as_dvec3();
                let above = f64::from(truth.smallest_radius) * truth.normal;
                Self::Facing {
                    starts: STARTS.map(|start| point + start * above),
                    light: bright * cosine as f32,
                }
            }
            _ => Self::Unclear,
        }
    }
}

/// Whether anything is between the starts and the lamp; `None` where that is not clear.
fn is_shadowed(oracle: &Oracle<'_>, starts: [DVec3; 2], toward: DVec3) -> Option<bool> {
    let [near, far] =
        starts.map(|start| oracle.first_hit(&Ray::new(start.as_vec3(), toward.as_vec3())));
    let is_clear = !near.is_ambiguous() && !far.is_ambiguous();
    let is_hit = |truth: Truth| truth.verdict != Verdict::Miss;
    (is_clear && is_hit(near) == is_hit(far)).then(|| is_hit(near))
}
