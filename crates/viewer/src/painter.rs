//! The thread that draws: coarse while the camera moves, sharp when it rests, then light.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use metaball::{
    Camera, Clip, Error, Hit, LightOptions, Model, Picture, Shown, Solid, Verdict, View,
};

use crate::events::Post;
use crate::mailbox::Mailbox;
use crate::pace::Pace;
use crate::subject::told;

/// What a picture shows, but for where it is seen from.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// What it shows where no light is asked for.
    pub picture: Picture,
    /// The region that the solid is cut to, in the coordinates of the scene's file.
    pub clip: Clip,
    /// Ray traced light, gathered while the camera rests.
    pub light: LightOptions,
}

/// What is to be drawn.
#[derive(Debug, Clone)]
pub(crate) struct Order {
    pub(crate) model: Arc<Model>,
    pub(crate) camera: Camera,
    /// Pixels across and down, when sharp.
    pub(crate) size: (u32, u32),
    pub(crate) look: Look,
    /// Whether the next order will soon be there.
    pub(crate) moving: bool,
}

/// What was drawn.
#[derive(Debug)]
pub struct Painting {
    /// The picture and its hits.
    pub shown: Shown,
    /// Its rays: the size is less than was asked for while it is coarse.
    pub view: View,
    /// What of.
    pub model: Arc<Model>,
    /// How far it is.
    pub stage: Stage,
    /// Pixels that arithmetic could not decide.
    pub undecided: usize,
    /// The time that its rays took; of light, all of its samples so far.
    pub time: Duration,
}

/// How far a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Of fewer pixels than were asked for, since the camera moves.
    Coarse,
    /// A ray through each pixel.
    Sharp,
    /// In ray traced light, of so many samples.
    Lit(u32),
}

/// Draws on a thread of its own, until it is dropped.
#[derive(Debug)]
pub(crate) struct Painter {
    orders: Arc<Mailbox<Order>>,
}

impl Painter {
    /// What is drawn, or why it cannot be, goes to `post`.
    pub(crate) fn new(post: Post<Result<Painting, String>>) -> Self {
        let orders = Arc::new(Mailbox::new());
        let taken = orders.clone();
        thread::spawn(move || work(&taken, &post));
        Self { orders }
    }

    /// Draws this next. A sharp picture that is being drawn is given up, a coarse one is shown.
    pub(crate) fn order(&self, order: Order) {
        self.orders.put(order);
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        self.orders.close();
    }
}

fn work(orders: &Mailbox<Order>, post: &Post<Result<Painting, String>>) {
    let mut pace = Pace::default();
    let mut next = orders.take();
    while let Some(first) = next.take() {
        let (model, clip) = (first.model.clone(), first.look.clip.clone());
        let solid = match model.cut(&clip) {
            Ok(solid) => solid,
            Err(error) => {
                post.send(Err(told(&error)));
                next = orders.take();
                continue;
            }
        };
        let mut order = first;
        // The same solid is kept from picture to picture, with what it learns.
        next = loop {
            let easel = Easel { solid: &solid, order: &order, orders, post };
            match easel.paint(&mut pace) {
                Ok(()) | Err(Error::Interrupted) => {}
                Err(error) => post.send(Err(told(&error))),
            }
            match orders.take() {
                Some(next) if Arc::ptr_eq(&next.model, &model) && next.look.clip == clip => {
                    order = next;
                }
                other => break other,
            }
        };
    }
}

/// One order being drawn.
struct Easel<'a> {
    solid: &'a Solid<'a>,
    order: &'a Order,
    orders: &'a Mailbox<Order>,
    post: &'a Post<Result<Painting, String>>,
}

impl Easel<'_> {
    fn paint(&self, pace: &mut Pace) -> Result<(), Error> {
        let &Order { size, moving, .. } = self.order;
        let (coarse, is_first) = (pace.coarse(size), pace.is_new());
        if (moving || is_first) && coarse != size {
            self.draw(coarse, Stage::Coarse, pace)?;
            if moving {
                return Ok(());
            }
        }
        self.draw(size, Stage::Sharp, pace)?;
        if !moving && self.order.look.light.is_asked() {
            self.light()?;
        }
        Ok(())
    }

    fn draw(&self, size: (u32, u32), stage: Stage, pace: &mut Pace) -> Result<(), Error> {
        let view = View::new(self.order.camera, size.0, size.1)?;
        let start = Instant::now();
        let is_sharp = !self.order.moving;
        let watch = || self.go_on(is_sharp);
        let shown = self.solid.draw(&view, self.order.look.picture, watch)?;
        let time = start.elapsed();
        pace.learn(view.pixels(), time);
        self.show(shown, view, stage, time);
        Ok(())
    }

    fn light(&self) -> Result<(), Error> {
        let (width, height) = self.order.size;
        let view = View::new(self.order.camera, width, height)?;
        let start = Instant::now();
        let light = &self.order.look.light;
        self.solid.light(
            &view,
            light,
            || self.go_on(true),
            |samples, shown| {
                self.show(shown, view.clone(), Stage::Lit(samples), start.elapsed());
            },
        )
    }

    /// A picture that is not to be shown at once is given up for the next order.
    fn go_on(&self, can_be_given_up: bool) -> ControlFlow<()> {
        let stops = if can_be_given_up { self.orders.calls() } else { self.orders.is_closed() };
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn show(&self, shown: Shown, view: View, stage: Stage, time: Duration) {
        let model = self.order.model.clone();
        let is_undecided = |hit: &&Hit| hit.verdict == Verdict::Undecided;
        let undecided = shown.hits.iter().filter(is_undecided).count();
        self.post.send(Ok(Painting { shown, view, model, stage, undecided, time }));
    }
}
