//! How deep in a tree rays went, as counting shaders report it, against walks through the tree itself.

use fbvh::{EMPTY, Kind, LEAF, Tree};
use glam::{DVec3, Vec3};
use libtest_mimic::{Failed, Trial};
use metaball_core::gpu::{Gpu, Targets, render};
use metaball_core::{Aabb, Camera, Kernel, Metaball, Ray, Scene, View};

use super::{load, on_gpu, preset, tree_options, view_of};

/// By what part of a scene unit boxes are grown or shrunk to be certainly met or certainly missed: the
/// shader's slabs are in f32, and the scenes lie a few units from the eye.
const MARGIN: f64 = 1e-5;

pub(super) fn trials() -> Vec<Trial> {
    let scattered = ["bvh", "fbvh", "fbvh-certified"].map(|method| {
        on_gpu(format!("depth::random-200::{method}"), move |gpu| {
            let bench = load("random-200")?;
            as_walked(gpu, method, &bench.scene, &view_of(&bench)?)
        })
    });
    let suspended = on_gpu("depth::of_suspended_rays".to_owned(), |gpu| {
        let (scene, view) = behind_a_large_leaf()?;
        as_walked(gpu, "fbvh", &scene, &view)
    });
    scattered.into_iter().chain([suspended]).collect()
}

/// Each pixel's depth lies between those of two walks, which agree about most rays. Depths that were
/// moved by a pixel do not.
fn as_walked(gpu: &Gpu, method: &str, scene: &Scene, view: &View) -> Result<(), Failed> {
    let tree = Tree::build(scene, &tree_options(method)?)?;
    let renderer = preset(method)?.renderer(true).on_adapter();
    let mut renderer = renderer.ok_or("nothing is counted on the CPU")?;
    renderer.build(gpu, scene)?;
    let has_colors = scene.colors().is_some();
    let targets = Targets::new(gpu, view.width(), view.height(), has_colors, true)?;
    render(gpu, renderer.as_mut(), &targets, view)?;
    let work = targets.read_work(gpu)?.ok_or("nothing was counted")?;
    let mut depths: Vec<_> = work.iter().map(|work| work.depth).collect();

    let rays = targets.read_rays(gpu, view)?;
    let walks: Vec<_> = rays
        .iter()
        .zip(targets.read_hits(gpu)?)
        .map(|(ray, hit)| {
            let end = if hit.is_hit() { hit.t } else { ray.t_max };
            // Boxes that overlap may be entered before a nearer hit is known.
            let latest = if tree.kind() == Kind::ModifiedBvh { ray.t_max } else { end };
            (deepest(&tree, ray, end, -MARGIN), deepest(&tree, ray, latest, MARGIN))
        })
        .collect();
    let strange = |depths: &[u32]| {
        let beyond = |(depth, (least, most)): &(&u32, &(u32, u32))| depth < &least || depth > &most;
        depths.iter().zip(&walks).filter(beyond).count()
    };
    if strange(&depths) > 0 {
        return Err(format!("{} rays went to other depths", strange(&depths)).into());
    }
    let known = walks.iter().filter(|(least, most)| least == most).count();
    if tree.kind() != Kind::ModifiedBvh && 10 * known < 9 * walks.len() {
        return Err(format!("walks agree about {known} rays of {}", walks.len()).into());
    }
    depths.rotate_right(1);
    if strange(&depths) == 0 {
        return Err("depths of neighbours passed".into());
    }
    Ok(())
}

/// Interior nodes on the longest way down through boxes that the ray enters before `end`, each box grown
/// by a margin.
fn deepest(tree: &Tree, ray: &Ray, end: f32, margin: f64) -> u32 {
    let enters = |bounds: &Aabb| {
        let inverse = ray.direction.as_dvec3().recip();
        let origin = ray.origin.as_dvec3();
        let to_low = (bounds.min.as_dvec3() - margin - origin) * inverse;
        let to_high = (bounds.max.as_dvec3() + margin - origin) * inverse;
        let enter = to_low.min(to_high).max_element().max(0.0);
        let leave = to_low.max(to_high).min_element();
        enter <= leave && enter < f64::from(end) + margin
    };
    let mut most = 0;
    let mut left = vec![(tree.root(), 0)];
    while let Some((index, above)) = left.pop() {
        if index == EMPTY || index & LEAF != 0 {
            continue;
        }
        let node = &tree.nodes()[index as usize];
        most = most.max(above + 1);
        let children = [(node.left, node.left_bounds()), (node.right, node.right_bounds())];
        let entered = children.into_iter().filter(|(_, bounds)| enters(bounds));
        left.extend(entered.map(|(child, _)| (child, above + 1)));
    }
    most
}

/// Balls behind 1,200 that no plane can part: rays are suspended in the leaf of those, and find what lies
/// behind it when they resume.
fn behind_a_large_leaf() -> Result<(Scene, View), Failed> {
    let large_leaf = (0..1200).map(|index| Metaball {
        center: Vec3::new(1e-4 * (index % 7) as f32, 1e-4 * (index % 11) as f32, 0.0),
        radius: 1.0 + 1e-3 * (index % 13) as f32,
        strength: 1e-4,
    });
    let behind = (0..200).map(|index| {
        let in_cube = (DVec3::new(0.618, 0.755, 0.57) * f64::from(index)).fract();
        Metaball::new((in_cube * 4.0 - DVec3::new(2.0, 2.0, 6.0)).as_vec3(), 0.4)
    });
    let scene = Scene::new(large_leaf.chain(behind), Kernel::QUARTIC, 0.3)?;
    let camera = Camera::look_at(Vec3::new(0.3, 0.2, 3.0), Vec3::ZERO, Vec3::Y, 40.0)?;
    Ok((scene, View::new(camera, 20, 15)?))
}
