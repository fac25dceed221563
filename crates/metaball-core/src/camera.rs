//! Pinhole cameras, and views: cameras with an image size.

use std::ops::Range;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use thiserror::Error;

use crate::{Aabb, NO_LIMIT, Ray};

/// A pinhole camera in a right-handed world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    half_height: f32,
}

/// Why arguments make no camera.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A vector has a NaN or infinite coordinate.
    #[error("camera {name}: needed finite coordinates, found {found}")]
    NotFinite {
        /// `eye`, `look_at` or `up`.
        name: &'static str,
        /// The vector.
        found: Vec3,
    },
    /// The vertical field of view is out of range.
    #[error("camera vertical_fov_degrees: needed an angle above 0 and below 180, found {found}")]
    FieldOfView {
        /// The angle in degrees.
        found: f32,
    },
    /// Eye and `look_at` are one point.
    #[error("camera: needed an eye apart from look_at, found both at {found}")]
    NoDirection {
        /// The common point.
        found: Vec3,
    },
    /// The up vector is zero or parallel to the direction of view.
    #[error("camera up: needed a vector that is not along the view direction, found {found}")]
    Up {
        /// The up vector.
        found: Vec3,
    },
}

impl Camera {
    /// A camera at `eye` that sees `look_at` in the middle of its picture. `up` points upwards in
    /// the picture; it need be neither unit nor perpendicular. The field of view is the angle
    /// between the top and the bottom edge.
    ///
    /// # Errors
    /// Names the argument that makes no camera.
    pub fn look_at(
        eye: Vec3,
        look_at: Vec3,
        up: Vec3,
        vertical_fov_degrees: f32,
    ) -> Result<Self, CameraError> {
        for (name, found) in [("eye", eye), ("look_at", look_at), ("up", up)] {
            if !found.is_finite() {
                return Err(CameraError::NotFinite { name, found });
            }
        }
        if !(vertical_fov_degrees > 0.0 && vertical_fov_degrees < 180.0) {
            return Err(CameraError::FieldOfView { found: vertical_fov_degrees });
        }
        let forward = (look_at.as_dvec3() - eye.as_dvec3())
            .try_normalize()
            .ok_or(CameraError::NoDirection { found: eye })?;
        let right = up
            .as_dvec3()
            .try_normalize()
            .map(|up| forward.cross(up))
            .filter(|right| right.length() > 1e-6)
            .ok_or(CameraError::Up { found: up })?
            .normalize();
        let half_height = (0.5 * f64::from(vertical_fov_degrees)).to_radians().tan();
        Ok(Self {
            eye,
            right: right.as_vec3(),
            up: right.cross(forward).as_vec3(),
            forward: forward.as_vec3(),
            half_height: half_height as f32,
        })
    }

    /// A camera with y up, or with z up where it looks along y: see [`look_at`](Self::look_at).
    ///
    /// # Errors
    /// Names the argument that makes no camera.
    pub fn upright(
        eye: Vec3,
        look_at: Vec3,
        vertical_fov_degrees: f32,
    ) -> Result<Self, CameraError> {
        let towards = |up| Self::look_at(eye, look_at, up, vertical_fov_degrees);
        towards(Vec3::Y).or_else(|error| match error {
            CameraError::Up { .. } => towards(Vec3::Z),
            error => Err(error),
        })
    }

    /// A camera outside the box that frames its bounding sphere, seen from `direction` (from the
    /// middle of the box towards the eye; not zero), [upright](Self::upright) and with a field of view of
    /// 38°. An empty box is framed as a unit cube at the origin.
    pub fn framing(bounds: &Aabb, direction: Vec3) -> Self {
        const FIELD_OF_VIEW: f32 = 38.0;
        let (center, radius) = if bounds.is_empty() {
            (Vec3::ZERO, 1.0)
        } else {
            (bounds.center(), 0.5 * bounds.extent().length())
        };
        let distance = radius / (0.5 * FIELD_OF_VIEW).to_radians().sin();
        let direction = direction.try_normalize().unwrap_or(Vec3::Z);
        // A speck far from the origin can be nearer than the next float: then any camera will do.
        Self::upright(center + distance * direction, center, FIELD_OF_VIEW).unwrap_or(Self {
            eye: center,
            right: Vec3::X,
            up: Vec3::Y,
            forward: Vec3::NEG_Z,
            half_height: 0.34,
        })
    }

