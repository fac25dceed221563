//! What the panel of the page shows, as its worker tells it.

use std::ptr;

use metaball::{NoteKind, legend_svg};
use metaball_core::Kernel;
use serde::Serialize;
use viewer::cut::{NORMALS, last_plane, reach};
use viewer::{Painting, Pick, Progress, Stage};

use crate::act::{Light, Shown};
use crate::front::Front;

/// Balls that are listed of a point; how many there are is said.
const LISTED: usize = 12;

/// All of it.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct State {
    /// What is being done: `reading`, `building` or nothing.
    progress: Option<&'static str>,
    /// What went wrong last.
    failure: Option<String>,
    scene: Option<Scene>,
    picture: Option<PictureState>,
    points: Vec<Point>,
    /// Between two points.
    distance: Option<f64>,
    light: Light,
    /// The command line that draws this picture.
    command: Option<String>,
}

#[derive(Debug, PartialEq, Serialize)]
struct Scene {
    name: String,
    balls: usize,
    /// Scene units.
    size: [f32; 3],
    build_ms: f64,
    tree_bytes: usize,
    notes: Vec<(&'static str, String)>,
    /// A picture in SVG.
    legend: Option<String>,
    kernels: Vec<String>,
    kernel: String,
    threshold: f32,
    /// Whether they are the scene's own.
    is_own_field: bool,
    radius_scale: f32,
    color_by: Option<String>,
    frame: Option<u32>,
    shown: Shown,
    /// Outward normals that a cut may have, with their names, and from where to where its plane may lie.
    normals: Vec<([f32; 3], &'static str, f64, f64)>,
    cut: Option<([f32; 3], f64)>,
}

#[derive(Debug, PartialEq, Serialize)]
struct PictureState {
    width: u32,
    height: u32,
    /// `coarse`, `sharp` or `lit`.
    stage: &'static str,
    /// Whether it is of the latest model, camera and size.
    is_latest: bool,
    samples: u32,
    ms: f64,
    rate: Option<f64>,
    undecided: usize,
}

#[derive(Debug, PartialEq, Serialize)]
struct Point {
    position: [f64; 3],
    normal: [f32; 3],
    t: f32,
    field: f64,
    is_inside: bool,
    on_face: bool,
    balls: usize,
    /// The first of them: their numbers, what they add, and that in parts of the field.
    shares: Vec<(usize, f64, f64)>,
}

impl State {
    pub(crate) fn of(front: &Front) -> Self {
        let viewer = &front.viewer;
        let failure = front.refusal.as_deref().or(viewer.failure());
        let distance = match front.picks.as_slice() {
            [first, second] => Some(first.point.distance(second.point)),
            _ => None,
        };
        Self {
            progress: match viewer.progress() {
                Progress::Ready => None,
                Progress::Reading(_) => Some("reading"),
                Progress::Building(_) => Some("building"),
            },
            failure: failure.map(str::to_owned),
            scene: Scene::of(front),
            picture: viewer.painting().map(|painting| PictureState::of(painting, front)),
            points: front.picks.iter().map(Point::of).collect(),
            distance,
            light: Light::of(&viewer.look().light),
            command: viewer.command_line().map(|line| line.to_string()),
        }
    }
}

#[cfg(test)]
impl State {
    /// What went wrong last.
    pub(crate) fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }
}

impl Scene {
    fn of(front: &Front) -> Option<Self> {
        let viewer = &front.viewer;
        let (subject, model) = (viewer.subject()?, viewer.model()?);
        let (scene, reading) = (model.scene(), viewer.reading());
        let toward_eye = viewer.pose().map(|pose| (-pose.axes()[2].as_vec3(), "toward the eye"));
        let normals = NORMALS.into_iter().chain(toward_eye);
        Some(Self {
            name: subject.name.clone(),
            balls: scene.len(),
            size: model.bounds().extent().to_array(),
            build_ms: 1e3 * model.build_time().as_secs_f64(),
            tree_bytes: model.tree_bytes(),
            notes: subject
                .notes
                .iter()
                .flatten()
                .map(|note| (kind(note.kind), note.text.clone()))
                .collect(),
            legend: subject.legend.as_ref().map(legend_svg),
            kernels: Kernel::all().map(|kernel| kernel.to_string()).collect(),
            kernel: scene.kernel().to_string(),
            threshold: scene.threshold(),
            is_own_field: *viewer.field() == metaball::Overrides::default(),
            radius_scale: reading.radius_scale.unwrap_or(1.0),
            color_by: reading.color_by.as_ref().map(ToString::to_string),
            frame: reading.frame,
            shown: Shown::of(viewer.look().picture),
            normals: normals
                .map(|(normal, name)| {
                    let range = reach(model, normal);
                    (normal.to_array(), name, *range.start(), *range.end())
                })
                .collect(),
            cut: last_plane(viewer.look()).map(|(normal, offset)| (normal.to_array(), offset)),
        })
    }
}

impl PictureState {
    fn of(painting: &Painting, front: &Front) -> Self {
        let (viewer, view) = (&front.viewer, &painting.view);
        let is_of_model = viewer.model().is_some_and(|model| ptr::eq(model, &*painting.model));
        let is_of_size = (view.width(), view.height()) == front.size;
        let (stage, samples) = match painting.stage {
            Stage::Coarse => ("coarse", 0),
            Stage::Sharp => ("sharp", 0),
            Stage::Lit(samples) => ("lit", samples),
        };
        Self {
            width: view.width(),
            height: view.height(),
            stage,
            is_latest: is_of_model && is_of_size && viewer.camera() == Some(*view.camera()),
            samples,
            ms: 1e3 * painting.time.as_secs_f64(),
            rate: viewer.rate(),
            undecided: painting.undecided,
        }
    }
}

impl Point {
    fn of(pick: &Pick) -> Self {
        let shares = pick.shares.iter().take(LISTED);
        Self {
            position: pick.point.to_array(),
            normal: pick.normal().to_array(),
            t: pick.hit.t,
            field: pick.field,
            is_inside: pick.is_inside(),
            on_face: pick.on_face,
            balls: pick.shares.len(),
            shares: shares.map(|share| (share.ball, share.value, share.share)).collect(),
        }
    }
}

fn kind(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Read => "Read",
        NoteKind::Guessed => "Guessed",
        NoteKind::LeftOut => "Left out",
        _ => "Changed",
    }
}
