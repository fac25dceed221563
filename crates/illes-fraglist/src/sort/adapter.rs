//! Radix sort on the adapter, four bits a pass.

use metaball_core::gpu::{
    Frame, Gpu, RenderError, Shader, Specialization, bind_group, workgroup_grid,
};

use crate::layouts::Layouts;

/// Entries of a workgroup: `BLOCK` of `shaders/wgsl/illes_fraglist/radix.wgsl`.
const BLOCK: u32 = 1024;

/// Invocations of a workgroup that has one an entry.
const GROUP: u32 = 128;

/// Values of a digit, and digits of a key; even, so that the last pass ends where the first began.
const DIGITS: u32 = 16;
const PASSES: usize = 8;

/// The steps of `shaders/wgsl/illes_fraglist/radix.wgsl`.
pub(crate) struct RadixSort {
    make: wgpu::ComputePipeline,
    count: wgpu::ComputePipeline,
    scan: wgpu::ComputePipeline,
    spread: wgpu::ComputePipeline,
    take: wgpu::ComputePipeline,
}

/// What the balls of a scene are sorted in.
pub(crate) struct SortBuffers {
    balls: u32,
    table: wgpu::Buffer,
    /// Reads the second buffer of entries and writes the first; the other way around.
    to_first: wgpu::BindGroup,
    to_second: wgpu::BindGroup,
    bytes: u64,
}

impl RadixSort {
    pub(crate) fn new(
        gpu: &Gpu,
        spec: &Specialization,
        layouts: &Layouts,
    ) -> Result<Self, RenderError> {
        let shader = Shader::new(gpu, "illes sort", "illes_fraglist/radix", spec)?;
        let groups = [&layouts.frame, &layouts.scene, &layouts.sort];
        let step = |entry| shader.compute(gpu, "illes sort", entry, spec, &groups, &[]);
        Ok(Self {
            make: step("make_entries")?,
            count: step("count_digits")?,
            scan: step("scan_digits")?,
            spread: step("spread_entries")?,
            take: step("take_order")?,
        })
    }

    /// The pass `sort`.
    pub(crate) fn record(
        &self,
        frame: &mut Frame<'_>,
        scene: &wgpu::BindGroup,
        buffers: &SortBuffers,
    ) {
        let targets = frame.targets();
        frame.encoder().clear_buffer(&buffers.table, 0, Some(4));
        let single = workgroup_grid(buffers.balls.div_ceil(GROUP));
        let blocks = workgroup_grid(buffers.balls.div_ceil(BLOCK));
        frame.compute("sort", |pass| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, scene, &[]);
            let mut step = |pipeline, (columns, rows): (u32, u32), group| {
                pass.set_bind_group(2, group, &[]);
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(columns, rows, 1);
            };
            step(&self.make, single, &buffers.to_first);
            for digit in 0..PASSES {
                let group = if digit % 2 == 0 { &buffers.to_second } else { &buffers.to_first };
                step(&self.count, blocks, group);
                step(&self.scan, (1, 1), group);
                step(&self.spread, blocks, group);
            }
            step(&self.take, single, &buffers.to_second);
        });
    }
}

impl SortBuffers {
    /// Buffers to sort so many balls into `order`.
    pub(crate) fn new(
        gpu: &Gpu,
        layouts: &Layouts,
        balls: u32,
        order: &wgpu::Buffer,
    ) -> Result<Self, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let entries = || gpu.storage("illes sort entries", 8 * u64::from(balls), none);
        let (first, second) = (entries()?, entries()?);
        let counters = u64::from(DIGITS) * u64::from(balls.div_ceil(BLOCK).max(1));
        let table = gpu.storage("illes sort table", 4 * (1 + counters), none)?;
        let group = |from: &wgpu::Buffer, to: &wgpu::Buffer| {
            let buffers = [(0, from), (1, to), (2, &table), (3, order)];
            bind_group(gpu, "illes sort", &layouts.sort, &buffers)
        };
        let (to_first, to_second) =
            gpu.checked(|| (group(&second, &first), group(&first, &second)))?;
        let bytes = first.size() + second.size() + table.size();
        Ok(Self { balls, table, to_first, to_second, bytes })
    }

    /// Bytes on the adapter.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
