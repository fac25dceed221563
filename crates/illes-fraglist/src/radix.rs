//! Sorting on the device: by effective distance, four bits a pass.

use metaball_core::gpu::{Frame, Gpu, RenderError, Shader, Specialization};

use crate::pipelines::{Layouts, storage};

/// `BLOCK` of `illes_fraglist/radix.wgsl`: entries of a workgroup.
const BLOCK: u32 = 1024;

/// Invocations of a workgroup that has one an entry.
const GROUP: u32 = 128;

/// Workgroups of a row of a dispatch.
const GROUPS_OF_ROW: u32 = 32768;

/// Values of a digit, and digits of a key; even, so that the last pass ends where the first began.
const DIGITS: u32 = 16;
const PASSES: usize = 8;

/// `illes_fraglist/radix.wgsl`.
pub(crate) struct RadixSort {
    layout: wgpu::BindGroupLayout,
    make: wgpu::ComputePipeline,
    count: wgpu::ComputePipeline,
    place: wgpu::ComputePipeline,
    spread: wgpu::ComputePipeline,
    take: wgpu::ComputePipeline,
}

/// What the balls of a scene are sorted in.
pub(crate) struct SortRoom {
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
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("illes sort"),
            entries: &[storage(0, true), storage(1, false), storage(2, false), storage(3, false)],
        });
        let shader = Shader::new(gpu, "illes sort", "illes_fraglist/radix", spec)?;
        let groups = [&layouts.frame, &layouts.scene, &layout];
        let step = |entry| shader.compute(gpu, "illes sort", entry, spec, &groups, &[]);
        Ok(Self {
            make: step("make_entries")?,
            count: step("count_digits")?,
            place: step("place_digits")?,
            spread: step("spread_entries")?,
            take: step("take_order")?,
            layout,
        })
    }

    /// Room to sort so many balls into `order`.
    pub(crate) fn room(
        &self,
        gpu: &Gpu,
        balls: u32,
        order: &wgpu::Buffer,
    ) -> Result<SortRoom, RenderError> {
        let none = wgpu::BufferUsages::empty();
        let entries = || gpu.storage("illes sort entries", 8 * u64::from(balls), none);
        let (first, second) = (entries()?, entries()?);
        let places = u64::from(DIGITS) * u64::from(balls.div_ceil(BLOCK).max(1));
        let table = gpu.storage("illes sort table", 4 * (1 + places), none)?;
        let group = |from: &wgpu::Buffer, to: &wgpu::Buffer| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("illes sort"),
                layout: &self.layout,
                entries: &[bound(0, from), bound(1, to), bound(2, &table), bound(3, order)],
            })
        };
        let (to_first, to_second) =
            gpu.checked(|| (group(&second, &first), group(&first, &second)))?;
        let bytes = first.size() + second.size() + table.size();
        Ok(SortRoom { balls, table, to_first, to_second, bytes })
    }

    /// The pass `sort`.
    pub(crate) fn record(&self, frame: &mut Frame<'_>, scene: &wgpu::BindGroup, room: &SortRoom) {
        let targets = frame.targets();
        frame.encoder().clear_buffer(&room.table, 0, Some(4));
        let single = grid(room.balls.div_ceil(GROUP));
        let blocks = grid(room.balls.div_ceil(BLOCK));
        frame.compute("sort", |pass| {
            pass.set_bind_group(0, targets.bind_group(), &[]);
            pass.set_bind_group(1, scene, &[]);
            let mut step = |pipeline, (columns, rows): (u32, u32), group| {
                pass.set_bind_group(2, group, &[]);
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(columns, rows, 1);
            };
            step(&self.make, single, &room.to_first);
            for digit in 0..PASSES {
                let group = if digit % 2 == 0 { &room.to_second } else { &room.to_first };
                step(&self.count, blocks, group);
                step(&self.place, (1, 1), group);
                step(&self.spread, blocks, group);
            }
            step(&self.take, single, &room.to_second);
        });
    }
}

impl SortRoom {
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn bound(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

/// Columns and rows of a dispatch of so many workgroups, or a few more.
fn grid(groups: u32) -> (u32, u32) {
    (groups.clamp(1, GROUPS_OF_ROW), groups.div_ceil(GROUPS_OF_ROW).max(1))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use metaball_core::gpu::{IsoRenderer, Targets, render};
    use metaball_core::{Camera, Kernel, Metaball, Scene, View};

    use super::*;
    use crate::sort::by_effective_distance;
    use crate::{Options, Renderer, Sort};

    /// Every third ball stands where the one before it does; the eye is among them, so that some
    /// distances are negative. Coordinates are small multiples of powers of two and the eye is at one:
    /// all but the root is exact, and the root is rounded the same way wherever it is right to half a
    /// unit. Where an adapter's is not, the order may differ where two distances nearly agree.
    #[test]
    fn the_device_sorts_as_the_host_does() {
        let Some(gpu) = Gpu::for_test() else { return };
        let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 60.0).expect("legal");
        let view = View::new(camera, 8, 6).expect("legal");
        let targets = Targets::new(&gpu, 8, 6, false, false).expect("small");
        let options = Options { sort: Sort::Device, ..Options::default() };
        for count in [1_u32, 2, 1023, 1025, 9000] {
            let balls = (0..count).map(|index| {
                let place = index - u32::from(index % 3 == 2);
                let [x, y, z] = [0x9e37_79b9_u32, 0x85eb_ca6b, 0xc2b2_ae35]
                    .map(|factor| (place.wrapping_mul(factor) >> 24) as f32 / 32.0 - 4.0);
                Metaball { center: Vec3::new(x, y, z), radius: 0.5, strength: 0.01 }
            });
            let scene = Scene::new(balls, Kernel::QUARTIC, 100.0).expect("legal");
            let mut renderer = Renderer::new("illes", options, false);
            renderer.build(&gpu, &scene).expect("builds");
            render(&gpu, &mut renderer, &targets, &view).expect("draws");
            let order = renderer.order(&gpu).expect("readable").expect("built");
            assert_eq!(order, by_effective_distance(scene.supports(), &camera), "{count} balls");
        }
    }
}
