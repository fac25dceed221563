//! What a window shows and does, without the window.

mod moving;
mod order;

use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use fbvh::{Kind, Options};
use glam::DVec3;
use metaball::{Camera, Clip, Model, Overrides, Picture, ReadOptions, Viewpoint};
use metaball_core::CameraError;
use web_time::Instant;

pub use self::moving::Timeline;
use self::order::Ordered;
use crate::builder::{self, Builder, Built};
use crate::command_line::CommandLine;
use crate::crew::Crew;
use crate::events::{Post, Wake};
use crate::export::{Export, Exporting, Job};
use crate::painter::{Look, Painter, Painting};
use crate::pick::Pick;
use crate::pose::Pose;
use crate::subject::{Opener, Subject, told};

/// What a window begins with; nothing, by default.
#[derive(Debug, Clone, Default)]
pub struct Start {
    /// What is opened, if anything.
    pub spec: Option<String>,
    /// How it is read.
    pub reading: ReadOptions,
    /// What replaces its kernel, threshold and colours.
    pub field: Overrides,
    /// Where it is seen from.
    pub viewpoint: Viewpoint,
    /// What is seen.
    pub look: Look,
}

/// How far what was opened last is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// There is nothing to be done.
    Ready,
    /// It is being read, since then.
    Reading(Instant),
    /// Its tree is being built, since then.
    Building(Instant),
}

/// The state of a window, and the tasks beside it.
pub struct Viewer {
    opener: Arc<dyn Opener>,
    crew: Arc<dyn Crew>,
    wake: Wake,
    subject: Option<Arc<Subject>>,
    model: Option<Arc<Model>>,
    models: u64,
    painting: Option<Painting>,
    paintings: u64,
    /// How many pictures there have been with other rays, or another model, than the one before.
    sights: u64,
    failure: Option<String>,
    progress: Progress,
    reading: ReadOptions,
    field: Overrides,
    tree: Options,
    look: Look,
    first: Viewpoint,
    pose: Option<Pose>,
    timeline: Timeline,
    ordered: Ordered,
    opened: Inbox<(u64, Result<Subject, String>)>,
    opening: u64,
    /// Whether what is being opened begins without the options of what was there before.
    opens_anew: bool,
    building: u64,
    /// Builds up to this number have been given up.
    given_up: u64,
    /// What the model was built by.
    latest: Option<builder::Order>,
    built: Inbox<Built>,
    painted: Inbox<Result<Painting, String>>,
    builder: Builder,
    painter: Painter,
    exporting: Option<Exporting>,
    exported: Option<Result<String, String>>,
    written: Inbox<Result<String, String>>,
}

/// Both ends of a channel: one for the tasks that will report.
struct Inbox<T> {
    post: Post<T>,
    reports: Receiver<T>,
}

impl<T> Inbox<T> {
    fn new(wake: &Wake) -> Self {
        let (post, reports) = Post::new(wake.clone());
        Self { post, reports }
    }
}

impl Viewer {
    /// Begins. The tasks of the crew call `wake` when they have something to show.
    pub fn new(opener: Arc<dyn Opener>, crew: Arc<dyn Crew>, start: Start, wake: &Wake) -> Self {
        let (built, painted) = (Inbox::new(wake), Inbox::new(wake));
        let mut viewer = Self {
            opener,
            wake: wake.clone(),
            subject: None,
            model: None,
            models: 0,
            painting: None,
            paintings: 0,
            sights: 0,
            failure: None,
            progress: Progress::Ready,
            reading: start.reading,
            field: start.field,
            tree: Options::certified(),
            look: start.look,
            first: start.viewpoint,
            pose: None,
            timeline: Timeline::default(),
            ordered: Ordered::default(),
            opened: Inbox::new(wake),
            opening: 0,
            opens_anew: false,
            building: 0,
            given_up: 0,
            latest: None,
            builder: Builder::new(&*crew, built.post.clone()),
            painter: Painter::new(&crew, painted.post.clone()),
            crew,
            built,
            painted,
            exporting: None,
            exported: None,
            written: Inbox::new(wake),
        };
        if let Some(spec) = start.spec {
            let reading = viewer.reading.clone();
            viewer.read(spec, reading, false);
        }
        viewer
    }

