//! The window of metaball: turns the surface that particles imply, lights it, and says what any point of
//! it is made of.
//!
//! A [`Viewer`] is all of it but the window: what is looked at ([`Subject`]), where from ([`Pose`]), and
//! threads that read, build and draw beside it, so that nothing that it is asked to do takes long. It is
//! tested without a window. [`open_window`] shows one: egui's widgets and a picture, on whatever OpenGL the
//! machine has, which may be Mesa's in software. The picture is drawn by the library `metaball` on the
//! CPU, ray for ray as its command `render` draws it.

mod builder;
mod command_line;
mod events;
mod export;
mod judge;
mod mailbox;
mod pace;
mod painter;
mod pick;
mod pose;
mod subject;
mod viewer;
mod window;

pub use command_line::CommandLine;
pub use events::Wake;
pub use export::Export;
pub use judge::Verdicts;
pub use painter::{Look, Painting, Stage};
pub use pick::{Pick, Share};
pub use pose::Pose;
pub use subject::{Content, Opener, Subject};
pub use viewer::{Progress, Start, Timeline, Viewer};
pub use window::{Window, WindowError, open_window};
