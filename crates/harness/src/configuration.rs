//! A method with its options set: what comparisons, charts, stability and the choice of `auto` draw with.

pub mod sweeps;
pub mod variants;

use std::collections::BTreeMap;
use std::fmt;

use metaball_core::gpu::Gpu;

use crate::methods::Method;
use crate::record::Adapter;
use crate::renderer::Renderer;
use crate::technique::Technique;

/// A method with its options set.
#[derive(Debug, Clone)]
pub struct Configuration {
    /// The method.
    pub method: &'static Method,
    /// Names and values of the options that differ from the method's preset.
    pub options: BTreeMap<String, String>,
    /// What it does, with all its options.
    pub technique: Technique,
    /// Name in tables and on the command line: `fbvh`, or `fbvh, tolerance 1e-3`, unless it has a
    /// [name of its own](Self::called).
    pub name: String,
    /// Name in headings; an option follows an ellipsis.
    pub title: String,
}

impl Configuration {
    /// The method as it is listed.
    pub fn preset(method: &'static Method) -> Self {
        let (name, title) = (method.name.to_owned(), method.title.to_owned());
        let technique = method.technique;
        Self { method, options: BTreeMap::new(), technique, name, title }
    }

    /// The method with one option set otherwise.
    pub fn with(method: &'static Method, option: &str, value: &str, technique: Technique) -> Self {
        let options = BTreeMap::from([(option.to_owned(), value.to_owned())]);
        Self::with_all(method, options, technique)
    }

    /// The method with several options set otherwise, by their names.
    pub fn with_all(
        method: &'static Method,
        options: BTreeMap<String, String>,
        technique: Technique,
    ) -> Self {
        let name = label(method.name, &options);
        let set: Vec<_> = options.iter().map(|(name, value)| format!("{name} {value}")).collect();
        Self { method, technique, name, title: format!("… {}", set.join(", ")), options }
    }

    /// The same under a name and a title of its own.
    #[must_use]
    pub fn called(self, name: &str, title: &str) -> Self {
        Self { name: name.to_owned(), title: title.to_owned(), ..self }
    }

    /// A renderer without a scene, under the method's name. It counts its work or, as when timing,
    /// does not.
    pub fn renderer(&self, counting: bool) -> Renderer {
        self.technique.renderer(self.method.name, counting)
    }

    /// Whether it draws nothing without an adapter.
    pub fn needs_adapter(&self) -> bool {
        self.method.needs_adapter()
    }

    /// What it is drawn by: the adapter, or the CPU where it needs none.
    pub fn drawn_by(&self, gpu: Option<&Gpu>) -> Adapter {
        match (self.needs_adapter(), gpu) {
            (true, None) => Adapter::none(),
            (true, Some(_)) => Adapter::of(gpu),
            (false, _) => Adapter::cpu(),
        }
    }
}

impl From<&'static Method> for Configuration {
    fn from(method: &'static Method) -> Self {
        Self::preset(method)
    }
}

impl fmt::Display for Configuration {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name)
    }
}

/// A method's name and the options that differ from its preset.
pub fn label(method: &str, options: &BTreeMap<String, String>) -> String {
    let options: String = options.iter().map(|(name, value)| format!(", {name} {value}")).collect();
    format!("{method}{options}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use fbvh::SecantSearch;

    use crate::methods::methods;

    #[test]
    fn configurations_say_what_they_set() {
        let method = &methods()[1];
        assert_eq!(Configuration::preset(method).to_string(), "fbvh");
        let search = SecantSearch { tolerance: 1e-3, ..SecantSearch::DEFAULT };
        let technique = Technique::Tree(fbvh::Options::fitted(), Some(search));
        let set = Configuration::with(method, "tolerance", "1e-3", technique);
        assert_eq!(set.to_string(), "fbvh, tolerance 1e-3");
        assert_eq!(set.renderer(false).name(), "fbvh");
        assert_eq!(set.called("fbvh+coarse", "… coarse").to_string(), "fbvh+coarse");
    }
}
