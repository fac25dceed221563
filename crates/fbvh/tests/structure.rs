//! Trees of random scenes are valid, and do not depend on the number of threads.

mod scenes;

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use fbvh::{
    Boxes, BuildError, Classes, Cost, EMPTY, Fitting, Flaw, Kind, MAX_DEPTH, Options, Structure,
    Tree,
};
use glam::Vec3;
use metaball_core::{Kernel, Metaball, Scene};
use proptest::prelude::*;
use rayon::ThreadPoolBuilder;

/// Every option at work, in combinations that leave trees shallow and deep.
fn any_options() -> impl Strategy<Value = Options> {
    let boxes =
        prop::sample::select(vec![Boxes::Cut, Boxes::Support, Boxes::PerNode, Boxes::PerBall]);
    let fitted = (boxes, prop::sample::select(vec![0u32, 12, 1000]))
        .prop_map(|(boxes, discard_up_to)| Structure::Fitted(Fitting { boxes, discard_up_to }));
    let certified = (1u32..20, 0.06f32..1.4).prop_map(|(leaf_size, smallest_side)| {
        Structure::Certified(Classes { leaf_size, smallest_side })
    });
    let structure = prop_oneof![1 => Just(Structure::ModifiedBvh), 3 => fitted, 2 => certified];
    let cost = prop::sample::select(vec![
        Cost::Linear,
        Cost::Quadratic { lambda: 0.0 },
        Cost::Quadratic { lambda: 8.0 },
    ]);
    let halve_above = prop::sample::select(vec![4, 16, u32::MAX]);
    let max_depth = prop::sample::select(vec![0, 3, MAX_DEPTH]);
    (structure, cost, 0.1f32..30.0, 2u32..=16, halve_above, 1u32..4, max_depth).prop_map(
        |(structure, cost, traversal_cost, bins, halve_above, leaf_size, max_depth)| Options {
            structure,
            cost,
            traversal_cost,
            bins,
            halve_above,
            leaf_size,
            max_depth,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn trees_are_well_formed(scene in scenes::any_signed_scene(60), options in any_options()) {
        let negative = scene.negative_ball().filter(|_| options.kind() != Kind::Certified);
        let built = Tree::build(&scene, &options);
        if let Some(source) = negative {
            let refusal = BuildError::NegativeOfPublished { kind: options.kind(), source };
            prop_assert_eq!(built, Err(refusal));
            return Ok(());
        }
        let tree = built.expect("legal options");
        match tree.validate(&scene) {
            Ok(stats) => {
                prop_assert!(stats.depth <= options.max_depth);
                prop_assert_eq!(stats.list_entries, tree.lists().len());
                prop_assert_eq!(tree.is_empty(), stats.leaves == 0);
            }
            Err(flaw) => prop_assert!(false, "{}", flaw),
        }
    }
}

/// A few thousand balls, so that building forks, in clumps, so that trees are uneven.
fn clumps() -> Scene {
    let mut state = 1u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let balls = (0..20_000).map(|index| {
        let clump = (index % 7) as f32;
        let center = Vec3::new(random(), random(), random()) * (1.0 + clump) + 3.0 * clump;
        Metaball { center, radius: 0.05 + 0.1 * random(), strength: 0.5 + random() }
    });
    Scene::new(balls, Kernel::QUARTIC, 0.3).expect("legal balls")
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let scene = clumps();
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let trees = [1, 2, 4].map(|threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| Tree::build(&scene, &options)).expect("legal options")
        });
        assert!(trees[0].nodes().len() > 1000, "{:?} is too small to fork", options.kind());
        assert_eq!(trees[0], trees[1]);
        assert_eq!(trees[0], trees[2]);
    }
}

/// Where a negative ball reaches nothing, the tree is the one without it to the last bit: what no ball of a box
/// needs is not paid for.
#[test]
fn a_negative_ball_elsewhere_changes_nothing() {
    let scene = clumps();
    let with = |center: Vec3| {
        let negative = Metaball { center, radius: 0.5, strength: -0.3 };
        let balls = scene.balls().chain([negative]);
        Scene::new(balls, scene.kernel(), scene.threshold()).expect("legal balls")
    };
    let build = |scene: &Scene| Tree::build(scene, &Options::certified()).expect("legal options");
    assert!(build(&scene) == build(&with(Vec3::splat(-20.0))));
    assert!(build(&scene) != build(&with(Vec3::splat(3.5))), "a canary among the balls");
}

