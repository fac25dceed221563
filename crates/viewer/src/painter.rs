//! The task that draws: coarse while the camera moves, sharp when it rests, then light.

use std::sync::Arc;
use std::time::Duration;

use metaball::{
    Camera, Clip, Error, Hit, LightOptions, Model, Picture, Shown, Solid, Verdict, View,
};
use web_time::Instant;

use crate::crew::Crew;
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

impl Default for Look {
    fn default() -> Self {
        Self { picture: Picture::Phong, clip: Clip::default(), light: LightOptions::default() }
    }
}

impl Look {
    /// Samples of light until an option asks for another number: enough that noise is gone.
    pub const SAMPLES: u32 = 64;
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

/// Draws beside all else, until it is dropped.
#[derive(Debug)]
pub(crate) struct Painter {
    orders: Arc<Mailbox<Order>>,
}

impl Painter {
    /// What is drawn, or why it cannot be, goes to `post`.
    pub(crate) fn new(crew: &Arc<dyn Crew>, post: Post<Result<Painting, String>>) -> Self {
        let orders = Arc::new(Mailbox::new());
        let (own, taken) = (crew.clone(), orders.clone());
        crew.begin(Box::new(move || {
            Box::pin(
                async move { work(&Studio { crew: &*own, orders: &taken, post: &post }).await },
            )
        }));
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

/// What all pictures share.
struct Studio<'a> {
    crew: &'a dyn Crew,
    orders: &'a Mailbox<Order>,
    post: &'a Post<Result<Painting, String>>,
}

async fn work(studio: &Studio<'_>) {
    let Studio { orders, post, .. } = studio;
    let mut pace = Pace::default();
    let mut next = orders.take().await;
    while let Some(first) = next.take() {
        let (model, clip) = (first.model.clone(), first.look.clip.clone());
        let solid = match model.cut(&clip) {
            Ok(solid) => solid,
            Err(error) => {
                post.send(Err(told(&error)));
                next = orders.take().await;
                continue;
            }
        };
        let mut order = first;
        // The same solid is kept from picture to picture, with what it learns.
        next = loop {
            let easel = Easel { studio, solid: &solid, order: &order };
            match easel.paint(&mut pace).await {
                Ok(()) | Err(Error::Interrupted) => {}
                Err(error) => post.send(Err(told(&error))),
            }
            match orders.take().await {
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
    studio: &'a Studio<'a>,
    solid: &'a Solid<'a>,
    order: &'a Order,
}

impl Easel<'_> {
    async fn paint(&self, pace: &mut Pace) -> Result<(), Error> {
        let &Order { size, moving, .. } = self.order;
        let (coarse, is_first) = (pace.coarse(size), pace.is_new());
        if (moving || is_first) && coarse != size {
            self.draw(coarse, Stage::Coarse, pace).await?;
            if moving {
                return Ok(());
            }
        }
        self.draw(size, Stage::Sharp, pace).await?;
        if !moving && self.order.look.light.is_asked() {
            self.light().await?;
        }
        Ok(())
    }

    async fn draw(&self, size: (u32, u32), stage: Stage, pace: &mut Pace) -> Result<(), Error> {
        let view = View::new(self.order.camera, size.0, size.1)?;
        let mut time = Duration::ZERO;
        let mut steps = self.solid.draw(&view, self.order.look.picture)?;
        while let Some(shown) = timed(&mut time, || steps.next()) {
            if let Some(shown) = shown {
                pace.learn(view.pixels(), time);
                self.show(shown, &view, stage, time);
            }
            self.turn(!self.order.moving).await?;
        }
        Ok(())
    }

    async fn light(&self) -> Result<(), Error> {
        let (width, height) = self.order.size;
        let view = View::new(self.order.camera, width, height)?;
        let mut time = Duration::ZERO;
        let mut steps = self.solid.light(&view, &self.order.look.light)?;
        while let Some(shown) = timed(&mut time, || steps.next()) {
            if let Some((samples, shown)) = shown {
                self.show(shown, &view, Stage::Lit(samples), time);
            }
            self.turn(true).await?;
        }
        Ok(())
    }

    /// Lets others have their turn. A picture that is not to be shown at once is given up for the next
    /// order.
    async fn turn(&self, can_be_given_up: bool) -> Result<(), Error> {
        let Studio { crew, orders, .. } = self.studio;
        crew.turn().await;
        let stops = if can_be_given_up { orders.calls() } else { orders.is_closed() };
        if stops { Err(Error::Interrupted) } else { Ok(()) }
    }

    fn show(&self, shown: Shown, view: &View, stage: Stage, time: Duration) {
        let (model, view) = (self.order.model.clone(), view.clone());
        let is_undecided = |hit: &&Hit| hit.verdict == Verdict::Undecided;
        let undecided = shown.hits.iter().filter(is_undecided).count();
        self.studio.post.send(Ok(Painting { shown, view, model, stage, undecided, time }));
    }
}

/// Does something, and adds the time that it takes.
fn timed<T>(time: &mut Duration, something: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let done = something();
    *time += start.elapsed();
    done
}