    /// Opens something else, as its file says it, seen from where its own camera is.
    pub fn open(&mut self, spec: String) {
        self.read(spec, ReadOptions::default(), true);
    }

    /// Reads the same again, otherwise.
    pub fn read_as(&mut self, reading: ReadOptions) {
        if let Some(subject) = self.subject.as_ref().filter(|_| reading != self.reading) {
            let spec = subject.spec.clone();
            self.reading = reading.clone();
            self.read(spec, reading, false);
        }
    }

    /// Reads in a task of its own, since nothing interrupts a reader: it may go on for a while after
    /// it is no longer wanted.
    fn read(&mut self, spec: String, reading: ReadOptions, anew: bool) {
        self.opening += 1;
        self.opens_anew = anew;
        self.progress = Progress::Reading(Instant::now());
        let (opener, id) = (self.opener.clone(), self.opening);
        let post = self.opened.post.clone();
        self.crew.begin(Box::new(move || {
            Box::pin(async move {
                let subject = opener.open(&spec, &reading);
                post.send((id, subject.map_err(|error| told(&*error))));
            })
        }));
    }

    /// Gives up what is being read or built: what was there before is still shown.
    pub fn cancel(&mut self) {
        if self.progress == Progress::Ready {
            return;
        }
        self.opening += 1;
        self.given_up = self.building;
        self.progress = Progress::Ready;
        match self.latest.clone() {
            Some(latest) => self.go_back(latest),
            None => self.subject = None,
        }
    }

    /// Back to what the model was built by.
    fn go_back(&mut self, latest: builder::Order) {
        if !self.is_current(&latest.subject) {
            self.timeline = Timeline::of(&latest.subject);
        }
        let now = Instant::now();
        self.timeline = self.timeline.playing(false, now).at(latest.frame, now);
        self.reading = latest.subject.reading.clone();
        (self.field, self.tree) = (latest.field, latest.tree);
        self.subject = Some(latest.subject);
    }

    /// Takes what the tasks have reported.
    pub fn hear(&mut self) {
        self.take_written();
        while let Ok((id, subject)) = self.opened.reports.try_recv() {
            if id == self.opening {
                self.take_subject(subject);
            }
        }
        while let Ok(built) = self.built.reports.try_recv() {
            self.take_built(built);
        }
        while let Ok(painted) = self.painted.reports.try_recv() {
            self.ordered.count(&painted);
            match painted {
                Ok(painting) => {
                    let is_same = |old: &Painting| {
                        old.view == painting.view && Arc::ptr_eq(&old.model, &painting.model)
                    };
                    if !self.painting.as_ref().is_some_and(is_same) {
                        self.sights += 1;
                    }
                    self.painting = Some(painting);
                    self.paintings += 1;
                }
                Err(failure) => self.failure = Some(failure),
            }
        }
    }

    fn take_written(&mut self) {
        if let Ok(written) = self.written.reports.try_recv() {
            self.exporting = None;
            self.exported = Some(written);
        }
    }

    fn take_subject(&mut self, subject: Result<Subject, String>) {
        match subject {
            Ok(subject) => {
                if self.opens_anew {
                    self.begin_anew();
                }
                if self.subject.as_ref().is_none_or(|old| old.spec != subject.spec) {
                    self.pose = None;
                    self.timeline = Timeline::of(&subject);
                }
                self.failure = None;
                self.subject = Some(Arc::new(subject));
                self.build();
            }
            Err(failure) => {
                self.failure = Some(failure);
                self.progress = Progress::Ready;
            }
        }
    }

    /// Forgets what was asked of another subject.
    fn begin_anew(&mut self) {
        self.reading = ReadOptions::default();
        self.field = Overrides::default();
        self.first = Viewpoint::default();
        self.look.clip = Clip::default();
        self.pose = None;
    }

    fn build(&mut self) {
        let Some(subject) = self.subject.clone() else { return };
        self.building += 1;
        self.progress = Progress::Building(Instant::now());
        let (frame, next) = (self.timeline.frame(), self.timeline.next());
        self.builder.order(builder::Order {
            number: self.building,
            subject,
            frame,
            field: self.field,
            tree: self.tree,
            next,
        });
    }

