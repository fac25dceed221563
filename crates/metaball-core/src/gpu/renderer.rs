//! The trait of methods, and the loop that draws a frame with one.

use std::time::Duration;

use super::{Frame, FrameReport, FrameStatus, Gpu, RayTracer, RenderError, Targets};
use crate::{Scene, View};

/// A method that finds, for every primary ray, the first point where the field reaches the threshold.
///
/// It writes hits, and in scenes with colours the blended colour, and nothing else. Shading, clocks,
/// counters and read-back are shared; [the module](crate::gpu#writing-a-method) shows how to write one.
///
/// A renderer can be sent to another thread, to build there while another one draws.
pub trait IsoRenderer: Send {
    /// Stable name in file names, tables and tests: lower-case letters, digits, dashes.
    fn name(&self) -> &'static str;

    /// Makes everything that depends on the scene alone, on host and device, in the place of the scene
    /// before.
    ///
    /// # Errors
    /// When the scene does not fit the adapter or the method.
    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError>;

    /// Records the passes that turn the frame's rays into hits: each pixel is written, or reported
    /// as unfinished. Never submits, waits or reads back.
    ///
    /// # Errors
    /// When no scene was built, or a pass cannot be recorded.
    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError>;

    /// Properties of the last frame apart from its times, such as the number of balls drawn, under
    /// stable names. Waits for the device.
    ///
    /// # Errors
    /// When there was no frame, or the device fails.
    fn frame_facts(&self, gpu: &Gpu) -> Result<Vec<(&'static str, f64)>, RenderError> {
        let _ = gpu;
        Ok(Vec::new())
    }

    /// Bytes held on the device in addition to [`BuildReport::device_bytes`]: what the size of the
    /// picture and the frames so far have needed. 0 where nothing is kept from frame to frame.
    fn frame_bytes(&self) -> u64 {
        0
    }

    /// Enlarges the capacities that an incomplete frame reported as too small. `Ok(false)`: larger ones
    /// would not help.
    ///
    /// # Errors
    /// When the adapter has no larger ones.
    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let _ = (gpu, status);
        Ok(false)
    }

    /// The method as a tracer of free rays through the scene built last; `None` where it finds primary
    /// hits alone.
    fn ray_tracer(&mut self) -> Option<&mut dyn RayTracer> {
        None
    }
}

/// Time and memory that the build of a scene took.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BuildReport {
    /// Host time for the acceleration structure.
    pub structure: Duration,
    /// Host time for composing shaders and making pipelines.
    pub pipelines: Duration,
    /// Bytes uploaded to the device.
    pub upload_bytes: u64,
    /// Bytes held on the device for this scene; [`IsoRenderer::frame_bytes`] is what frames add.
    pub device_bytes: u64,
    /// Properties of the structure, such as its number of nodes, under stable names.
    pub facts: Vec<(&'static str, f64)>,
}

/// Frames drawn again with larger capacities before a method is held not to converge. Capacities are
/// counted in 32 bits, and growing to what was needed at least doubles the one that was too small: 32
/// doublings of each of four capacities exhaust every possibility.
const MOST_REDONE: u32 = 4 * 32;

/// Draws the view, with larger capacities as long as the frame is incomplete. The report is that of the
/// complete frame alone.
///
/// # Errors
/// [`RenderError::Incomplete`] when larger capacities do not help, and any error of the method.
pub fn render(
    gpu: &Gpu,
    renderer: &mut dyn IsoRenderer,
    targets: &Targets,
    view: &View,
) -> Result<FrameReport, RenderError> {
    render_with(gpu, renderer, targets, view, |renderer, frame| renderer.encode(frame))
}

/// As [`render`], with passes of the caller's: `encode` records them in place of
/// [`IsoRenderer::encode`], once for each time that the frame is drawn.
///
/// # Errors
/// As [`render`].
pub fn render_with(
    gpu: &Gpu,
    renderer: &mut dyn IsoRenderer,
    targets: &Targets,
    view: &View,
    mut encode: impl FnMut(&mut dyn IsoRenderer, &mut Frame<'_>) -> Result<(), RenderError>,
) -> Result<FrameReport, RenderError> {
    let mut redone = 0;
    loop {
        let mut frame = Frame::begin(gpu, targets, view)?;
        encode(renderer, &mut frame)?;
        let report = frame.finish()?;
        if report.status.is_complete() {
            return Ok(report);
        }
        if redone == MOST_REDONE || !renderer.grow(gpu, &report.status)? {
            return Err(RenderError::Incomplete { method: renderer.name(), status: report.status });
        }
        redone += 1;
    }
}
