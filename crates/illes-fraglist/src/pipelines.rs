//! The pipelines, and what they are specialised for.

use metaball_core::gpu::{Gpu, RenderError, Specialization};

use crate::cast::CastPasses;
use crate::gather::GatherPasses;
use crate::layouts::Layouts;
use crate::options::{Options, Sort};
use crate::sort::RadixSort;

/// Those of the sort on the adapter, of the gathering, and of the cast.
pub(crate) struct Pipelines {
    pub(crate) specialized: Specialization,
    pub(crate) layouts: Layouts,
    /// Where balls are sorted on the adapter.
    pub(crate) sort: Option<RadixSort>,
    pub(crate) gather: GatherPasses,
    pub(crate) cast: CastPasses,
}

impl Pipelines {
    pub(crate) fn new(
        gpu: &Gpu,
        specialized: Specialization,
        options: &Options,
        budget: Option<u32>,
    ) -> Result<Self, RenderError> {
        let layouts = Layouts::new(gpu, &specialized);
        let sort = match options.sort {
            Sort::Host => None,
            Sort::Adapter => Some(RadixSort::new(gpu, &specialized, &layouts)?),
        };
        let gather = GatherPasses::new(gpu, &specialized, &layouts, options.gather)?;
        let cast = CastPasses::new(gpu, &specialized, &layouts, options, budget)?;
        Ok(Self { specialized, sort, gather, cast, layouts })
    }
}
