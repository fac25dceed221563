//! The table of modules. A new WGSL file is one line here.

use crate::interfaces::INTERFACES;

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
    /// The path by which others import this module: that of its file, such as `core::view`. What
    /// implements an [`Interface`](crate::Interface) is imported as that: by the path of its folder.
    pub fn import_path(&self) -> String {
        let folder = self.name.rsplit_once('/').map(|(folder, _)| folder);
        let interface = INTERFACES.iter().find(|interface| Some(interface.folder) == folder);
        interface.map_or(self.name, |interface| interface.folder).replace('/', "::")
    }

    /// What the module imports: the path of a module, or of an item in one.
    pub(crate) fn imports(&self) -> impl Iterator<Item = &'static str> {
        let directives = self.source.lines().filter_map(|line| line.strip_prefix("#import "));
        directives.map(|path| path.split("::{").next().unwrap_or(path).trim())
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

/// Every module. Of those that implement an [`Interface`](crate::Interface) a
/// [`Variant`](crate::Variant) chooses one.
pub const MODULES: &[Module] = &[
    // What all methods share.
    import!("core/view"),
    import!("core/ray"),
    import!("core/make_ray"),
    entry!("core/rays"),
    import!("core/ray_list"),
    import!("core/hit"),
    import!("core/status"),
    import!("core/scene"),
    import!("core/kernel_read"),
    import!("core/powers"),
    import!("core/field"),
    import!("core/nearby_origin"),
    import!("core/cover"),
    import!("core/tiles"),
    import!("core/prefix_sum"),
    import!("core/srgb"),
    import!("core/color_record"),
    import!("core/work_record"),
    import!("opaque/none"),
    import!("opaque/image"),
    import!("exponent/compiled"),
    import!("exponent/read"),
    import!("kernel/power"),
    import!("kernel/wyvill"),
    import!("kernel/perlin"),
    import!("kernel/cubic_spline"),
    import!("kernel/quintic_spline"),
    import!("kernel/wendland_c2"),
    import!("kernel/wendland_c4"),
    import!("kernel/wendland_c6"),
    import!("kernel/gaussian"),
    import!("kernel/any"),
    import!("profile/rim"),
    import!("profile/perlin"),
    import!("profile/splines"),
    import!("profile/wendland"),
    import!("profile/gaussian"),
    import!("support/uniform"),
    import!("support/varied"),
    import!("strength/unit"),
    import!("strength/varied"),
    import!("color/none"),
    import!("color/blended"),
    import!("work/off"),
    import!("work/counted"),
    // Arbitrary rays.
    import!("batch/free_ray"),
    import!("batch/queried"),
    entry!("batch/list_rays"),
    import!("ray/primary"),
    import!("ray/free"),
    // Pictures of hits.
    import!("shade/picture"),
    import!("shade/light"),
    import!("shade/base/white"),
    import!("shade/base/blended"),
    entry!("shade/phong"),
    entry!("shade/color"),
    entry!("shade/normal"),
    entry!("shade/depth"),
    entry!("shade/work"),
    entry!("shade/spheres"),
    // The crate metaball-light.
    import!("light/path"),
    import!("light/sampling"),
    import!("light/environment/sky"),
    import!("light/environment/image"),
    import!("light/floor"),
    import!("light/secondary"),
    import!("light/phong"),
    import!("light/mirror"),
    import!("light/lamps"),
    import!("light/occlusion"),
    import!("light/fluid"),
    import!("light/scatter"),
    entry!("light/start"),
    entry!("light/surface"),
    entry!("light/shadow"),
    entry!("light/add_sample"),
    // The crate fbvh.
    import!("fbvh/structure"),
    import!("fbvh/budget"),
    import!("fbvh/relative_ray"),
    import!("fbvh/projection"),
    import!("fbvh/near_balls"),
    import!("fbvh/bounds"),
    import!("fbvh/excess/entry"),
    import!("fbvh/excess/exit"),
    import!("fbvh/test_result"),
    import!("fbvh/polynomial_test/quartic"),
    import!("fbvh/polynomial_test/none"),
    import!("fbvh/leaf_outcome"),
    import!("fbvh/leaf/published"),
    import!("fbvh/leaf/certified"),
    import!("fbvh/suspended"),
    entry!("fbvh/trace"),
    // The crate illes-fraglist.
    import!("illes_fraglist/balls"),
    import!("illes_fraglist/lists"),
    import!("illes_fraglist/budget"),
    import!("illes_fraglist/order"),
    import!("illes_fraglist/records"),
    import!("illes_fraglist/active"),
    import!("illes_fraglist/cubic_root"),
    import!("illes_fraglist/polynomial"),
    import!("illes_fraglist/polynomial_root"),
    import!("illes_fraglist/array_size/of_12"),
    import!("illes_fraglist/array_size/of_24"),
    import!("illes_fraglist/array_size/of_48"),
    import!("illes_fraglist/array_size/of_96"),
    import!("illes_fraglist/piece/running_cubic"),
    import!("illes_fraglist/piece/rebuilt_cubic"),
    import!("illes_fraglist/piece/exact"),
    import!("illes_fraglist/overlap/printed"),
    import!("illes_fraglist/overlap/searched"),
    import!("illes_fraglist/waiting"),
    import!("illes_fraglist/tiles"),
    entry!("illes_fraglist/radix"),
    entry!("illes_fraglist/cores"),
    entry!("illes_fraglist/gather"),
    entry!("illes_fraglist/bin"),
    entry!("illes_fraglist/collect"),
    entry!("illes_fraglist/begin"),
    entry!("illes_fraglist/cast"),
    // The crate kanamori-peel.
    import!("kanamori_peel/frame"),
    import!("kanamori_peel/chord"),
    import!("kanamori_peel/placed"),
    import!("kanamori_peel/tiles"),
    import!("kanamori_peel/outline/rectangle"),
    import!("kanamori_peel/outline/tessellation"),
    import!("kanamori_peel/arranged"),
    import!("kanamori_peel/bernstein/power"),
    import!("kanamori_peel/bernstein/quartic"),
    import!("kanamori_peel/bernstein/wyvill"),
    import!("kanamori_peel/bezier"),
    import!("kanamori_peel/clipping/short_stack"),
    import!("kanamori_peel/clipping/iterative"),
    import!("kanamori_peel/clipping/original"),
    import!("kanamori_peel/longest/four_targets"),
    import!("kanamori_peel/longest/eight_targets"),
    import!("kanamori_peel/list"),
    entry!("kanamori_peel/arrange"),
    entry!("kanamori_peel/register"),
    entry!("kanamori_peel/turn"),
    entry!("kanamori_peel/kernels"),
    entry!("kanamori_peel/peel"),
    entry!("kanamori_peel/test"),
    import!("kanamori_robust/lists"),
    entry!("kanamori_robust/register"),
    entry!("kanamori_robust/search"),
];