    fn take_built(&mut self, Built { order, model }: Built) {
        if order.number <= self.given_up || !self.is_current(&order.subject) {
            return;
        }
        if order.number == self.building {
            self.progress = Progress::Ready;
        }
        match model {
            Ok(model) => {
                self.failure = None;
                self.model = Some(model);
                self.models += 1;
                self.latest = Some(order);
                if let Some(Err(error)) = self.seen() {
                    self.failure = Some(error.to_string());
                }
            }
            Err(failure) => self.failure = Some(failure),
        }
    }

    fn is_current(&self, subject: &Arc<Subject>) -> bool {
        self.subject.as_ref().is_some_and(|current| Arc::ptr_eq(current, subject))
    }

    /// What is looked at.
    pub fn subject(&self) -> Option<&Subject> {
        self.subject.as_deref()
    }

    /// What is drawn: the latest that was built.
    pub fn model(&self) -> Option<&Model> {
        self.model.as_deref()
    }

    /// How many there have been.
    pub fn models(&self) -> u64 {
        self.models
    }

    /// The latest picture.
    pub fn painting(&self) -> Option<&Painting> {
        self.painting.as_ref()
    }

    /// How many pictures there have been.
    pub fn paintings(&self) -> u64 {
        self.paintings
    }

    /// How many there have been with other rays, or of another model, than the one before.
    pub fn sights(&self) -> u64 {
        self.sights
    }

    /// What tasks call that have something to show.
    pub fn wake(&self) -> &Wake {
        &self.wake
    }

    /// What went wrong last.
    pub fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Whether anything is being read or built.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// How the subject was read.
    pub fn reading(&self) -> &ReadOptions {
        &self.reading
    }

    /// What replaces its kernel, threshold and colours.
    pub fn field(&self) -> &Overrides {
        &self.field
    }

    /// Replaces them by others; the tree is built anew beside what is shown.
    pub fn set_field(&mut self, field: Overrides) {
        if field != self.field {
            self.field = field;
            self.build();
        }
    }

    /// The tree that is traced.
    pub fn kind(&self) -> Kind {
        self.tree.kind()
    }

    /// Traces another tree, which is built beside what is shown.
    pub fn set_kind(&mut self, kind: Kind) {
        if kind != self.kind() {
            self.tree = match kind {
                Kind::ModifiedBvh => Options::modified_bvh(),
                Kind::Fitted => Options::fitted(),
                Kind::Certified => Options::certified(),
            };
            self.build();
        }
    }

    /// What is seen.
    pub fn look(&self) -> &Look {
        &self.look
    }

