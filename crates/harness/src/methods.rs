//! The only list of methods.

use fbvh::gpu::Renderer;
use fbvh::{Options, TraceOptions};
use metaball_core::gpu::IsoRenderer;

/// A method that can be compared.
#[derive(Debug)]
pub struct Method {
    /// Stable name on the command line, in records and in file names.
    pub name: &'static str,
    /// Name in headings.
    pub title: &'static str,
    /// Where it was published.
    pub paper: &'static str,
    /// What it does, one sentence.
    pub about: &'static str,
    /// Makes a renderer that counts its work or, as when timing, does not.
    pub make: fn(counting: bool) -> Box<dyn IsoRenderer>,
}

/// All methods, in the order of tables.
pub const METHODS: &[Method] = &[
    Method {
        name: "bvh",
        title: "Modified BVH",
        paper: "Gourmel et al. 2010, section 4",
        about: "A hierarchy whose leaves own their balls and name all others that reach in; boxes \
                overlap, and a ray goes on until no nearer leaf is left.",
        make: |counting| bvh("bvh", Options::modified_bvh(), counting),
    },
    Method {
        name: "fbvh",
        title: "Fitted BVH",
        paper: "Gourmel et al. 2010, section 5",
        about: "Balls are split among leaves whose fitted boxes do not overlap; the first hit ends \
                the ray.",
        make: |counting| bvh("fbvh", Options::fitted(), counting),
    },
];

fn bvh(name: &'static str, options: Options, counting: bool) -> Box<dyn IsoRenderer> {
    Box::new(Renderer::new(name, options, TraceOptions::default(), counting))
}

/// The method of that name.
pub fn find(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_renderers_know_theirs() {
        for (index, method) in METHODS.iter().enumerate() {
            assert!(METHODS[..index].iter().all(|other| other.name != method.name));
            for counting in [false, true] {
                assert_eq!((method.make)(counting).name(), method.name);
            }
        }
        assert!(find("fbvh").is_some() && find("no such method").is_none());
    }
}
