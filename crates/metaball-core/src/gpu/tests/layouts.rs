//! Host structs against their WGSL twins.

use metaball_shaders::{StructLayout, Variant, compose, host_layout, struct_layout};

use crate::gpu::ray_list::ListHead;
use crate::gpu::spheres::CoreSphere;
use crate::gpu::{FrameStatus, FreeRay, KernelRead, PackedRay, SceneHeader, ViewUniform};
use crate::{PackedHit, Support, ValueRange, Work};

fn wgsl(module: &str, name: &str) -> StructLayout {
    let variant = Variant::trials().next().expect("there are variants");
    let module = compose(module, &variant).expect("composes");
    struct_layout(&module, name).expect("the module has the struct")
}

#[test]
fn host_structs_are_their_twins() {
    let twins = [
        (wgsl("core/hit", "Hit"), host_layout!(PackedHit { normal, t, status })),
        (wgsl("core/view", "PrimaryRay"), host_layout!(PackedRay { direction, t_max })),
        (
            wgsl("batch/free_ray", "FreeRay"),
            host_layout!(FreeRay { origin, t_max, direction, query }),
        ),
        (
            wgsl("core/view", "View"),
            host_layout!(ViewUniform { eye, width, right, height, up, half_pixel, forward }),
        ),
        (wgsl("core/status", "Status"), host_layout!(FrameStatus { unfinished, needed })),
        (wgsl("core/scene", "Support"), host_layout!(Support { center, radius })),
        (wgsl("core/scene", "SceneHeader"), host_layout!(SceneHeader { threshold, balls })),
        (
            wgsl("core/kernel_read", "KernelRead"),
            host_layout!(KernelRead { family, exponent, gaussian_exponent, gaussian_scale }),
        ),
        (
            wgsl("core/work_record", "Work"),
            host_layout!(Work {
                nodes,
                leaf_tests,
                balls,
                evaluations,
                iterations,
                layers,
                depth,
                longest_search
            }),
        ),
        (wgsl("shade/picture", "ValueRange"), host_layout!(ValueRange { low, high })),
        (
            wgsl("shade/spheres", "CoreSphere"),
            host_layout!(CoreSphere { center, radius, color, half_depth }),
        ),
    ];
    for (device, host) in twins {
        assert_eq!(device, host);
    }
    let head = host_layout!(ListHead { groups_x, groups_y, groups_z, count });
    let listing = wgsl("batch/list_rays", "Listing");
    assert_eq!(head.members[..], listing.members[..4]);
    assert_eq!(listing.members[4], ("pixels".to_owned(), head.size));
}

#[test]
fn swapped_fields_are_noticed() {
    #[repr(C)]
    struct Swapped {
        t: f32,
        normal: [f32; 2],
        status: u32,
    }
    assert_ne!(wgsl("core/hit", "Hit"), host_layout!(Swapped { normal, t, status }));
    assert_ne!(wgsl("core/hit", "Hit"), host_layout!(Swapped { t, normal, status }));
}
