//! Functions of the method's modules, evaluated on the adapter for a list of records.

use metaball_core::Kernel;
use metaball_core::gpu::{
    Binding, Gpu, Shader, ShaderModule, Specialization, bind_group, bind_group_layout,
};

use crate::pipelines::search_modules;
use crate::{Clipping, Options};

/// A curve's coefficients, up to degree 16, or numbers that a curve follows from.
pub(super) type Record = [f32; 20];

/// A module whose entry point turns each `record` into an `outcome`, by these statements.
macro_rules! record_shader {
    ($imports:literal, $statements:literal) => {
        concat!(
            $imports,
            "
            @group(0) @binding(0) var<storage, read> inputs: array<array<f32, 20>>;
            @group(0) @binding(1) var<storage, read_write> outputs: array<array<f32, 20>>;
            @compute @workgroup_size(64)
            fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {
                if id.x >= arrayLength(&inputs) {
                    return;
                }
                let record = inputs[id.x];
                var outcome = array<f32, 20>();",
            $statements,
            "
                outputs[id.x] = outcome;
            }"
        )
    };
}
pub(super) use record_shader;

/// The outcomes of a [`record_shader`]. `constants` are those of the modules that it imports.
pub(super) fn evaluate(
    gpu: &Gpu,
    source: &'static str,
    kernel: Kernel,
    clipping: Clipping,
    constants: &[(&str, f64)],
    inputs: &[Record],
) -> Vec<Record> {
    let spec = Specialization { kernel, ..Specialization::without_balls() };
    let options = Options { clipping, ..Options::default() };
    let search = search_modules(kernel, spec.kernel_form, &options).expect("has a form");
    let spec = spec.choosing(search);
    let module = ShaderModule { name: "test", source, is_entry: true };
    let shader = Shader::of_module(gpu, &module, &spec).expect("composes");
    let layout = bind_group_layout(gpu, "records", &[(0, Binding::Read), (1, Binding::Write)]);
    let pipeline = shader
        .compute(gpu, "evaluate", "evaluate", &spec, &[&layout], constants)
        .expect("makes a pipeline");
    let none = wgpu::BufferUsages::empty();
    let workgroups = (inputs.len() as u32).div_ceil(64);
    let inputs = gpu.upload("inputs", inputs, none).expect("small");
    let outputs = gpu.storage("outputs", inputs.size(), none).expect("small");
    let group = bind_group(gpu, "records", &layout, &[(0, &inputs), (1, &outputs)]);
    gpu.checked(|| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(workgroups, 1, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
    })
    .expect("runs");
    gpu.read(&outputs).expect("reads")
}