    /// The camera whose parts these are, bit for bit: [`eye`](Self::eye), the axes [`right`](Self::right),
    /// [`up`](Self::up) and [`forward`](Self::forward), and [`half_height`](Self::half_height).
    ///
    /// # Errors
    /// Names what no camera has.
    pub fn of_parts(eye: Vec3, axes: [Vec3; 3], half_height: f32) -> Result<Self, CameraError> {
        /// Of what is 0 or 1 between unit vectors at right angles, in f32.
        const ROUNDING: f32 = 1e-5;
        let [right, up, forward] = axes;
        let products = [right.length_squared() - 1.0, up.length_squared() - 1.0, up.dot(right)];
        let is_framed = products.iter().all(|product| product.abs() <= ROUNDING)
            && right.cross(up).distance(-forward) <= ROUNDING;
        if !eye.is_finite() {
            return Err(CameraError::NotFinite { name: "eye", found: eye });
        }
        if !is_framed {
            return Err(CameraError::Up { found: up });
        }
        if !(half_height > 0.0 && half_height.is_finite()) {
            let found = 2.0 * half_height.atan().to_degrees();
            return Err(CameraError::FieldOfView { found });
        }
        Ok(Self { eye, right, up, forward, half_height })
    }

    /// Where all primary rays start, world space, scene units.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// Unit vector to the right of the picture.
    pub fn right(&self) -> Vec3 {
        self.right
    }

    /// Unit vector to the top of the picture.
    pub fn up(&self) -> Vec3 {
        self.up
    }

    /// Unit vector into the picture.
    pub fn forward(&self) -> Vec3 {
        self.forward
    }

    /// Tangent of half the vertical field of view: half the picture's height at unit distance.
    pub fn half_height(&self) -> f32 {
        self.half_height
    }

    /// The same camera turned about its eye, so that the middle of its picture is what was at (`right`, `up`)
    /// from the middle, in scene units on the picture at unit distance.
    #[must_use]
    pub fn turned(&self, right: f32, up: f32) -> Self {
        let [x, y, z] = [self.right, self.up, self.forward].map(Vec3::as_dvec3);
        let forward = (z + f64::from(right) * x + f64::from(up) * y).normalize();
        // Not along `up`, since `forward` was across it.
        let right = forward.cross(y).normalize();
        let up = right.cross(forward);
        let (right, up, forward) = (right.as_vec3(), up.as_vec3(), forward.as_vec3());
        Self { right, up, forward, ..*self }
    }

    /// The same camera moved sideways and upwards by so many scene units, looking the same way.
    #[must_use]
    pub fn shifted(&self, right: f32, up: f32) -> Self {
        Self { eye: self.eye + right * self.right + up * self.up, ..*self }
    }

    /// The unit direction through the middle of pixel (`column`, `row`), counted from the top left,
    /// in f64 from the stored f32 camera. [`View::rays`] hands out its f32 rounding; the rays of shaders
    /// are tested against it.
    pub fn exact_direction(&self, column: u32, row: u32, width: u32, height: u32) -> DVec3 {
        (self.towards_column(column, width, height) + self.up_to_row(row, height)).normalize()
    }

