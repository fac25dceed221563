//! The one trait, and the loop that everyone draws with.

use std::time::Duration;

use super::{Frame, FrameReport, FrameStatus, Gpu, RayTracer, RenderError, Targets};
use crate::{Scene, View};

/// One way of finding, for every primary ray, the first point where the field reaches the
/// threshold.
///
/// A method writes hits, and in scenes with colours the blended colour, and nothing else. Shading,
/// clocks, counters and read-back are shared.
///
/// A renderer can go to another thread: one builds there while another draws.
pub trait IsoRenderer: Send {
    /// Stable name in file names, tables and tests: lower case, digits, dashes.
    fn name(&self) -> &'static str;

    /// Makes everything that depends on the scene alone, on host and device, replacing what was
    /// there.
    ///
    /// # Errors
    /// When the scene does not fit the adapter or the method.
    fn build(&mut self, gpu: &Gpu, scene: &Scene) -> Result<BuildReport, RenderError>;

    /// Records the passes that turn the frame's rays into hits: each pixel is written, or reported
    /// as unfinished. Does not submit, wait or read back.
    ///
    /// # Errors
    /// When a pass cannot be recorded.
    fn encode(&mut self, frame: &mut Frame<'_>) -> Result<(), RenderError>;

    /// What the last frame was like beyond its times, such as the number of balls it drew, under
    /// stable names. Waits for the device.
    ///
    /// # Errors
    /// When there was no frame, or the device fails.
    fn frame_facts(&self, gpu: &Gpu) -> Result<Vec<(&'static str, f64)>, RenderError> {
        let _ = gpu;
        Ok(Vec::new())
    }

    /// Bytes held on the device beside those of the build report: what the picture's size and the course
    /// of frames have asked for so far. None where nothing is kept from frame to frame.
    fn frame_bytes(&self) -> u64 {
        0
    }

    /// After a frame that ran out of room, makes more. `Ok(false)`: more room would not help.
    ///
    /// # Errors
    /// When there is no more room to be had.
    fn grow(&mut self, gpu: &Gpu, status: &FrameStatus) -> Result<bool, RenderError> {
        let _ = (gpu, status);
        Ok(false)
    }

    /// The method as a tracer of arbitrary rays through the scene built last; `None` where it finds
    /// primary hits alone.
    fn ray_tracer(&mut self) -> Option<&mut dyn RayTracer> {
        None
    }
}

/// What building a scene took.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BuildReport {
    /// Host time for the structure.
    pub structure: Duration,
    /// Host time for composing shaders and making pipelines.
    pub pipelines: Duration,
    /// Bytes sent to the device.
    pub upload_bytes: u64,
    /// Bytes held on the device for this scene; [`IsoRenderer::frame_bytes`] tells of the rest.
    pub device_bytes: u64,
    /// What the structure is like, such as its number of nodes.
    pub facts: Vec<(&'static str, f64)>,
}

/// Frames redone for want of room before a method is held not to converge. Rooms are counted in 32
/// bits, and growth to what was needed at least doubles the one that was too small: 32 doublings of
/// each of four rooms exhaust every possibility.
const MOST_REDONE: u32 = 4 * 32;

/// Draws the view, again with more room where a frame was not whole, and reports on the whole frame
/// alone.
///
/// # Errors
/// [`RenderError::Incomplete`] when growing does not help, and whatever stops the method.
pub fn render(
    gpu: &Gpu,
    renderer: &mut dyn IsoRenderer,
    targets: &Targets,
    view: &View,
) -> Result<FrameReport, RenderError> {
    render_with(gpu, renderer, targets, view, |renderer, frame| renderer.encode(frame))
}

/// As [`render`], with passes of the caller's: `encode` records them, once for each time that the
/// frame is drawn.
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