#[test]
fn a_tree_that_is_not_wanted_any_more_is_given_up() {
    let scene = clumps();
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let asked = AtomicUsize::new(0);
        let build = |limit| {
            asked.store(0, Relaxed);
            Tree::build_while(&scene, &options, || asked.fetch_add(1, Relaxed) < limit)
        };
        let whole = Tree::build(&scene, &options).expect("legal options");
        assert_eq!(build(usize::MAX).expect("wanted"), whole);
        let all = asked.load(Relaxed);
        assert!(all > whole.nodes().len(), "asked {all} times");
        for limit in [0, 1, all / 2, all - 1] {
            assert_eq!(build(limit), Err(BuildError::BrokenOff));
            assert!(asked.load(Relaxed) <= limit + rayon::current_num_threads(), "asked on");
        }
    }
}

#[test]
fn large_trees_are_well_formed() {
    let scene = clumps();
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let tree = Tree::build(&scene, &options).expect("legal options");
        assert_eq!(tree.validate(&scene).map(|stats| stats.leaves), Ok(tree.leaf_count()));
    }
}

#[test]
fn trees_of_another_scene_are_invalid() {
    let row = |distance: f32| {
        let balls = (0..50).map(|at| Metaball::new(Vec3::X * distance * at as f32, 1.0));
        Scene::new(balls, Kernel::Wyvill, 0.2).expect("legal balls")
    };
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let tree = Tree::build(&row(1.5), &options).expect("legal options");
        assert!(tree.validate(&row(1.5)).is_ok());
        let flaw = tree.validate(&row(1.3)).expect_err("balls have moved");
        assert!(matches!(flaw, Flaw::Incomplete { .. } | Flaw::OwnOutside { .. }), "{flaw}");
    }
}

#[test]
fn nothing_to_see_is_an_empty_tree() {
    let empty = Scene::new([], Kernel::QUARTIC, 0.5).expect("legal");
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let tree = Tree::build(&empty, &options).expect("legal options");
        assert_eq!((tree.root(), tree.leaf_count(), tree.kind()), (EMPTY, 0, options.kind()));
    }
    // Five balls of strength 1 never sum to 6, wherever they are.
    let weak = (0..5).map(|at| Metaball::new(0.1 * at as f32 * Vec3::ONE, 1.0));
    let weak = Scene::new(weak, Kernel::QUARTIC, 6.0).expect("legal");
    assert!(Tree::build(&weak, &Options::fitted()).expect("legal options").is_empty());
}

#[test]
fn coincident_balls_are_one_leaf() {
    let balls = std::iter::repeat_n(Metaball::new(Vec3::ONE, 1.0), 5000);
    let scene = Scene::new(balls, Kernel::QUARTIC, 0.5).expect("legal");
    for options in [Options::modified_bvh(), Options::fitted(), Options::certified()] {
        let stats = Tree::build(&scene, &options).expect("legal options").stats();
        assert_eq!((stats.leaves, stats.list_entries), (1, 5000), "{:?}", options.kind());
    }
}

#[test]
fn balls_that_all_overlap_are_not_coincident() {
    let mut state = 7u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let balls = (0..200).map(|_| Metaball::new(Vec3::new(random(), random(), random()), 1.8));
    let scene = Scene::new(balls, Kernel::QUARTIC, 20.0).expect("legal");
    let stats = Tree::build(&scene, &Options::certified()).expect("legal options").stats();
    assert!(stats.leaves > 8, "{stats:?}");
}

/// A point of a box is known to 2⁻²² of it in f32: for a small ball on a large one that is too little,
/// unless the box is small too.
#[test]
fn boxes_are_narrow_for_their_least_ball() {
    for ratio in [1e2f32, 1e4, 1e6] {
        let balls = [
            Metaball::new(Vec3::ZERO, ratio),
            Metaball::new(std::f32::consts::FRAC_1_SQRT_2 * ratio * Vec3::Z, 1.0),
        ];
        let scene = Scene::new(balls, Kernel::QUARTIC, 0.25).expect("legal");
        let tree = Tree::build(&scene, &Options::certified()).expect("legal options");
        let wide = (0..tree.leaf_count()).filter(|&leaf| tree.leaf_balls(leaf).1.contains(&1));
        let widths = wide.map(|leaf| tree.leaves()[leaf].bounds().extent().max_element());
        let widest = widths.reduce(f32::max);
        assert!(widest.is_some_and(|side| side <= 16.0), "{ratio}: {widest:?}");
        assert!(tree.leaf_count() < 200, "{ratio}: {} leaves", tree.leaf_count());
    }
}

#[test]
fn bins_out_of_range_are_refused() {
    let scene = Scene::new([], Kernel::QUARTIC, 0.5).expect("legal");
    let error = Tree::build(&scene, &Options { bins: 1, ..Options::fitted() });
    assert_eq!(error, Err(BuildError::Bins { found: 1 }));
    assert_eq!(Options::fitted().kind(), Kind::Fitted);
}
