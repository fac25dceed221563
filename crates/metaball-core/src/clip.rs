//! Regions that a solid is cut to, and what a cut makes of rays and hits.

use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::{Aabb, Hit, Ray, Verdict};

/// A convex region: the points that lie in all of its half-spaces, all of space where it has none. What
/// of a solid lies in it is kept, and the solid is closed by the region's faces.
///
/// A ray is cut before it is traced, and what is found along its [section](Section) is an answer about
/// the cut solid:
///
/// ```
/// use metaball_core::{Clip, Hit, Ray, Verdict};
///
/// let clip = Clip::default().and_plane([0.0, 0.0, 1.0].into(), 0.5)?;
/// let section = clip.section(&Ray::new([0.0, 0.0, 3.0].into(), [0.0, 0.0, -1.0].into()));
/// assert_eq!(section.ray.t_min, 2.5);
///
/// // The section starts in the solid: on its cut face.
/// let inside = Hit { verdict: Verdict::Inside, t: section.ray.t_min, ..Hit::MISS };
/// let hit = section.first_hit(inside);
/// assert_eq!((hit.verdict, hit.t, hit.normal), (Verdict::Hit, 2.5, [0.0, 0.0, 1.0].into()));
/// # Ok::<(), metaball_core::ClipError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clip {
    planes: Vec<Plane>,
}

/// A half-space: the points x with `normal` · x ≤ `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plane {
    normal: Vec3,
    offset: f64,
}

/// Why numbers are no region.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ClipError {
    /// A plane's normal is zero or not finite.
    #[error("clip plane: needed a finite normal other than zero, found {found}")]
    Normal {
        /// The normal.
        found: Vec3,
    },
    /// A plane's offset is not finite.
    #[error("clip plane: needed a finite offset, found {found}")]
    Offset {
        /// The offset.
        found: f64,
    },
    /// A box has a corner that is not finite, or holds nothing.
    #[error("clip box: needed finite corners, the least one first, found {min} and {max}")]
    Box {
        /// The least corner.
        min: Vec3,
        /// The greatest corner.
        max: Vec3,
    },
}

impl Clip {
    /// What of the region lies on the inner side of a plane too: the points x with `normal` · x ≤
    /// `offset`, where the normal points out of what is kept. World space, in scene units for a unit
    /// normal; any other length will do.
    ///
    /// # Errors
    /// When the normal is zero or a number not finite.
    pub fn and_plane(mut self, normal: Vec3, offset: f64) -> Result<Self, ClipError> {
        if !normal.is_finite() || normal == Vec3::ZERO {
            return Err(ClipError::Normal { found: normal });
        }
        if !offset.is_finite() {
            return Err(ClipError::Offset { found: offset });
        }
        self.planes.push(Plane { normal, offset });
        Ok(self)
    }

    /// What of the region lies in a box too, world space, scene units.
    ///
    /// # Errors
    /// When the box holds no point or a number is not finite.
    pub fn and_box(mut self, bounds: &Aabb) -> Result<Self, ClipError> {
        let Aabb { min, max } = *bounds;
        if !min.is_finite() || !max.is_finite() || bounds.is_empty() {
            return Err(ClipError::Box { min, max });
        }
        for axis in Vec3::AXES {
            self.planes.push(Plane { normal: axis, offset: max.dot(axis).into() });
            self.planes.push(Plane { normal: -axis, offset: (-min.dot(axis)).into() });
        }
        Ok(self)
    }

    /// What of the region lies in the other one too.
    #[must_use]
    pub fn and(mut self, other: &Self) -> Self {
        self.planes.extend_from_slice(&other.planes);
        self
    }

    /// The same region where coordinates begin at `origin`, as those of a
    /// [scene](crate::Scene::origin) can.
    #[must_use]
    pub fn relative_to(mut self, origin: DVec3) -> Self {
        for plane in &mut self.planes {
            plane.offset -= plane.normal.as_dvec3().dot(origin);
        }
        self
    }

