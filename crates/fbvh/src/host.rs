//! The trees traced on the CPU, behind [`HostMethod`].

use metaball_core::{Hit, HostError, HostMethod, HostRenderer, Ray, Scene};

use crate::{Options, SecantSearch, TraceError, Tracer, Tree};

/// Draws primary rays through a tree of the scene with a [`Tracer`].
#[derive(Debug, Clone, Copy)]
pub struct Method {
    name: &'static str,
    options: Options,
    /// How leaves of a published tree are searched.
    search: Option<SecantSearch>,
}

impl Method {
    /// Trees with these options, under a name for reports and errors.
    ///
    /// Leaves of published trees are searched as [`SecantSearch::DEFAULT`] says;
    /// [`Method::with_search`] changes that.
    pub fn new(name: &'static str, options: Options) -> Self {
        let search = options.kind().is_published().then_some(SecantSearch::DEFAULT);
        Self { name, options, search }
    }

    /// The same with other options for the leaves of a published tree.
    ///
    /// # Errors
    /// [`TraceError::SecantOfCertified`] when the tree is certified: it has no such options.
    pub fn with_search(self, search: SecantSearch) -> Result<Self, TraceError> {
        if self.search.is_none() {
            return Err(TraceError::SecantOfCertified { found: self.options.kind() });
        }
        Ok(Self { search: Some(search), ..self })
    }
}

impl HostMethod for Method {
    fn name(&self) -> &'static str {
        self.name
    }

    fn build<'s>(&self, scene: &'s Scene) -> Result<Box<dyn HostRenderer + 's>, HostError> {
        let Self { name: method, options, search } = *self;
        let tree = Tree::build(scene, &options)
            .map_err(|source| HostError::Structure { method, source: Box::new(source) })?;
        Ok(Box::new(Built { tree, scene, search }))
    }
}

/// A tree with the scene that it was built from.
struct Built<'s> {
    tree: Tree,
    scene: &'s Scene,
    search: Option<SecantSearch>,
}

impl HostRenderer for Built<'_> {
    fn picture_hits(&self, rays: &[Ray], width: usize) -> Vec<Hit> {
        let tracer = Tracer::new(&self.tree, self.scene);
        let tracer = match self.search {
            Some(search) => tracer.with_search(search).expect("a published tree"),
            None => tracer,
        };
        tracer.picture_hits(rays, width)
    }

    fn bytes(&self) -> u64 {
        self.tree.stats().bytes as u64
    }
}