    /// From the eye to the middle of a column, on the picture at unit distance.
    fn towards_column(&self, column: u32, width: u32, height: u32) -> DVec3 {
        let (width, height) = (f64::from(width), f64::from(height));
        let half_height = f64::from(self.half_height);
        let x = (2.0 * (f64::from(column) + 0.5) / width - 1.0) * half_height * width / height;
        self.forward.as_dvec3() + x * self.right.as_dvec3()
    }

    /// From the middle of the picture at unit distance up to a row.
    fn up_to_row(&self, row: u32, height: u32) -> DVec3 {
        let y = 1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(height);
        y * f64::from(self.half_height) * self.up.as_dvec3()
    }
}

/// A camera, an image size, and perhaps an opaque scene among the metaballs.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    camera: Camera,
    width: u32,
    height: u32,
    opaque_distance: Option<Arc<[f32]>>,
}

/// Why arguments make no view.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The image has no pixels, or more than an index of 32 bits can name.
    #[error("image size: needed from 1 to {} pixels, found {width} × {height}", i32::MAX)]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The opaque distance image has another size than the view.
    #[error("opaque distance image: needed {needed} pixels, found {found}")]
    OpaqueSize {
        /// Width times height of the view.
        needed: usize,
        /// Pixels of the image.
        found: usize,
    },
    /// A distance is negative or NaN.
    #[error(
        "opaque distance image: needed distances of at least 0, found {found} at pixel {index}"
    )]
    OpaqueDistance {
        /// Index of the pixel, row by row from the top left.
        index: usize,
        /// The distance, printed.
        found: String,
    },
}

impl View {
    /// A view without an opaque scene.
    ///
    /// # Errors
    /// When the image has no pixels or too many.
    pub fn new(camera: Camera, width: u32, height: u32) -> Result<Self, ViewError> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > i32::MAX as u64 {
            return Err(ViewError::Size { width, height });
        }
        Ok(Self { camera, width, height, opaque_distance: None })
    }

    /// Adds an opaque scene: for each pixel, row by row from the top left, the t at which its ray meets
    /// something opaque, scene units, +∞ where there is nothing (Illés and Szécsi, phase 2; the polygons of
    /// Kanamori et al.). No ray continues beyond it.
    ///
    /// # Errors
    /// When the image's size differs or a distance is negative or NaN.
    pub fn with_opaque_distance(mut self, distance: Arc<[f32]>) -> Result<Self, ViewError> {
        if distance.len() != self.pixels() {
            return Err(ViewError::OpaqueSize { needed: self.pixels(), found: distance.len() });
        }
        if let Some(index) = distance.iter().position(|t| t.is_nan() || *t < 0.0) {
            let found = distance[index].to_string();
            return Err(ViewError::OpaqueDistance { index, found });
        }
        self.opaque_distance = Some(distance);
        Ok(self)
    }

    /// The same image size and opaque scene, seen by another camera.
    #[must_use]
    pub fn with_camera(&self, camera: Camera) -> Self {
        Self { camera, ..self.clone() }
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Width times height.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Distances of the opaque scene, if the view has one.
    pub fn opaque_distance(&self) -> Option<&[f32]> {
        self.opaque_distance.as_deref()
    }

    /// The view's rays, row by row from the top left: exact directions, rounded once. They end where
    /// the opaque scene does. Made on rayon's current pool.
    pub fn rays(&self) -> Vec<Ray> {
        self.rays_of_rows(0..self.height)
    }

    /// The same of some rows, counted from the top; of those that the view has.
    pub fn rays_of_rows(&self, rows: Range<u32>) -> Vec<Ray> {
        let rows = rows.start.min(self.height)..rows.end.min(self.height);
        let width = self.width as usize;
        let (first, directions) = (rows.start as usize * width, self.directions());
        let ray = |pixel: usize| {
            let opaque = self.opaque_distance().map(|distances| distances[pixel]);
            let t_max = opaque.map_or(NO_LIMIT, |distance| distance.min(NO_LIMIT));
            Ray { t_max, ..Ray::new(self.camera.eye, directions.through(pixel as u32)) }
        };
        (first..first + rows.len() * width).into_par_iter().map(ray).collect()
    }

    /// The directions of the view's rays.
    pub fn directions(&self) -> PixelDirections {
        let Self { camera, width, height, .. } = self;
        let column = |column| camera.towards_column(column, *width, *height);
        let row = |row| camera.up_to_row(row, *height);
        PixelDirections {
            columns: (0..*width).map(column).collect(),
            rows: (0..*height).map(row).collect(),
        }
    }
}