    /// The half-spaces that it is made of: the points x with normal · x ≤ offset, as [`Clip::and_plane`]
    /// takes them.
    pub fn planes(&self) -> impl ExactSizeIterator<Item = (Vec3, f64)> + '_ {
        self.planes.iter().map(|plane| (plane.normal, plane.offset))
    }

    /// Whether the region is all of space, which cuts nothing.
    pub fn is_all(&self) -> bool {
        self.planes.is_empty()
    }

    /// The part of a ray that lies in the region, and the faces that cut it off.
    ///
    /// Where the ray crosses a plane is computed in f64 from the stored numbers, and rounded once, to the
    /// nearest f32: the face is off by at most half a unit in the last place of t. Which face comes
    /// first, and whether there is a section at all, is decided before that rounding.
    pub fn section(&self, ray: &Ray) -> Section {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (mut start, mut end) = (f64::from(ray.t_min), f64::from(ray.t_max));
        let (mut entry, mut exit) = (None, None);
        for plane in &self.planes {
            let normal = plane.normal.as_dvec3();
            let rise = normal.dot(direction);
            let below = plane.offset - normal.dot(origin);
            let t = below / rise;
            if rise > 0.0 && t < end {
                (end, exit) = (t, Some(normal));
            } else if rise < 0.0 && t > start {
                (start, entry) = (t, Some(normal));
            } else if rise == 0.0 && below < 0.0 {
                (start, end) = (f64::INFINITY, f64::NEG_INFINITY);
            }
        }
        let (t_min, t_max) = if start <= end { (start as f32, end as f32) } else { (1.0, 0.0) };
        let ray = Ray { t_min, t_max, ..*ray };
        Section { ray, entry: entry.map(unit), exit: exit.map(unit) }
    }
}

/// The normal as it is stored in hits.
fn unit(normal: DVec3) -> Vec3 {
    normal.normalize().as_vec3()
}

/// The part of a ray that lies in a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// The ray from where it enters the region to where it leaves it; [empty](Ray::is_empty) where it
    /// misses it.
    pub ray: Ray,
    /// The unit normal, out of the region, of the face by which the ray enters it; `None` where the ray
    /// starts in the region.
    pub entry: Option<Vec3>,
    /// The same of the face by which it leaves; `None` where it ends in the region.
    pub exit: Option<Vec3>,
}

impl Section {
    /// The first hit of the cut solid, from that of the section: on the face where the section starts in
    /// the solid.
    pub fn first_hit(&self, found: Hit) -> Hit {
        match (found.verdict, self.entry) {
            (Verdict::Inside, Some(normal)) => Hit { verdict: Verdict::Hit, normal, ..found },
            _ => found,
        }
    }

    /// Whether a hit along the ray is on a face.
    pub fn has_on_face(&self, hit: &Hit) -> bool {
        let Ray { t_min, t_max, .. } = self.ray;
        let is_at = |t, face: Option<Vec3>| hit.t == t && face == Some(hit.normal);
        hit.verdict == Verdict::Hit && (is_at(t_min, self.entry) || is_at(t_max, self.exit))
    }

    /// Whether the cut solid is anywhere on the ray, from the same about the section.
    pub fn any_hit(&self, found: Verdict) -> Verdict {
        if found == Verdict::Inside && self.entry.is_some() { Verdict::Hit } else { found }
    }

