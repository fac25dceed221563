//! The pipelines, and what they are specialised for.

use metaball_core::Kernel;
use metaball_core::gpu::{Gpu, RenderError, Shader, Specialization};

use crate::gather::GatherPasses;
use crate::layouts::Layouts;
use crate::options::{ARRAY_CAPACITY, Options, Sort, exact_degree};
use crate::sort::RadixSort;

/// The sort on the adapter, the gathering, and `shaders/wgsl/illes_fraglist/cast.wgsl`.
pub(crate) struct Pipelines {
    pub(crate) specialized: Specialization,
    pub(crate) layouts: Layouts,
    /// Where balls are sorted on the adapter.
    pub(crate) sort: Option<RadixSort>,
    pub(crate) gather: GatherPasses,
    pub(crate) cast: wgpu::ComputePipeline,
}

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        specialized: Specialization,
        options: &Options,
    ) -> Result<Self, RenderError> {
        let layouts = Layouts::new(gpu, &specialized);
        let sort = match options.sort {
            Sort::Host => None,
            Sort::Adapter => Some(RadixSort::new(gpu, &specialized, &layouts)?),
        };
        let gather = GatherPasses::new(gpu, &specialized, &layouts, options.gather)?;
        let Layouts { frame, scene, balls, lists, .. } = &layouts;
        let cast = Shader::new(gpu, "illes cast", "illes_fraglist/cast", &specialized)?.compute(
            gpu,
            "illes cast",
            "cast_rays",
            &specialized,
            &[frame, scene, balls, lists],
            &cast_constants(specialized.kernel, options),
        )?;
        Ok(Self { specialized, sort, gather, cast, layouts })
    }
}

/// Override constants by id: of `shaders/wgsl/illes_fraglist/records.wgsl`, and for exact pieces of
/// `shaders/wgsl/illes_fraglist/polynomial.wgsl`.
fn cast_constants(kernel: Kernel, options: &Options) -> Vec<(&'static str, f64)> {
    let mut constants = vec![("49", f64::from(options.array_capacity.clamp(3, ARRAY_CAPACITY)))];
    if let (true, Some(degree)) = (options.piece.is_exact(), exact_degree(kernel)) {
        let weight = |power: usize| {
            kernel.coefficients().and_then(|all| all.get(power)).copied().unwrap_or(0.0)
        };
        let weights = [("50", weight(1)), ("51", weight(2)), ("52", weight(3))];
        constants.extend(weights);
        constants.push(("53", f64::from(degree)));
    }
    constants
}
