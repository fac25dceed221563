//! Metaballs in a program that has a wgpu device of its own, and shades the hits with a shader of its
//! own: `cargo run --release -p fbvh --features gpu --example trace_in_your_wgpu -- picture.png`.

use std::{env, error::Error};

use fbvh::{Options, gpu::Renderer};
use glam::Vec3;
use image::RgbaImage;
use metaball_core::gpu::{Gpu, IsoRenderer, Targets, render};
use metaball_core::{Camera, Kernel, Metaball, Scene, View};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

/// Reads hits as `PackedHit` lays them out, and paints normals.
const PAINT: &str = "
struct Hit { normal: vec2<f32>, t: f32, status: u32 }
@group(0) @binding(0) var<storage, read> hits: array<Hit>;
@group(0) @binding(1) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn paint(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&hits) { return; }
    let hit = hits[id.x];
    var color = vec3(0.09, 0.10, 0.12);
    if (hit.status & 255u) == 1u {
        // The octahedron unfolded.
        let z = 1.0 - abs(hit.normal.x) - abs(hit.normal.y);
        let lower = (1.0 - abs(hit.normal.yx)) * select(vec2(-1.0), vec2(1.0), hit.normal >= vec2(0.0));
        color = 0.5 + 0.5 * normalize(vec3(select(lower, hit.normal, z >= 0.0), z));
    }
    pixels[id.x] = pack4x8unorm(vec4(color, 1.0));
}";

fn main() -> Result<(), Box<dyn Error>> {
    let path = env::args().nth(1).ok_or("needed the path of a picture to write")?;

    // Your program has these already.
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    // Handles are shared, not moved: the device remains yours.
    let gpu = Gpu::of_device(&adapter, device.clone(), queue.clone());

    // Once per scene: a grid of balls whose radii swell from corner to corner.
    let balls = (0..512).map(|index| {
        let center = Vec3::new((index % 8) as f32, (index / 8 % 8) as f32, (index / 64) as f32);
        Metaball::new(center, 0.8 + 0.05 * center.element_sum())
    });
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.4)?;
    let mut metaballs = Renderer::new("metaballs", Options::certified(), false);
    metaballs.build(&gpu, &scene)?;

    // Once per image size, and once per view.
    let targets = Targets::new(&gpu, WIDTH, HEIGHT, false, false)?;
    let camera = Camera::framing(&scene.bounds(), Vec3::new(-0.7, -0.4, -1.0));
    let view = View::new(camera, WIDTH, HEIGHT)?;
    let report = render(&gpu, &mut metaballs, &targets, &view)?;
    eprintln!("{} in {:.1?}", gpu.report().name, report.wall);

    // Your own pass over the hits, which have not left the GPU.
    let pixels = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixels"),
        size: u64::from(WIDTH * HEIGHT * 4),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("paint"),
        layout: None,
        module: &device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("paint"),
            source: wgpu::ShaderSource::Wgsl(PAINT.into()),
        }),
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("paint"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: targets.hits().as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: pixels.as_entire_binding() },
        ],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bound, &[]);
    pass.dispatch_workgroups((WIDTH * HEIGHT).div_ceil(64), 1, 1);
    drop(pass);
    queue.submit([encoder.finish()]);

    let rgba = gpu.read(&pixels)?;
    RgbaImage::from_raw(WIDTH, HEIGHT, rgba).ok_or("four bytes a pixel")?.save(path)?;
    Ok(())
}
