//! Who finds the surface.

use fbvh::Options;
#[cfg(feature = "gpu")]
use metaball_core::gpu::IsoRenderer;

/// A method of finding the surface along rays.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Method {
    /// A tree of the crate [`fbvh`]: the only methods that need no graphics adapter.
    Tree(Options),
    /// Any method of the harness.
    #[cfg(feature = "harness")]
    Listed(harness::configuration::Configuration),
    /// Whatever is quickest on the scene and right enough.
    #[cfg(feature = "harness")]
    Auto(Choosing),
}

/// How to choose a method by measurement.
#[cfg(feature = "harness")]
#[derive(Debug, Clone)]
pub struct Choosing {
    /// The largest error for 99 of 100 hits, mean support radii.
    pub max_error: f64,
    /// Where choices are kept.
    pub cache: harness::auto::cache::Cache,
}

impl Default for Method {
    /// The certified tree.
    fn default() -> Self {
        Self::Tree(Options::certified())
    }
}

impl Method {
    /// Stable name, as on the command line.
    pub fn name(&self) -> &str {
        match self {
            Self::Tree(options) => options.kind().name(),
            #[cfg(feature = "harness")]
            Self::Listed(configuration) => &configuration.name,
            #[cfg(feature = "harness")]
            Self::Auto(_) => "auto",
        }
    }

    /// The tree that it traces, if it is one of the trees.
    pub(crate) fn tree(&self) -> Option<Options> {
        match self {
            Self::Tree(options) => Some(*options),
            #[cfg(feature = "harness")]
            Self::Listed(configuration) => configuration.technique.tree(),
            #[cfg(feature = "harness")]
            Self::Auto(_) => None,
        }
    }

    /// Whether it is on the CPU alone, whatever else there is.
    pub(crate) fn is_on_host(&self) -> bool {
        match self {
            Self::Tree(_) => false,
            #[cfg(feature = "harness")]
            Self::Listed(configuration) => !configuration.needs_adapter(),
            #[cfg(feature = "harness")]
            Self::Auto(_) => false,
        }
    }

    /// A renderer on an adapter, without a scene. It counts its work or, as when timing, does not. `None`
    /// for methods that are on the CPU alone, and for `auto`, which has to see the view first.
    #[cfg(feature = "gpu")]
    pub(crate) fn on_adapter(&self, counting: bool) -> Option<Box<dyn IsoRenderer>> {
        match self {
            Self::Tree(options) => {
                let name = options.kind().name();
                Some(Box::new(fbvh::gpu::Renderer::new(name, *options, counting)))
            }
            #[cfg(feature = "harness")]
            Self::Listed(configuration) => configuration.renderer(counting).on_adapter(),
            #[cfg(feature = "harness")]
            Self::Auto(_) => None,
        }
    }

    /// What drew, as names and texts.
    pub(crate) fn account(&self) -> Vec<(&'static str, String)> {
        let paper = match self {
            Self::Tree(options) => options.kind().source(),
            #[cfg(feature = "harness")]
            Self::Listed(configuration) => configuration.method.paper,
            #[cfg(feature = "harness")]
            Self::Auto(_) => "",
        };
        vec![("method", format!("{} ({paper})", self.name()))]
    }
}