    /// The first exit of the `whole` ray from the cut solid, from that of the section: on the face by
    /// which the ray leaves the region if it has not left the solid before. A ray that starts outside
    /// of the region is at its exit, [`Verdict::Inside`] the space beyond the solid.
    pub fn first_exit(&self, whole: &Ray, found: Hit) -> Hit {
        let starts_outside = self.entry.is_some() || self.ray.is_empty();
        match (found.verdict, self.exit) {
            _ if whole.is_empty() => found,
            _ if starts_outside => {
                let (t, normal) = (whole.t_min, whole.direction);
                Hit { verdict: Verdict::Inside, fallback: false, t, normal }
            }
            (Verdict::Miss, Some(normal)) => {
                Hit { verdict: Verdict::Hit, fallback: false, t: self.ray.t_max, normal }
            }
            _ => found,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NO_LIMIT;

    fn along_x() -> Ray {
        Ray::new(Vec3::new(-3.0, 0.25, 0.0), Vec3::X)
    }

    #[test]
    fn all_of_space_cuts_nothing() {
        let clip = Clip::default();
        assert!(clip.is_all());
        let section = clip.section(&along_x());
        assert_eq!(section, Section { ray: along_x(), entry: None, exit: None });
        let inside = Hit { verdict: Verdict::Inside, t: 0.0, ..Hit::MISS };
        assert_eq!(section.first_hit(inside), inside);
    }

    #[test]
    fn a_box_is_entered_and_left_by_its_faces() {
        let bounds = Aabb { min: Vec3::NEG_ONE, max: Vec3::new(0.1, 0.25, 2.0) };
        let clip = Clip::default().and_box(&bounds).expect("a box");
        let Section { ray, entry, exit } = clip.section(&along_x());
        // 3.1 of f32 numbers, rounded once.
        assert_eq!((ray.t_min, ray.t_max), (2.0, (3.0 + f64::from(0.1f32)) as f32));
        assert_eq!((entry, exit), (Some(Vec3::NEG_X), Some(Vec3::X)));
        let within = clip.section(&Ray { t_min: 2.5, t_max: 2.75, ..along_x() });
        assert_eq!((within.ray.t_min, within.ray.t_max), (2.5, 2.75));
        assert_eq!((within.entry, within.exit), (None, None));
        // Above it, past it, and short of it.
        let above = Ray { origin: Vec3::new(-3.0, 0.26, 0.0), ..along_x() };
        for missing in [above, Ray { t_min: 4.0, ..along_x() }, Ray { t_max: 1.0, ..along_x() }] {
            assert!(clip.section(&missing).ray.is_empty(), "{missing:?}");
        }
    }

    #[test]
    fn planes_have_normals_of_any_length() {
        let normal = Vec3::new(3.0, 4.0, 0.0);
        let clip = Clip::default().and_plane(normal, 1.0).expect("a plane");
        let section = clip.section(&along_x());
        // 3x + 4·0.25 = 1 where x = 0.
        assert_eq!((section.ray.t_min, section.ray.t_max), (0.0, 3.0));
        assert_eq!(section.exit, Some(Vec3::new(0.6, 0.8, 0.0)));
        let back = clip.section(&Ray::new(Vec3::new(2.0, 0.25, 0.0), Vec3::NEG_X));
        assert_eq!((back.ray.t_min, back.ray.t_max), (2.0, NO_LIMIT));
        assert_eq!(back.entry, Some(Vec3::new(0.6, 0.8, 0.0)));
    }

    #[test]
    fn a_region_is_the_same_about_another_origin() {
        let about = DVec3::new(5_460_000.0, 7.0, -2.0);
        let far = Clip::default().and_plane(Vec3::X, about.x + 0.25).expect("a plane");
        let both = far
            .relative_to(about)
            .and(&Clip::default().and_plane(Vec3::NEG_X, 1.0).expect("a plane"));
        let section = both.section(&along_x());
        assert_eq!((section.ray.t_min, section.ray.t_max), (2.0, 3.25));
    }

    #[test]
    fn exits_are_at_the_first_of_surface_and_face() {
        let clip = Clip::default().and_plane(Vec3::X, 0.5).expect("a plane");
        let section = clip.section(&along_x());
        let surface = Hit { verdict: Verdict::Hit, t: 3.25, fallback: false, normal: Vec3::Y };
        assert_eq!(section.first_exit(&along_x(), surface), surface);
        let face = Hit { t: 3.5, normal: Vec3::X, ..surface };
        assert!(section.has_on_face(&face) && !section.has_on_face(&surface));
        assert_eq!(section.first_exit(&along_x(), Hit::MISS), face);
        let ends = Ray { t_max: 3.0, ..along_x() };
        assert_eq!(clip.section(&ends).first_exit(&ends, Hit::MISS), Hit::MISS);
        let outside = Ray { t_min: 3.75, ..along_x() };
        let exit = clip.section(&outside).first_exit(&outside, Hit::MISS);
        assert_eq!((exit.verdict, exit.t), (Verdict::Inside, 3.75));
        let nothing = Ray { t_min: 2.0, t_max: 1.0, ..along_x() };
        assert_eq!(clip.section(&nothing).first_exit(&nothing, Hit::MISS), Hit::MISS);
    }

    #[test]
    fn numbers_that_are_no_region_are_refused() {
        let plane = |normal, offset| Clip::default().and_plane(normal, offset);
        assert_eq!(plane(Vec3::ZERO, 1.0), Err(ClipError::Normal { found: Vec3::ZERO }));
        assert!(plane(Vec3::NAN, 1.0).is_err());
        assert_eq!(plane(Vec3::X, f64::INFINITY), Err(ClipError::Offset { found: f64::INFINITY }));
        let turned = Aabb { min: Vec3::ONE, max: Vec3::ZERO };
        let error = Clip::default().and_box(&turned).expect_err("refused").to_string();
        assert!(error.starts_with("clip box: needed finite corners"), "{error}");
    }

    #[test]
    fn rays_without_meaning_do_no_harm() {
        let clip = Clip::default().and_plane(Vec3::X, 0.5).expect("a plane");
        for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            clip.section(&Ray::new(Vec3::ZERO, bad));
            clip.section(&Ray::new(bad, Vec3::X));
        }
        assert!(clip.section(&Ray::new(Vec3::X, Vec3::ZERO)).ray.is_empty());
    }
}