/// Directions through the middles of a view's pixels. A picture has few columns and rows, and many
/// pixels: what those of a column or a row have in common is kept.
#[derive(Debug, Clone)]
pub struct PixelDirections {
    columns: Vec<DVec3>,
    rows: Vec<DVec3>,
}

impl PixelDirections {
    /// The unit direction through a pixel, named by its index row by row: [`Camera::exact_direction`],
    /// rounded once.
    ///
    /// # Panics
    /// When the view has no such pixel.
    pub fn through(&self, pixel: u32) -> Vec3 {
        let (column, row) =
            (pixel as usize % self.columns.len(), pixel as usize / self.columns.len());
        (self.columns[column] + self.rows[row]).normalize().as_vec3()
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    fn camera() -> Camera {
        Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 90.0).expect("legal")
    }

    #[test]
    fn a_turned_camera_looks_where_it_was_told() {
        let camera = camera().turned(0.3, -0.2);
        let wanted = Vec3::new(0.3, -0.2, -1.0).normalize();
        assert_abs_diff_eq!(camera.forward(), wanted, epsilon = 1e-6);
        assert_abs_diff_eq!(camera.right().cross(camera.up()), -wanted, epsilon = 1e-6);
        assert_abs_diff_eq!(camera.right().dot(camera.up()), 0.0, epsilon = 1e-6);
        assert!(camera.right().y.abs() < 1e-6 && camera.up().y > 0.9);
    }

    #[test]
    fn its_parts_make_a_camera_again() {
        let camera = camera().turned(0.3, -0.2);
        let axes = [camera.right(), camera.up(), camera.forward()];
        let again = |axes, height| Camera::of_parts(camera.eye(), axes, height);
        assert_eq!(again(axes, camera.half_height()), Ok(camera));
        let mirrored = [-axes[0], axes[1], axes[2]];
        assert!(matches!(again(mirrored, 1.0), Err(CameraError::Up { .. })));
        assert!(matches!(again([Vec3::NAN; 3], 1.0), Err(CameraError::Up { .. })));
        assert!(matches!(again(axes, 0.0), Err(CameraError::FieldOfView { .. })));
    }

    #[test]
    fn directions_follow_the_picture() {
        let middle = camera().exact_direction(1, 1, 3, 3);
        assert_abs_diff_eq!(middle.as_vec3(), Vec3::NEG_Z, epsilon = 1e-6);
        let top_left = camera().exact_direction(0, 0, 3, 3);
        assert!(top_left.x < 0.0 && top_left.y > 0.0);
        // A field of view of 90° puts the top edge at 45°.
        let top = camera().exact_direction(1, 0, 3, 3_000);
        assert_abs_diff_eq!(top.y / -top.z, 1.0, epsilon = 1e-3);
    }

    #[test]
    fn rays_go_through_the_middles_of_pixels() {
        let (width, height) = (37, 23);
        let distances: Arc<[f32]> =
            (0..width * height).map(|pixel| [2.5, f32::INFINITY][pixel as usize % 2]).collect();
        let view = View::new(camera().turned(0.3, -0.2), width, height).expect("legal");
        let view = view.with_opaque_distance(distances).expect("a distance a pixel");
        let rays = view.rays();
        assert_eq!(rays.len(), view.pixels());
        for (pixel, ray) in (0..).zip(rays) {
            let (column, row) = (pixel % width, pixel / width);
            let direction = view.camera().exact_direction(column, row, width, height).as_vec3();
            let t_max = [2.5, NO_LIMIT][pixel as usize % 2];
            assert_eq!(ray, Ray { t_max, ..Ray::new(view.camera().eye(), direction) });
        }
    }

