//! The surface's own colour.

use glam::Vec3;

use crate::{Color, Scene};

/// A scene's balls as they colour its surface, and the means to find those around a point.
#[derive(Debug)]
pub struct SurfaceColors<'a> {
    scene: &'a Scene,
    /// Balls by the x of their centres; empty in a scene without colours.
    along_x: Vec<u32>,
    /// The largest of their support radii.
    reach: f32,
}

impl<'a> SurfaceColors<'a> {
    /// The material of scenes without colours, in linear light: `WHITE` of `shaders/wgsl/shade/light.wgsl`.
    pub const UNCOLORED: Vec3 = Vec3::new(0.80, 0.78, 0.74);

    /// The colours of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        let supports = scene.supports();
        let balls = if scene.colors().is_some() { scene.len() as u32 } else { 0 };
        let mut along_x: Vec<_> = (0..balls).collect();
        let x = |ball: u32| supports[ball as usize].center.x;
        along_x.sort_by(|&a, &b| x(a).total_cmp(&x(b)));
        let radius = |&ball: &u32| supports[ball as usize].radius;
        let reach = along_x.iter().map(radius).fold(0.0, f32::max);
        Self { scene, along_x, reach }
    }

    /// The colour at a point of the surface in linear light: each ball's counts by its share of what is added
    /// to the field, and those of balls that take away from it do not. `near` names balls among which are all that add to the field there; where it is empty they
    /// are looked for.
    pub fn at(&self, point: Vec3, near: &[u32]) -> Vec3 {
        let Some(colors) = self.scene.colors() else { return Self::UNCOLORED };
        let near = if near.is_empty() { self.around(point) } else { near };
        let mut blended = Vec3::ZERO;
        let mut total = 0.0;
        for &ball in near {
            let ball = ball as usize;
            let support = self.scene.supports()[ball];
            let depth =
                1.0 - point.distance_squared(support.center) / (support.radius * support.radius);
            let strength = self.scene.strengths().map_or(1.0, |strengths| strengths[ball]);
            if depth > 0.0 && strength > 0.0 {
                let weight = strength * self.scene.kernel().value_at_depth(depth);
                blended += weight * colors[ball].to_linear();
                total += weight;
            }
        }
        // Methods store what they blend in eight bits before it is lit.
        Color::from_linear(blended / f32::max(total, 1e-30)).to_linear()
    }

    fn around(&self, point: Vec3) -> &[u32] {
        let x = |&ball: &u32| self.scene.supports()[ball as usize].center.x;
        let first = self.along_x.partition_point(|ball| x(ball) < point.x - self.reach);
        let end = self.along_x.partition_point(|ball| x(ball) <= point.x + self.reach);
        &self.along_x[first..end]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Kernel, Metaball};

    #[test]
    fn colors_are_blended_by_shares_of_the_field() {
        let balls = [-0.5, 0.5, 9.0].map(|x| Metaball::new(x * Vec3::X, 1.0));
        let plain = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
        let [red, green, blue] =
            [[255, 0, 0], [0, 255, 0], [0, 0, 255]].map(|[r, g, b]| Color::srgb(r, g, b));
        let scene = plain.clone().with_colors(vec![red, green, blue]).expect("a colour a ball");
        let colors = SurfaceColors::new(&scene);
        let middle = colors.at(Vec3::ZERO, &[]);
        assert!((middle - Vec3::new(0.5, 0.5, 0.0)).abs().max_element() < 5e-3, "{middle}");
        assert_eq!(colors.at(Vec3::ZERO, &[0, 1, 2]), middle);
        assert_eq!(colors.at(9.0 * Vec3::X, &[]), Vec3::Z);
        assert_eq!(SurfaceColors::new(&plain).at(Vec3::ZERO, &[]), SurfaceColors::UNCOLORED);
    }

    #[test]
    fn what_takes_away_has_no_color() {
        let balls = [(-0.5, 1.0), (0.5, -0.5)]
            .map(|(x, strength)| Metaball { strength, ..Metaball::new(x * Vec3::X, 1.0) });
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
        let [red, green] = [[255, 0, 0], [0, 255, 0]].map(|[r, g, b]| Color::srgb(r, g, b));
        let scene = scene.with_colors(vec![red, green]).expect("a colour a ball");
        assert_eq!(SurfaceColors::new(&scene).at(Vec3::ZERO, &[]), Vec3::X);
    }
}
