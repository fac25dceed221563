//! The viewer behind the page, without the browser.

use std::sync::Arc;
use std::time::Duration;

use metaball::{Clip, Image, LightOptions, Overrides, Picture, ReadOptions, Viewpoint};
use viewer::{Crew, Hand, Look, Pick, Start, Viewer, Wake};

use crate::act::Act;
use crate::files::Files;
use crate::state::State;

/// The viewer, and what the page's user is doing with it.
pub(crate) struct Front {
    pub(crate) viewer: Viewer,
    pub(crate) hand: Hand,
    /// The points that were picked last, two at most.
    pub(crate) picks: Vec<Pick>,
    /// Whether a hand has hold of the picture.
    pub(crate) held: bool,
    /// Pixels across and down.
    pub(crate) size: (u32, u32),
    /// Why the last act was not done.
    pub(crate) refusal: Option<String>,
    files: Arc<Files>,
    /// Which model the picks are of.
    picked: u64,
    /// Which painting was handed out last.
    handed: u64,
}

impl Front {
    /// With nothing to be seen yet.
    pub(crate) fn new(crew: Arc<dyn Crew>, wake: &Wake) -> Self {
        let files = Arc::new(Files::default());
        let start = Start {
            spec: None,
            reading: ReadOptions::default(),
            field: Overrides::default(),
            viewpoint: Viewpoint::default(),
            look: Look {
                picture: Picture::Phong,
                clip: Clip::default(),
                light: LightOptions::default(),
            },
        };
        Self {
            viewer: Viewer::new(files.clone(), crew, start, wake),
            hand: Hand::default(),
            picks: Vec::new(),
            held: false,
            size: (1, 1),
            refusal: None,
            files,
            picked: 0,
            handed: 0,
        }
    }

    /// Opens the bytes of a file.
    pub(crate) fn open(&mut self, name: String, bytes: Vec<u8>) {
        let shown = self.viewer.subject().map(|subject| subject.spec.as_str());
        self.files.take(&name, bytes, shown);
        self.refusal = None;
        self.viewer.open(name);
    }

    /// Does what a user has done, in JSON.
    pub(crate) fn act(&mut self, json: &str) -> Result<(), serde_json::Error> {
        self.refusal = None;
        serde_json::from_str::<Act>(json)?.is_done_by(self);
        Ok(())
    }

    /// Goes on with what the tasks have done. Returns when it wants to be called again, if nothing else
    /// happens.
    pub(crate) fn go_on(&mut self) -> Option<Duration> {
        self.viewer.hear();
        if self.picked != self.viewer.models() {
            self.picked = self.viewer.models();
            self.picks.clear();
        }
        self.viewer.draw(self.size, self.held)
    }

    /// The latest picture, if it has not been handed out yet.
    pub(crate) fn picture(&mut self) -> Option<&Image> {
        let handed = self.viewer.paintings();
        let is_new = std::mem::replace(&mut self.handed, handed) != handed;
        Some(&self.viewer.painting().filter(|_| is_new)?.shown.image)
    }

    /// What the panel shows.
    pub(crate) fn state(&self) -> State {
        State::of(self)
    }

    /// The point that is seen at a place: to be said, or to be looked at.
    pub(crate) fn pick(&mut self, (right, down): (f64, f64), centre: bool) {
        let Some((width, height)) = self.viewer.size() else { return };
        let pixel = |share: f64, count: u32| {
            ((share * f64::from(count)) as i64).clamp(0, i64::from(count) - 1) as u32
        };
        match self.viewer.pick((pixel(right, width), pixel(down, height))) {
            Some(found) if centre => {
                if let Some(pose) = self.viewer.pose() {
                    self.viewer.set_pose(pose.centered(found.point));
                }
            }
            Some(found) => {
                if self.picks.len() > 1 {
                    self.picks.clear();
                }
                self.picks.push(found);
            }
            None => self.picks.clear(),
        }
    }
}
