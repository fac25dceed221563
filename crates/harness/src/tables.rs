//! Tables that papers print, measured anew and set beside the printed numbers; one of programs that a
//! user would take instead, one of what `auto` chooses, and one of what it saves that shaders are made
//! for a scene.

pub mod auto;
pub mod gourmel;
pub mod gourmel_light;
pub mod illes;
pub mod kanamori;
pub mod peers;
pub mod specialisation;
