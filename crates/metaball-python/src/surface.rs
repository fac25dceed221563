//! The surface of a scene: its tree, and what is asked of it.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use metaball::{DrawOptions, Drawing, Loaded, Progress};
use metaball_core::reference::Oracle;
use metaball_core::{Camera as SceneCamera, Color, Kernel, RayQuery, Scene};
use numpy::ndarray::Array3;
use numpy::{PyArray1, PyArray2, PyArray3};
use particle_files::{Positions, load, load_table, own_camera};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::arrays::PointArray;
use crate::camera::{Camera, CameraParts, camera_of, parts_of};
use crate::comparison::{ComparisonArrays, TruthArrays, comparison, truth_arrays, truths};
use crate::errors::{raised, refused};
use crate::light::Light;
use crate::options::{Corners, Plane, clip, picture_named};
use crate::particles::Particles;
use crate::rays::{Columns, HitArrays, HitColumns, RayArrays, traced};
use crate::reading::{Reading, Said, TableArrays, overrides, rows, said};
use crate::watch::watch;

/// A scene with its tree and a camera that shows it.
#[pyclass(frozen, module = "metaball._metaball")]
pub(crate) struct Surface {
    surface: metaball::Model,
    camera: SceneCamera,
}

/// Three coordinates, a tuple in Python.
type Point = (f64, f64, f64);

/// Rays of a picture: the eye, shape (1, 3), and directions (n, 3).
type ViewRays<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f32>>);

