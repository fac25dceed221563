//! The viewer behind the page, without the browser.

use std::sync::Arc;
use std::time::Duration;

use metaball::Image;
use viewer::{Crew, Hand, Pick, Start, Viewer, Wake};

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
        Self {
            viewer: Viewer::new(files.clone(), crew, Start::default(), wake),
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
        serde_json::from_str::<Act>(json)?.perform(self);
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

#[cfg(test)]
mod tests {
    use std::thread::sleep;
    use std::time::Instant;

    use metaball::{Backend, DrawOptions, draw};
    use serde_json::{Value, json};
    use viewer::{Stage, Threads};

    use super::*;

    const WATER: &[u8] = include_bytes!("../../particle-files/examples/water.xyz");
    const PATIENCE: Duration = Duration::from_secs(60);

    fn front() -> Front {
        let mut front = Front::new(Arc::new(Threads), &(Arc::new(|| ()) as _));
        front.open("water.xyz".to_owned(), WATER.to_vec());
        act(&mut front, &json!({ "act": "resize", "width": 90, "height": 70 }));
        front
    }

    fn act(front: &mut Front, act: &Value) {
        front.act(&act.to_string()).expect("an act");
    }

    fn until(front: &mut Front, is_so: impl Fn(&Front) -> bool) {
        let begin = Instant::now();
        while !is_so(front) {
            assert!(begin.elapsed() < PATIENCE, "it never is");
            sleep(Duration::from_millis(2));
            front.go_on();
        }
    }

    /// The picture at rest is what the library draws.
    fn assert_drawn(front: &mut Front) {
        until(front, |front| {
            let is_latest = |at: &viewer::Painting| {
                Some(*at.view.camera()) == front.viewer.camera() && at.stage == Stage::Sharp
            };
            front.viewer.painting().is_some_and(is_latest)
        });
        let (subject, model) = (front.viewer.subject(), front.viewer.model());
        let (subject, model) = (subject.expect("open"), model.expect("built"));
        let options = DrawOptions {
            size: front.size,
            viewpoint: front.viewer.viewpoint(),
            picture: front.viewer.look().picture,
            clip: front.viewer.look().clip.clone(),
            backend: Backend::Cpu,
            ..DrawOptions::default()
        };
        let wanted = draw(model.scene(), &subject.camera, &options).expect("drawn");
        assert!(wanted.hit_count() > 100);
        assert!(front.picture().is_some_and(|image| *image == wanted.image));
        assert!(front.picture().is_none(), "it has been handed out");
    }

    #[test]
    fn acts_change_what_is_drawn() {
        let mut front = front();
        assert_drawn(&mut front);
        for moved in [
            json!({ "act": "turn", "by": [0.3, 0.1] }),
            json!({ "act": "zoom", "at": [0.4, 0.4], "share": 0.8 }),
            json!({ "act": "along", "axis": [0.0, 0.0, 1.0] }),
            json!({ "act": "home" }),
        ] {
            let before = front.viewer.camera();
            act(&mut front, &moved);
            assert_ne!(front.viewer.camera(), before, "{moved}");
            assert_drawn(&mut front);
        }
        act(&mut front, &json!({ "act": "pick", "at": [0.5, 0.5], "centre": false }));
        let state = serde_json::to_value(front.state()).expect("JSON");
        assert_eq!(state["points"][0]["shares"][0][0], 0, "the oxygen");
        assert_eq!(state["scene"]["balls"], 3);
        assert_eq!(state["failure"], Value::Null);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let mut front = front();
        until(&mut front, |front| front.viewer.model().is_some());
        let read =
            json!({ "act": "read", "radius_scale": null, "color_by": "charge=1", "frame": null });
        act(&mut front, &read);
        assert!(front.state().failure().is_some_and(|said| said.starts_with("color by")));
        front.open("four.csv".to_owned(), b"x,y,z,radius\n0,0,0,four\n".to_vec());
        until(&mut front, |front| front.viewer.failure().is_some());
        let said = front.state();
        assert!(said.failure().is_some_and(|said| said.starts_with("four.csv, line 2, column 4")));
        assert!(front.act(r#"{"act":"fly"}"#).is_err() && front.act("{").is_err());
        // What was there before is still there, and can be read again.
        let read = json!({ "act": "read", "radius_scale": 2.0, "color_by": null, "frame": null });
        act(&mut front, &read);
        until(&mut front, |front| front.viewer.models() == 2);
        assert_eq!(front.viewer.subject().map(|subject| subject.spec.as_str()), Some("water.xyz"));
    }
}
