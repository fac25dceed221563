//! The window: egui's widgets around a [`Viewer`].

mod canvas;
mod error_map;
mod keys;
mod marks;
mod notice;
mod panel;
mod status;

use std::sync::Arc;

use eframe::egui::{self, CentralPanel, Panel, ViewportBuilder};
use thiserror::Error;

use self::canvas::Canvas;
use self::panel::Sections;
use crate::{Judge, Opener, Pick, Start, Threads, Viewer, Wake};

/// Why there is no window.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WindowError {
    /// There is nothing to show it on.
    #[error(
        "window: needed a display, found neither DISPLAY nor WAYLAND_DISPLAY in the environment; render \
         and animate need none"
    )]
    NoDisplay,
    /// The display cannot be opened, or has no OpenGL.
    #[error(
        "window: needed a display with OpenGL 2 or later, found {found}; on Debian and Ubuntu apt-get \
         install libgl1 libegl1 libgl1-mesa-dri brings OpenGL without a graphics card, and render and \
         animate need neither"
    )]
    System {
        /// What the system said.
        found: String,
    },
}

/// Opens a window, and returns when it is closed. What is read, built and drawn is given up then.
///
/// # Errors
/// When there is no display, or no OpenGL on it.
pub fn open_window(opener: Arc<dyn Opener>, start: Start) -> Result<(), WindowError> {
    if !has_display() {
        return Err(WindowError::NoDisplay);
    }
    // Reading begins before there is a window, which takes longer to open.
    let context = egui::Context::default();
    let waker = context.clone();
    let wake: Wake = Arc::new(move || waker.request_repaint());
    let window = Window::new(Viewer::new(opener, Arc::new(Threads), start, &wake));
    let options = eframe::NativeOptions {
        viewport: ViewportBuilder::default()
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([480.0, 360.0])
            .with_app_id("metaball"),
        ..eframe::NativeOptions::default()
    };
    let creator = Box::new(|_: &eframe::CreationContext<'_>| Ok(Box::new(window) as Box<_>));
    eframe::run_native_ext("metaball", options, Some(context), creator)
        .map_err(|error| WindowError::System { found: error.to_string() })
}

/// Whether the environment names a display, where that is how one is found.
fn has_display() -> bool {
    let names = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    let is_set = |name: &&str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(target_os = "macos", windows)) || names.iter().any(is_set)
}

/// The widgets, and what they remember.
pub struct Window {
    viewer: Viewer,
    canvas: Canvas,
    sections: Sections,
    judge: Judge,
    picks: Vec<Pick>,
    /// Which model they are of.
    picked: u64,
    title: String,
}

impl Window {
    /// Around a viewer.
    pub fn new(viewer: Viewer) -> Self {
        let (canvas, sections, judge) = Default::default();
        Self { viewer, canvas, sections, judge, picks: Vec::new(), picked: 0, title: String::new() }
    }

    /// What is shown and done.
    pub fn viewer(&self) -> &Viewer {
        &self.viewer
    }

    /// The same, to be told what to do.
    pub fn viewer_mut(&mut self) -> &mut Viewer {
        &mut self.viewer
    }

    /// The points that were picked last, two at most.
    pub fn picks(&self) -> &[Pick] {
        &self.picks
    }

    /// What the reference says of the picture, where that was asked for.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// Shows all of it.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        self.viewer.hear();
        self.judge.hear(&self.viewer);
        if self.picked != self.viewer.models() {
            self.picked = self.viewer.models();
            self.picks.clear();
        }
        self.entitle(ui);
        keys::obey(ui, &mut self.viewer, self.canvas.id());
        self.open_dropped(ui);
        Panel::bottom("status").show(ui, |ui| status::show(ui, &mut self.viewer));
        Panel::right("panel").default_size(300.0).size_range(240.0..=460.0).show(ui, |ui| {
            self.sections.show(ui, &mut self.viewer, &mut self.picks, &mut self.judge);
        });
        CentralPanel::no_frame().show(ui, |ui| {
            self.canvas.show(ui, &mut self.viewer, &mut self.picks, &self.judge);
            notice::show(ui, &mut self.viewer);
        });
    }

    /// Names the window by what it shows.
    fn entitle(&mut self, ui: &egui::Ui) {
        let name = self.viewer.subject().map(|subject| subject.name.as_str());
        let title = name.map_or("metaball".to_owned(), |name| format!("{name} – metaball"));
        if title != self.title {
            self.title.clone_from(&title);
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }

    /// Opens a file that was dropped onto the window.
    fn open_dropped(&mut self, ui: &egui::Ui) {
        let dropped = ui.input(|input| input.raw.dropped_files.last().cloned());
        if let Some(file) = dropped {
            self.viewer.open(file.path().display().to_string());
        }
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}