/// A picture: pixels, hits, and linear light where there is any.
type PictureArrays<'py> =
    (Bound<'py, PyArray3<u8>>, HitArrays<'py>, Option<Bound<'py, PyArray3<f32>>>);

#[pymethods]
impl Surface {
    #[new]
    fn new(
        py: Python<'_>,
        particles: Particles<'_>,
        kernel: &str,
        threshold: f32,
    ) -> PyResult<Self> {
        let kernel = kernel.parse::<Kernel>().map_err(raised)?;
        let scene = particles.scene(py, kernel, threshold).map_err(raised)?;
        let (camera, _) = own_camera(&scene);
        Self::of(py, scene, camera)
    }

    /// The surface of a file, of particles or of a scene, and the reader's notes.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        reading: Reading,
        kernel: Option<&str>,
        threshold: Option<f32>,
    ) -> PyResult<(Self, Said)> {
        let overrides = overrides(kernel, threshold)?;
        let loaded = py.detach(|| load(path, &reading.options()?, &overrides));
        Self::loaded(py, loaded.map_err(raised)?)
    }

    /// The surface of a table, and what was said of it.
    #[staticmethod]
    fn of_table(
        py: Python<'_>,
        table: TableArrays<'_>,
        reading: Reading,
        kernel: Option<&str>,
        threshold: Option<f32>,
    ) -> PyResult<(Self, Said)> {
        let (overrides, table) = (overrides(kernel, threshold)?, table.table()?);
        let loaded = py.detach(|| load_table(table, &reading.options()?, &overrides));
        Self::loaded(py, loaded.map_err(raised)?)
    }

    /// The surface of what `state` has given.
    #[staticmethod]
    fn restored(
        py: Python<'_>,
        particles: Particles<'_>,
        kernel: &str,
        threshold: f32,
        origin: [f64; 3],
        camera: CameraParts,
    ) -> PyResult<Self> {
        let kernel = kernel.parse::<Kernel>().map_err(raised)?;
        let scene = particles.scene(py, kernel, threshold).map_err(raised)?;
        Self::of(py, scene.with_origin(DVec3::from_array(origin)), camera_of(camera)?)
    }

    /// Its balls in the scene's coordinates, as the arguments of `metaball.Particles`, the scene's origin and the
    /// camera.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyDict>, Point, CameraParts)> {
        let scene = self.surface.scene();
        let arguments = PyDict::new(py);
        let centers = scene.supports().iter().flat_map(|ball| ball.center.to_array()).collect();
        arguments.set_item("centers", rows(py, centers)?)?;
        let radii = scene.supports().iter().map(|ball| ball.radius);
        arguments.set_item("support_radius", PyArray1::from_vec(py, radii.collect()))?;
        if let Some(strengths) = scene.strengths() {
            arguments.set_item("strength", PyArray1::from_slice(py, strengths))?;
        }
        if let Some(colors) = scene.colors() {
            let channels = colors.iter().copied().flat_map(Color::to_srgb).collect();
            arguments.set_item("color", rows(py, channels)?)?;
        }
        Ok((arguments, scene.origin().into(), parts_of(&self.camera)))
    }

    #[getter]
    fn kernel(&self) -> String {
        self.surface.scene().kernel().to_string()
    }

    #[getter]
    fn threshold(&self) -> f32 {
        self.surface.scene().threshold()
    }

    #[getter]
    fn tree_bytes(&self) -> usize {
        self.surface.tree_bytes()
    }

    #[getter]
    fn build_seconds(&self) -> f64 {
        self.surface.build_time().as_secs_f64()
    }

    /// Corners of the box around all supports, in the particles' coordinates; `None` where there is no ball.
    #[getter]
    fn bounds(&self) -> Option<(Point, Point)> {
        let scene = self.surface.scene();
        let (bounds, origin) = (scene.bounds(), scene.origin());
        let corner = |corner: Vec3| (corner.as_dvec3() + origin).into();
        (!bounds.is_empty()).then(|| (corner(bounds.min), corner(bounds.max)))
    }

    /// Eye, point looked at, up and field of view of the camera that shows it.
    #[getter]
    fn camera(&self) -> (Point, Point, Point, f32) {
        let (camera, origin) = (&self.camera, self.surface.scene().origin());
        let eye = camera.eye().as_dvec3();
        let ahead = eye + camera.forward().as_dvec3();
        let degrees = 2.0 * camera.half_height().atan().to_degrees();
        let up = camera.up().as_dvec3();
        ((eye + origin).into(), (ahead + origin).into(), up.into(), degrees)
    }

    fn __len__(&self) -> usize {
        self.surface.scene().len()
    }

    /// Draws a picture.
    #[expect(clippy::too_many_arguments, reason = "those of `metaball.Surface.render`")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        camera: Option<Camera>,
        size: (u32, u32),
        picture: &str,
        planes: Vec<Plane>,
        corners: Option<Corners>,
        light: Light,
        bar: Option<Py<PyAny>>,
    ) -> PyResult<PictureArrays<'py>> {
        let options = DrawOptions {
            size,
            viewpoint: Camera::viewpoint(camera),
            picture: picture_named(picture)?,
            clip: clip(planes, corners)?,
            light: light.options()?,
            ..DrawOptions::default()
        };
        let Drawing { image, hits, film, .. } = watch(py, bar, |watched| {
            let told = |progress: Progress| watched.is_at(progress.done as usize);
            self.surface.draw(&self.camera, &options, || watched.goes_on(), told).map_err(raised)
        })?;
        let (width, height) = (image.width as usize, image.height as usize);
        let columns = py.detach(|| Columns::of(&hits));
        let light = film.map(|film| {
            let channels = film.light.iter().flat_map(Vec3::to_array).collect();
            array3(py, (height, width, 3), channels)
        });
        let pixels = array3(py, (height, width, 4), image.rgba)?;
        Ok((pixels, columns.into_arrays(py)?, light.transpose()?))
    }

    /// Rays of a camera, row by row from the top left.
    fn rays<'py>(
        &self,
        py: Python<'py>,
        camera: Option<Camera>,
        size: (u32, u32),
    ) -> PyResult<ViewRays<'py>> {
        let scene = self.surface.scene();
        let camera = Camera::viewpoint(camera).camera(&self.camera, scene).map_err(raised)?;
        let view = metaball::View::new(camera, size.0, size.1).map_err(raised)?;
        let eye = (camera.eye().as_dvec3() + scene.origin()).to_array();
        let rays = py.detach(|| view.rays());
        let directions = rays.iter().flat_map(|ray| ray.direction.to_array()).collect();
        Ok((rows(py, eye.to_vec())?, rows(py, directions)?))
    }

    /// First hits of rays.
    fn trace<'py>(
        &self,
        py: Python<'py>,
        rays: RayArrays<'py>,
        bar: Option<Py<PyAny>>,
    ) -> PyResult<HitArrays<'py>> {
        let rays = rays.rays(self.surface.scene().origin());
        let tracer = self.surface.tracer();
        let found = watch(py, bar, |watched| traced(&rays, &tracer, RayQuery::FirstHit, watched));
        found?.into_arrays(py)
    }

    /// Where rays that start inside leave the solid.
    fn exit<'py>(&self, py: Python<'py>, rays: RayArrays<'py>) -> PyResult<HitArrays<'py>> {
        let rays = rays.rays(self.surface.scene().origin());
        let tracer = self.surface.tracer();
        let found = watch(py, None, |watched| traced(&rays, &tracer, RayQuery::Exit, watched));
        found?.into_arrays(py)
    }

    /// Whether there is solid on rays: their verdicts.
    fn any_hit<'py>(
        &self,
        py: Python<'py>,
        rays: RayArrays<'py>,
    ) -> PyResult<Bound<'py, PyArray1<u8>>> {
        let rays = rays.rays(self.surface.scene().origin());
        let tracer = self.surface.tracer();
        let found = watch(py, None, |watched| traced(&rays, &tracer, RayQuery::AnyHit, watched));
        Ok(PyArray1::from_vec(py, found?.into_verdicts()))
    }

    /// The truth along rays, by the reference.
    fn truth<'py>(
        &self,
        py: Python<'py>,
        rays: RayArrays<'py>,
        bar: Option<Py<PyAny>>,
    ) -> PyResult<TruthArrays<'py>> {
        let rays = rays.rays(self.surface.scene().origin());
        let found = watch(py, bar, |watched| truths(&self.oracle().0, &rays, watched));
        truth_arrays(py, &found?)
    }

    /// Hits, as columns, against the truth along the same rays.
    fn compare<'py>(
        &self,
        py: Python<'py>,
        rays: RayArrays<'py>,
        hits: HitColumns<'py>,
        bar: Option<Py<PyAny>>,
    ) -> PyResult<ComparisonArrays<'py>> {
        let hits = hits.hits()?;
        let rays = rays.rays(self.surface.scene().origin());
        if hits.len() != rays.count() {
            let needed = format!("those of {} rays", rays.count());
            return Err(refused("hits", &needed, hits.len()));
        }
        let found = watch(py, bar, |watched| truths(&self.oracle().0, &rays, watched));
        comparison(py, &found?, &hits)
    }

    /// The field at points, f64.
    fn field<'py>(
        &self,
        py: Python<'py>,
        points: PointArray<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points = points.points();
        let values = py.detach(|| {
            let (oracle, origin) = self.oracle();
            let value = |index| oracle.field(points.at(index) - origin);
            (0..points.count()).into_par_iter().map(value).collect()
        });
        Ok(PyArray1::from_vec(py, values))
    }

    /// The field's gradient at points, f64.
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        points: PointArray<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = points.points();
        let values: Vec<[f64; 3]> = py.detach(|| {
            let (oracle, origin) = self.oracle();
            let value = |index| oracle.gradient(points.at(index) - origin).to_array();
            (0..points.count()).into_par_iter().map(value).collect()
        });
        rows(py, values.into_flattened())
    }
}

impl Surface {
    fn of(py: Python<'_>, scene: Scene, camera: SceneCamera) -> PyResult<Self> {
        let method = metaball::Method::default();
        let surface = watch(py, None, |watched| {
            metaball::Model::new_while(scene, &method, || watched.goes_on()).map_err(raised)
        })?;
        Ok(Self { surface, camera })
    }

    fn loaded(py: Python<'_>, loaded: Loaded) -> PyResult<(Self, Said)> {
        let Loaded { scene, camera, notes, .. } = loaded;
        Ok((Self::of(py, scene, camera)?, said(&notes)))
    }

    /// The reference, and the origin of its coordinates.
    fn oracle(&self) -> (Oracle<'_>, DVec3) {
        (Oracle::new(self.surface.scene()), self.surface.scene().origin())
    }
}

/// An array of three axes, from its numbers in C order.
fn array3<T: numpy::Element>(
    py: Python<'_>,
    shape: (usize, usize, usize),
    numbers: Vec<T>,
) -> PyResult<Bound<'_, PyArray3<T>>> {
    let array = Array3::from_shape_vec(shape, numbers)
        .map_err(|error| refused("picture", "pixels of its size", error))?;
    Ok(PyArray3::from_owned_array(py, array))
}
