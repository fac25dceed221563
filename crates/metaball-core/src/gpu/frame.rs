//! One frame: a view, its passes and their times.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::targets::ViewUniform;
use super::{FrameStatus, Gpu, RenderError, Targets};
use crate::View;

/// A frame being recorded. Opens all passes, so that each has a label and a time.
#[derive(Debug)]
pub struct Frame<'a> {
    gpu: &'a Gpu,
    targets: &'a Targets,
    view: &'a View,
    encoder: wgpu::CommandEncoder,
    begun: Instant,
    spans: Vec<(String, Span)>,
    timed_passes: u32,
    untimed_passes: u32,
    _lease: Lease<'a>,
}

/// Times and status of a finished frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameReport {
    /// Wall time from the beginning of the frame to the device's fence.
    pub wall: Duration,
    /// Time of each label, summed over its passes, in the order of first use. Labels that begin with
    /// `cpu:` are host time, and the only ones where the adapter cannot time passes.
    pub passes: Vec<(String, Duration)>,
    /// Passes without a time: the adapter cannot time passes, or there were more than 2048.
    pub untimed_passes: u32,
    /// Whether the frame is complete.
    pub status: FrameStatus,
}

/// Attachments of a render pass.
#[derive(Debug, Clone, Default)]
pub struct RenderAttachments<'a> {
    /// Colour targets, by location.
    pub colors: &'a [Option<wgpu::RenderPassColorAttachment<'a>>],
    /// Depth target.
    pub depth: Option<wgpu::RenderPassDepthStencilAttachment<'a>>,
}

#[derive(Debug, Clone, Copy)]
enum Span {
    /// The timed pass of this number.
    Pass(u32),
    Host(Duration),
}

impl<'a> Frame<'a> {
    /// Starts the clock, clears status and work, and makes the view's rays (pass `rays`).
    ///
    /// # Errors
    /// When the view's size is not the targets', or another frame is using them.
    pub fn begin(gpu: &'a Gpu, targets: &'a Targets, view: &'a View) -> Result<Self, RenderError> {
        let begun = Instant::now();
        let needed = (targets.width(), targets.height());
        let found = (view.width(), view.height());
        if needed != found {
            return Err(RenderError::ViewSize { needed, found });
        }
        let lease = Lease::take(&targets.in_use)?;
        let ray_pass = targets.ray_pass(gpu, view)?;
        let encoder = gpu.checked(|| {
            let uniform = ViewUniform::new(view);
            gpu.queue.write_buffer(&targets.view, 0, bytemuck::bytes_of(&uniform));
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&targets.status, 0, None);
            if let Some(work) = targets.work() {
                encoder.clear_buffer(work, 0, None);
            }
            encoder
        })?;
        let mut frame = Self {
            gpu,
            targets,
            view,
            encoder,
            begun,
            spans: Vec::new(),
            timed_passes: 0,
            untimed_passes: 0,
            _lease: lease,
        };
        frame.compute("rays", |pass| ray_pass.record(pass, targets.workgroups()));
        Ok(frame)
    }

    /// The device.
    pub fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// The targets that the frame writes.
    pub fn targets(&self) -> &'a Targets {
        self.targets
    }

    /// The view that the frame draws.
    pub fn view(&self) -> &'a View {
        self.view
    }

    /// Records a compute pass. Times of passes with one label are summed.
    pub fn compute(
        &mut self,
        label: &'static str,
        record: impl FnOnce(&mut wgpu::ComputePass<'_>),
    ) {
        let clock = self.targets.clock.pass(self.timed_passes);
        let timestamp_writes = clock.map(|(query_set, pass)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(pass.beginning()),
            end_of_pass_write_index: Some(pass.end()),
        });
        self.note_pass(label, timestamp_writes.is_some());
        record(&mut self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(label),
            timestamp_writes,
        }));
    }

    /// Records a render pass. Times of passes with one label are summed.
    pub fn render(
        &mut self,
        label: &'static str,
        attachments: RenderAttachments<'_>,
        record: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let clock = self.targets.clock.pass(self.timed_passes);
        let timestamp_writes = clock.map(|(query_set, pass)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(pass.beginning()),
            end_of_pass_write_index: Some(pass.end()),
        });
        self.note_pass(label, timestamp_writes.is_some());
        record(&mut self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: attachments.colors,
            depth_stencil_attachment: attachments.depth,
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        }));
    }

    /// Does host work that belongs to the frame, such as a sort. The report has its time as
    /// `cpu:label`, next to those of the passes.
    pub fn cpu<T>(&mut self, label: &'static str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.spans.push((format!("cpu:{label}"), Span::Host(start.elapsed())));
        result
    }

    /// For copies and clears. Passes go through [`Frame::compute`] and [`Frame::render`].
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        &mut self.encoder
    }

    /// Submits the frame, waits for the fence, and reads the status and the clock.
    ///
    /// # Errors
    /// When wgpu refuses a pass or the device fails.
    pub fn finish(mut self) -> Result<FrameReport, RenderError> {
        let Self { gpu, targets, .. } = self;
        targets.clock.record(&mut self.encoder, self.timed_passes, &targets.status);
        gpu.checked(|| gpu.queue.submit([self.encoder.finish()]))?;
        gpu.wait()?;
        let wall = self.begun.elapsed();
        let (status, durations) = targets.clock.read(gpu, self.timed_passes)?;

        let mut passes: Vec<(String, Duration)> = Vec::new();
        for (label, span) in self.spans {
            let duration = match span {
                Span::Pass(index) => durations[index as usize],
                Span::Host(duration) => duration,
            };
            match passes.iter_mut().find(|(known, _)| *known == label) {
                Some((_, sum)) => *sum += duration,
                None => passes.push((label, duration)),
            }
        }
        Ok(FrameReport { wall, passes, untimed_passes: self.untimed_passes, status })
    }

    fn note_pass(&mut self, label: &'static str, is_timed: bool) {
        if is_timed {
            self.spans.push((label.to_owned(), Span::Pass(self.timed_passes)));
            self.timed_passes += 1;
        } else {
            self.untimed_passes += 1;
        }
    }
}

/// A frame's exclusive use of its targets.
#[derive(Debug)]
struct Lease<'a>(&'a AtomicBool);

impl<'a> Lease<'a> {
    fn take(in_use: &'a AtomicBool) -> Result<Self, RenderError> {
        if in_use.swap(true, Ordering::Acquire) {
            return Err(RenderError::TargetsInUse);
        }
        Ok(Self(in_use))
    }
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}
