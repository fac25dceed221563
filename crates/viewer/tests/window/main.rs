//! The window without a display: egui's own harness presses, drags and resizes, and what comes of it is
//! held against the library's drawing.

mod broken;
mod camera;
mod field;
mod output;
mod pick;
mod sections;
mod splash;
mod stage;
mod truth;
