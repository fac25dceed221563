//! Timestamps of passes, and the read-back of a frame's status.

use std::time::Duration;

use super::{FrameStatus, Gpu, RenderError};

/// Queries of a set, the most that WebGPU allows: two are a pass, so 2048 passes of a frame can be
/// timed.
const QUERIES: u32 = 4096;

/// Offset of the status in the staging buffer, in bytes: behind all timestamps.
const STATUS_OFFSET: u64 = QUERIES as u64 * size_of::<u64>() as u64;

/// The query set of a frame's passes, with what it takes to read it.
#[derive(Debug)]
pub(super) struct Clock {
    /// `None` where the adapter cannot time passes.
    queries: Option<(wgpu::QuerySet, wgpu::Buffer)>,
    staging: wgpu::Buffer,
    nanoseconds_per_tick: f32,
}

/// The queries of a pass, by its number.
#[derive(Debug, Clone, Copy)]
pub(super) struct TimedPass(u32);

impl Clock {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, RenderError> {
        let buffer = |label, size, usage| {
            let descriptor = wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            };
            gpu.device.create_buffer(&descriptor)
        };
        gpu.checked(|| Self {
            queries: gpu.report().timestamps.then(|| {
                let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                    label: Some("passes"),
                    ty: wgpu::QueryType::Timestamp,
                    count: QUERIES,
                });
                let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
                (set, buffer("timestamps", STATUS_OFFSET, usage))
            }),
            staging: buffer(
                "frame report",
                STATUS_OFFSET + size_of::<FrameStatus>().next_multiple_of(8) as u64,
                wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            ),
            nanoseconds_per_tick: gpu.queue.get_timestamp_period(),
        })
    }

    /// The set and the queries of the frame's pass number `index`, if it can be timed.
    pub(super) fn pass(&self, index: u32) -> Option<(&wgpu::QuerySet, TimedPass)> {
        let (set, _) = self.queries.as_ref()?;
        (index < QUERIES / 2).then_some((set, TimedPass(index)))
    }

    /// Records the copies that bring the first `passes` and the status to the host.
    pub(super) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        passes: u32,
        status: &wgpu::Buffer,
    ) {
        if let Some((set, resolved)) = self.queries.as_ref().filter(|_| passes > 0) {
            let bytes = u64::from(2 * passes) * size_of::<u64>() as u64;
            encoder.resolve_query_set(set, 0..2 * passes, resolved, 0);
            encoder.copy_buffer_to_buffer(resolved, 0, &self.staging, 0, bytes);
        }
        encoder.copy_buffer_to_buffer(status, 0, &self.staging, STATUS_OFFSET, status.size());
    }

    /// The status and each timed pass's duration, once the copies are done.
    pub(super) fn read(
        &self,
        gpu: &Gpu,
        passes: u32,
    ) -> Result<(FrameStatus, Vec<Duration>), RenderError> {
        gpu.read_mapped(&self.staging, |bytes| {
            let (stamps, status) = bytes.split_at(STATUS_OFFSET as usize);
            let status = bytemuck::pod_read_unaligned(&status[..size_of::<FrameStatus>()]);
            let (stamps, _) = stamps.split_at(passes as usize * 2 * size_of::<u64>());
            let stamps: Vec<u64> = bytemuck::pod_collect_to_vec(stamps);
            let duration = |pair: &[u64]| {
                // A clock that runs backwards inside a pass is a fault of the driver: no time at all.
                let ticks = pair[1].saturating_sub(pair[0]);
                let nanoseconds = ticks as f64 * f64::from(self.nanoseconds_per_tick);
                Duration::from_nanos(nanoseconds as u64)
            };
            (status, stamps.chunks_exact(2).map(duration).collect())
        })
    }
}

impl TimedPass {
    /// The query at the pass's beginning.
    pub(super) fn beginning(self) -> u32 {
        2 * self.0
    }

    /// The query at the pass's end.
    pub(super) fn end(self) -> u32 {
        2 * self.0 + 1
    }
}
