//! From a module's name to a naga module, by imports alone.

use std::collections::HashSet;

use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, ComposerError, NagaModuleDescriptor,
};
use thiserror::Error;

use crate::{MODULES, Module, Variant};

/// Why a module cannot be composed. Every text names the WGSL file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ComposeError {
    /// The table has no such module.
    #[error("shader module {name}: not in the table of modules")]
    Unknown {
        /// The name that was given.
        name: String,
    },
    /// An import that no module satisfies, or several do.
    #[error(
        "shader module {importer} imports {path}: needed one module to provide it, found {}",
        list(found)
    )]
    Ambiguous {
        /// Module with the import.
        importer: &'static str,
        /// The import path.
        path: String,
        /// The modules that would do; none when it is unknown.
        found: Vec<&'static str>,
    },
    /// Modules import each other in a circle.
    #[error("shader module {name}: imports itself")]
    Circle {
        /// A module of the circle.
        name: &'static str,
    },
    /// WGSL that does not parse or validate.
    #[error("{text}")]
    Wgsl {
        /// The message with file, line and the offending text.
        text: String,
    },
}

fn list(found: &[&str]) -> String {
    if found.is_empty() { "none".to_owned() } else { found.join(" and ") }
}

/// Composes a module of the table with everything it imports, and validates it.
///
/// One without entry points makes sense for reflection only.
///
/// # Errors
/// When the name is unknown, an import has no single provider, or the WGSL is wrong.
pub fn compose(name: &str, variant: &Variant) -> Result<naga::Module, ComposeError> {
    let module = MODULES
        .iter()
        .find(|module| module.name == name)
        .ok_or_else(|| ComposeError::Unknown { name: name.to_owned() })?;
    compose_module(module, variant)
}

/// Composes a module from elsewhere, which may import those of the table: the entry module of a
/// method in a crate of its own.
///
/// # Errors
/// As [`compose`].
pub fn compose_module(module: &Module, variant: &Variant) -> Result<naga::Module, ComposeError> {
    let mut composition = Composition {
        composer: Composer::default().with_capabilities(capabilities()),
        providers: providers(variant),
        added: HashSet::new(),
        open: vec![module.name],
    };
    composition.add_imports_of(module)?;
    let descriptor = NagaModuleDescriptor {
        source: module.source,
        file_path: &file_path(module),
        ..NagaModuleDescriptor::default()
    };
    let composed = composition.composer.make_naga_module(descriptor);
    composed.map_err(|error| composition.explain(&error))
}

/// What shaders may use beyond plain WebGPU.
fn capabilities() -> naga::valid::Capabilities {
    use naga::valid::Capabilities;
    Capabilities::default() | Capabilities::EARLY_DEPTH_TEST | Capabilities::PRIMITIVE_INDEX
}

/// The modules that can be imported under this variant, with their import paths. Where it chooses an
/// implementation of an interface, the others are left out.
fn providers(variant: &Variant) -> Vec<(String, &'static Module)> {
    let chosen = variant.modules();
    let importable = MODULES.iter().filter(|module| !module.is_entry);
    let mut providers: Vec<_> = importable.map(|module| (module.import_path(), module)).collect();
    let is_chosen = |module: &Module| chosen.contains(&module.name);
    let chosen_paths: HashSet<_> =
        MODULES.iter().filter(|module| is_chosen(module)).map(Module::import_path).collect();
    providers.retain(|(path, module)| is_chosen(module) || !chosen_paths.contains(path));
    providers
}

struct Composition {
    composer: Composer,
    providers: Vec<(String, &'static Module)>,
    added: HashSet<&'static str>,
    open: Vec<&'static str>,
}

impl Composition {
    /// Adds, depth first, everything the module needs.
    fn add_imports_of(&mut self, module: &Module) -> Result<(), ComposeError> {
        for import in module.imports() {
            let provider = self.provider(module.name, import)?;
            if self.open.contains(&provider.name) {
                return Err(ComposeError::Circle { name: provider.name });
            }
            if self.added.insert(provider.name) {
                self.open.push(provider.name);
                self.add_imports_of(provider)?;
                self.open.pop();
                let descriptor = ComposableModuleDescriptor {
                    source: provider.source,
                    file_path: &file_path(provider),
                    as_name: Some(provider.import_path()),
                    ..ComposableModuleDescriptor::default()
                };
                if let Err(error) = self.composer.add_composable_module(descriptor) {
                    return Err(self.explain(&error));
                }
            }
        }
        Ok(())
    }

    /// The one module behind an import, which may name the module or an item of it.
    fn provider(
        &self,
        importer: &'static str,
        import: &str,
    ) -> Result<&'static Module, ComposeError> {
        let found: Vec<_> = self
            .providers
            .iter()
            .filter(|(path, _)| {
                import
                    .strip_prefix(path.as_str())
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
            })
            .map(|(_, module)| *module)
            .collect();
        match found[..] {
            [module] => Ok(module),
            _ => Err(ComposeError::Ambiguous {
                importer,
                path: import.to_owned(),
                found: found.iter().map(|module| module.name).collect(),
            }),
        }
    }

    fn explain(&self, error: &ComposerError) -> ComposeError {
        ComposeError::Wgsl { text: error.emit_to_string(&self.composer) }
    }
}

fn file_path(module: &Module) -> String {
    format!("wgsl/{}.wgsl", module.name)
}