    #[test]
    fn rows_have_the_rays_of_the_view() {
        let (width, height) = (37, 23);
        let distances: Arc<[f32]> = (0..width * height).map(|pixel| pixel as f32).collect();
        let view = View::new(camera().turned(0.3, -0.2), width, height).expect("legal");
        let view = view.with_opaque_distance(distances).expect("a distance a pixel");
        for step in [1, 8, 16, 23, 40] {
            let bands = (0..height).step_by(step);
            let rays: Vec<Ray> =
                bands.flat_map(|row| view.rays_of_rows(row..row + step as u32)).collect();
            assert!(rays == view.rays(), "in steps of {step} rows");
        }
        assert_eq!(view.rays_of_rows(23..30), []);
        assert_ne!(view.rays_of_rows(0..8), view.rays_of_rows(8..16));
    }

    #[test]
    fn z_is_up_where_y_is_ahead() {
        for (eye, up) in [(Vec3::Y, Vec3::Z), (Vec3::NEG_Y, Vec3::Z), (Vec3::Z, Vec3::Y)] {
            let camera = Camera::upright(10.0 * eye, Vec3::ZERO, 38.0).expect("legal");
            assert_eq!(Ok(camera), Camera::look_at(10.0 * eye, Vec3::ZERO, up, 38.0));
        }
        let tilted = Camera::upright(Vec3::new(0.0, 10.0, 0.01), Vec3::ZERO, 38.0).expect("legal");
        assert!(tilted.up().z < -0.99, "y is up as long as it can be");
        assert!(Camera::upright(Vec3::Y, Vec3::Y, 38.0).is_err());
        assert!(Camera::upright(Vec3::Y, Vec3::ZERO, 180.0).is_err());
    }

    #[test]
    fn impossible_cameras_are_refused() {
        let up = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::Z, 38.0).expect_err("refused");
        assert!(up.to_string().starts_with("camera up: needed"));
        let fov = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::Y, 180.0).expect_err("refused");
        assert_eq!(fov, CameraError::FieldOfView { found: 180.0 });
        assert!(Camera::look_at(Vec3::Z, Vec3::Z, Vec3::Y, 38.0).is_err());
        assert!(Camera::look_at(Vec3::NAN, Vec3::Z, Vec3::Y, 38.0).is_err());
    }

    #[test]
    fn framing_never_fails() {
        for center in [0.0, 1.0, 1e18] {
            for radius in [1e-18, 1.0, 1e18] {
                for direction in [Vec3::Z, Vec3::Y, Vec3::ZERO, Vec3::ONE] {
                    let bounds = Aabb::around_sphere(Vec3::splat(center), radius);
                    assert!(Camera::framing(&bounds, direction).forward().is_normalized());
                }
            }
        }
        assert!(Camera::framing(&Aabb::EMPTY, Vec3::Z).eye().is_finite());
    }

    #[test]
    fn views_check_the_opaque_scene() {
        let view = View::new(camera(), 2, 2).expect("legal");
        let wrong = view.clone().with_opaque_distance(Arc::from([1.0].as_slice()));
        assert_eq!(wrong, Err(ViewError::OpaqueSize { needed: 4, found: 1 }));
        let nan =
            view.clone().with_opaque_distance(Arc::from([1.0, f32::NAN, 0.0, 0.0].as_slice()));
        assert!(matches!(nan, Err(ViewError::OpaqueDistance { index: 1, .. })));
        assert!(view.with_opaque_distance(Arc::from([f32::INFINITY; 4].as_slice())).is_ok());
        assert!(View::new(camera(), 0, 5).is_err());
    }
}
