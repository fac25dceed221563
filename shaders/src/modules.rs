//! The table of modules. A new WGSL file is one line here.

/// A WGSL file.
#[derive(Debug, Clone, Copy)]
pub struct Module {
    /// Path below `wgsl/` without the extension, such as `core/view`.
    pub name: &'static str,
    /// What the file holds.
    pub source: &'static str,
    /// Whether it holds entry points. What does not is imported by name.
    pub is_entry: bool,
}

impl Module {
    /// The path by which others import this module, if they can.
    pub(crate) fn import_path(&self) -> Option<&'static str> {
        self.directives("#define_import_path ").next()
    }

    /// What the module imports: the path of a module, or of an item in one.
    pub(crate) fn imports(&self) -> impl Iterator<Item = &'static str> {
        self.directives("#import ").map(|path| path.split("::{").next().unwrap_or(path))
    }

    fn directives(&self, keyword: &'static str) -> impl Iterator<Item = &'static str> {
        self.source.lines().filter_map(move |line| line.strip_prefix(keyword)).map(str::trim)
    }
}

macro_rules! module {
    ($name:literal, $is_entry:literal) => {
        Module {
            name: $name,
            source: include_str!(concat!("../wgsl/", $name, ".wgsl")),
            is_entry: $is_entry,
        }
    };
}

macro_rules! entry {
    ($name:literal) => {
        module!($name, true)
    };
}

macro_rules! import {
    ($name:literal) => {
        module!($name, false)
    };
}

/// Every module. Where several define one import path, a [`Variant`](crate::Variant) chooses.
pub const MODULES: &[Module] = &[
    import!("core/view"),
    import!("core/make_ray"),
    entry!("core/rays"),
    import!("opaque/none"),
    import!("opaque/image"),
    import!("ray/record"),
    import!("ray/listed"),
    entry!("ray/list"),
    import!("ray/primary"),
    import!("ray/free"),
    import!("core/hit"),
    import!("core/status"),
    import!("core/scene"),
    import!("core/field"),
    import!("core/cover"),
    import!("core/beside"),
    import!("exponent/compiled"),
    import!("exponent/read"),
    import!("kernel/read"),
    import!("kernel/powers"),
    import!("kernel/power"),
    import!("kernel/wyvill"),
    import!("kernel/perlin"),
    import!("kernel/any"),
    import!("support/uniform"),
    import!("support/varied"),
    import!("strength/unit"),
    import!("strength/varied"),
    import!("color/srgb"),
    import!("color/record"),
    import!("color/none"),
    import!("color/blended"),
    import!("work/record"),
    import!("work/off"),
    import!("work/counted"),
    import!("shade/picture"),
    import!("shade/light"),
    import!("shade/base_white"),
    import!("shade/base_blended"),
    entry!("shade/phong"),
    entry!("shade/color"),
    entry!("shade/normal"),
    entry!("shade/depth"),
    entry!("shade/work"),
    entry!("shade/spheres"),
    import!("light/path"),
    import!("light/sampling"),
    import!("light/sky"),
    import!("light/image"),
    import!("light/floor"),
    import!("light/scatter"),
    entry!("light/start"),
    entry!("light/surface"),
    entry!("light/shadow"),
    entry!("light/add_sample"),
    import!("fbvh/structure"),
    import!("fbvh/suspend"),
    import!("fbvh/leaf"),
    import!("fbvh/local"),
    import!("fbvh/projection"),
    import!("fbvh/nearby"),
    import!("fbvh/bounds"),
    import!("fbvh/rises"),
    import!("fbvh/falls"),
    import!("fbvh/outlook"),
    import!("fbvh/quartic"),
    import!("fbvh/no_look"),
    import!("fbvh/certified_leaf"),
    entry!("fbvh/trace"),
    import!("illes_fraglist/balls"),
    import!("illes_fraglist/lists"),
    import!("illes_fraglist/budget"),
    import!("illes_fraglist/order"),
    import!("illes_fraglist/records"),
    import!("illes_fraglist/active"),
    import!("illes_fraglist/cubic"),
    import!("illes_fraglist/polynomial"),
    import!("illes_fraglist/bernstein"),
    import!("illes_fraglist/rebuilt"),
    import!("illes_fraglist/absolute"),
    import!("illes_fraglist/exact"),
    import!("illes_fraglist/crowd_printed"),
    import!("illes_fraglist/crowd_searched"),
    entry!("illes_fraglist/cores"),
    entry!("illes_fraglist/gather"),
    import!("illes_fraglist/prefix"),
    entry!("illes_fraglist/radix"),
    import!("illes_fraglist/tiles"),
    entry!("illes_fraglist/bin"),
    entry!("illes_fraglist/collect"),
    entry!("illes_fraglist/cast"),
    import!("kanamori_peel/frame"),
    import!("kanamori_peel/chord"),
    import!("kanamori_peel/placed"),
    import!("kanamori_peel/tiles"),
    import!("kanamori_peel/outline_rectangle"),
    import!("kanamori_peel/outline_tessellation"),
    import!("kanamori_peel/arranged"),
    entry!("kanamori_peel/arrange"),
    entry!("kanamori_peel/register"),
    entry!("kanamori_peel/turn"),
    entry!("kanamori_peel/kernels"),
    entry!("kanamori_peel/peel"),
    import!("kanamori_peel/power"),
    import!("kanamori_peel/quartic"),
    import!("kanamori_peel/wyvill"),
    import!("kanamori_peel/bezier"),
    import!("kanamori_peel/clipping_short_stack"),
    import!("kanamori_peel/clipping_iterative"),
    import!("kanamori_peel/clipping_original"),
    import!("kanamori_peel/list"),
    entry!("kanamori_peel/test"),
    import!("kanamori_robust/lists"),
    entry!("kanamori_robust/register"),
    entry!("kanamori_robust/search"),
];
