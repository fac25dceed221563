//! The window of metaball: turns the surface that particles imply, lights it, and says what any point of
//! it is made of.
//!
//! A [`Viewer`] is all of it but the window: what is looked at ([`Subject`]), where from ([`Pose`]), and
//! tasks that read, build and draw beside it, so that nothing that it is asked to do takes long. A [`Crew`]
//! runs them: each on a thread, or in turns where there are no threads. It is tested without a window. The
//! picture is drawn by the library `metaball` on the CPU, ray for ray as its command `render` draws it.
//!
//! # Features
//! With `window`, which is a default, `open_window` shows one: egui's widgets and a picture, on whatever
//! OpenGL the machine has, which may be Mesa's in software. Without it the viewer is for another front, such
//! as the page of a browser.

mod builder;
mod command_line;
mod crew;
pub mod cut;
mod events;
mod export;
mod hand;
#[cfg(feature = "window")]
mod judge;
mod mailbox;
mod material;
mod pace;
mod painter;
mod pick;
mod pose;
mod subject;
mod viewer;
#[cfg(feature = "window")]
mod window;

pub use command_line::CommandLine;
pub use crew::{Awaited, Crew, Task, Threads};
pub use events::Wake;
pub use export::Export;
pub use hand::Hand;
#[cfg(feature = "window")]
pub use judge::{Judge, Verdicts};
pub use material::Material;
pub use painter::{Look, Painting, Stage};
pub use pick::{Pick, Share};
pub use pose::Pose;
pub use subject::{Content, Opener, Subject};
pub use viewer::{Progress, Start, Timeline, Viewer};
#[cfg(feature = "window")]
pub use window::{Window, WindowError, open_window};
