//! A method with its options set: what takes part in a contest.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use metaball_core::gpu::IsoRenderer;

use crate::methods::Method;

/// Makes a renderer that counts its work or, as when timing, does not.
type Make = dyn Fn(bool) -> Box<dyn IsoRenderer> + Send + Sync;

/// A method with its options set.
#[derive(Clone)]
pub struct Setting {
    /// The method.
    pub method: &'static Method,
    /// Names and values of the options that differ from the method's preset.
    pub options: BTreeMap<String, String>,
    make: Arc<Make>,
}

impl Setting {
    /// The method as it is listed.
    pub fn preset(method: &'static Method) -> Self {
        Self { method, options: BTreeMap::new(), make: Arc::new(method.make) }
    }

    /// The method with one option set otherwise.
    pub fn with(
        method: &'static Method,
        option: &str,
        value: &str,
        make: impl Fn(bool) -> Box<dyn IsoRenderer> + Send + Sync + 'static,
    ) -> Self {
        let options = BTreeMap::from([(option.to_owned(), value.to_owned())]);
        Self { method, options, make: Arc::new(make) }
    }

    /// A renderer without a scene.
    pub fn renderer(&self, counting: bool) -> Box<dyn IsoRenderer> {
        (self.make)(counting)
    }
}

impl From<&'static Method> for Setting {
    fn from(method: &'static Method) -> Self {
        Self::preset(method)
    }
}

/// `fbvh`, or `fbvh, tolerance 1e-3`.
impl fmt::Display for Setting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&label(self.method.name, &self.options))
    }
}

impl fmt::Debug for Setting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Setting({self})")
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
    use crate::methods::METHODS;

    #[test]
    fn settings_say_what_they_set() {
        let method = &METHODS[1];
        assert_eq!(Setting::preset(method).to_string(), "fbvh");
        let set = Setting::with(method, "tolerance", "1e-3", method.make);
        assert_eq!(set.to_string(), "fbvh, tolerance 1e-3");
        assert_eq!(set.renderer(false).name(), "fbvh");
    }
}
