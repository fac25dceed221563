//! Layouts of WGSL structs by reflection, for tests that hold host structs against them.

/// Size and members of a WGSL struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructLayout {
    /// Name and byte offset of each member, in order.
    pub members: Vec<(String, u32)>,
    /// Bytes, padding at the end included.
    pub size: u32,
}

/// Layout of a struct that the composed module uses; `None` when it has no struct of that name.
pub fn struct_layout(module: &naga::Module, name: &str) -> Option<StructLayout> {
    module.types.iter().find_map(|(_, ty)| {
        let naga::TypeInner::Struct { members, span } = &ty.inner else { return None };
        (written_name(ty.name.as_deref()?) == name).then(|| StructLayout {
            members: members
                .iter()
                .map(|member| (member.name.clone().unwrap_or_default(), member.offset))
                .collect(),
            size: *span,
        })
    })
}

/// Layout of a host struct, to be held against its WGSL twin:
/// `host_layout!(PackedHit { normal, t, status })`. What only pads is left out.
#[macro_export]
macro_rules! host_layout {
    ($host:ty { $($member:ident),+ $(,)? }) => {
        $crate::StructLayout {
            members: vec![
                $((stringify!($member).to_owned(), std::mem::offset_of!($host, $member) as u32)),+
            ],
            size: size_of::<$host>() as u32,
        }
    };
}

/// The name as the WGSL file has it, without what composition adds.
fn written_name(composed: &str) -> &str {
    composed.split_once("X_naga_oil_mod_X").map_or(composed, |(written, _)| written)
}
