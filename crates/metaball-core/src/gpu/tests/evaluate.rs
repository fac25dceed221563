//! Functions of the shared modules, evaluated on the device.

use glam::{Vec3, Vec4};
use metaball_shaders::Module;

use crate::gpu::layout::{Binding, bind_group, bind_group_layout};
use crate::gpu::{Gpu, SceneBuffers, Shader, Specialization, scene_layout};
use crate::{Generality, Kernel, PackedHit, Scene};

/// The results of entry point `evaluate` of the module for the inputs, in a scene that it may read.
fn evaluate(gpu: &Gpu, module: &Module, scene: &Scene, inputs: &[Vec4]) -> Vec<Vec4> {
    let spec = Specialization::of(scene, false);
    let bindings = bind_group_layout(gpu, "values", &[(0, Binding::Read), (1, Binding::Write)]);
    let shader = Shader::of_module(gpu, module, &spec).expect("composes");
    let layouts = [&bindings, &scene_layout(gpu, &spec)];
    let pipeline = shader
        .compute(gpu, "evaluate", "evaluate", &spec, &layouts, &[])
        .expect("makes a pipeline");
    let scene = SceneBuffers::new(gpu, scene).expect("small");
    let none = wgpu::BufferUsages::empty();
    let inputs = gpu.upload("inputs", inputs, none).expect("small");
    let outputs = gpu.storage("outputs", inputs.size(), none).expect("small");
    let values = bind_group(gpu, "values", &bindings, &[(0, &inputs), (1, &outputs)]);
    gpu.checked(|| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &values, &[]);
        pass.set_bind_group(1, scene.bind_group(), &[]);
        pass.dispatch_workgroups((inputs.size() / 16).div_ceil(64) as u32, 1, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    })
    .expect("runs");
    gpu.read(&outputs).expect("reads")
}

fn empty(kernel: Kernel) -> Scene {
    Scene::new([], kernel, 0.5).expect("legal")
}

/// Points spread evenly over the unit sphere, and the corners and edges of the octahedron.
fn normals() -> Vec<Vec3> {
    let spiral = (0..2000).map(|index| {
        let z = (f64::from(index) + 0.5) / 1000.0 - 1.0;
        let (sine, cosine) = (2.399_963_229_728_653 * f64::from(index)).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        glam::DVec3::new(radius * cosine, radius * sine, z).as_vec3()
    });
    let signs = [-1.0, -0.0, 0.0, 1.0];
    let corners = (0..64).map(|index| {
        Vec3::new(signs[index & 3], signs[index >> 2 & 3], signs[index >> 4]).normalize_or_zero()
    });
    spiral.chain(corners).filter(|normal| *normal != Vec3::ZERO).collect()
}

/// With u = 2⁻²⁴: the sum of three numbers errs by 2u and the division by 5u where WGSL's 2.5 units
/// are used up, so x and y together by 7u; z = 1 − |x| − |y| by 7u + 2u. The vector so found is at least
/// 1/√3 long, so its direction errs by √(7² + 9²)·√3·u = 20u, and the last normalisation by 3u more.
#[test]
fn normals_survive_packing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let source = "#import core::hit::{fold, unfold}
        @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
        @compute @workgroup_size(64)
        fn evaluate(@builtin(global_invocation_id) invocation: vec3<u32>) {
            let folded = fold(inputs[invocation.x].xyz);
            outputs[invocation.x] = vec4(folded, unfold(folded).xy);
        }";
    let module = Module { name: "test", source, is_entry: true };
    let normals = normals();
    let inputs: Vec<_> = normals.iter().map(|normal| normal.extend(0.0)).collect();
    let outputs = evaluate(&gpu, &module, &empty(Kernel::QUARTIC), &inputs);
    let tolerance = 23.0 * 0.5f32.powi(24);
    for (normal, output) in normals.iter().zip(outputs) {
        let packed = PackedHit { normal: [output.x, output.y], t: 1.0, status: 1 };
        let error = (packed.unpack().normal - normal).length();
        assert!(error < tolerance, "{normal}: {error:e}");
        let error = (normal.truncate() - glam::Vec2::new(output.z, output.w)).length();
        assert!(error < tolerance, "{normal} unfolded on the device: {error:e}");
    }
}

/// The greatest |d²k/dt²|·R² along lines past a ball, by differences of slopes.
fn greatest_bend(kernel: Kernel) -> f64 {
    const STEP: f64 = 1e-4;
    let lines = (0..40).map(|line| f64::from(line) / 40.0);
    let bends = lines.flat_map(|distance| {
        let slope = move |t: f64| 2.0 * t * kernel.slope(distance * distance + t * t);
        let points = (0..400).map(|point| f64::from(point) / 400.0);
        points.map(move |t| (slope(t + 0.5 * STEP) - slope(t - 0.5 * STEP)).abs() / STEP)
    });
    bends.fold(0.0, f64::max)
}

/// Kernels, compiled in and with the exponent or all of it read, are the host's to as many units in the last
/// place of themselves as the search for a root allows them: eight, and as many more as they say. Along a
/// line they bend no more than they say.
#[test]
fn kernels_are_those_of_the_host() {
    let Some(gpu) = Gpu::for_test() else { return };
    let source = "#import kernel::{greatest_bend, kernel, kernel_roundings, kernel_slope}
        @group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
        @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;
        @compute @workgroup_size(64)
        fn evaluate(@builtin(global_invocation_id) invocation: vec3<u32>) {
            let v = inputs[invocation.x].x;
            outputs[invocation.x] =
                vec4(kernel(v), kernel_slope(v), f32(kernel_roundings()), greatest_bend());
        }";
    let module = Module { name: "test", source, is_entry: true };
    let steps = (-20..=1000).map(|step| step as f32 / 1000.0);
    let depths: Vec<_> = steps.chain((1..40).map(|power| 0.5f32.powi(power))).collect();
    let inputs: Vec<_> = depths.iter().map(|v| Vec4::splat(*v)).collect();
    let gaussians = [1.0, 2.25, 6.0].map(|cut| Kernel::gaussian(cut).expect("legal"));
    for kernel in Kernel::all().chain(gaussians) {
        let compiled = empty(kernel);
        let read =
            [Generality::Exponent, Generality::Kernel].map(|part| empty(kernel).generalized(part));
        for scene in read.iter().chain([&compiled]) {
            let form = scene.kernel_form();
            let outputs = evaluate(&gpu, &module, scene, &inputs);
            let most = 1.001 * outputs[0].w;
            assert!(most >= greatest_bend(kernel) as f32, "{kernel}, {form:?}: {most}");
            for (v, output) in depths.iter().zip(outputs) {
                let part = f64::from((8.0 + output.z) * f32::EPSILON);
                let s = 1.0 - f64::from(*v);
                for (found, exact) in [(output.x, kernel.value(s)), (output.y, -kernel.slope(s))] {
                    let error = (f64::from(found) - exact).abs();
                    let allowed = part * exact + f64::from(f32::MIN_POSITIVE);
                    assert!(error <= allowed, "{kernel}, {form:?}, at {v}: {found} for {exact}");
                }
            }
        }
    }
}