    /// Shows something else of it.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
    }

    /// Where it is seen from, as options of drawing.
    pub fn viewpoint(&self) -> Viewpoint {
        self.pose.map_or(self.first, |pose| pose.viewpoint())
    }

    /// The camera of the next picture.
    pub fn camera(&self) -> Option<Camera> {
        self.seen()?.ok()
    }

    fn seen(&self) -> Option<Result<Camera, CameraError>> {
        let (subject, model) = (self.subject.as_ref()?, self.model.as_ref()?);
        Some(self.viewpoint().camera(&subject.camera, model.scene()))
    }

    /// Where the eye is; `None` before there is anything to see.
    pub fn pose(&self) -> Option<Pose> {
        let model = self.model.as_ref()?;
        let from_first = || {
            let camera = self.camera()?;
            Some(Pose::of(&camera, model.scene().origin(), model.bounds().center()))
        };
        self.pose.or_else(from_first)
    }

    /// Moves the eye, if that makes a camera.
    pub fn set_pose(&mut self, pose: Pose) {
        let Some((subject, model)) = self.subject.as_ref().zip(self.model.as_ref()) else { return };
        if pose.viewpoint().camera(&subject.camera, model.scene()).is_ok() {
            self.pose = Some(pose);
        }
    }

    /// Back to where it was first seen from.
    pub fn go_home(&mut self) {
        self.pose = None;
    }

    /// The point that the latest picture shows at a place of it, from the top left, each from 0 to 1, in the
    /// coordinates of the scene's file.
    pub fn point_at(&self, (right, down): (f64, f64)) -> Option<DVec3> {
        let Painting { shown, view, model, .. } = self.painting.as_ref()?;
        let index = |share: f64, count: u32| {
            ((share * f64::from(count)) as i64).clamp(0, i64::from(count) - 1) as u32
        };
        let (column, row) = (index(right, view.width()), index(down, view.height()));
        let hit = shown.hits.get((row * view.width() + column) as usize)?;
        let direction = view.camera().exact_direction(column, row, view.width(), view.height());
        let point = view.camera().eye().as_dvec3() + f64::from(hit.t) * direction;
        hit.is_hit().then(|| point + model.scene().origin())
    }

    /// What a pixel shows of the picture that is asked for now.
    pub fn pick(&self, pixel: (u32, u32)) -> Option<Pick> {
        let (model, view) = (self.model.as_ref()?, self.ordered.view(self.camera()?)?);
        Pick::at(model, &self.look.clip, &view, pixel).ok().flatten()
    }

    /// The command line that draws this picture.
    pub fn command_line(&self) -> Option<CommandLine> {
        let subject = self.subject.as_ref()?;
        let line = match self.timeline.is_moving() {
            false => CommandLine::new(&["metaball", "render", &subject.spec]),
            true => {
                let frame = self.timeline.frame();
                let frames = format!("{frame}..{}", frame + 1);
                let line = CommandLine::new(&["metaball", "animate", &subject.spec]);
                line.flag("frames", Some(frames))
            }
        };
        let size = self.ordered.size().map(|(width, height)| format!("{width}x{height}"));
        let is_lit = self.look.light.is_asked();
        let picture = if is_lit { Picture::Phong } else { self.look.picture };
        let line = line
            .reading(&self.reading)
            .field(&self.field)
            .flag("method", (self.kind() != Kind::Certified).then(|| self.kind().name()))
            .viewpoint(&self.viewpoint())
            .picture(picture)
            .clip(&self.look.clip)
            .light(&self.look.light)
            .flag("size", size);
        Some(line.switch("cpu", true))
    }

    /// Pixels across and down of the picture that was ordered last.
    pub fn size(&self) -> Option<(u32, u32)> {
        self.ordered.size()
    }

    /// Writes what is seen to a file, beside all else.
    pub fn export(&mut self, export: Export) {
        let (Some(subject), Some(model)) = (&self.subject, &self.model) else { return };
        let job = Job {
            model: model.clone(),
            camera: subject.camera,
            viewpoint: self.viewpoint(),
            look: self.look.clone(),
            legend: subject.legend.clone(),
            inputs: subject.inputs.clone(),
            export,
        };
        self.exported = None;
        self.exporting = Some(Exporting::new(&*self.crew, job, self.written.post.clone()));
    }

    /// The share of the file that is done, 0 to 1, while one is written.
    pub fn exporting(&self) -> Option<f32> {
        self.exporting.as_ref().map(Exporting::progress)
    }

    /// Breaks the file off. The same picture goes on from what is finished.
    pub fn stop_export(&mut self) {
        if let Some(exporting) = &self.exporting {
            exporting.stop();
        }
    }

    /// The file that was written last, or why it was not.
    pub fn exported(&self) -> Option<Result<&str, &str>> {
        let exported = self.exported.as_ref()?;
        Some(exported.as_deref().map_err(String::as_str))
    }

    /// The frames, where it moves.
    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    /// Shows another frame, or begins or ends to play.
    pub fn set_timeline(&mut self, timeline: Timeline) {
        let is_other = timeline.frame() != self.timeline.frame();
        self.timeline = timeline;
        if is_other {
            self.build();
        }
    }

    /// Orders the picture of this size, if it is another than the one ordered last. `held` says that
    /// the user is about to move the camera on. Returns when it wants to be called again, if nothing
    /// else happens.
    pub fn draw(&mut self, size: (u32, u32), held: bool) -> Option<Duration> {
        let now = Instant::now();
        if self.progress == Progress::Ready
            && let Some(frame) = self.timeline.due(now)
        {
            self.timeline = self.timeline.at(frame, now);
            self.build();
        }
        let (camera, model) = (self.camera()?, self.model.clone()?);
        let moving = held || self.timeline.is_playing();
        let again = self.ordered.order(&self.painter, (model, camera, size, &self.look), moving);
        again.into_iter().chain(self.timeline.wait(now)).min()
    }

    /// Pictures a second, while the camera moves.
    pub fn rate(&self) -> Option<f64> {
        self.ordered.rate()
    }
}
